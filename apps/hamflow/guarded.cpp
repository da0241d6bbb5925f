#include "guarded.hpp"

#include <sys/mman.h>

#include <filesystem>
#include <iostream>
#include <new>

#include "hamflow/detail/workflow/rejection_json.hpp"
#include "hamflow/figures/stop_drawing.hpp"
#include "hamflow/run/socket.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "progress.hpp"
#include "whole_file.hpp"

namespace hamflow::app {

namespace {

int rejected(bool json, const std::vector<Complaint>& complaints) {
  for (const Complaint& complaint : complaints) std::cerr << complaint.text() << '\n';
  if (json) std::cout << rejection_json(complaints);
  return exit_rejected;
}

int failed(bool json, const std::string& kind, const std::string& message, int status) {
  print_error(message);
  if (json) std::cout << failure_json(kind, message);
  return status;
}

/// Some input and output libraries crash if a small allocation fails. A command therefore starts only if 64 MiB can be
/// allocated. If memory runs out later, one of our large allocations fails first, and we handle that.
void require_memory() {
  constexpr std::size_t required = std::size_t{64} << 20;
  void* const trial = mmap(nullptr, required, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (trial == MAP_FAILED) throw std::bad_alloc();
  munmap(trial, required);
}

}  // namespace

int guarded(bool json, const std::function<int()>& body, const std::string& failure, const KeptWork* kept) {
  const figures::StopDrawingScope watch([] { return !interrupted(); });
  try {
    require_memory();
    return body();
  } catch (const Rejection& rejection) {
    return rejected(json, rejection.complaints);
  } catch (const figures::DrawingStopped& error) {
    return failed(json, "interrupted", error.what(), exit_interrupted);
  } catch (const FileError& error) {
    return failed(json, "file", error.what(), exit_file);
  } catch (const std::filesystem::filesystem_error& error) {
    return failed(json, "file", error.what(), exit_file);
  } catch (const ClientError& error) {
    return failed(json, "client", error.what(), exit_failed);
  } catch (const Error& error) {
    if (!failure.empty()) return failed(json, failure, error.what(), exit_failed);
    return rejected(json, {{"", 0, 0, "", error.what()}});
  } catch (const std::bad_alloc&) {
    const std::string more = kept != nullptr ? kept->sentence() : "";
    return failed(json, "memory", "out of memory" + (more.empty() ? "" : "; " + more), exit_failed);
  } catch (const std::exception& error) {
    return failed(json, "error", error.what(), exit_failed);
  }
}

int write_after_report(const std::function<void()>& files) {
  try {
    files();
    return exit_done;
  } catch (const figures::DrawingStopped& error) {
    print_error(error.what());
    return exit_interrupted;
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
    return exit_file;
  } catch (const std::exception& error) {
    print_error(error.what());
    return exit_file;
  }
}

void print_notes(const std::vector<std::string>& notes, bool quiet) {
  if (quiet) return;
  for (const std::string& note : notes) std::cerr << "note: " << note << '\n';
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::cerr << "warning: " << warning << '\n';
}

void print_error(const std::string& message, const std::string& hint, const std::string& details) {
  std::cerr << "error: " << message << '\n';
  if (!hint.empty()) std::cerr << "hint: " << hint << '\n';
  if (!details.empty()) std::cerr << "details: " << details << '\n';
}

void write_file(const std::string& file, const std::string& text) {
  hamflow::WholeFile whole(file);
  hamflow::write_whole(whole, text);
}

void require_folder_of(const std::string& file) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::error_code ignored;
  if (file.empty() || folder.empty() || std::filesystem::is_directory(folder, ignored)) return;
  throw hamflow::FileError(file + " cannot be written: the folder " + folder.string() + " does not exist");
}

int written_out(int status) {
  std::cout.flush();
  if (std::cout) return status;
  print_error("cannot write to standard output");
  return exit_file;
}

int exit_status(const std::string& status) {
  if (status == "failed") return exit_failed;
  return status == "interrupted" ? exit_interrupted : exit_done;
}

}  // namespace hamflow::app
