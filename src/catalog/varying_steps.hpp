// Steps of varying length on a problem behind virtual calls.
#pragma once

#include "erased.hpp"
#include "hamflow/methods/step_monitors.hpp"
#include "step_control.hpp"

namespace hamflow {

/// What decides the lengths of steps on a problem, or on its recording.
/// @tparam S the number type   @param weights of arclength
template <class P, class W>
StepMonitor<RealOf<P>, dynamic> step_monitor(const P& problem, const StepControl& control,
                                             const ArclengthWeights<W>& weights) {
  return control.monitor == default_monitor ? arclength_monitor(problem, weights) : distance_monitor(problem);
}
template <class R>
ArclengthWeights<R> weights_of(const ErasedRun<R>& run, const StepControl& control) {
  if (control.monitor != default_monitor) return {};
  return arclength_weights(run.functions.template as<Capability::smooth>(), run.q, run.p);
}

inline constexpr Capability natural_face = Capability::separable | Capability::quadratic_kinetic;

/// Lets the steps of a simulation vary where the request says so.
template <class R, class S>
void vary_steps_as_requested(S& simulation, const ErasedRun<R>& run, const Request& request) {
  const StepControl control = step_control_of(request.method);
  if (!control.reversible) return;
  const ArclengthWeights<R> weights = weights_of(run, control);
  if (includes(run.functions.capability, natural_face)) {
    simulation.vary_steps(step_monitor(run.functions.template as<natural_face>(), control, weights));
  } else {
    simulation.vary_steps(step_monitor(run.functions.template as<Capability::smooth>(), control, weights));
  }
}

}  // namespace hamflow
