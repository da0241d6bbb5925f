// cg(1) for any H(q, p).   [Gross1999, (1.43), (1.44), (3.127)-(3.131)]
//     q1 - q0 = h int H_p dalpha,   p1 - p0 = -h int H_q dalpha   along the straight segment from z0 to z1 = z0 + u.
// Newton runs in u = (q1 - q0, p1 - p0) on r(u) = h int J grad H - u with the exact tangent
//     K_T = I + h sum_l b_l alpha_l [[-H_pq, -H_pp], [H_qq, H_qp]].
#pragma once

#include <limits>

#include "hamflow/methods/element/context.hpp"

namespace hamflow {

template <class P, class Real>
class GeneralElement {
 public:
  static constexpr std::size_t n = P::dimension;
  static constexpr std::size_t m = n == dynamic ? dynamic : 2 * n;
  using V = Vector<Real, n>;
  using Z = Vector<Real, m>;
  using Context = ElementContext<Real>;

  explicit GeneralElement(const P&) {}

  void guess(Context& context, const P& problem, const Real& h, const V& q0, const V& p0, Increment<Real, n>& u) {
    u.q = zeros_like(q0);
    u.p = zeros_like(q0);
    if (memory_.empty()) {
      gradient(problem, q0, p0, u.p, u.q);
      for (Real& x : u.q) x = h * x;
      for (Real& x : u.p) x = -h * x;
      ++context.effort.gradient;
    } else {
      Z z = zeros<Real, m>(2 * q0.size());
      memory_.predict(z);
      split(z, u);
    }
  }
  void remember(const Increment<Real, n>& u) { memory_.remember(joined(u)); }
  void forget() { memory_.forget(); }
  template <class Archive>
  void archive(Archive& ar) {
    ar(memory_);
  }

  Outcome converge(Context& context, const P& problem, const Real& h, const V& q0, const V& p0, Increment<Real, n>& u,
                   std::string* history) {
    const CgOptions& options = context.options;
    const std::size_t size = 2 * q0.size();
    Real previous(0);
    bool at_rounding = false;
    int stalls = 0;
    for (int k = 0;; ++k) {
      Z target = zeros<Real, m>(size);
      Z noise = target;  // what the target rounds by, coordinate by coordinate
      Matrix<Real, m> k_t = zero_matrix(target);
      integrate(context, problem, h, q0, p0, u, target, noise, k_t);
      const Z now = joined(u);
      Z r = target;
      for (std::size_t i = 0; i < size; ++i) r[i] = target[i] - now[i];
      if (options.tolerance || history != nullptr || options.diagnostics) {
        const Real norm = seed_residual(options, q0, p0, u, r);
        if (history != nullptr) detail::note_residual(norm, k, *history);
        context.diagnostics.residual = static_cast<double>(norm);
        if (options.tolerance) {
          const bool small = norm < static_cast<Real>(*options.tolerance);
          if (small || (at_rounding && !options.seed_criterion)) {
            if (!small) ++context.effort.stagnated;
            split(target, u);
            return Outcome::done;
          }
        }
      }
      if (k == options.max_iterations) return Outcome::not_converged;

      if (options.diagnostics) detail::note_tangent<Real, m>(k_t, context.diagnostics);
      const Z correction = solve(k_t, r);
      ++context.effort.linear_solves;
      // The largest correction in units of its noise: q and p have units of their own.
      Real distance(0);
      for (std::size_t i = 0; i < size; ++i) {
        const Real unit = epsilon * (noise[i] + abs(now[i]));
        const Real here = abs(correction[i]) / larger(unit, std::numeric_limits<Real>::min());
        distance = here <= distance ? distance : here;  // NaN is kept
      }
      if (!(distance <= std::numeric_limits<Real>::max())) return Outcome::not_converged;
      at_rounding = newton_at_rounding(distance, previous, k == 0, Real(1), stalls);
      if (at_rounding && !options.tolerance) {
        // The target at u + correction to second order: correction - K correction is what it changes by. u + correction
        // itself would be rounded with the sign of the correction.
        for (std::size_t i = 0; i < size; ++i) {
          Real change = correction[i];
          for (std::size_t j = 0; j < size; ++j) change -= k_t[i][j] * correction[j];
          target[i] += change;
        }
        split(target, u);
        return Outcome::done;
      }
      Z next = now;
      for (std::size_t i = 0; i < size; ++i) next[i] += correction[i];
      split(next, u);
      previous = distance;
    }
  }

