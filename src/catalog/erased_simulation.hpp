// The definition of simulate_erased, instantiated in one file for each number type.
#pragma once

#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "hamflow/verify/extrapolated_midpoint.hpp"
#include "visit_erased.hpp"

namespace hamflow {

template <class R>
std::unique_ptr<Simulation> simulate_erased(const ErasedRun<R>& run, const Request& request) {
  const auto simulate = [&]<Capability c, class M>(const M& recipe) {
    const auto build = [&]<class A>(A arithmetic) -> std::unique_ptr<Simulation> {
      const auto problem = run.functions.template as<c>();
      using P = std::remove_const_t<decltype(problem)>;
      auto method = recipe.template bind<P, A>(problem);
      return std::make_unique<SimulationOf<P, decltype(method), A>>(problem, method, run.q, run.p, run.h, arithmetic);
    };
    if constexpr (std::is_same_v<R, double> && has_typed_kernel<M>() && (M::bijective || always_compensated<M>())) {
      return std::unique_ptr<Simulation>();  // compiled with each problem
    } else if constexpr (always_compensated<M>()) {
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
  return visit_erased(run.functions.capability, request.method, simulate);
}

}  // namespace hamflow
