// The definition of simulate_erased, instantiated in one file for each number type.
#pragma once

#include "hamflow/run/simulation_of.hpp"
#include "visit_erased.hpp"

namespace hamflow {

template <class R>
std::unique_ptr<Simulation> simulate_erased(const ErasedRun<R>& run, const MethodSpec& spec, bool compensated) {
  return visit_erased(run.functions.capability, spec, [&]<Capability c, class Recipe>(const Recipe& recipe) {
    const auto build = [&]<class A>() -> std::unique_ptr<Simulation> {
      const auto problem = run.functions.template as<c>();
      auto method = recipe.template bind<decltype(problem), A>(problem);
      return std::make_unique<SimulationOf<std::remove_const_t<decltype(problem)>, decltype(method), A>>(
          problem, method, run.q, run.p, run.h);
    };
    if constexpr (always_compensated<Recipe>()) {
      return build.template operator()<Compensated<R>>();
    } else {
      if constexpr (std::is_same_v<R, double>) {
        if (compensated) return build.template operator()<Compensated<R>>();
      }
      return build.template operator()<Plain<R>>();
    }
  });
}

}  // namespace hamflow
