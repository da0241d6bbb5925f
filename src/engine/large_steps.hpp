// Changes of a method if a step has too many unknowns for a matrix.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// The number of unknowns of a step for the given number of coordinates; 0 if the method has no limit.
std::size_t unknowns_of_step(const MethodSpec& spec, std::size_t coordinates);

/// With more coordinates the Hessian of a gas does not fit into memory.
inline constexpr std::size_t most_gas_coordinates_with_hessian = 3000;

/// The method of a run with its default iteration: a large sparse system may use "fixed-point-or-newton". @param
/// request complete
MethodSpec method_taken(const Request& request);

/// The option of a method that this number of coordinates does not allow, and why: "found ...; allowed ...".
std::optional<RefusedOption> refused_option(const MethodSpec& spec, std::size_t coordinates);

/// A given option that is replaced for this number of coordinates, and why.
struct ReplacedOption {
  std::string name;
  std::string message;  // "newton is not used: ..."
};
std::vector<ReplacedOption> replaced_options(const MethodSpec& spec, std::size_t coordinates);

}  // namespace hamflow
