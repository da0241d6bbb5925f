#include "run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>

#include "hamflow/core/error.hpp"

namespace hamflow {

namespace fs = std::filesystem;

void make_folder(const fs::path& folder, bool force) {
  std::error_code error;
  if (fs::exists(folder, error)) {
    if (!fs::is_directory(folder)) throw FileError(folder.string() + " exists and is no folder");
    if (!force) {
      throw FileError("the folder " + folder.string() +
                      " exists; give --resume to go on with the run in it, --force to replace it, or --out another");
    }
    const FolderLock lock(folder);
    for (const char* left : {"checkpoint.bin", "run.h5", "summary.json", "trajectory.csv", "figures"})
      fs::remove_all(folder / left, error);
    if (error) throw FileError("cannot clear " + folder.string() + ": " + error.message());
  }
  fs::create_directories(folder, error);
  if (error) throw FileError("cannot make the folder " + folder.string() + ": " + error.message());
}

FolderLock::FolderLock(const fs::path& folder) : descriptor_(open(folder.c_str(), O_RDONLY | O_CLOEXEC)) {
  // Where files cannot be locked (some network folders) nobody is kept out.
  if (descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(descriptor_);
    throw FileError("another run is writing into the folder " + folder.string());
  }
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

void write_text(const fs::path& file, const std::string& text) {
  std::ofstream out(file);
  out << text;
  out.flush();
  if (!out) throw FileError("cannot write " + file.string());
}

}  // namespace hamflow
