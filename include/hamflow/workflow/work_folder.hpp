// The folder that a command writes into: refused, made, replaced or gone on with, locked from then on, its files
// written whole. Run, sweep, comparison, reversal, session and reproduction use it alike.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hamflow {

struct Scenario;

/// What to do with a folder that exists.
enum class Existing {
  refuse,   // FileError
  replace,  // what an earlier one of its kind left in it is removed, nothing else
  resume    // the work in it goes on, bit for bit as if it had never stopped; FileError where the files are not its own
};

/// A kind of folder: what its command leaves in it. Each knows its own files, and takes no others away.
struct FolderKind {
  std::string name;                    // in a sentence, e.g. "run"
  std::vector<std::string> signs;      // files that tell it from the others
  std::vector<std::string> files;      // all beside figures/, in the order in which they are removed
  std::vector<std::string> figures{};  // the stems of those that are drawn into figures/
  std::string goes_on_from{};          // the file without which nothing goes on; empty: it never goes on
};

/// run.h5, trajectory.csv, summary.json, checkpoint.bin and figures/.
const FolderKind& run_folder();
/// sweep.h5, sweep.csv, section.csv, summary.json and members.bin.
const FolderKind& sweep_folder();
/// compare.json, compare.csv and figures/work-precision.
const FolderKind& comparison_folder();
/// reverse.h5, reverse.json and reversal.bin.
const FolderKind& reversal_folder();

class WorkFolder {
 public:
  /// Looks at the folder, changes nothing in it, and keeps other processes out of one that exists.
  /// @throws FileError when it exists and is to be refused; when it is of another kind; when another process is writing
  /// into it; with Existing::resume when its files have nothing to go on from
  WorkFolder(std::filesystem::path folder, const FolderKind& kind, Existing existing);
  ~WorkFolder();
  WorkFolder(WorkFolder&& other) noexcept;
  WorkFolder& operator=(WorkFolder&&) = delete;

  /// Whether the work in it goes on: Existing::resume, and the file is there from which it does.
  bool goes_on() const { return goes_on_; }
  /// What is worth saying about how it begins; empty: nothing.
  const std::string& note() const { return note_; }

  /// Makes the folder where there is none, and removes what is to be replaced. Nothing where the work goes on.
  /// @throws FileError when it cannot be made or emptied, or another process has made it meanwhile
  void prepare();
  /// The same for the work of a scenario.
  /// @throws Rejection when the file from which its particles start is among what would be removed
  void prepare(const Scenario& scenario);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }
  /// Writes a whole text file, or leaves the old one. @throws FileError
  void write(const std::filesystem::path& name, const std::string& text) const;
  void remove(const std::filesystem::path& name) const;
  /// The folder's figures/, which is made. @throws FileError
  std::filesystem::path figures() const;

 private:
  void lock();
  void unlock();

  std::filesystem::path path_;
  const FolderKind* kind_;
  Existing existing_;
  bool is_there_ = false;
  bool goes_on_ = false;
  std::string note_;
  int descriptor_ = -1;
};

/// Writes a whole text file, or leaves the old one. @throws FileError
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace hamflow
