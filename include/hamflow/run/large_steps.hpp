// What changes for a method where a step has more unknowns than a matrix is made for.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// The option of a method that so many coordinates do not allow, and why: "found ...; allowed ...".
std::optional<RefusedOption> refused_option(const MethodSpec& spec, std::size_t coordinates);

/// An option that was given, and what a step of so many coordinates takes in its place, and why.
struct ReplacedOption {
  std::string name;
  std::string message;  // "newton is not used: ..."
};
std::vector<ReplacedOption> replaced_options(const MethodSpec& spec, std::size_t coordinates);

}  // namespace hamflow
