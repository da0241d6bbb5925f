// The folder that a run leaves: run.h5, summary.json, trajectory.csv, figures/.
#pragma once

#include <filesystem>
#include <string>

namespace hamflow {

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
