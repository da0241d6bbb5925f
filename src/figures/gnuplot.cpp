#include "gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "text.hpp"

extern char** environ;

namespace hamflow::figures {

namespace {
struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

/// Temporary files are used instead of pipes, so that no stream can block another, and nothing causes SIGPIPE.
File scratch_file() {
  File file(std::tmpfile());
  if (!file) throw FileError(fmt::format("no temporary file for gnuplot: {}", std::strerror(errno)));
  fcntl(fileno(file.get()), F_SETFD, FD_CLOEXEC);
  return file;
}

/// A temporary folder for the output of gnuplot.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "hamflow-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw FileError(fmt::format("no temporary folder for gnuplot: {}", std::strerror(errno)));
    }
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code none;
    std::filesystem::remove_all(path_, none);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string contents(std::FILE* file) {
  std::string bytes;
  std::rewind(file);
  char buffer[65536];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, file)) > 0;) bytes.append(buffer, n);
  return bytes;
}

/// Returns the error messages of gnuplot, without its echo of the script.
std::string complaint(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size() && lines.size() < 6;) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    line.erase(0, line.find_first_not_of(" \t"));
    if (line.empty() || line == "^" || line.starts_with("gnuplot>")) continue;
    lines.push_back(line.substr(0, 300));
  }
  return lines.empty() ? "it gave no reason" : joined(lines, "; ");
}

[[noreturn]] void fail_to_start(int error) {
  if (error == ENOENT) {
    throw FileError("gnuplot was not found: figures are drawn by it; install it (Debian: apt install gnuplot-nox)");
  }
  throw FileError(fmt::format("gnuplot could not be started: {}", std::strerror(error)));
}

void erase_between(std::string& bytes, const std::string& from, const std::string& to, const std::string& instead) {
  const std::size_t begin = bytes.find(from);
  if (begin == std::string::npos) return;
  const std::size_t end = bytes.find(to, begin);
  if (end == std::string::npos) return;
  bytes.replace(begin, end + to.size() - begin, instead);
}

std::string as_xml(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else {
      result += c;
    }
  }
  return result;
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
}
}  // namespace

