// The lengths of steps, by name: the options that every family has whose steps are of one length otherwise.
#pragma once

#include <optional>
#include <string>

#include "hamflow/methods/step_control.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// What a method's options say about the lengths of its steps.
struct StepControl {
  bool reversible = false;
  std::string monitor = default_monitor;
};
StepControl step_control_of(const MethodSpec& method);

/// Declares step_control and monitor, in families that do not control their steps themselves.
void add_step_control(MethodFamily& family);
/// What is wrong with the two, or with others beside them.
std::optional<RefusedOption> refused_step_control(const MethodSpec& method);
/// Why a problem has no such monitor; empty where it has.
std::string refused_monitor(const MethodSpec& method, const ProblemEntry& problem);

}  // namespace hamflow
