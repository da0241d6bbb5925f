// Which steps a method takes, as options and claims say it. The reversible steps of varying length are those of
// detail/methods/step_density.hpp.
#pragma once

#include <string>

#include "hamflow/core/method_info.hpp"

namespace hamflow {

// The option, in every family, and what it may be besides steps of a method's own; what decides lengths, the first
// where nothing is named.
inline constexpr const char* step_control_option = "step_control";
inline constexpr const char* fixed_steps = "fixed";
inline constexpr const char* reversible_steps = "reversible";
inline constexpr const char* monitor_option = "monitor";
inline constexpr const char* default_monitor = "arclength";
inline constexpr const char* distance_monitor_name = "distance";

/// What a method claims whose steps vary: the map of (z, density) is symmetric and reversible where the method is, and
/// energies that each step conserves are conserved. It is not symplectic.
/// @return with the name "stv4(step_control=reversible,monitor=distance)"
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
