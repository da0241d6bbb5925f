// A separate program, hamflow-reproduce, carries out the experiments of the two theses. `reproduce`, `list experiments`
// and `show ID` start it.
#pragma once

#include <string>
#include <vector>

namespace hamflow::app {

/// Replaces this process by hamflow-reproduce, which is looked for in the folder of this program, then in PATH.
/// @throws FileError if it is not found; the message names the command that builds it
[[noreturn]] void become_reproduce(const std::vector<std::string>& arguments);
/// The ids of all experiments; empty if hamflow-reproduce is not installed.
std::vector<std::string> experiment_ids();

}  // namespace hamflow::app
