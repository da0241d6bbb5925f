// The functions that a problem may define besides its Hamiltonian. Each concept below holds if the problem defines the
// function; otherwise the default in its comment applies. R is the type of the parameters (P::Real), S the type of the
// state. Functions of the state are templates over S, so that dual numbers, recordings and lanes can be used. Functions
// that are summed over pairs of bodies or links are in core/concepts.hpp (PairwiseForces, PairwiseGradients), together
// with Cyclic and ChargeInField.
#pragma once

#include <concepts>
#include <functional>
#include <optional>
#include <string>

#include "hamflow/core/problem_info.hpp"

namespace hamflow {

template <class P>
using RealOf = typename P::Real;
/// Positions, momenta, velocities or forces.
template <class P, class S = RealOf<P>>
using VectorOf = Vector<S, P::dimension>;
template <class P, class S = RealOf<P>>
using MatrixOf = Matrix<S, P::dimension>;

// Derivatives written by hand. The default is dual numbers, which have a fixed number of slopes; so a problem of
// dynamic size must define velocity and force, or gradient, and second derivatives for implicit methods.

/// velocity(p, v): v = dT/dp.
template <class P, class S = RealOf<P>>
concept HasVelocity = requires(const P& problem, const VectorOf<P, S>& p, VectorOf<P, S>& v) {
  problem.velocity(p, v);
};
/// force(q, f): f = -dV/dq.
template <class P, class S = RealOf<P>>
concept HasForce = requires(const P& problem, const VectorOf<P, S>& q, VectorOf<P, S>& f) {
  problem.force(q, f);
};
/// scaled_velocity(factor, p, v): v = factor dT/dp. Default: the product.
template <class P, class F, class S = RealOf<P>>
concept HasScaledVelocity = requires(const P& problem, const F& factor, const VectorOf<P, S>& p, VectorOf<P, S>& v) {
  problem.scaled_velocity(factor, p, v);
};
/// scaled_force(factor, q, f): f = -factor dV/dq. Default: the product.
template <class P, class F, class S = RealOf<P>>
concept HasScaledForce = requires(const P& problem, const F& factor, const VectorOf<P, S>& q, VectorOf<P, S>& f) {
  problem.scaled_force(factor, q, f);
};
/// potential_hessian(q, out): out[i][j] = d^2 V/dq_i dq_j. Default: from force_and_hessian, if defined.
template <class P, class S = RealOf<P>>
concept HasPotentialHessian = requires(const P& problem, const VectorOf<P, S>& q, MatrixOf<P, S>& out) {
  problem.potential_hessian(q, out);
};
/// force_and_hessian(q, f, out): both at once, if they share square roots and divisions. Default: one after the other.
template <class P, class S = RealOf<P>>
concept HasForceAndHessian = requires(const P& problem, const VectorOf<P, S>& q, VectorOf<P, S>& f,
                                      MatrixOf<P, S>& out) {
  problem.force_and_hessian(q, f, out);
};
/// gradient(q, p, dq, dp): dq = dH/dq, dp = dH/dp. Default: from velocity and force of a separable problem.
template <class P, class S = RealOf<P>>
concept HasGradient = requires(const P& problem, const VectorOf<P, S>& x, VectorOf<P, S>& out) {
  problem.gradient(x, x, out, out);
};
/// hessian(q, p, qq, qp, pp): qq[i][j] = d^2 H/dq_i dq_j, qp[i][j] = d^2 H/dq_i dp_j, pp[i][j] = d^2 H/dp_i dp_j.
/// Default: from potential_hessian, if T is quadratic.
template <class P, class S = RealOf<P>>
concept HasHessian = requires(const P& problem, const VectorOf<P, S>& x, MatrixOf<P, S>& out) {
  problem.hessian(x, x, out, out, out);
};

// Constraints. Defaults: there are none.

/// constraints(q): g, as a Vector; the motion has g(q) = 0.
template <class P, class S = RealOf<P>>
concept HasConstraints = requires(const P& problem, const VectorOf<P, S>& q) {
  problem.constraints(q);
};
/// constraint_gradients(q): the rows of g', as Gradients (core/constraints.hpp). Default: by dual numbers.
template <class P, class S = RealOf<P>>
concept HasConstraintGradients = requires(const P& problem, const VectorOf<P, S>& q) {
  problem.constraint_gradients(q);
};

// Conserved quantities besides H.

/// invariants(q, p, t): all numbers of all invariants of info() in a row, as a Vector. Default: none.
template <class P, class S = RealOf<P>>
concept HasInvariants = requires(const P& problem, const VectorOf<P, S>& x, const S& t) {
  problem.invariants(x, x, t);
};
/// invariant_sizes(): the number of components of each invariant. Default: one each.
template <class P>
concept HasInvariantSizes = requires(const P& problem) {
  problem.invariant_sizes();
};
/// total_mass(): the M of an invariant with Terms::centre_of_mass. Default: the invariant is not judged.
template <class P>
concept HasTotalMass = requires(const P& problem) {
  { problem.total_mass() } -> std::convertible_to<RealOf<P>>;
};

/// to_barycentre(q, p): moves the centre of mass of a state to the origin, at rest. Default: not available.
template <class P, class S = RealOf<P>>
concept HasBarycentre = requires(const P& problem, VectorOf<P, S>& x) {
  problem.to_barycentre(x, x);
};

/// distance_rate(q, v): the rate of change of the logarithm of a distance when the coordinates change at the rates v.
/// It is the distance that limits the step most: from the centre, or between the two closest bodies. Smooth, and odd in
/// v. Default: there is no such distance.
template <class P, class S = RealOf<P>>
concept HasDistanceRate = requires(const P& problem, const VectorOf<P, S>& x) {
  { problem.distance_rate(x, x) } -> std::convertible_to<S>;
};

// Exact results about the motion. Default: unknown.

/// exact(q, p, t): the state after time t, in long double; std::nullopt if unknown.
template <class P>
concept HasExact = requires(const P& problem, const VectorOf<P, long double>& x, long double t) {
  { problem.exact(x, x, t) } -> std::same_as<std::optional<Start<long double, P::dimension>>>;
};
/// exact_radius(q, p): r as a function of phi on the orbit through a planar state; an empty function if unknown.
template <class P>
concept HasExactRadius = requires(const P& problem, const VectorOf<P, double>& x) {
  { problem.exact_radius(x, x) } -> std::same_as<std::function<double(double)>>;
};
/// describe_orbit(q, p): the entries `orbit` of a summary.
template <class P>
concept HasOrbitFacts = requires(const P& problem, const VectorOf<P, double>& x) {
  { problem.describe_orbit(x, x) } -> std::same_as<OrbitFacts>;
};

// Parameters and starts, all static. `given` are the parameters of [problem]. Defaults: everything is accepted, and
// there are no geometric starts.

/// refused_parameters(given): the error of parameters that are each in their range, as the key at fault and a message
/// that begins with "allowed". If several keys are at fault, the key is empty and the message is what is allowed. Both
/// are empty if the parameters are accepted.
template <class P>
concept HasRefusedParameters = requires(const Parameters<RealOf<P>>& given) {
  { P::refused_parameters(given) } -> std::same_as<std::pair<std::string, std::string>>;
};
/// refused_size(given, size): what is allowed instead of `size` coordinates; empty if they are accepted. A problem of
/// dynamic size must define it.
template <class P>
concept HasRefusedSize = requires(const Parameters<RealOf<P>>& given, std::size_t size) {
  { P::refused_size(given, size) } -> std::same_as<std::string>;
};
/// refused_start(given, q): the error of a start, to follow the word "found"; empty if the start is accepted.
template <class P>
concept HasRefusedStart = requires(const Parameters<RealOf<P>>& given, const VectorOf<P>& q) {
  { P::refused_start(given, q) } -> std::same_as<std::string>;
};
/// start(kind, given, orbit, conditions): the state of a geometric start of info(); `conditions` receives every
/// inequality that the geometry has to meet.
template <class P>
concept HasStart = requires(const std::string& kind, const Parameters<RealOf<P>>& values, Conditions& conditions) {
  { P::start(kind, values, values, conditions) } -> std::same_as<Start<RealOf<P>, P::dimension>>;
};
/// derive(kind, orbit, given): sets the parameters in `given` that a geometric start determines (StartInfo::derives).
template <class P>
concept HasDerive = requires(const std::string& kind, const Parameters<RealOf<P>>& orbit,
                             Parameters<RealOf<P>>& given) {
  P::derive(kind, orbit, given);
};

// Charts, both static: a canonical change of coordinates that does not depend on parameters. One of the entries with
// the same ProblemInfo::chart_key is the reference chart and defines neither function. Both throw an Error outside the
// range of a chart, with what was found and what is allowed.

/// to_reference(state), from_reference(state).
template <class P>
concept HasChart = requires(const Start<RealOf<P>, P::dimension>& state) {
  { P::to_reference(state) } -> std::same_as<Start<RealOf<P>, P::dimension>>;
  { P::from_reference(state) } -> std::same_as<Start<RealOf<P>, P::dimension>>;
};

}  // namespace hamflow
