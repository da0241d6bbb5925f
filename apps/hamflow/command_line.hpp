// What the command line adds to CLI11: whole numbers as 1e6, and "did you mean ...?" for commands, options and words.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "hamflow/core/complaint.hpp"
#include "hamflow/detail/core/option_info.hpp"

namespace hamflow::app {

/// Accepts whole numbers in every form that numbers have, e.g. 1e6 or 10^6, for options of type int.
CLI::Validator whole_number(double least, double most);
/// Accepts the words of a closed list, and names the one that was probably meant.
CLI::Validator one_of(const std::vector<std::string>& words);
/// @throws CLI::ValidationError when the first word is no command
void reject_unknown_command(const CLI::App& app, int argc, char** argv);
/// An option without a value takes the next one for it, so that a run would be kept in a folder called --json.
/// @throws CLI::ValidationError when an option that needs a value is followed by none
void reject_missing_value(const CLI::App& app, int argc, char** argv);
/// What is wrong with the command line: for options that do not exist with those that do.
std::vector<Complaint> complaints_of(const CLI::App& app, const CLI::ParseError& error);

}  // namespace hamflow::app
