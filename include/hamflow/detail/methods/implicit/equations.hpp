// The equations of one step of an implicit method, which a new implicit method must define. newton.hpp solves them,
// implicit_method.hpp makes a method of them, and the verification differentiates them.
//
// A step from z0 = (q0, p0) is given by unknowns U with
//     r(z0, U) = 0,      z1 = z0 + E(U),
// U is measured from the last state: U = 0 means z1 = z0. Stages of a collocation, coefficients of a polynomial, or z1
// - z0 itself are such unknowns. Newton may solve for fewer variables X if the others follow from them (the momenta of
// a mechanical system, a cyclic coordinate); without elimination X is U.
//
// An object of the class `E` exists for each step. It keeps references to objects that outlive the step: its `Setup`
// (options, coefficients, mass matrix), the problem and z0:
//
//     E(const Setup&, const P&, const Real& h, const V& q0, const V& p0, Effort&)      V = Vector<Real, n>
//     static constexpr std::size_t n           degrees of freedom, or `dynamic`
//     Problem, Real, Setup                     types
//     Variables = Vector<Real, ...>            X
//     Unknowns = Vector<Real, ...>             U
//     Memory = Vector<Real, ...>               data from which the initial guess is extrapolated
//     Point                                    the values at one X, with a member `residual` (Variables): r, with that
//                                              sign for which X + tangent^-1 r is better than X; default-constructible
// Newton:
//     Variables last_state() const             X of U = 0
//     Variables predicted() const              from z0 alone, by an explicit formula
//     Variables started(const Memory&) const   from an extrapolated memory
//     void evaluate(const Variables&, Point&) const            residual and data of the Jacobian; counts evaluations
//     tangent(const Point&) const              -dr/dX, a Matrix
//     Real norm(const Variables&, const Point&) const          of the residual, for the option `tolerance`
//     Correction<Real> measure(const Variables& x, const Point&, const Variables& correction) const
// The end of a step, without a further evaluation; both leave the solution in x:
//     Increment<Real, n> taken(Variables& x, const Point&) const                         z1 - z0 at x
//     Increment<Real, n> taken(Variables& x, const Point&, const Variables& c) const     at x + c, where c is the last
//                                              correction, to second order in c
//     Memory memory(const Variables& x, const Increment<Real, n>& taken) const
//     Unknowns unknowns(const Variables& x, const Increment<Real, n>& taken) const
// Verification, for numbers S of any type (dual numbers above all), with Vectors of as many entries:
//     residual(q0, p0, unknowns) const         r(z0, U)
//     static increment(unknowns)               E(U), an Increment<S, n>; where it depends on coefficients, a member
//                                              increment<n>(unknowns) of Setup instead
// Optional:
//     void remove_residual_rounding(const Variables&, Point&) const
//                                              called after evaluate(), before the last corrections
//     Real hidden_terms(const Variables& x, const Point&, const Variables& c) const
//                                              called if the correction c counts as rounding: the size of the terms if
//                                              it is far larger than the rounding of a solution, else 0
//     Real own_gain(const Variables& x) const  the energy gain of the step according to the equations themselves, that
//                                              is, the rounding of the solution
//     bool energy_error_acceptable(const Variables& x, const Increment<Real, n>& taken) const
//                                              called for a root found from a bad guess, because implicit equations
//                                              have roots that do not belong to the motion
//     bool too_coarse(const Variables& x, const Increment<Real, n>& taken) const
//                                              called after convergence: whether the step must be solved again after
//                                              Setup::refine()
//     Guesses                                  a type that replaces Extrapolation<Memory>
//     Point::linearised                        a bool: whether evaluate() must compute the data of the Jacobian. With
//                                              it every Iteration can solve the equations, without it only Newton's.
//     const V& positions() const, momenta() const, E from(const V& q0, const V& p0) const
//                                              the state, and the same step from another state: iterations without
//                                              second derivatives measure the effect of rounded coordinates with it
// `Setup` is made from (const P&, Options) and has
//     MethodInfo info() const                  the method's claims
//     NewtonOptions newton() const
//     std::string detail() const               for the text of a failure: "5 Gauss points"
//     static constexpr const char* residual_name
//     archive(ar)                              the part that changes during a run
// and, with too_coarse(), refine() (returns false at the limit), no_finer_rule_message() (a text for that case),
// current_rule() and return_to().
#pragma once

