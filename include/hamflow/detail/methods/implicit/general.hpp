// cg(1) for any H(q, p).   [Gross1999, (1.43), (1.44), (3.127)-(3.131)]
//     q1 - q0 = h int H_p dalpha,   p1 - p0 = -h int H_q dalpha   along the straight segment from z0 to z1 = z0 + u.
// Newton's method solves r(u) = h int J grad H - u = 0 for u = (q1 - q0, p1 - p0) with the exact Jacobian
//     K_T = I + h sum_l b_l alpha_l [[-H_pq, -H_pp], [H_qq, H_qp]].
#pragma once

#include <algorithm>

#include "hamflow/detail/methods/implicit/newton.hpp"
#include "hamflow/detail/methods/implicit/segment.hpp"

namespace hamflow {

/// The variables are u, which is also extrapolated.
template <class P, class R>
class GeneralElement : public SegmentEquations<P, R> {
  using Base = SegmentEquations<P, R>;

 public:
  using Base::m;
  using typename Base::Real;
  using typename Base::V;
  static constexpr std::size_t n = P::dimension;
  using Z = Vector<Real, m>;
  using Variables = Z;
  using Memory = Z;
  struct Setup : SegmentSetup<Real> {
    Setup(const P&, const CgOptions& options) : SegmentSetup<Real>(options) {}
  };
  struct Point {
    Z residual{};
    Z sum{};     // kappa int J grad H
    Z target{};  // the u that follows from it, h int J grad H
    Z noise{};   // rounding of the target in units of epsilon, coordinate by coordinate
    Matrix<Real, m> tangent{};
  };

