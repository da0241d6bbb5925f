#include "hamflow/workflow/work_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <toml++/toml.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "figure_kinds.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "whole_file.hpp"

namespace hamflow {

namespace fs = std::filesystem;

namespace {

using Names = std::vector<fs::path>;

std::vector<std::string> names_of_figures() {
  std::vector<std::string> names;
  for (const FigureKindInfo& kind : figure_kinds()) names.push_back(kind.name);
  return names;
}

}  // namespace

// The file from which work is resumed is removed last, so that a folder is still recognised if a kill interrupts the
// removal.
const FolderKind& run_folder() {
  static const FolderKind kind{.name = "run",
                               .signs = {"run.h5"},
                               .files = {"run.h5", "trajectory.csv", "summary.json", "checkpoint.bin"},
                               .figures = names_of_figures(),
                               .resumes_from = "checkpoint.bin"};
  return kind;
}

const FolderKind& sweep_folder() {
  static const FolderKind kind{.name = "sweep",
                               .signs = {"sweep.h5", "members.bin"},
                               .files = {"sweep.h5", "sweep.csv", "section.csv", "summary.json", "members.bin"},
                               .resumes_from = "members.bin"};
  return kind;
}

const FolderKind& comparison_folder() {
  static const FolderKind kind{.name = "comparison",
                               .signs = {"compare.json"},
                               .files = {"compare.json", "compare.csv"},
                               .figures = {"work-precision"}};
  return kind;
}

const FolderKind& reversal_folder() {
  static const FolderKind kind{.name = "reversal",
                               .signs = {"reverse.h5", "reversal.bin"},
                               .files = {"reverse.h5", "reverse.json", "reversal.bin"},
                               .resumes_from = "reversal.bin"};
  return kind;
}

namespace {

bool is_there(const fs::path& file) {
  std::error_code none;
  return fs::exists(fs::symlink_status(file, none));
}

/// Returns the files of this kind that exist in the folder, including half-written ones left by a kill.
Names found_in(const fs::path& folder, const FolderKind& kind) {
  Names names;
  std::error_code none;
  if (fs::is_directory(fs::symlink_status(folder / "figures", none))) {
    for (const std::string& figure : kind.figures) {
      for (const char* format : {".svg", ".pdf", ".png"}) names.push_back(fs::path("figures") / (figure + format));
    }
  }
  for (const std::string& name : kind.files) {
    names.push_back(next_name(next_name(name)));
    names.push_back(next_name(name));
    names.emplace_back(name);
  }
  std::erase_if(names, [&](const fs::path& name) { return !is_there(folder / name); });
  return names;
}

/// Returns the names of the finished files, such as "run.h5, figures/orbit.svg"; empty if there are none.
std::string finished_files_in(const fs::path& folder, const FolderKind& kind) {
  Names found = found_in(folder, kind);
  std::erase_if(found, [](const fs::path& name) { return name.extension() == ".new"; });
  return joined(found, [](const fs::path& name) { return name.string(); });
}

void remove_file(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(fs::symlink_status(file, error))) {
    throw FileError(file.string() + " is a folder, which hamflow did not make, so it is not removed; give another " +
                    option_name("out"));
  }
  fs::remove(file, error);
  if (error) throw FileError("cannot remove " + file.string() + ": " + error.message());
}

/// Returns the name of the other kind to which the folder belongs; empty: none.
std::string other_kind_in(const fs::path& folder, const FolderKind& kind) {
  for (const FolderKind* other : {&run_folder(), &sweep_folder(), &comparison_folder(), &reversal_folder()}) {
    const bool is_other = std::any_of(other->signs.begin(), other->signs.end(),
                                      [&](const std::string& sign) { return is_there(folder / sign); });
    if (other->name != kind.name && is_other) return other->name;
  }
  return {};
}

/// Returns whether a file, or the target of a link, is one of the names in the folder.
bool is_among(const fs::path& file, const fs::path& folder, const Names& names) {
  std::error_code none;
  const fs::path there = fs::weakly_canonical(fs::absolute(folder), none);
  const fs::path whole = fs::absolute(file);
  const fs::path spellings[] = {fs::weakly_canonical(whole, none),
                                fs::weakly_canonical(whole.parent_path(), none) / whole.filename()};
  return std::any_of(names.begin(), names.end(), [&](const fs::path& name) {
    return std::any_of(std::begin(spellings), std::end(spellings),
                       [&](const fs::path& spelling) { return spelling == there / name; });
  });
}

/// @throws Rejection if the file with the initial particles is among the names
void refuse_own_input(const Scenario& scenario, const fs::path& folder, const Names& removed) {
  const std::string key = "problem." + scenario.problem->info.file_key;
  const auto given = scenario.settings.find(key);
  if (given == scenario.settings.end()) return;
  // A setting is stored as TOML text, with quotes.
  const toml::table read = toml::parse("file = " + given->second.text);
  const auto file = read["file"].value<std::string>();
  if (!file || !is_among(fs::path(scenario.file).parent_path() / *file, folder, removed)) return;
  throw Rejection({{scenario.file, given->second.line, given->second.column, key,
                    "found \"" + *file + "\", which " + option_name("force") + " would remove from " + folder.string() +
                        "; allowed another " + option_name("out") + ", or a copy of the file in another folder"}});
}

}  // namespace

