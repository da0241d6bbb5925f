// A file is whole or it is not there: it is written under another name, forced to the disk and renamed. A kill, a full
// disk or an error on the way leaves what was there before. The file under the other name is always a new one: a link
// that somebody has put there is removed, and never followed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace hamflow {

/// The name under which a file of a run's folder is written first. The folder belongs to one writer at a time, so that
/// the name is always the same, and what a kill leaves under it is replaced by the next run.
std::filesystem::path next_name(const std::filesystem::path& file);

/// Opens a new file for writing in the place of what had its name; a link is removed, not followed.
/// @return the descriptor   @throws FileError
int open_new_file(const std::filesystem::path& file);

class WholeFile {
 public:
  /// A file that somebody else names, e.g. with -o: written beside it under a name of this process, hidden. A device or
  /// a pipe is written directly, and a link is followed: it stays, and the file that it leads to is replaced.
  explicit WholeFile(const std::filesystem::path& file);
  /// A file written under the name `part`.
  WholeFile(std::filesystem::path file, std::filesystem::path part);
  /// Removes what was written unless it was put in place.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;
  /// Where to write, for those who open files themselves, as new ones.
  const std::filesystem::path& part() const { return part_; }
  /// Appends to it. @throws FileError naming the reason, e.g. that the disk is full
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  /// Forced to the disk and renamed. @throws FileError
  void put_in_place();

 private:
  [[noreturn]] void fail(int error) const;
  void close_descriptor();

  std::filesystem::path file_;
  std::filesystem::path part_;
  int descriptor_ = -1;
  bool waits_ = true;
};

/// @throws FileError naming the reason, e.g. that the disk is full; what was there is then still there
void write_whole(WholeFile& file, std::span<const std::byte> bytes);
void write_whole(WholeFile& file, std::string_view text);

/// Until then a crash of the machine can lose what was written. @throws FileError
void force_to_disk(const std::filesystem::path& file_or_folder);

}  // namespace hamflow
