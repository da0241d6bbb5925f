// Turns the result of a command into an exit status. If the command fails, `--json` prints the error here in place of a
// summary. No other code does this.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "kept_work.hpp"

namespace hamflow::app {

/// Runs the body of a command and returns its status. An exception is printed on stderr, and with `json` on stdout too.
/// Status of an exception: Rejection 2; FileError and errors of std::filesystem 3; Error 2, because the request was
/// wrong, or 1 if `failure` names the work that can fail for a valid request, e.g. "comparison"; any other 1.
/// @param kept for commands with --resume: the message "out of memory" says where their results are
int guarded(bool json, const std::function<int()>& body, const std::string& failure = {},
            const KeptWork* kept = nullptr);

/// Writes files after the report was printed. Stdout already holds its one JSON text, so an exception is printed on
/// stderr only.   @return exit_done, exit_file, or exit_interrupted if drawing was stopped
int write_after_report(const std::function<void()>& files);

/// Prints notes on stderr, one per line, unless `quiet`.
void print_notes(const std::vector<std::string>& notes, bool quiet);
/// Prints "warning: ..." lines on stderr, with --quiet too.
void print_warnings(const std::vector<std::string>& warnings);
void print_error(const std::string& message, const std::string& hint = {}, const std::string& details = {});

/// Writes a text file whose name was given by an option.   @throws FileError
void write_file(const std::string& file, const std::string& text);

/// Checks the folder of an output file before the work begins, since hours of work could not be saved otherwise.
/// @throws FileError if the folder of the file is missing
void require_folder_of(const std::string& file);

/// Flushes standard output at the end of a command. Returns `status`; or prints an error and returns exit_file if
/// standard output could not be written.
int written_out(int status);

/// The exit status of a report whose status is "done", "failed" or "interrupted".
int exit_status(const std::string& status);

}  // namespace hamflow::app