WorkFolder::WorkFolder(fs::path folder, const FolderKind& kind, Existing existing)
    : path_(std::move(folder)), kind_(&kind), existing_(existing), is_there_(is_there(path_)) {
  std::error_code error;
  if (!is_there_) {
    if (existing == Existing::resume) {
      note_ = "the folder " + path_.string() + " does not exist, so the " + kind.name + " starts from the beginning";
    }
    return;
  }
  if (!fs::is_directory(path_, error)) throw FileError(path_.string() + " exists and is not a folder");
  const std::string other = other_kind_in(path_, kind);
  if (existing == Existing::refuse) {
    if (!other.empty()) {
      throw FileError("the folder " + path_.string() + " exists and contains a " + other + "; give another " +
                      option_name("out"));
    }
    throw FileError(
        "the folder " + path_.string() + " exists; give " +
        (kind.resumes_from.empty() ? "" : option_name("resume") + " to continue the " + kind.name + " in it, ") +
        option_name("force") + " to replace it, or another " + option_name("out"));
  }
  lock();
  resumes_ = existing == Existing::resume && is_there(path_ / kind.resumes_from);
  if (resumes_) return;
  if (!other.empty()) {
    throw FileError(
        "found a " + other + " in " + path_.string() +
        (existing == Existing::replace ? ", which is not replaced" : ", which cannot be resumed as a " + kind.name) +
        "; allowed a folder of a " + kind.name + ", or another " + option_name("out"));
  }
  if (existing == Existing::replace) return;
  if (const std::string left = finished_files_in(path_, kind); !left.empty()) {
    throw FileError("cannot resume: " + path_.string() + " contains " + left + ", but no " + kind.resumes_from +
                    "; give another " + option_name("out") + ", or " + option_name("force") + " to replace the files");
  }
  note_ = "there is no " + kind.resumes_from + " in " + path_.string() + ", so the " + kind.name +
          " starts from the beginning";
}

WorkFolder::~WorkFolder() { unlock(); }

WorkFolder::WorkFolder(WorkFolder&& other) noexcept
    : path_(std::move(other.path_)),
      kind_(other.kind_),
      existing_(other.existing_),
      is_there_(other.is_there_),
      resumes_(other.resumes_),
      note_(std::move(other.note_)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

void WorkFolder::lock() {
  descriptor_ = open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  // Some network folders cannot be locked. Then other processes are not kept out.
  if (descriptor_ >= 0 && flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    unlock();
    throw FileError("another process is writing into the folder " + path_.string());
  }
}

void WorkFolder::unlock() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
}

void WorkFolder::prepare() {
  if (resumes_) return;
  std::error_code error;
  if (!is_there_) {
    const bool made = fs::create_directories(path_, error);
    if (error) throw FileError("cannot make the folder " + path_.string() + ": " + error.message());
    if (!made)
      throw FileError("another process has made the folder " + path_.string() + " meanwhile; give another " +
                      option_name("out"));
    lock();
    is_there_ = true;
    return;
  }
  for (const fs::path& name : found_in(path_, *kind_)) remove_file(path_ / name);
  const fs::path figures = path_ / "figures";
  if (!kind_->figures.empty() && fs::is_directory(fs::symlink_status(figures, error)) && fs::is_empty(figures, error)) {
    fs::remove(figures, error);
  }
}

void WorkFolder::prepare(const Scenario& scenario) {
  if (is_there_ && !resumes_) refuse_own_input(scenario, path_, found_in(path_, *kind_));
  prepare();
}

void WorkFolder::write(const fs::path& name, const std::string& text) const { write_text(path_ / name, text); }

void WorkFolder::remove(const fs::path& name) const { fs::remove(path_ / name); }

fs::path WorkFolder::figures() const {
  std::error_code error;
  fs::create_directories(path_ / "figures", error);
  if (error) throw FileError("cannot make the folder " + (path_ / "figures").string() + ": " + error.message());
  return path_ / "figures";
}

void write_text(const fs::path& file, const std::string& text) {
  WholeFile whole(file, next_name(file));
  write_whole(whole, text);
}

}  // namespace hamflow
