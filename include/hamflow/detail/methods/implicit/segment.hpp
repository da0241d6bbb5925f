// Shared by the three solvers of cg(1): the options, the Gauss rule, points on the segment from z0 to z1 = z0 + u, and
// the equation that all of them solve. The verification differentiates this equation, so that it detects a solver of
// another equation.   [Gross1999, (1.43), (1.44)]
#pragma once

#include <string>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/methods/cg_options.hpp"
#include "hamflow/detail/methods/implicit/equations.hpp"
#include "hamflow/detail/numerics/exact_product.hpp"
#include "hamflow/detail/numerics/few.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow {

namespace detail {

/// x0 + d/2. The points of the segment are middle + offset d with exactly symmetric offsets. With x0 + c d, the
/// rounding of c would bias every step in the same direction, by about epsilon d.V''d, and the energy would drift.
template <class Real, class S, std::size_t N>
Vector<S, N> midpoint(const Vector<S, N>& x0, const Vector<S, N>& d) {
  Vector<S, N> middle = zeros_like(x0);
  for (std::size_t i = 0; i < middle.size(); ++i) middle[i] = x0[i] + Real(0.5) * d[i];
  return middle;
}

template <class Real, class S, std::size_t N>
Vector<S, N> on_segment(const Vector<S, N>& middle, const Real& offset, const Vector<S, N>& d) {
  Vector<S, N> x = zeros_like(middle);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = middle[i] + offset * d[i];
  return x;
}

/// Combines (q, p) into one vector of unknowns, and splits it again.
template <std::size_t N>
inline constexpr std::size_t twice = N == dynamic ? dynamic : 2 * N;
template <class S, std::size_t N>
Vector<S, twice<N>> stacked(const Vector<S, N>& q, const Vector<S, N>& p) {
  Vector<S, twice<N>> z = zeros<S, twice<N>>(2 * q.size());
  for (std::size_t i = 0; i < q.size(); ++i) {
    z[i] = q[i];
    z[q.size() + i] = p[i];
  }
  return z;
}
template <std::size_t N, class S, std::size_t M>
Increment<S, N> halves(const Vector<S, M>& z) {
  const std::size_t size = z.size() / 2;
  Increment<S, N> u{zeros<S, N>(size), zeros<S, N>(size)};
  for (std::size_t i = 0; i < size; ++i) {
    u.q[i] = z[i];
    u.p[i] = z[size + i];
  }
  return u;
}

}  // namespace detail

/// Options and Gauss rule, which "auto" refines during a run.
template <class Real>
class SegmentSetup {
 public:
  static constexpr const char* residual_name = "residual (2.63)";

  explicit SegmentSetup(const CgOptions& options) : options_(options) { restart(); }  // NOLINT: restart() sets the rule
  /// Resets to the points of a new run.
  void restart() { rule_ = &gauss_rule<Real>(options_.quadrature > 0 ? options_.quadrature : 1); }

  MethodInfo info() const { return describe(options_); }
  NewtonOptions newton() const {
    return {options_.tolerance, options_.seed_criterion, options_.max_iterations, options_.halve, options_.diagnostics};
  }
  const CgOptions& options() const { return options_; }
  const GaussRule<Real>& rule() const { return *rule_; }
  std::string detail() const {
    return std::to_string(rule_->points) + (rule_->points == 1 ? " Gauss point" : " Gauss points");
  }

  bool automatic() const { return options_.quadrature == 0; }
  /// Adds a point; returns false at the limit, since the test needs one point more.
  bool refine() {
    if (rule_->points == most_gauss_points - 1) return false;
    rule_ = &gauss_rule<Real>(rule_->points + 1);
    return true;
  }
  std::string no_finer_rule_message() const {
    return "the force varies so much along the step, or the step is so stiff, that " + detail() +
           " do not keep the energy error at rounding level; a fixed number as method.quadrature skips this test";
  }
  const GaussRule<Real>* current_rule() const { return rule_; }
  void return_to(const GaussRule<Real>* rule) { rule_ = rule; }
  template <class Archive>
  void archive(Archive& ar) {
    int points = rule_->points;
    ar(points);
    if constexpr (Archive::reading) rule_ = &gauss_rule<Real>(points);
  }

 private:
  CgOptions options_;
  const GaussRule<Real>* rule_ = nullptr;
};

/// The equation of cg(1) in u = z1 - z0, for any H:  h int J grad H - u = 0 along the segment.
template <class P, class R>
class SegmentEquations {
 public:
  using Problem = P;
  using Real = R;
  static constexpr std::size_t n = P::dimension;
  static constexpr std::size_t m = detail::twice<n>;
  using V = Vector<Real, n>;
  using Unknowns = Vector<Real, m>;

  template <class S>
  Vector<S, m> residual(const Vector<S, n>& q0, const Vector<S, n>& p0, const Vector<S, m>& unknowns) const {
    const Increment<S, n> u = detail::halves<n>(unknowns);
    const Vector<S, n> middle_q = detail::midpoint<Real>(q0, u.q);
    const Vector<S, n> middle_p = detail::midpoint<Real>(p0, u.p);
    Increment<S, n> r = u;
    for (std::size_t i = 0; i < q0.size(); ++i) {
      r.q[i] = -u.q[i];
      r.p[i] = -u.p[i];
    }
    Vector<S, n> dq = zeros_like(q0);
    Vector<S, n> dp = zeros_like(q0);
    for (std::size_t l = 0; l < rule_.c.size(); ++l) {
      gradient(problem_, detail::on_segment(middle_q, rule_.offset[l], u.q),
               detail::on_segment(middle_p, rule_.offset[l], u.p), dq, dp);
      for (std::size_t i = 0; i < q0.size(); ++i) {
        r.q[i] += h_ * rule_.b[l] * dp[i];
        r.p[i] -= h_ * rule_.b[l] * dq[i];
      }
    }
    return detail::stacked(r.q, r.p);
  }
  template <class S>
  static Increment<S, n> increment(const Vector<S, m>& unknowns) {
    return detail::halves<n>(unknowns);
  }
  template <class X>
  static Unknowns unknowns(const X&, const Increment<Real, n>& taken) {
    return detail::stacked(taken.q, taken.p);
  }

 protected:
  SegmentEquations(const P& problem, const Real& h, const GaussRule<Real>& rule)
      : problem_(problem), h_(h), unit_(h / detail::golden_ratio<Real>()), rule_(rule) {}

  const P& problem_;
  const Real h_;
  const Real unit_;  // h/kappa
  const GaussRule<Real>& rule_;
};

}  // namespace hamflow