namespace {
thread_local const std::function<bool()>* asked_while_drawing = nullptr;

/// Runs gnuplot in a process group of its own. So Ctrl-C in a terminal reaches only the program that waits for it, and
/// processes that gnuplot started end with it.
class Child {
 public:
  Child(std::FILE* input, std::FILE* output, std::FILE* errors) {
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fileno(input), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(output), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(errors), STDERR_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
    sigset_t usual;  // signals that this program ignores; a figure cut short by a file size limit has to be noticed
    sigemptyset(&usual);
    sigaddset(&usual, SIGXFSZ);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    std::string program = "gnuplot";
    std::string defaults = "-d";  // the user's start-up file must not change a figure
    char* const arguments[] = {program.data(), defaults.data(), nullptr};
    const int error = posix_spawnp(&id_, program.c_str(), &actions, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) fail_to_start(error);
  }
  ~Child() {
    if (ended_) return;
    kill(-id_, SIGKILL);
    while (waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Returns its exit status, once it has ended.
  std::optional<int> ended() {
    int status = 0;
    const pid_t which = waitpid(id_, &status, WNOHANG);
    if (which < 0 && errno != EINTR)
      throw FileError(fmt::format("waiting for gnuplot failed: {}", std::strerror(errno)));
    ended_ = which == id_;
    return ended_ ? std::optional(status) : std::nullopt;
  }

 private:
  pid_t id_ = 0;
  bool ended_ = false;
};

int wait_for(Child& child, double longest) {
  const auto begin = std::chrono::steady_clock::now();
  while (true) {
    if (const auto status = child.ended()) return *status;
    if (asked_while_drawing != nullptr && *asked_while_drawing && !(*asked_while_drawing)()) {
      throw DrawingStopped("stopped while gnuplot was drawing");
    }
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > longest) {
      throw FileError(fmt::format("gnuplot was stopped, because it did not finish within {:g} s", longest));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}
}  // namespace

StopDrawingScope::StopDrawingScope(std::function<bool()> go_on)
    : go_on_(std::move(go_on)), before_(asked_while_drawing) {
  asked_while_drawing = &go_on_;
}
StopDrawingScope::~StopDrawingScope() { asked_while_drawing = before_; }

std::vector<std::string> run_gnuplot(const std::vector<std::string>& scripts, double longest) {
  const ScratchFolder folder;
  std::string script;
  for (std::size_t k = 0; k < scripts.size(); ++k) {
    std::string name = (folder / std::to_string(k)).string();
    replace_all(name, "'", "''");
    const std::size_t behind_terminal = scripts[k].find('\n') + 1;
    // The SVG terminal starts with the last colour that it used. This makes every figure start with the same one.
    script += "set terminal svg\nset output '/dev/null'\nplot [0:1] x\nreset session\n";
    script += scripts[k].substr(0, behind_terminal) + "set output '" + name + "'\n" +
              scripts[k].substr(behind_terminal) + "unset output\nreset session\n";
  }
  longest *= static_cast<double>(scripts.size());
  const File input = scratch_file();
  const File output = scratch_file();
  const File errors = scratch_file();
  if (std::fwrite(script.data(), 1, script.size(), input.get()) != script.size() || std::fflush(input.get()) != 0) {
    throw FileError(fmt::format("the script for gnuplot could not be written: {}", std::strerror(errno)));
  }
  std::rewind(input.get());
  Child child(input.get(), output.get(), errors.get());
  const int status = wait_for(child, longest);
  if (WIFSIGNALED(status)) throw FileError(fmt::format("gnuplot was ended by signal {}", WTERMSIG(status)));
  if (WEXITSTATUS(status) != 0) {
    throw FileError(
        fmt::format("gnuplot failed with status {}: {}", WEXITSTATUS(status), complaint(contents(errors.get()))));
  }
  std::vector<std::string> figures;
  for (std::size_t k = 0; k < scripts.size(); ++k) {
    figures.push_back(contents(folder / std::to_string(k)));
    if (figures.back().empty()) throw FileError("gnuplot wrote nothing: " + complaint(contents(errors.get())));
  }
  return figures;
}

std::string finished(std::string bytes, Format format, const std::string& title) {
  const char* const begins = format == Format::svg ? "<?xml" : format == Format::pdf ? "%PDF-" : "\x89PNG";
  if (!bytes.starts_with(begins)) throw FileError("gnuplot wrote something that is not a figure");
  if (format == Format::svg) {
    erase_between(bytes, "<title>", "</title>", "<title>" + as_xml(printable(title)) + "</title>");
    replace_all(bytes, "<text>", "<text xml:space=\"preserve\">");  // keeps blanks around subscripts
    // A browser without the font should take a similar one instead of its default serif font.
    replace_all(bytes, "font-family=\"DejaVu Sans\"", "font-family=\"DejaVu Sans, Verdana, sans-serif\"");
  } else if (format == Format::pdf) {
    const std::size_t begin = bytes.rfind("/CreationDate (");
    const std::size_t end = begin == std::string::npos ? begin : bytes.find(')', begin);
    // Overwriting with blanks keeps every offset of the file's object table.
    if (end != std::string::npos) bytes.replace(begin, end + 1 - begin, std::string(end + 1 - begin, ' '));
  }
  return bytes;
}

std::string font_probe() {
  return "set terminal pdfcairo size 2cm,2cm\nset label 'x' at screen 0.5,0.5\nplot [0:1] 0\n";
}

void require_font(const std::string& probed) {
  if (probed.find("/FontFile") == std::string::npos) {
    throw FileError("there is no font for the text of a figure; install one (Debian: apt install fonts-dejavu-core)");
  }
}

}  // namespace hamflow::figures
