// The folder that a run leaves: run.h5, summary.json, trajectory.csv, figures/; that of a sweep: sweep.h5, sweep.csv,
// section.csv, summary.json, members.bin; that of a comparison: compare.json, compare.csv, figures/; that of a
// reversal: reverse.h5, reverse.json.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hamflow {

struct Scenario;

/// What leaves a folder. Each knows its own files, and takes no others away.
enum class FolderOf { run, sweep, comparison, reversal };

/// The stem of the figure that a comparison draws.
constexpr const char* comparison_figure = "work-precision";

/// Makes the folder. With `force` an existing one is used, and what an earlier one of its kind left in it is removed,
/// nothing else: of figures/ only the figures that it draws.
/// @throws FileError when it exists or cannot be made; with `force` when it is that of another kind
void make_folder(const std::filesystem::path& folder, FolderOf what, bool force);

/// @throws Rejection when the file from which particles start is among what make_folder would remove with `force`
void refuse_own_input(const Scenario& scenario, const std::filesystem::path& folder, FolderOf what);

/// @throws FileError when the folder is that of another kind, which would be spoilt by what goes on in it
void refuse_other_kind(const std::filesystem::path& folder, FolderOf what);

/// The names of what a run left in an existing folder, e.g. "run.h5, figures/orbit.svg"; empty if it left nothing.
std::string left_in(const std::filesystem::path& folder, FolderOf what);

/// Keeps other runs out of a folder while it lives: two writers would spoil each other's files.
class FolderLock {
 public:
  /// @throws FileError when another run has it
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// Writes a whole text file of the folder, or leaves the old one. @throws FileError
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace hamflow
