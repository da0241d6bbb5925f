// hamflow reproduce: starts the program hamflow-reproduce, as `git foo` starts git-foo.
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "commands.hpp"
#include "experiments.hpp"
#include "guarded.hpp"
#include "hamflow/core/error.hpp"

namespace hamflow::app {

namespace {
namespace fs = std::filesystem;
constexpr const char* program = "hamflow-reproduce";

/// The path of hamflow-reproduce; empty if it is not found.
fs::path found_program() {
  std::error_code none;
  std::vector<fs::path> folders{fs::read_symlink("/proc/self/exe", none).parent_path()};
  const char* const path = std::getenv("PATH");
  std::istringstream names(path == nullptr ? "" : path);
  for (std::string name; std::getline(names, name, ':');) folders.emplace_back(name);
  for (const fs::path& folder : folders) {
    const fs::path file = folder / program;
    if (!folder.empty() && fs::is_regular_file(file, none) && access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}
}  // namespace

void become_reproduce(const std::vector<std::string>& arguments) {
  const fs::path file = found_program();
  if (file.empty()) {
    throw FileError(std::string("the program ") + program +
                    ", which carries out the experiments, is neither in the folder of hamflow nor in PATH; to build "
                    "it, run ./dev theses in the sources of hamflow");
  }
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  std::cout.flush();
  execv(file.c_str(), pointers.data());
  throw FileError("cannot start " + file.string() + ": " + std::strerror(errno));
}

int reproduce_command(const std::vector<std::string>& arguments) {
  const bool json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
  return guarded(json, [&]() -> int { become_reproduce(arguments); });
}

std::vector<std::string> experiment_ids() {
  const fs::path file = found_program();
  if (file.empty()) return {};
  std::string quoted = "'";  // for the shell of popen()
  for (const char c : file.string()) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen((quoted + "' --list --json").c_str(), "r"), pclose);
  std::string text;
  char buffer[4096];
  for (std::size_t n = 0; pipe && (n = std::fread(buffer, 1, sizeof buffer, pipe.get())) > 0;) text.append(buffer, n);
  std::vector<std::string> ids;
  const auto all = nlohmann::json::parse(text, nullptr, false);
  for (const auto& one : all.is_array() ? all : nlohmann::json::array()) ids.push_back(one.value("id", ""));
  return ids;
}

}  // namespace hamflow::app
