// Energy-conserving Petrov-Galerkin finite elements in time, cg(1).   [Gross1999, (1.43), (1.44)]
//     q1 - q0 = h int_0^1 H_p dalpha,   p1 - p0 = -h int_0^1 H_q dalpha   along the straight segment from z0 to z1.
// Multiplied by p1 - p0 and q1 - q0 the two give int dH = 0. H is therefore conserved exactly for polynomials H of
// degree <= 2 s with s Gauss points, and otherwise to the error of the quadrature. Order 2, symmetric. s = 1 is the
// implicit midpoint rule (symplectic, not energy-conserving). Solvers for a step are in implicit/: natural.hpp
// eliminates p, cyclic.hpp eliminates a cyclic coordinate, general.hpp works for any H. Increments are added with
// compensation.
#pragma once

#include "hamflow/core/error.hpp"
#include "hamflow/detail/core/capability.hpp"
#include "hamflow/detail/methods/implicit/cyclic.hpp"
#include "hamflow/detail/methods/implicit/general.hpp"
#include "hamflow/detail/methods/implicit/implicit_method.hpp"
#include "hamflow/detail/methods/implicit/natural.hpp"

namespace hamflow {

namespace detail {
template <class P, class Real>
auto element_for() {
  if constexpr (QuadraticKinetic<P> && TwiceDifferentiable<P>) {
    return std::type_identity<NaturalElement<P, Real>>{};
  } else if constexpr (Cyclic<P>) {
    return std::type_identity<CyclicElement<P, Real>>{};
  } else {
    return std::type_identity<GeneralElement<P, Real>>{};
  }
}
}  // namespace detail

/// One step of cg(1).
/// @tparam Element the equations of the step; by default the cheapest that the problem allows
template <class P, Arithmetic A, class Element = typename decltype(detail::element_for<P, typename A::Real>())::type>
class ContinuousGalerkin : public ImplicitMethod<P, A, Element> {
 public:
  static_assert(Smooth<P>, "hamflow: cg needs a Smooth problem: its Newton uses all second derivatives of H");
  ContinuousGalerkin(const P& problem, const CgOptions& options) : ImplicitMethod<P, A, Element>(problem, options) {}
};

/// The recipe of cg(1): Cg{CgOptions{.quadrature = 5}}; for higher degrees and other iterations use CgOfDegree
/// (methods/averages.hpp). @throws Error when bound with another degree or iteration
struct Cg {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  static constexpr bool typed = true;
  static constexpr Capability capability_sets[] = {Capability::separable | Capability::quadratic_kinetic,
                                                   Capability::cyclic, Capability::smooth};
  template <class P>
  static constexpr bool accepts = Smooth<P>;
  CgOptions options{};
  template <class P, class A>
  using Stepper = ContinuousGalerkin<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    if (options.degree != 1 || options.iteration != Iteration::newton) {
      throw Error("Cg supports only degree 1 with Newton's iteration; use CgOfDegree for others");
    }
    return Stepper<P, A>(problem, options);
  }
};

}  // namespace hamflow
