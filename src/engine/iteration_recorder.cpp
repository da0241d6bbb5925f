#include "iteration_recorder.hpp"

#include <stdexcept>

#include "hamflow/arithmetic/compensated.hpp"

namespace hamflow {

namespace {
constexpr Capability natural = Capability::separable | Capability::quadratic_kinetic;

template <Capability c>
IterationRecorder recorder_on(const ErasedFunctions<double>& functions, const AverageOptions& options) {
  using Traced = AnyProblem<Trace<double>, c>;
  using Equations = typename decltype(detail::averages_for<Traced, Trace<double>>())::type;
  return [problem = Traced(functions.size, functions.trace), options](const IterationFrame& frame,
                                                                      std::vector<double> values, int points,
                                                                      const IterationTime& time, IterationParts parts) {
    return record_iteration<Equations, Compensated<Trace<double>>>(problem, options, frame, std::move(values), points,
                                                                   time, parts);
  };
}
/// Whether second derivatives can be recorded: for a general H only if they are written by hand.
bool has_second_derivatives(const ErasedFunctions<double>& functions) {
  const Vector<Trace<double>, dynamic> x(functions.size);
  Matrix<Trace<double>, dynamic> qq(functions.size);
  auto qp = qq;
  auto pp = qq;
  try {
    functions.trace->hessian(x, x, qq, qp, pp);
    return true;
  } catch (const std::logic_error&) {  // thrown by Functions without second derivatives
    return false;
  }
}
}  // namespace

IterationRecorder iteration_recorder(const ErasedFunctions<double>& functions, Capability capabilities,
                                     const AverageOptions& options) {
  if (capabilities == Capability::smooth) {
    if (options.element.iteration == Iteration::newton && !has_second_derivatives(functions)) return {};
    return recorder_on<Capability::smooth>(functions, options);
  }
  if (capabilities != natural)
    return {};  // the momentum of a cyclic coordinate is a constant of the problem without it
  return recorder_on<natural>(functions, options);
}

StageRecorder stage_recorder(const ErasedFunctions<double>& functions, Capability capabilities,
                             const AverageOptions& options) {
  if (capabilities != natural || !options.in_stages ||
      first_iteration(options.element.iteration) != Iteration::fixed_point ||
      widest_native_lanes() == LaneSet::generic) {
    return {};
  }
  return [problem = StagesInLanes::Traced(functions.size, functions.trace), stages = options.element.degree](
             std::span<const double> q, std::span<const double> p) {
    const LaneSet lanes = stages <= 4 ? LaneSet::avx2 : widest_native_lanes();  // four stages fill a shorter register
    return StagesInLanes::recorded(problem, stage_table<double>(stages), q, p, lanes);
  };
}

}  // namespace hamflow
