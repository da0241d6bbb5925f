// The equations of one step of an implicit method: what a new implicit method has to write. newton.hpp solves them,
// implicit_method.hpp makes a method of them, and the verification differentiates them.
//
// A step from z0 = (q0, p0) is given by unknowns U with
//     r(z0, U) = 0,      z1 = z0 + E(U),
// U counted from the last state: U = 0 means that nothing has moved, z1 = z0. Stages of a collocation are such
// unknowns, and so are the coefficients of a polynomial, or z1 - z0 itself. Newton may run in other, fewer variables X,
// where the rest follows from them (the momenta of a mechanical system, a cyclic coordinate); without elimination X is
// U.
//
// A class `E` of equations is one object for each step. It keeps references to what outlives the step, its `Setup`
// (options, coefficients, mass matrix), to the problem and to z0:
//
//     E(const Setup&, const P&, const Real& h, const V& q0, const V& p0, Effort&)      V = Vector<Real, n>
//     static constexpr std::size_t n           degrees of freedom, or `dynamic`
//     Problem, Real, Setup                     types
//     Variables = Vector<Real, ...>            X
//     Unknowns = Vector<Real, ...>             U
//     Memory = Vector<Real, ...>               what is extrapolated from step to step for the first guess
//     Point                                    what is known at one X, with a member `residual` (Variables): r, of that
//                                              sign for which X + tangent^-1 r is better than X; default-constructible
// Newton:
//     Variables last_state() const             X of U = 0
//     Variables predicted() const              from z0 alone, by an explicit formula
//     Variables started(const Memory&) const   from an extrapolated memory
//     void evaluate(const Variables&, Point&) const            residual, and what its tangent needs; counts evaluations
//     tangent(const Point&) const              -dr/dX, a Matrix
//     Real norm(const Variables&, const Point&) const          of the residual, as option `tolerance` means it
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
//     void remove_residual_rounding(const Variables&, Point&) const        after evaluate(), before the last
//     corrections: the residual
//                                              without its own rounding
//     Real hidden_terms(const Variables& x, const Point&, const Variables& c) const     asked where the correction c
//     counts
//                                              as rounding: how large the terms are where that is far more than a
//                                              solution rounds by, else 0
//     Real own_gain(const Variables& x) const  the energy that the equations themselves see the step gain: what the
//                                              rounding of the solution makes of it
//     bool energy_error_acceptable(const Variables& x, const Increment<Real, n>& taken) const      asked of a root that
//     was found
//                                              from a bad start: implicit equations have roots that have nothing to do
//                                              with the motion
//     bool too_coarse(const Variables& x, const Increment<Real, n>& taken) const      asked after convergence: whether
//                                              the step has to be solved again after Setup::refine()
//     Guesses                                  a type in place of Extrapolation<Memory>
//     Point::linearised                        a bool: whether evaluate() has to compute what the tangent needs. Then
//                                              every Iteration can solve the equations, else Newton's alone.
//     const V& positions() const, momenta() const, E from(const V& q0, const V& p0) const      the state, and the same
//                                              step from another one: iterations without second derivatives learn from
//                                              it what the rounding of coordinates makes of the residual
// `Setup` is made from (const P&, Options) and has
//     MethodInfo info() const                  the method's claims
//     NewtonOptions newton() const
//     std::string detail() const               for the text of a failure: "5 Gauss points"
//     static constexpr const char* residual_name
//     archive(ar)                              what of it changes during a run
// and, with too_coarse(), refine() (false: as fine as can be), no_finer_rule_message() (that as a text), and mark() and
// return_to().
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

/// The size of a correction, and what rounding alone makes of the corrected variables: epsilon times the size of the
/// terms that they are computed from. Both in one unit: a length, say, or, where variables have different units, the
/// noise itself.
template <class Real>
struct Correction {
  Real size;
  Real noise;
};

/// The unit of rounding: a constant of the hardware's types, for others asked for where it stands.
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

/// **StepEquations**: see the head of this file.
template <class E>
concept StepEquations =
    detail::SolvableByNewton<E> && detail::EndsStep<E> && detail::Verifiable<E> && detail::HasStepSetup<E>;

}  // namespace hamflow