#include <concepts>
#include <limits>
#include <string>

#include "hamflow/core/concepts.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/detail/methods/implicit/newton_options.hpp"

namespace hamflow {

/// z1 - z0 of one step.
template <class Real, std::size_t N>
struct Increment {
  Vector<Real, N> q{};
  Vector<Real, N> p{};
};

/// The size of a correction, and the rounding of the corrected variables: epsilon times the size of their terms. Both
/// have the same unit, for example a length or, if variables have different units, the noise itself.
template <class Real>
struct Correction {
  Real size;
  Real noise;
};

/// The unit of rounding: a constant for hardware types, evaluated at each use for others.
template <class Real>
struct Epsilon {
  friend constexpr Real operator*(Epsilon, const Real& x) { return std::numeric_limits<Real>::epsilon() * x; }
};

namespace detail {
template <class E>
concept HasStepTypes = requires {
  typename E::Problem;
  typename E::Real;
  typename E::Setup;
  typename E::Variables;
  typename E::Unknowns;
  typename E::Memory;
  typename E::Point;
  { E::n } -> std::convertible_to<std::size_t>;
};
template <class E>
concept SolvableByNewton = HasStepTypes<E> &&
    requires(const E& step, const typename E::Variables& x, typename E::Point& at, const typename E::Memory& memory) {
  { step.last_state() } -> std::same_as<typename E::Variables>;
  { step.predicted() } -> std::same_as<typename E::Variables>;
  { step.started(memory) } -> std::same_as<typename E::Variables>;
  step.evaluate(x, at);
  { at.residual } -> std::convertible_to<typename E::Variables>;
  { step.tangent(at)[0][0] } -> std::convertible_to<typename E::Real>;
  { step.norm(x, at) } -> std::convertible_to<typename E::Real>;
  { step.measure(x, at, x) } -> std::same_as<Correction<typename E::Real>>;
};
template <class E>
concept EndsStep = HasStepTypes<E> && requires(const E& step, typename E::Variables& x, const typename E::Point& at,
                                               const Increment<typename E::Real, E::n>& taken) {
  { step.taken(x, at) } -> std::same_as<Increment<typename E::Real, E::n>>;
  { step.taken(x, at, x) } -> std::same_as<Increment<typename E::Real, E::n>>;
  { step.memory(x, taken) } -> std::same_as<typename E::Memory>;
  { step.unknowns(x, taken) } -> std::same_as<typename E::Unknowns>;
};
template <class E>
concept Verifiable = HasStepTypes<E> &&
    requires(const E& step, const Vector<typename E::Real, E::n>& z, const typename E::Unknowns& u) {
  { step.residual(z, z, u) } -> std::same_as<typename E::Unknowns>;
  requires requires(const typename E::Setup& setup) {
    { setup.template increment<E::n>(u) } -> std::same_as<Increment<typename E::Real, E::n>>;
  } || requires {
    { E::increment(u) } -> std::same_as<Increment<typename E::Real, E::n>>;
  };
};
template <class E>
concept HasStepSetup = HasStepTypes<E> && requires(typename E::Setup& setup) {
  { setup.info() } -> std::convertible_to<MethodInfo>;
  { setup.newton() } -> std::convertible_to<NewtonOptions>;
  { setup.detail() } -> std::convertible_to<std::string>;
  { E::Setup::residual_name } -> std::convertible_to<std::string>;
};
}  // namespace detail

/// **StepEquations**: see the top of this file.
template <class E>
concept StepEquations =
    detail::SolvableByNewton<E> && detail::EndsStep<E> && detail::Verifiable<E> && detail::HasStepSetup<E>;

}  // namespace hamflow
