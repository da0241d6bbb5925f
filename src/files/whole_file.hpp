// Writes a file as a whole or not at all: it is written under another name, forced to the disk, and renamed. A kill, a
// full disk or an error leaves the previous file. The other name always gets a new file: a link with that name is
// removed and never followed.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace hamflow {

/// Returns the name under which a file in a run's folder is first written. Only one writer uses the folder at a time,
/// so the name is always the same, and the next run replaces a file that a kill has left.
std::filesystem::path next_name(const std::filesystem::path& file);

/// Opens a new file for writing in place of any file of that name. A link is removed, not followed.
/// @return the descriptor   @throws FileError
int open_new_file(const std::filesystem::path& file);

class WholeFile {
 public:
  /// Writes a file that the user names, for example with -o. It is first written in the same folder under a hidden name
  /// that contains the process id. A device or a pipe is written directly. A link is kept, and the file that it points
  /// to is replaced.
  explicit WholeFile(const std::filesystem::path& file);
  /// Writes a file first under the name `part`.
  WholeFile(std::filesystem::path file, std::filesystem::path part);
  /// Removes the written part, unless put_in_place() was called.
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;
  /// The path to write to, for code that opens a new file itself.
  const std::filesystem::path& part() const { return part_; }
  /// Appends bytes. @throws FileError with the reason, for example a full disk
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  /// Forces the file to the disk and renames it. @throws FileError
  void put_in_place();

 private:
  [[noreturn]] void fail(int error) const;
  void close_descriptor();

  std::filesystem::path file_;
  std::filesystem::path part_;
  int descriptor_ = -1;
  bool is_pending_ = true;
};

/// Writes all bytes and puts the file in place. @throws FileError with the reason, for example a full disk; the
/// previous file is kept in this case
void write_whole(WholeFile& file, std::span<const std::byte> bytes);
void write_whole(WholeFile& file, std::string_view text);

/// Forces data to the disk; before that a crash of the machine can lose them. @throws FileError
void force_to_disk(const std::filesystem::path& file_or_folder);

}  // namespace hamflow
