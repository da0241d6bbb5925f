// Capabilities that problems offer and methods require. A method that requires a capability that the problem lacks does
// not compile, and the message names the capability (tests/compile_fail).
#pragma once

#include <concepts>
#include <cstddef>

#include "hamflow/core/dual.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/detail/core/optional_functions.hpp"

namespace hamflow {

/// **Arithmetic**: the type for storage may differ from the type for computation. Forces are evaluated in Real;
/// positions and momenta are stored as Stored, which only needs addition of a Real.
template <class A>
concept Arithmetic = requires(A a, typename A::Stored s, const typename A::Real r) {
  { a.position.store(r) } -> std::same_as<typename A::Stored>;
  { a.momentum.read(s) } -> std::convertible_to<typename A::Real>;
  a.position.add(s, r);  // s <- s + r
  a.momentum.add(s, r);
  { a.lost() } -> std::convertible_to<bool>;       // a number left the range of Stored
  { A::exact_undo } -> std::convertible_to<bool>;  // add(s, r); add(s, -r); restores every bit of s
};

/// **IntegerSums**: the stored numbers are integers. Each contribution is rounded to an integer once, and their sum is
/// exact and independent of their order.
template <class A>
concept IntegerSums = Arithmetic<A> && std::integral<typename A::Stored> &&
    requires(A a, typename A::Stored s, typename A::Real r) {
  { a.position.difference(s, s) } -> std::convertible_to<typename A::Real>;  // of two coordinates, as a number
  { a.momentum.units(r, r, s) } -> std::same_as<bool>;                       // s = r rounded; false beyond a limit
  a.momentum.add_units(s, s);
};

/// The dual number that carries the gradient with respect to one vector of the problem.
template <class P, class S = typename P::Real>
using GradientDual = Dual<S, P::dimension>;

namespace detail {
template <class P, class S = typename P::Real>
concept HasParts = requires(const P& problem, const VectorOf<P, S>& x) {
  { problem.kinetic(x) } -> std::convertible_to<S>;
  { problem.potential(x) } -> std::convertible_to<S>;
};
template <class P, class S = typename P::Real>
concept HasEnergy = requires(const P& problem, const VectorOf<P, S>& x) {
  { problem.energy(x, x) } -> std::convertible_to<S>;
};
/// Dual numbers have a fixed number of slopes: they cannot differentiate a problem of dynamic size.
template <class P>
concept OfFixedSize = (P::dimension != dynamic);
template <class R>
struct AnyDifference {
  R operator()(std::size_t a, std::size_t b) const;  // q_a - q_b
};
template <class R>
struct AnyPairSink {
  void operator()(std::size_t up, std::size_t down, const R& r);  // r is added to p_up and subtracted from p_down
};
template <class P>
using EnergyDual = Dual<typename P::Real, 2 * P::dimension>;
}  // namespace detail

/// **Problem**: a Hamiltonian and nothing else. `Real` is the type of its parameters, `dimension` the number of degrees
/// of freedom. The problem gives energy(q, p), or kinetic(p) and potential(q).
template <class P>
concept Problem = requires {
  typename P::Real;
  { P::dimension } -> std::convertible_to<std::size_t>;
}
&&(detail::HasEnergy<P> || detail::HasParts<P>);

/// **Separable**: H = T(p) + V(q), with velocity(p, out) and force(q, out) written by hand, or kinetic and potential as
/// function templates that dual numbers differentiate. A problem of dynamic size must give velocity and force.
template <class P>
concept Separable = Problem<P> && detail::HasParts<P> &&
    ((HasVelocity<P> && HasForce<P>) || (detail::OfFixedSize<P> && detail::HasParts<P, GradientDual<P>>));

/// **Differentiable**: dH/dq and dH/dp, written by hand or by dual numbers. Every separable problem is differentiable.
template <class P>
concept Differentiable = Problem<P> &&
    (Separable<P> || HasGradient<P> || (detail::OfFixedSize<P> && detail::HasEnergy<P, detail::EnergyDual<P>>));

/// **QuadraticKinetic**: T = p^T M^-1 p / 2 with constant M, declared by `quadratic_kinetic = true`.
template <class P>
concept QuadraticKinetic = Separable<P> && requires {
  requires P::quadratic_kinetic;
};

/// **TwiceDifferentiable**: V''(q), written by hand or by nested dual numbers. A problem of dynamic size must give
/// force_and_hessian or potential_hessian.
template <class P>
concept TwiceDifferentiable = Separable<P> &&
    (HasPotentialHessian<P> || HasForceAndHessian<P> ||
     (detail::OfFixedSize<P> && detail::HasParts<P, Dual<GradientDual<P>, P::dimension>>));

/// **Smooth**: the whole Hessian of H, written by hand or by nested dual numbers. Implicit methods for any H need it.
template <class P>
concept Smooth = Differentiable<P> &&
    (HasHessian<P> || (QuadraticKinetic<P> && TwiceDifferentiable<P>) ||
     (detail::OfFixedSize<P> &&
      (HasGradient<P, detail::EnergyDual<P>> || detail::HasParts<P, Dual<GradientDual<P>, P::dimension>> ||
       detail::HasEnergy<P, Dual<detail::EnergyDual<P>, 2 * P::dimension>>)));

/// **PairwiseForces**: V is a sum over pairs, and a kick is computed pair by pair, as a function of differences of
/// coordinates. pair_kicks(factor, difference, first, last, sink) visits the pairs of the rows first .. last - 1 and
/// calls sink(a, b, r) where factor times the pair's force adds r to p_a and subtracts it from p_b.
template <class P>
concept PairwiseForces = Separable<P> && requires(const P& problem, const typename P::Real& factor,
                                                  const detail::AnyDifference<typename P::Real>& difference,
                                                  std::size_t row, detail::AnyPairSink<typename P::Real>& sink) {
  { problem.pair_rows() } -> std::convertible_to<std::size_t>;        // upper bound for the pairs of one coordinate
  { problem.pairs_in_row(row) } -> std::convertible_to<std::size_t>;  // for sharing the work
  problem.pair_kicks(factor, difference, row, row, sink);
};

/// **PairwiseGradients**: V'' v is a sum over pairs, too, for kicks with force gradient.
template <class P>
concept PairwiseGradients = PairwiseForces<P> &&
    requires(const P& problem, const typename P::Real& factor,
             const detail::AnyDifference<typename P::Real>& difference, const VectorOf<P>& v, std::size_t row,
             detail::AnyPairSink<typename P::Real>& sink) {
  problem.pair_gradient_kicks(factor, factor, v, difference, row, row, sink);
};

/// **Cyclic**: H does not depend on the last coordinate. For a fixed momentum of that coordinate, the other coordinates
/// form a QuadraticKinetic problem, reduced(p). Implicit elements then solve for the other coordinates only.
template <class P>
concept Cyclic = Smooth<P> && requires(const P& problem, const VectorOf<P>& q, const typename P::Real& p) {
  typename P::Reduced;
  { problem.reduced(p) } -> std::same_as<typename P::Reduced>;
  { problem.cyclic_rate(VectorOf<typename P::Reduced>{}, p) } -> std::convertible_to<typename P::Real>;  // dH/dp_last
};

/// **ChargeInField**: a charged particle in a uniform magnetic field; its canonical momentum differs from mass times
/// velocity.
template <class P>
concept ChargeInField = Smooth<P> && requires(const P& problem, const VectorOf<P>& x, VectorOf<P>& out) {
  problem.velocity_of(x, x, out);                              // v from (q, p)
  problem.momentum_of(x, x, out);                              // p from (q, v)
  { problem.rotation() } -> std::convertible_to<VectorOf<P>>;  // charge * field / mass: v' = v x rotation
};

}  // namespace hamflow