  /// Whether one more point sees more energy gained along the segment than rounding explains. With the points in use
  /// the gain is zero: int H_q.(q1 - q0) + int H_p.(p1 - p0) = -(p1 - p0).(q1 - q0)/h + (q1 - q0).(p1 - p0)/h.
  bool too_coarse(Context& context, const P& problem, const Real&, const V& q0, const V& p0,
                  const Increment<Real, n>& u) {
    const GaussRule<Real>& finer = gauss_rule<Real>(context.rule->points + 1);
    const V middle_q = detail::midpoint<Real>(q0, u.q);
    const V middle_p = detail::midpoint<Real>(p0, u.p);
    V dq = zeros_like(q0);
    V dp = zeros_like(q0);
    Matrix<Real, n> qq = zero_matrix(q0);
    Matrix<Real, n> qp = qq;
    Matrix<Real, n> pp = qq;
    gradient(problem, middle_q, middle_p, dq, dp);
    hessian(problem, middle_q, middle_p, qq, qp, pp);
    const Real terms(finer.points + 4);
    Real rounding(0);
    for (std::size_t i = 0; i < q0.size(); ++i) {
      Real of_q = terms * abs(dq[i]);
      Real of_p = terms * abs(dp[i]);
      for (std::size_t j = 0; j < q0.size(); ++j) {
        const Real along_q = 3 * abs(middle_q[j]) + terms * abs(u.q[j]);
        const Real along_p = 3 * abs(middle_p[j]) + terms * abs(u.p[j]);
        of_q += abs(qq[i][j]) * along_q + abs(qp[i][j]) * along_p;
        of_p += abs(qp[j][i]) * along_q + abs(pp[i][j]) * along_p;
      }
      rounding += epsilon * (abs(u.q[i]) * of_q + abs(u.p[i]) * of_p);
    }
    Real gain(0);
    for (std::size_t l = 0; l < finer.c.size(); ++l) {
      gradient(problem, detail::on_segment(middle_q, finer.offset[l], u.q),
               detail::on_segment(middle_p, finer.offset[l], u.p), dq, dp);
      for (std::size_t i = 0; i < q0.size(); ++i) gain += finer.b[l] * (dq[i] * u.q[i] + dp[i] * u.p[i]);
    }
    context.effort.gradient += finer.points + 1;
    ++context.effort.hessian;
    return abs(gain) > rounding;
  }

 private:
  static constexpr auto epsilon = Epsilon<Real>{};

  static Z joined(const Increment<Real, n>& u) {
    Z z = zeros<Real, m>(2 * u.q.size());
    for (std::size_t i = 0; i < u.q.size(); ++i) {
      z[i] = u.q[i];
      z[u.q.size() + i] = u.p[i];
    }
    return z;
  }
  static void split(const Z& z, Increment<Real, n>& u) {
    for (std::size_t i = 0; i < u.q.size(); ++i) {
      u.q[i] = z[i];
      u.p[i] = z[u.q.size() + i];
    }
  }

  /// target = h int J grad H; k_t the tangent; noise the sum of the absolute values of what enters the target, with
  /// what coordinates rounded to epsilon change in it.
  void integrate(Context& context, const P& problem, const Real& h, const V& q0, const V& p0,
                 const Increment<Real, n>& u, Z& target, Z& noise, Matrix<Real, m>& k_t) const {
    const GaussRule<Real>& rule = *context.rule;
    const std::size_t size = q0.size();
    const V middle_q = detail::midpoint<Real>(q0, u.q);
    const V middle_p = detail::midpoint<Real>(p0, u.p);
    V dq = zeros_like(q0);
    V dp = zeros_like(q0);
    Matrix<Real, n> qq = zero_matrix(q0);
    Matrix<Real, n> qp = qq;
    Matrix<Real, n> pp = qq;
    for (std::size_t l = 0; l < rule.c.size(); ++l) {
      const V q = detail::on_segment(middle_q, rule.offset[l], u.q);
      const V p = detail::on_segment(middle_p, rule.offset[l], u.p);
      gradient(problem, q, p, dq, dp);
      hessian(problem, q, p, qq, qp, pp);
      const Real weight = h * rule.b[l];
      const Real slope = weight * (Real(0.5) + rule.offset[l]);
      for (std::size_t i = 0; i < size; ++i) {
        target[i] += weight * dp[i];
        target[size + i] -= weight * dq[i];
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
    context.effort.gradient += rule.points;
    context.effort.hessian += rule.points;
  }

  /// The 2-norm of r in q and p. The seed's programs iterate in z1 and form z1 - z0 anew: so does its criterion.
  static Real seed_residual(const CgOptions& options, const V& q0, const V& p0, const Increment<Real, n>& u, Z r) {
    const std::size_t size = q0.size();
    Real sum(0);
    for (std::size_t i = 0; i < size; ++i) {
      if (options.seed_criterion) {
        r[i] += u.q[i] - ((q0[i] + u.q[i]) - q0[i]);
        r[size + i] += u.p[i] - ((p0[i] + u.p[i]) - p0[i]);
      }
      sum += r[i] * r[i] + r[size + i] * r[size + i];
    }
    return sqrt(sum);
  }

  Extrapolation<Z> memory_;
};

}  // namespace hamflow
