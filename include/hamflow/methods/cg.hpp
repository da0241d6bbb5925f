// Energy-conserving Petrov-Galerkin finite elements in time, cg(1).   [Gross1999, (1.43), (1.44)]
//     q1 - q0 = h int_0^1 H_p dalpha,   p1 - p0 = -h int_0^1 H_q dalpha   along the straight segment from z0 to z1.
// Multiplied by p1 - p0 and q1 - q0 the two give int dH = 0: with exact quadrature H is conserved, exactly for
// polynomials H of degree <= 2 s with s Gauss points, to the error of the quadrature else. Order 2, symmetric. s = 1 is
// the implicit midpoint rule (symplectic, not energy-conserving). element/ holds the ways to solve a step: natural.hpp
// with p eliminated, cyclic.hpp with a cyclic coordinate closed, general.hpp for any H. Increments are added with
// compensation.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "hamflow/core/capability.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/methods/element/cyclic.hpp"
#include "hamflow/methods/element/general.hpp"
#include "hamflow/methods/element/natural.hpp"

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

/// One step of cg(1). What it remembers (the last increments, from which the first guess is extrapolated, and the
/// number of quadrature points in "auto") is part of a run's state.
/// @tparam Element how a step is solved; by default the cheapest way that the problem allows
template <class P, Arithmetic A, class Element = typename decltype(detail::element_for<P, typename A::Real>())::type>
class ContinuousGalerkin {
 public:
  static_assert(Smooth<P>, "hamflow: cg needs a Smooth problem: its Newton uses all second derivatives of H");
  static_assert(
      !A::exact_undo,
      "hamflow: the lattice needs an explicit splitting method: an implicit step is no bijection of the lattice");
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = Real;

  ContinuousGalerkin(const P& problem, const CgOptions& options)
      : context_{options, &gauss_rule<Real>(options.quadrature > 0 ? options.quadrature : 1)}, element_(problem) {}

  MethodInfo info() const { return describe(context_.options); }

  Outcome step(const P& problem, const Base& h, PhasePoint<A, n>& z) {
    const long long before = context_.effort.linear_solves;
    const Outcome outcome = attempt(problem, h, z, 0, nullptr);
    if (outcome != Outcome::done) return outcome;
    Effort& effort = context_.effort;
    const long long solves = effort.linear_solves - before;
    effort.solves_min = effort.steps == 0 || solves < effort.solves_min ? solves : effort.solves_min;
    effort.solves_max = solves > effort.solves_max ? solves : effort.solves_max;
    ++effort.steps;
    if (context_.options.diagnostics) diagnose(problem, z, solves);
    return outcome;
  }

  void invalidate() { element_.forget(); }
  Effort effort() const { return context_.effort; }
  template <class Archive>
  void archive(Archive& ar) {
    int points = quadrature();
    ar(context_.effort, context_.diagnostics, points, element_);
    if constexpr (Archive::reading) context_.rule = &gauss_rule<Real>(points);
  }
  int quadrature() const { return context_.rule->points; }
  /// Of the last step and over all of them; unset unless asked for.
  StepDiagnostics diagnostics(const P& problem, const PhasePoint<A, n>& z) const {
    StepDiagnostics d;
    if (!context_.options.diagnostics) return d;
    d = context_.diagnostics;
    d.condition_inverse_mass = inverse_mass_condition(problem, z.positions(), z.momenta());  // at the start, too
    return d;
  }

  /// Repeats the step that failed and tells how its residual went. Changes nothing.
  std::string failure(const P& problem, const Base& h, const PhasePoint<A, n>& z) const {
    ContinuousGalerkin again = *this;
    PhasePoint<A, n> copy = z;
    std::string history;
    const CgOptions& options = context_.options;
    again.context_.options.halve = false;
    (void)again.attempt(problem, h, copy, 0, &history);
    const std::string points = std::to_string(again.quadrature()) + " Gauss points";
    if (options.quadrature == 0 && again.quadrature() == most_gauss_points - 1) {
      return "the force varies so much along the step that " + points + " do not keep the energy at rounding level";
    }
    return "Newton did not converge in " + std::to_string(options.max_iterations) +
           (options.max_iterations == 1 ? " iteration" : " iterations") + " with " + points +
           (options.halve ? ", nor in ten halvings of the step" : "") +
           "; residual (2.63) per iteration of the whole step: " + history;
  }

