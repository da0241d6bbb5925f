// Implicit methods whose unknowns are averages of the motion along the step
// (detail/methods/implicit/average_table.hpp): energy-conserving elements of any degree, by any iteration, and Gauss
// collocation in stages.
//     simulate(problem, CgOfDegree{{.degree = 3, .quadrature = 6}}, q, p, h);
//     simulate(problem, Gauss{{.stages = 4, .iteration = Iteration::fixed_point}}, q, p, h);
#pragma once

#include "hamflow/detail/core/capability.hpp"
#include "hamflow/detail/methods/implicit/averages_cyclic.hpp"
#include "hamflow/detail/methods/implicit/averages_general.hpp"
#include "hamflow/detail/methods/implicit/averages_natural.hpp"
#include "hamflow/detail/methods/implicit/implicit_method.hpp"

namespace hamflow {

namespace detail {
template <class P, class Real>
auto averages_for() {
  if constexpr (QuadraticKinetic<P> && TwiceDifferentiable<P>) {
    return std::type_identity<NaturalAverages<P, Real>>{};
  } else if constexpr (Cyclic<P>) {
    return std::type_identity<CyclicAverages<P, Real>>{};
  } else {
    return std::type_identity<GeneralAverages<P, Real>>{};
  }
}
}  // namespace detail

/// The largest number of unknowns of a step for which Newton's matrix is built.
inline constexpr std::size_t most_dense_unknowns = 500;
/// The default limit of corrections for linearly convergent iterations. With a convergence factor of 1/10 this is 100
/// digits, with 9/10 it is 4.
inline constexpr int linear_iterations = 100;

/// The recipe of both. Large systems use Iteration::fixed_point. Without second derivatives of H `iteration` must be
/// fixed_point. @throws Error when bound with another iteration to a problem without second derivatives
struct Averages {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  static constexpr Capability capability_sets[] = {Capability::separable | Capability::quadratic_kinetic,
                                                   Capability::cyclic, Capability::smooth};
  template <class P>
  static constexpr bool accepts = Differentiable<P>;
  AverageOptions options;
  template <class P, class A>
  using Stepper = ImplicitMethod<P, A, typename decltype(detail::averages_for<P, typename A::Real>())::type>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    const bool large =
        degrees_of_freedom(problem) * static_cast<std::size_t>(options.element.degree) > most_dense_unknowns;
    return Stepper<P, A>(problem, large ? without_tangent(options) : options);
  }

 private:
  /// @throws Error with diagnostics, which need the Jacobian
  static AverageOptions without_tangent(AverageOptions chosen) {
    if (chosen.element.diagnostics) {
      throw Error("systems of more than " + std::to_string(most_dense_unknowns) +
                  " unknowns are solved without a Jacobian, which diagnostics need");
    }
    if (chosen.element.iteration == Iteration::newton && chosen.element.max_iterations == CgOptions{}.max_iterations) {
      chosen.element.max_iterations = linear_iterations;
    }
    chosen.element.iteration = Iteration::fixed_point;
    return chosen;
  }
};

/// cg(k, s), order 2 k.
struct CgOfDegree : Averages {
  CgOfDegree(const CgOptions& chosen) : Averages{chosen} {}  // NOLINT: CgOfDegree{{.degree = 2}}
};
/// Gauss collocation, order 2 stages; the same map as cg(stages, stages).
struct Gauss : Averages {
  Gauss(const GaussOptions& chosen = {}) : Averages{chosen} {}  // NOLINT: Gauss{{.stages = 4}}
};

}  // namespace hamflow
