// The one place where what a command came to becomes an exit status, and where `--json` prints something in place of a
// summary.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "kept_work.hpp"

namespace hamflow::app {

/// Runs the body of a command and returns its status. An exception is printed on stderr, with `json` on stdout too:
/// Rejection: 2; FileError and errors of std::filesystem: 3; Error: 2, the request was
/// wrong, unless `failure` names what fails of requests that were right, e.g. "comparison": then 1; anything else: 1.
/// @param kept of work that is gone on with by --resume: what is said behind "out of memory"
int guarded(bool json, const std::function<int()>& body, const std::string& failure = {},
            const KeptWork* kept = nullptr);

/// What is written once a report is on stdout, which has one JSON text and no second: an exception is printed on stderr
/// alone.   @return exit_done, exit_file, or exit_interrupted where drawing was stopped
int written_behind_report(const std::function<void()>& files);

/// Notes and errors on stderr, a line each.
void print_notes(const std::vector<std::string>& notes, bool quiet);
/// Also with --quiet: "warning: ..." each.
void print_warnings(const std::vector<std::string>& warnings);
void print_error(const std::string& message, const std::string& hint = {}, const std::string& details = {});

/// Writes a text file that an option names.   @throws FileError
void write_file(const std::string& file, const std::string& text);

/// Before hours of work whose result could not be kept.   @throws FileError where the folder of the file is missing
void require_folder_of(const std::string& file);

/// At the end of a command: its status, or, where standard output could not be written, exit_file and an error.
int written_out(int status);

/// The status of something that was carried out: "done", "failed" or "interrupted".
int exit_status(const std::string& status);

}  // namespace hamflow::app
