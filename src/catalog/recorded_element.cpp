#include "hamflow/methods/implicit/recorded_element.hpp"

#include "erased.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "recorded_element.hpp"
#include "varying_steps.hpp"

namespace hamflow {

namespace {

template <Capability c>
auto recorder(const ErasedFunctions<double>& functions, const CgOptions& options, const ElementFrame& frame) {
  using Traced = AnyProblem<Trace<double>, c>;
  return [=, problem = functions.as<c>(), traced = Traced(functions.size, functions.trace)](int points) {
    CgOptions of_rule = options;
    of_rule.quadrature = points;
    return detail::element_programs<includes(c, Capability::quadratic_kinetic)>(problem, traced, of_rule, frame);
  };
}

}  // namespace

std::unique_ptr<Simulation> simulate_recorded_element(const ErasedRun<double>& run, const Request& request,
                                                      const CgOptions& options) {
  constexpr Capability natural = Capability::separable | Capability::quadratic_kinetic;
  using P = Erased<double, Capability::smooth>;
  const std::size_t n = run.functions.size;
  if (n > ElementFrame::most_coordinates) return nullptr;
  RecordedElementOptions recorded{options, {n, n}, {}};
  if (includes(run.functions.capability, natural)) {
    recorded.record = recorder<natural>(run.functions, options, recorded.frame);
  } else {
    recorded.frame.m = 2 * n;
    recorded.record = recorder<Capability::smooth>(run.functions, options, recorded.frame);
  }
  using A = Compensated<double>;
  using Method = ImplicitMethod<P, A, RecordedElement<P>>;
  const P problem = run.functions.as<Capability::smooth>();
  auto simulation =
      std::make_unique<SimulationOf<P, Method, A>>(problem, Method(problem, recorded), run.q, run.p, run.h);
  vary_steps_as_requested(*simulation, run, request);
  return simulation;
}

}  // namespace hamflow