  GeneralElement(const Setup& setup, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : Base(problem, h, setup.rule()), setup_(setup), q0_(q0), p0_(p0), effort_(effort) {}

  Z last_state() const { return zeros<Real, m>(2 * q0_.size()); }
  Z predicted() const {
    Increment<Real, n> u{zeros_like(q0_), zeros_like(q0_)};
    gradient(problem_, q0_, p0_, u.p, u.q);
    for (Real& x : u.q) x = h_ * x;
    for (Real& x : u.p) x = -h_ * x;
    ++effort_.gradient;
    return detail::stacked(u.q, u.p);
  }
  Z started(const Z& extrapolated) const { return extrapolated; }

  void evaluate(const Z& x, Point& at) const {
    at.sum = last_state();
    at.noise = at.sum;
    at.tangent = zero_matrix(x);
    integrate(detail::halves<n>(x), at.sum, at.noise, at.tangent);
    at.target = at.sum;
    for (Real& t : at.target) t = unit_ * t;
    at.residual = at.target;
    for (std::size_t i = 0; i < x.size(); ++i) at.residual[i] = at.target[i] - x[i];
  }
  /// Removes the rounding of the product with h from the residual, see natural.hpp.
  void remove_residual_rounding(const Z& x, Point& at) const {
    for (std::size_t i = 0; i < x.size(); ++i) {
      at.residual[i] = (at.target[i] - x[i]) + product_error(unit_, at.sum[i], at.target[i]);
    }
  }
  const Matrix<Real, m>& tangent(const Point& at) const { return at.tangent; }
  /// The largest correction in units of its noise, because q and p have different units.
  Correction<Real> measure(const Z& x, const Point& at, const Z& correction) const {
    return measured(at.noise, x, correction);
  }
  template <class X>
  static Correction<Real> measured(const X& noise, const X& x, const X& correction) {
    Real distance(0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Real unit = epsilon * (noise[i] + abs(x[i]));
      distance = larger_size(distance, in_units_of_noise(Real(abs(correction[i])), unit));
    }
    return {distance, Real(1)};
  }

  /// The size of the target if its rounding hides the step, else 0, see natural.hpp.
  Real hidden_terms(const Z& x, const Point& at, const Z& correction) const {
    return hidden_terms_of(at.target, x, correction);
  }
  template <class X>
  static Real hidden_terms_of(const X& target, const X& x, const X& correction) {
    Real size(0);
    Real step(0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      size = larger(size, Real(abs(target[i])));
      step = larger(step, Real(abs(x[i] + correction[i])));
    }
    return hidden_by_rounding(Real(epsilon * size), step) ? size : Real(0);
  }

  Increment<Real, n> taken(Z& x, const Point& at) const {
    x = at.target;
    return detail::halves<n>(x);
  }
  /// The target at u + correction to second order: it changes by correction - K correction. Added to a rounded value,
  /// most of this would be lost, with the sign of the correction, as in natural.hpp.
  Increment<Real, n> taken(Z& x, const Point& at, const Z& correction) const {
    for (std::size_t i = 0; i < x.size(); ++i) {
      Real change = correction[i];
      for (std::size_t j = 0; j < x.size(); ++j) change -= at.tangent[i][j] * correction[j];
      x[i] = at.target[i] + (product_error(unit_, at.sum[i], at.target[i]) + change);
    }
    return detail::halves<n>(x);
  }
  Z memory(const Z&, const Increment<Real, n>& taken) const { return detail::stacked(taken.q, taken.p); }

  /// The 2-norm of r in q and p. The programs of [Gross1999] iterate in z1 and compute z1 - z0 again; criterion "seed"
  /// does the same.
  Real norm(const Z& x, const Point& at) const {
    const std::size_t size = q0_.size();
    Z r = at.residual;
    Real sum(0);
    for (std::size_t i = 0; i < size; ++i) {
      if (setup_.options().seed_criterion) {
        r[i] += x[i] - ((q0_[i] + x[i]) - q0_[i]);
        r[size + i] += x[size + i] - ((p0_[i] + x[size + i]) - p0_[i]);
      }
      sum += r[i] * r[i] + r[size + i] * r[size + i];
    }
    return sqrt(sum);
  }

  /// Whether the energy gain along the segment with one more point is more than rounding explains. With the points in
  /// use the gain is zero: int H_q.(q1 - q0) + int H_p.(p1 - p0) = -(p1 - p0).(q1 - q0)/h + (q1 - q0).(p1 - p0)/h.
  bool too_coarse(const Z&, const Increment<Real, n>& u) const {
    const Real rounding = rounding_of_work(u);
    return abs(finer_work(u).gain) > rounding;
  }
  Real rounding_of_work(const Increment<Real, n>& u) const {
    const V middle_q = detail::midpoint<Real>(q0_, u.q);
    const V middle_p = detail::midpoint<Real>(p0_, u.p);
    V dq = zeros_like(q0_);
    V dp = zeros_like(q0_);
    Matrix<Real, n> qq = zero_matrix(q0_);
    Matrix<Real, n> qp = qq;
    Matrix<Real, n> pp = qq;
    gradient(problem_, middle_q, middle_p, dq, dp);
    hessian(problem_, middle_q, middle_p, qq, qp, pp);
    ++effort_.gradient;
    ++effort_.hessian;
    const Real terms(rule_.points + 5);
    Real rounding(0);
    for (std::size_t i = 0; i < q0_.size(); ++i) {
      Real of_q = terms * abs(dq[i]);
      Real of_p = terms * abs(dp[i]);
      for (std::size_t j = 0; j < q0_.size(); ++j) {
        const Real along_q = 3 * abs(middle_q[j]) + terms * abs(u.q[j]);
        const Real along_p = 3 * abs(middle_p[j]) + terms * abs(u.p[j]);
        of_q += abs(qq[i][j]) * along_q + abs(qp[i][j]) * along_p;
        of_p += abs(qp[j][i]) * along_q + abs(pp[i][j]) * along_p;
      }
      rounding += epsilon * (abs(u.q[i]) * of_q + abs(u.p[i]) * of_p);
    }
    return rounding;
  }
  /// Whether the energy error is below a hundredth of the work. The midpoint rule does not conserve the energy.
  bool energy_error_acceptable(const Z&, const Increment<Real, n>& u) const {
    if (rule_.points == 1) return true;
    const Work work = finer_work(u);
    return Real(100) * abs(work.gain) <= work.size;
  }

  /// The energy gain with one more point, and the sizes of its terms.
  struct Work {
    Real gain{0};
    Real size{0};
  };
  Work finer_work(const Increment<Real, n>& u) const {
    const GaussRule<Real>& finer = gauss_rule<Real>(std::min(rule_.points + 1, most_gauss_points));
    const V middle_q = detail::midpoint<Real>(q0_, u.q);
    const V middle_p = detail::midpoint<Real>(p0_, u.p);
    V dq = zeros_like(q0_);
    V dp = zeros_like(q0_);
    Work work;
    for (std::size_t l = 0; l < finer.c.size(); ++l) {
      gradient(problem_, detail::on_segment(middle_q, finer.offset[l], u.q),
               detail::on_segment(middle_p, finer.offset[l], u.p), dq, dp);
      for (std::size_t i = 0; i < q0_.size(); ++i) {
        work.gain += finer.b[l] * (dq[i] * u.q[i] + dp[i] * u.p[i]);
        work.size += finer.b[l] * (abs(dq[i] * u.q[i]) + abs(dp[i] * u.p[i]));
      }
    }
    effort_.gradient += finer.points;
    return work;
  }

 private:
  using Base::h_;
  using Base::problem_;
  using Base::rule_;
  using Base::unit_;
  static constexpr auto epsilon = Epsilon<Real>{};

  /// Computes sum = kappa int J grad H, the Jacobian k_t, and noise: the sum of the absolute values of the terms of the
  /// target, plus their changes by coordinates rounded to epsilon.
  void integrate(const Increment<Real, n>& u, Z& sum, Z& noise, Matrix<Real, m>& k_t) const {
    const std::size_t size = q0_.size();
    const V middle_q = detail::midpoint<Real>(q0_, u.q);
    const V middle_p = detail::midpoint<Real>(p0_, u.p);
    V dq = zeros_like(q0_);
    V dp = zeros_like(q0_);
    Matrix<Real, n> qq = zero_matrix(q0_);
    Matrix<Real, n> qp = qq;
    Matrix<Real, n> pp = qq;
    for (std::size_t l = 0; l < rule_.c.size(); ++l) {
      const V q = detail::on_segment(middle_q, rule_.offset[l], u.q);
      const V p = detail::on_segment(middle_p, rule_.offset[l], u.p);
      gradient(problem_, q, p, dq, dp);
      hessian(problem_, q, p, qq, qp, pp);
      const Real part = detail::golden_ratio<Real>() * rule_.b[l];
      const Real weight = h_ * rule_.b[l];
      const Real slope = weight * (Real(0.5) + rule_.offset[l]);
      for (std::size_t i = 0; i < size; ++i) {
        sum[i] += part * dp[i];
        sum[size + i] -= part * dq[i];
        Real of_q = abs(dp[i]);
        Real of_p = abs(dq[i]);
        for (std::size_t j = 0; j < size; ++j) {
          k_t[i][j] -= slope * qp[j][i];
          k_t[i][size + j] -= slope * pp[i][j];
          k_t[size + i][j] += slope * qq[i][j];
          k_t[size + i][size + j] += slope * qp[i][j];
          of_q += abs(qp[j][i] * q[j]) + abs(pp[i][j] * p[j]);
          of_p += abs(qq[i][j] * q[j]) + abs(qp[i][j] * p[j]);
        }
        noise[i] += abs(weight) * of_q;
        noise[size + i] += abs(weight) * of_p;
      }
    }
    for (std::size_t i = 0; i < 2 * size; ++i) k_t[i][i] += Real(1);
    effort_.gradient += rule_.points;
    effort_.hessian += rule_.points;
  }

  const Setup& setup_;
  const V& q0_;
  const V& p0_;
  Effort& effort_;
};

}  // namespace hamflow
