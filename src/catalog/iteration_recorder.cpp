#include "iteration_recorder.hpp"

#include "hamflow/arithmetic/compensated.hpp"

namespace hamflow {

namespace {
constexpr Capability natural = Capability::separable | Capability::quadratic_kinetic;

template <Capability c>
IterationRecorder recorder_on(const ErasedFunctions<double>& functions, const AverageOptions& options) {
  using Traced = AnyProblem<Trace<double>, c>;
  using Equations = typename decltype(detail::averages_for<Traced, Trace<double>>())::type;
  return [problem = Traced(functions.size, functions.trace), options](
             const IterationFrame& frame, std::vector<double> values, int points, double start) {
    return record_iteration<Equations, Compensated<Trace<double>>>(problem, options, frame, std::move(values), points,
                                                                   start);
  };
}
}  // namespace

IterationRecorder iteration_recorder(const ErasedFunctions<double>& functions, Capability face,
                                     const AverageOptions& options) {
  if (face == Capability::smooth) return recorder_on<Capability::smooth>(functions, options);
  if (face != natural) return {};  // the momentum of a cyclic coordinate is a constant of the problem without it
  return recorder_on<natural>(functions, options);
}

}  // namespace hamflow
