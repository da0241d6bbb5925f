// Energy-conserving Petrov-Galerkin finite elements in time, cg(1).   [Gross1999, (1.43), (1.44)]
//     q1 - q0 = h int_0^1 H_p dalpha,   p1 - p0 = -h int_0^1 H_q dalpha   along the straight segment from z0 to z1.
// Multiplied by p1 - p0 and q1 - q0 the two give int dH = 0: with exact quadrature H is conserved, exactly for
// polynomials H of degree <= 2 s with s Gauss points, to the error of the quadrature else. Order 2, symmetric. s = 1 is
// the implicit midpoint rule (symplectic, not energy-conserving). implicit/ holds the ways to solve a step: natural.hpp
// with p eliminated, cyclic.hpp with a cyclic coordinate closed, general.hpp for any H. Increments are added with
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
/// @tparam Element the equations as they are solved; by default the cheapest way that the problem allows
template <class P, Arithmetic A, class Element = typename decltype(detail::element_for<P, typename A::Real>())::type>
class ContinuousGalerkin : public ImplicitMethod<P, A, Element> {
 public:
  static_assert(Smooth<P>, "hamflow: cg needs a Smooth problem: its Newton uses all second derivatives of H");
  ContinuousGalerkin(const P& problem, const CgOptions& options) : ImplicitMethod<P, A, Element>(problem, options) {}
};

/// The recipe of cg(1): Cg{CgOptions{.quadrature = 5}}; elements of higher degree, and other iterations than Newton's,
/// are CgOfDegree (methods/averages.hpp). @throws Error when bound with a degree or an iteration that is not its own
struct Cg {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  static constexpr bool typed = true;
  static constexpr Capability faces[] = {Capability::separable | Capability::quadratic_kinetic, Capability::cyclic,
                                         Capability::smooth};
  template <class P>
  static constexpr bool accepts = Smooth<P>;
  CgOptions options{};
  template <class P, class A>
  using Stepper = ContinuousGalerkin<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    if (options.degree != 1 || options.iteration != Iteration::newton) {
      throw Error("Cg is the element of degree 1 solved by Newton's iteration; for others take CgOfDegree");
    }
    return Stepper<P, A>(problem, options);
  }
};

}  // namespace hamflow
