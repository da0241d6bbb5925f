// The options for steps of varying size, of every family that does not control its steps itself.
#pragma once

#include <optional>
#include <string>

#include "hamflow/methods/step_control.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// The step control that the options of a method select.
struct StepControl {
  bool reversible = false;
  std::string monitor = default_monitor;
};
StepControl step_control_of(const MethodSpec& method);

/// Declares step_control and monitor, in families that do not control their steps themselves.
void add_step_control(MethodFamily& family);
/// An error in these two options, or in their combination with others.
std::optional<RefusedOption> refused_step_control(const MethodSpec& method);
/// Why a problem does not have the monitor; empty if it does.
std::string refused_monitor(const MethodSpec& method, const ProblemEntry& problem);

}  // namespace hamflow
