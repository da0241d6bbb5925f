// The folder that a run leaves: run.h5, summary.json, trajectory.csv, figures/.
#pragma once

#include <filesystem>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// `<scenario stem>.run` in the working directory, unless the scenario or the command line names another.
std::filesystem::path folder_of(const Scenario& scenario, const std::string& out);
/// Makes the folder. With `force` an existing one is used, and what an earlier run left in it is removed, nothing else.
/// @throws FileError when it exists or cannot be made
void make_folder(const std::filesystem::path& folder, bool force);
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
/// Writes a text file. @throws FileError
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace hamflow
