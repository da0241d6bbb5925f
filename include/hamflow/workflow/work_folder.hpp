// Output folder of a command. It is refused, made, replaced or resumed, and then locked; each file in it is written as
// a whole. Runs, sweeps, comparisons, reversals, sessions and hamflow-reproduce use this class.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hamflow {

struct Scenario;

/// What to do with a folder that exists.
enum class Existing {
  refuse,   // throw FileError
  replace,  // remove the files of earlier work of the same kind, and no others
  // continue the work, with the same bits as without an interruption; FileError if the files are of other work
  resume
};

/// A kind of folder: the files that its command writes. Only these are ever removed.
struct FolderKind {
  std::string name;                    // as in a sentence, for example "run"
  std::vector<std::string> signs;      // files that identify this kind
  std::vector<std::string> files;      // all files except figures/, in the order in which they are removed
  std::vector<std::string> figures{};  // stems of the files in figures/
  std::string resumes_from{};          // file that is needed to resume; empty: this kind cannot be resumed
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
  /// Examines the folder without changing it, and locks it if it exists.
  /// @throws FileError if it exists and Existing::refuse is given; if it is of another kind; if another process writes
  /// into it; with Existing::resume, if it has no file to resume from
  WorkFolder(std::filesystem::path folder, const FolderKind& kind, Existing existing);
  ~WorkFolder();
  WorkFolder(WorkFolder&& other) noexcept;
  WorkFolder& operator=(WorkFolder&&) = delete;

  /// Whether work is resumed: Existing::resume was given and the file to resume from exists.
  bool resumes() const { return resumes_; }
  /// A note for the user; empty: there is none.
  const std::string& note() const { return note_; }

  /// Makes the folder if it does not exist, and removes the files that are replaced. Does nothing if work is resumed.
  /// @throws FileError if it cannot be made or emptied, or another process has made it in the meantime
  void prepare();
  /// The same for the work of a scenario.
  /// @throws Rejection if the file with the initial particles is one of the files that would be removed
  void prepare(const Scenario& scenario);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }
  /// Writes a text file as a whole; if that fails, the old file is kept. @throws FileError
  void write(const std::filesystem::path& name, const std::string& text) const;
  void remove(const std::filesystem::path& name) const;
  /// Makes the subfolder figures/ and returns its path. @throws FileError
  std::filesystem::path figures() const;

 private:
  void lock();
  void unlock();

  std::filesystem::path path_;
  const FolderKind* kind_;
  Existing existing_;
  bool is_there_ = false;
  bool resumes_ = false;
  std::string note_;
  int descriptor_ = -1;
};

/// Writes a text file as a whole; if that fails, the old file is kept. @throws FileError
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace hamflow
