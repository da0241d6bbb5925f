// The definition of simulate_erased, instantiated in one file for each number type.
#pragma once

#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/run/recorded_simulation.hpp"
#include "hamflow/verify/extrapolated_midpoint.hpp"
#include "visit_erased.hpp"

namespace hamflow {

/// The arithmetic in which the steps of another one are recorded.
template <class A>
struct TracedArithmetic;
template <>
struct TracedArithmetic<Plain<double>> {
  using type = Plain<Trace<double>>;
};
template <>
struct TracedArithmetic<Compensated<double>> {
  using type = Compensated<Trace<double>>;
};

/// Records steps of a method on the traced functions of a problem.
template <Capability c, class A, class M>
StepRecorder recorder_of(const ErasedRun<double>& run, const M& recipe, bool watch) {
  using Traced = AnyProblem<Trace<double>, c>;
  using TA = typename TracedArithmetic<A>::type;
  return [problem = Traced(run.functions.size, run.functions.trace), recipe, watch](
             const Vector<double, dynamic>& q, const Vector<double, dynamic>& p, double h, const RecordedTime& time) {
    return record_step<TA>(problem, recipe.template bind<Traced, TA>(problem), q, p, h, time, watch);
  };
}

template <class R>
std::unique_ptr<Simulation> simulate_erased(const ErasedRun<R>& run, const Request& request) {
  const auto simulate = [&]<Capability c, class M>(const M& recipe) {
    const auto build = [&]<class A>(A arithmetic) -> std::unique_ptr<Simulation> {
      const auto problem = run.functions.template as<c>();
      using P = std::remove_const_t<decltype(problem)>;
      auto method = recipe.template bind<P, A>(problem);
      using Ordinary = SimulationOf<P, decltype(method), A>;
      if constexpr (std::is_same_v<R, double> && is_recorded<M>() && !A::exact_undo) {
        return std::make_unique<RecordedSimulation<P, decltype(method), A>>(
            Ordinary(problem, method, run.q, run.p, run.h, arithmetic),
            request.record ? recorder_of<c, A>(run, recipe, request.watch) : StepRecorder(), request.watch);
      } else {
        return std::make_unique<Ordinary>(problem, method, run.q, run.p, run.h, arithmetic);
      }
    };
    if constexpr (always_compensated<M>()) {
      return build(Compensated<R>{});
    } else if constexpr (!std::is_same_v<R, double>) {
      return build(Plain<R>{});
    } else {
      if (request.arithmetic == "compensated") return build(Compensated<R>{});
      if constexpr (M::bijective) {
        if (request.arithmetic == "lattice") {
          Lattice lattice;
          lattice.position.set_unit(request.position_unit);
          lattice.momentum.set_unit(request.momentum_unit);
          return build(lattice);
        }
      }
      return build(Plain<R>{});
    }
  };
  if constexpr (!std::is_same_v<R, double>) {
    if (request.method.name == ExtrapolatedMidpoint::name) {
      const double tolerance = number_value(request.method.options.at(tolerance_option));
      return detail::visit_face<ExtrapolatedMidpoint, 0>(run.functions.capability,
                                                         ExtrapolatedMidpoint{{.tolerance = tolerance}}, simulate);
    }
  }
  return visit_erased(run.functions.capability, run.functions.size, request.method, simulate);
}

}  // namespace hamflow
