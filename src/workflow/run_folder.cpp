#include "run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "figure_kinds.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "whole_file.hpp"

namespace hamflow {

namespace fs = std::filesystem;

namespace {

using Names = std::vector<fs::path>;

bool is_there(const fs::path& file) {
  std::error_code none;
  return fs::exists(fs::symlink_status(file, none));
}

/// The files that a run or a sweep leaves, those included that a kill leaves half written. The checkpoint is the last:
/// what a kill interrupts on the way is still a run.
Names names_of(FolderOf what) {
  const std::vector<const char*> plain = what == FolderOf::run
                                             ? std::vector{"run.h5", "trajectory.csv", "summary.json", "checkpoint.bin"}
                                             : std::vector{"sweep.h5", "sweep.csv", "summary.json"};
  Names names;
  for (const char* name : plain) {
    names.push_back(next_name(next_name(name)));
    names.push_back(next_name(name));
    names.emplace_back(name);
  }
  return names;
}

/// What is in figures/ under the name of a figure of a run.
Names figures_in(const fs::path& folder) {
  Names names;
  std::error_code none;
  if (!fs::is_directory(fs::symlink_status(folder / "figures", none))) return names;
  for (const FigureKindInfo& kind : figure_kinds()) {
    for (const char* format : {".svg", ".pdf", ".png"}) {
      fs::path name = fs::path("figures") / (kind.name + format);
      if (is_there(folder / name)) names.push_back(std::move(name));
    }
  }
  return names;
}

Names found_in(const fs::path& folder, FolderOf what) {
  Names found = what == FolderOf::run ? figures_in(folder) : Names{};
  for (fs::path& name : names_of(what)) {
    if (is_there(folder / name)) found.push_back(std::move(name));
  }
  return found;
}

void remove_file(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(fs::symlink_status(file, error))) {
    throw FileError(file.string() + " is a folder, which no run leaves: it is not removed; give --out another");
  }
  fs::remove(file, error);
  if (error) throw FileError("cannot remove " + file.string() + ": " + error.message());
}

void clear(const fs::path& folder, FolderOf what) {
  const fs::path other = folder / (what == FolderOf::run ? "sweep.h5" : "run.h5");
  if (is_there(other)) {
    throw FileError(std::string("found ") + (what == FolderOf::run ? "a sweep" : "a run") + " in " + folder.string() +
                    ", which --force does not replace; allowed a folder of a " +
                    (what == FolderOf::run ? "run" : "sweep") + ", or --out another");
  }
  const FolderLock lock(folder);
  for (const fs::path& name : found_in(folder, what)) remove_file(folder / name);
  std::error_code none;
  const fs::path figures = folder / "figures";
  if (what == FolderOf::run && fs::is_directory(fs::symlink_status(figures, none)) && fs::is_empty(figures, none)) {
    fs::remove(figures, none);
  }
}

}  // namespace

std::string left_in(const fs::path& folder, FolderOf what) {
  Names found = found_in(folder, what);
  std::erase_if(found, [](const fs::path& name) { return name.extension() == ".new"; });  // nothing that was finished
  return joined(found, [](const fs::path& name) { return name.string(); });
}

void make_folder(const fs::path& folder, FolderOf what, bool force) {
  std::error_code error;
  if (is_there(folder)) {
    if (!fs::is_directory(folder, error)) throw FileError(folder.string() + " exists and is no folder");
    if (!force) {
      throw FileError("the folder " + folder.string() + " exists; give " +
                      (what == FolderOf::run ? "--resume to go on with the run in it, " : "") +
                      "--force to replace it, or --out another");
    }
    clear(folder, what);
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
  WholeFile whole(file, next_name(file));
  write_whole(whole, text);
}

}  // namespace hamflow
