// Steps of varying size on a problem behind virtual calls.
#pragma once

#include "erased.hpp"
#include "hamflow/methods/step_monitors.hpp"
#include "methods/step_control.hpp"

namespace hamflow {

/// The monitor for a problem, or for its recording.
template <class P>
StepMonitor<RealOf<P>, dynamic> step_monitor(const P& problem, const StepControl& control) {
  return control.monitor == default_monitor ? arclength_monitor(problem) : distance_monitor(problem);
}

inline constexpr Capability natural_capabilities = Capability::separable | Capability::quadratic_kinetic;

/// Makes the steps of a simulation vary if the request asks for it.
template <class R, class S>
void vary_steps_as_requested(S& simulation, const ErasedRun<R>& run, const Request& request) {
  const StepControl control = step_control_of(request.method);
  if (!control.reversible) return;
  if (includes(run.functions.capability, natural_capabilities)) {
    simulation.vary_steps(step_monitor(run.functions.template as<natural_capabilities>(), control));
  } else {
    simulation.vary_steps(step_monitor(run.functions.template as<Capability::smooth>(), control));
  }
}

}  // namespace hamflow