  /// The residual r(u) of the step from (q0, p0) with increments u, for any number type. The verification
  /// differentiates it.
  template <class S>
  void equations(const P& problem, const Base& h, const Vector<S, n>& q0, const Vector<S, n>& p0,
                 const Increment<S, n>& u, Increment<S, n>& r) const {
    const Vector<S, n> middle_q = detail::midpoint<Real>(q0, u.q);
    const Vector<S, n> middle_p = detail::midpoint<Real>(p0, u.p);
    r = u;
    for (std::size_t i = 0; i < q0.size(); ++i) {
      r.q[i] = -u.q[i];
      r.p[i] = -u.p[i];
    }
    const GaussRule<Real>& rule = *context_.rule;
    Vector<S, n> dq = zeros_like(q0);
    Vector<S, n> dp = zeros_like(q0);
    for (std::size_t l = 0; l < rule.c.size(); ++l) {
      gradient(problem, detail::on_segment(middle_q, rule.offset[l], u.q),
               detail::on_segment(middle_p, rule.offset[l], u.p), dq, dp);
      for (std::size_t i = 0; i < q0.size(); ++i) {
        r.q[i] += h * rule.b[l] * dp[i];
        r.p[i] -= h * rule.b[l] * dq[i];
      }
    }
  }

 private:
  static constexpr int deepest_halving = 10;

  /// The step, or, when it does not converge and halving is allowed, two steps of half its length.
  Outcome attempt(const P& problem, const Real& h, PhasePoint<A, n>& z, int depth, std::string* history) {
    const Vector<Real, n> q0 = z.positions();
    const Vector<Real, n> p0 = z.momenta();
    Increment<Real, n> u;
    element_.guess(context_, problem, h, q0, p0, u);
    Outcome outcome = element_.converge(context_, problem, h, q0, p0, u, history);
    if (context_.options.quadrature == 0) {
      const GaussRule<Real>* const before = context_.rule;
      while (outcome == Outcome::done && element_.too_coarse(context_, problem, h, q0, p0, u)) {
        // One more point than there are is needed to judge: the step is too long for the force.
        if (context_.rule->points == most_gauss_points - 1) {
          outcome = Outcome::not_converged;
          break;
        }
        context_.rule = &gauss_rule<Real>(context_.rule->points + 1);
        outcome = element_.converge(context_, problem, h, q0, p0, u, history);
      }
      // The points of a step that was not taken do not count.
      if (outcome != Outcome::done && history == nullptr) context_.rule = before;
    }
    if (outcome == Outcome::done) {
      z.move(Real(1), u.q);
      z.push(Real(1), u.p);
      element_.remember(u);
      return outcome;
    }
    if (!context_.options.halve || depth == deepest_halving) return outcome;
    const PhasePoint<A, n> start = z;
    invalidate();
    for (int half = 0; half < 2; ++half) {
      outcome = attempt(problem, h / 2, z, depth + 1, history);
      if (outcome != Outcome::done) {
        z = start;
        return outcome;
      }
    }
    if (depth == 0) ++context_.effort.halved;
    invalidate();  // the remembered increments belong to another step length
    return outcome;
  }

  [[gnu::noinline]] void diagnose(const P& problem, const PhasePoint<A, n>& z, long long solves) {
    StepDiagnostics& d = context_.diagnostics;
    d.iterations = static_cast<double>(solves);
    d.condition_inverse_mass = inverse_mass_condition(problem, z.positions(), z.momenta());
    d.extend(context_.effort.steps);
  }

  ElementContext<Real> context_;
  Element element_;
};

/// The recipe of cg: Cg{CgOptions{.quadrature = 5}}.
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
    return Stepper<P, A>(problem, options);
  }
};

}  // namespace hamflow
