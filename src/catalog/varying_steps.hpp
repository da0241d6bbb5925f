// Steps of varying length on a problem behind virtual calls.
#pragma once

#include "erased.hpp"
#include "hamflow/methods/step_monitors.hpp"
#include "step_control.hpp"

namespace hamflow {

/// Lets the steps of a simulation vary where the request says so.
template <class R, class S>
void vary_steps_as_requested(S& simulation, const ErasedRun<R>& run, const Request& request) {
  const StepControl control = step_control_of(request.method);
  if (!control.reversible) return;
  const auto problem = run.functions.template as<Capability::smooth>();
  simulation.vary_steps(control.monitor == default_monitor ? arclength_monitor(problem, run.q, run.p)
                                                           : distance_monitor(problem));
}

}  // namespace hamflow
