// Additions to CLI11: whole numbers such as 1e6, and "did you mean ...?" for commands, options and words.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "hamflow/core/complaint.hpp"
#include "hamflow/detail/core/option_info.hpp"

namespace hamflow::app {

/// Accepts whole numbers in every notation, e.g. 1e6 or 10^6, for options of type int.
CLI::Validator whole_number(double least, double most);
/// Accepts the words of a closed list; for any other word it names the nearest one.
CLI::Validator one_of(const std::vector<std::string>& words);
/// @throws CLI::ValidationError if the first word is not a command
void reject_unknown_command(const CLI::App& app, int argc, char** argv);
/// CLI11 takes the next option as the value of an option without one: `--out --json` would write to a folder --json.
/// @throws CLI::ValidationError if an option that needs a value has none
void reject_missing_value(const CLI::App& app, int argc, char** argv);
/// The errors in the command line. For an unknown option they list the options that exist.
std::vector<Complaint> complaints_of(const CLI::App& app, const CLI::ParseError& error);

}  // namespace hamflow::app
