// The options of step control and the claims of methods with it. Reversible steps of varying size are implemented in
// detail/methods/step_density.hpp.
#pragma once

#include <string>

#include "hamflow/core/method_info.hpp"

namespace hamflow {

// The names of the options and of their values, except for methods with adaptive sub-steps.
inline constexpr const char* step_control_option = "step_control";
inline constexpr const char* fixed_steps = "fixed";
inline constexpr const char* reversible_steps = "reversible";
inline constexpr const char* monitor_option = "monitor";
inline constexpr const char* default_monitor = "arclength";
inline constexpr const char* distance_monitor_name = "distance";

/// The claims of a method with steps of varying size. The map of (z, density) is symmetric and reversible if the
/// method is, and conserves the energy if each step does. It is not symplectic.
/// @return claims with a name such as "stv4(step_control=reversible,monitor=distance)"
inline MethodInfo with_varying_steps(MethodInfo info, const std::string& monitor) {
  if (info.name.back() == ')') {
    info.name.back() = ',';
  } else {
    info.name += '(';
  }
  info.name += std::string(step_control_option) + '=' + reversible_steps;
  if (monitor != default_monitor) info.name += std::string(",") + monitor_option + '=' + monitor;
  info.name += ')';
  info.symplectic = false;
  info.varies_steps = true;
  return info;
}

}  // namespace hamflow
