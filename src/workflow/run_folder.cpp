#include "run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <toml++/toml.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "figure_kinds.hpp"
#include "gas_options.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "whole_file.hpp"

namespace hamflow {

namespace fs = std::filesystem;

namespace {

using Names = std::vector<fs::path>;

bool is_there(const fs::path& file) {
  std::error_code none;
  return fs::exists(fs::symlink_status(file, none));
}

/// What a folder is of, and what it has beside figures/. What it goes on from is the last: what a kill interrupts on
/// the way is still a run, or a sweep.
struct KindOfFolder {
  FolderOf what;
  const char* name;                // in a sentence
  std::vector<const char*> signs;  // which tell it from the others
  std::vector<const char*> files;
};

const std::vector<KindOfFolder>& kinds_of_folders() {
  static const std::vector<KindOfFolder> all{
      {FolderOf::run, "run", {"run.h5"}, {"run.h5", "trajectory.csv", "summary.json", "checkpoint.bin"}},
      {FolderOf::sweep,
       "sweep",
       {"sweep.h5", "members.bin"},
       {"sweep.h5", "sweep.csv", "section.csv", "summary.json", "members.bin"}},
      {FolderOf::comparison, "comparison", {"compare.json"}, {"compare.json", "compare.csv"}},
      {FolderOf::reversal, "reversal", {"reverse.h5", "reversal.bin"}, {"reverse.h5", "reverse.json", "reversal.bin"}}};
  return all;
}

const KindOfFolder& kind_of(FolderOf what) {
  const auto& all = kinds_of_folders();
  return *std::find_if(all.begin(), all.end(), [&](const KindOfFolder& kind) { return kind.what == what; });
}

/// The files that a folder has, those included that a kill leaves half written.
Names names_of(FolderOf what) {
  Names names;
  for (const char* name : kind_of(what).files) {
    names.push_back(next_name(next_name(name)));
    names.push_back(next_name(name));
    names.emplace_back(name);
  }
  return names;
}

/// The figures that are drawn into figures/. One of a sweep is drawn where it was asked for.
std::vector<std::string> figures_of(FolderOf what) {
  std::vector<std::string> names;
  if (what == FolderOf::comparison) names.emplace_back(comparison_figure);
  if (what != FolderOf::run) return names;
  for (const FigureKindInfo& kind : figure_kinds()) names.push_back(kind.name);
  return names;
}

/// What is in figures/ under the name of a figure of such a folder.
Names figures_in(const fs::path& folder, FolderOf what) {
  Names names;
  std::error_code none;
  if (!fs::is_directory(fs::symlink_status(folder / "figures", none))) return names;
  for (const std::string& figure : figures_of(what)) {
    for (const char* format : {".svg", ".pdf", ".png"}) {
      fs::path name = fs::path("figures") / (figure + format);
      if (is_there(folder / name)) names.push_back(std::move(name));
    }
  }
  return names;
}

Names found_in(const fs::path& folder, FolderOf what) {
  Names found = figures_in(folder, what);
  for (fs::path& name : names_of(what)) {
    if (is_there(folder / name)) found.push_back(std::move(name));
  }
  return found;
}

void remove_file(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(fs::symlink_status(file, error))) {
    throw FileError(file.string() + " is a folder, which hamflow leaves under no such name: it is not removed; " +
                    "give --out another");
  }
  fs::remove(file, error);
  if (error) throw FileError("cannot remove " + file.string() + ": " + error.message());
}

/// The name of another kind whose folder it is; empty: none.
std::string other_kind_in(const fs::path& folder, FolderOf what) {
  for (const KindOfFolder& other : kinds_of_folders()) {
    const bool is_other =
        std::any_of(other.signs.begin(), other.signs.end(), [&](const char* sign) { return is_there(folder / sign); });
    if (other.what != what && is_other) return other.name;
  }
  return {};
}

void clear(const fs::path& folder, FolderOf what) {
  if (const std::string other = other_kind_in(folder, what); !other.empty()) {
    throw FileError("found a " + other + " in " + folder.string() + ", which is not replaced; allowed a folder of a " +
                    kind_of(what).name + ", or --out another");
  }
  const FolderLock lock(folder);
  for (const fs::path& name : found_in(folder, what)) remove_file(folder / name);
  std::error_code none;
  const fs::path figures = folder / "figures";
  if (what != FolderOf::sweep && fs::is_directory(fs::symlink_status(figures, none)) && fs::is_empty(figures, none)) {
    fs::remove(figures, none);
  }
}

/// Both as a name in its folder and as what a link leads to: either may be removed.
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

}  // namespace

void refuse_own_input(const Scenario& scenario, const fs::path& folder, FolderOf what) {
  const std::string key = "problem." + gas_options().file.name;
  const auto given = scenario.settings.find(key);
  if (given == scenario.settings.end()) return;
  // A setting is kept as it would stand in a file: with quotes.
  const toml::table read = toml::parse("file = " + given->second.text);
  const auto file = read["file"].value<std::string>();
  if (!file || !is_among(fs::path(scenario.file).parent_path() / *file, folder, found_in(folder, what))) return;
  throw Rejection({{scenario.file, given->second.line, given->second.column, key,
                    "found \"" + *file + "\", which --force would remove with what is in " + folder.string() +
                        "; allowed another --out, or a copy of the file elsewhere"}});
}

void refuse_other_kind(const fs::path& folder, FolderOf what) {
  const std::string other = other_kind_in(folder, what);
  if (other.empty()) return;
  const std::string own = kind_of(what).name;
  throw FileError("found a " + other + " in " + folder.string() + ", from which no " + own +
                  " goes on; allowed a folder of a " + own + ", or --out another");
}

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
      if (const std::string other = other_kind_in(folder, what); !other.empty()) {
        throw FileError("the folder " + folder.string() + " exists, with a " + other + " in it; give --out another");
      }
      throw FileError("the folder " + folder.string() + " exists; give " +
                      (what == FolderOf::comparison
                           ? std::string()
                           : std::string("--resume to go on with the ") + kind_of(what).name + " in it, ") +
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
