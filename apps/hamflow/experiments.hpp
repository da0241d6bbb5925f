// The experiments of the two theses are a program of their own, hamflow-reproduce. `reproduce`, `list experiments` and
// `show ID` start it.
#pragma once

#include <string>
#include <vector>

namespace hamflow::app {

/// Replaces this process by hamflow-reproduce, which lies beside this program or in PATH.
/// @throws FileError where there is none, naming the command that builds it
[[noreturn]] void become_reproduce(const std::vector<std::string>& arguments);
/// Empty where hamflow-reproduce is not installed.
std::vector<std::string> experiment_ids();

}  // namespace hamflow::app
