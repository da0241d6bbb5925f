// The kernels that are compiled for one problem. The build makes one translation unit of it, and one of
// erased_unit.hpp, for each file of problems/ and problems/potentials/, so that a new problem needs only a new file.
#pragma once

#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "methods/recipes.hpp"
#include "problem_start.hpp"
#include "typed_entry.hpp"

namespace hamflow {

template <template <class> class Family>
class ProblemUnit : ProblemStart<Family> {
  using In = ProblemStart<Family>;
  using typename In::P;
  static constexpr std::size_t n = P::dimension;

 public:
  static TypedEntry entry() {
    return {[](const MethodSpec& method) {
              return visit_method(method, [](const auto& recipe) { return is_accepted<P>(recipe); });
            },
            simulate, PairwiseForces<P>};
  }

 private:
  template <class A>
  static A arithmetic_of(const Request& request) {
    A arithmetic;
    if constexpr (A::exact_undo) {
      arithmetic.position.set_unit(request.position_unit);
      arithmetic.momentum.set_unit(request.momentum_unit);
    }
    return arithmetic;
  }

  template <class A, class M>
  static std::unique_ptr<Simulation> build(const Request& request, const M& recipe) {
    using R = typename A::Real;
    const auto s = In::template start<R>(request);
    const Family<R> problem{In::template make<R>(In::template parameters_of<R>(request), s.q.size())};
    const R h = evaluate_number<R>(request.dt);
    auto method = recipe.template bind<Family<R>, A>(problem);
    using Stepper = decltype(method);
    if constexpr (requires { method.use_threads(1); }) method.use_threads(static_cast<std::size_t>(request.threads));
    // There is no probe if the step runs on several threads, because the probe would run on one; in other cases it is
    // not worth the compile time.
    if constexpr (A::exact_undo && n == dynamic) {
      if (!request.watch) {
        return std::make_unique<SimulationOf<Family<R>, Stepper, A, NoProbe>>(problem, method, s.q, s.p, h,
                                                                              arithmetic_of<A>(request));
      }
    }
    return std::make_unique<SimulationOf<Family<R>, Stepper, A>>(problem, method, s.q, s.p, h,
                                                                 arithmetic_of<A>(request));
  }

  /// Null if there is no typed kernel for the request: it then runs behind virtual calls, recorded if possible.
  static std::unique_ptr<Simulation> simulate([[maybe_unused]] const Request& request) {
#ifdef HAMFLOW_LABORATORY
    return nullptr;  // a small program has none
#else
    return visit_method(request.method, [&]<class M>(const M& recipe) -> std::unique_ptr<Simulation> {
      if constexpr (!M::template accepts<P> || !has_typed_kernel<M>()) {
        return nullptr;
      } else if constexpr (always_compensated<M>()) {
        if (n == dynamic && request.start.q.size() > most_dense_unknowns) return nullptr;  // cg(1) without a matrix
        return build<Compensated<double>>(request, recipe);
      } else {
        if constexpr (M::bijective) {
          if (request.arithmetic == "lattice") return build<Lattice>(request, with_shape_at_run_time(recipe));
        }
        if constexpr (!is_recorded<M>()) {
          return request.arithmetic == "double" ? build<Plain<double>>(request, recipe) : nullptr;
        } else if constexpr (n == dynamic && M::bijective) {  // for more bodies than straight-line code can hold
          if (request.arithmetic == "double") return build<Plain<double>>(request, with_shape_at_run_time(recipe));
          if (request.arithmetic == "compensated") {
            return build<Compensated<double>>(request, with_shape_at_run_time(recipe));
          }
        }
        return nullptr;
      }
    });
#endif
  }
};

}  // namespace hamflow
