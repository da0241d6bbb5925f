// What changes for a method where a step has more unknowns than a matrix is made for.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// How many unknowns a step of so many coordinates is solved for; 0 where their number changes nothing.
std::size_t unknowns_of_step(const MethodSpec& spec, std::size_t coordinates);

/// The Hessian of a gas with more coordinates is a matrix that does not fit.
inline constexpr std::size_t most_gas_coordinates_with_hessian = 3000;

/// The method of a run with the iteration that is taken where nothing was said: a large sparse system may take
/// "fixed-point-or-newton". @param request complete
MethodSpec method_taken(const Request& request);

/// The option of a method that so many coordinates do not allow, and why: "found ...; allowed ...".
std::optional<RefusedOption> refused_option(const MethodSpec& spec, std::size_t coordinates);

/// An option that was given, and what a step of so many coordinates takes in its place, and why.
struct ReplacedOption {
  std::string name;
  std::string message;  // "newton is not used: ..."
};
std::vector<ReplacedOption> replaced_options(const MethodSpec& spec, std::size_t coordinates);

}  // namespace hamflow
