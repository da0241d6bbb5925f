// Measures how each rounding of a step of cg changes the energy.
//
// Let Z0 be the state with all stored digits, u = (d, e) the increment of the step, and
// T(u) = h int J grad H(Z0 + alpha u) dalpha in exact arithmetic. The energy changes by
//     H(Z0 + u) - H(Z0) = (e.a - d.b)/h,      (a, b) = T(u) - u,
// which is linear in the residual (a, b). A telescoping sum from T(u) at Z0 down to u splits it into one part for each
// rounding (`Source`), so the parts always add up to the change. Numbers that differ only in their last digits are
// subtracted in long double, which leaves a random error of 1e-21 of the scale per step.
#pragma once

#include <array>

#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/methods/cg.hpp"

namespace hamflow::drift {

using A = Compensated<double>;
using Long = long double;

enum Source {
  read_q,     // the step uses only the high part of the positions
  read_p,     // the step uses only the high part of the momenta
  rule,       // weights and offsets of the Gauss rule in double
  points,     // coordinates of the Gauss points
  functions,  // force, or gradient of H, at the points
  sums,       // the products with the weights and their sum
  residual,   // the rounding of d - x - c: d and e differ from the point where the mean force was linearised
  undone,     // the residual after Newton's last correction, from second derivatives: the stopping rule
  rounded_q,  // the last rounding of d
  rounded_p,  // the last rounding of e
  sources
};
inline constexpr const char* source_names[] = {"read q", "read p",   "rule",   "points",    "functions",
                                               "sums",   "residual", "undone", "rounded q", "rounded p"};
using Parts = std::array<double, sources>;

/// The equations E, which also store the last iterate of Newton's method in each step.
template <class E>
class RecordingEquations : public E {
 public:
  struct Last {
    typename E::Variables x{};
    typename E::Point at{};
    Increment<typename E::Real, E::n> taken{};
  };
  static inline thread_local Last last;

  using E::E;
  /// Disables the fast path, which does not show the last iterate. Newton's method gives the same bits.
  void fast_path(const auto&, int) const = delete;
  auto taken(typename E::Variables& x, const typename E::Point& at) const { return E::taken(x, at); }
  auto taken(typename E::Variables& x, const typename E::Point& at, const typename E::Variables& correction) const {
    last = {x, at, {}};
    last.taken = E::taken(x, at, correction);
    return last.taken;
  }
};

template <std::size_t N>
Vector<Long, N> to_long(const Vector<double, N>& x) {
  Vector<Long, N> y{};
  for (std::size_t i = 0; i < N; ++i) y[i] = x[i];
  return y;
}

/// The Gauss rule of the method in double (its weights are kappa b_l) and the exact one.
struct Rules {
  explicit Rules(int s) : in_use(gauss_rule<double>(s)), exact(gauss_rule<Quad>(s)) {}
  const GaussRule<double>& in_use;
  const GaussRule<Quad>& exact;
};

/// Splits steps for H = p^T M^-1 p/2 + V(q), with eliminated momenta.
template <class P, class Precise>
class NaturalParts {
 public:
  static constexpr std::size_t n = P::dimension;
  using E = NaturalElement<P, double>;
  NaturalParts(const P& problem, const Precise& precise, double h, int s)
      : problem_(problem), precise_(precise), h_(h), rules_(s) {}

  Parts operator()(const PhasePoint<A, n>& from, const typename RecordingEquations<E>::Last& last) const {
    using V = Vector<double, n>;
    using L = Vector<Long, n>;
    const V& d = last.taken.q;
    const V& e = last.taken.p;
    const V q0 = from.positions();
    const double unit = h_ / detail::golden_ratio<double>();
    V low_p{};
    for (std::size_t i = 0; i < n; ++i) low_p[i] = from.p[i].low;
    Parts parts{};

    // a = h M^-1 (P0 + e/2) - d
    V read{};
    velocity(problem_, low_p, read);
    L middle_p{};
    L v{};
    for (std::size_t i = 0; i < n; ++i) middle_p[i] = Long(from.p[i].high) + Long(e[i]) / 2;
    velocity(precise_, middle_p, v);
    for (std::size_t i = 0; i < n; ++i) {
      parts[read_p] += e[i] * read[i];
      parts[rounded_q] += e[i] * static_cast<double>(Long(h_) * v[i] - d[i]) / h_;
    }

    // b: the solution x + c of Newton's last linear equation in exact arithmetic
    L target{};
    L exact_sum{};
    for (std::size_t i = 0; i < n; ++i) {
      exact_sum[i] = Long(unit) * last.at.sum[i];
      middle_p[i] = Long(from.p[i].high) + exact_sum[i] / 2;
    }
    velocity(precise_, middle_p, target);
    Matrix<Long, n> k{};
    for (std::size_t j = 0; j < n; ++j) {
      V row{};
      V column{};
      for (std::size_t i = 0; i < n; ++i) row[i] = last.at.stiffness[j][i];
      velocity(problem_, row, column);
      for (std::size_t i = 0; i < n; ++i) k[i][j] = Long(h_) * h_ / 2 * column[i] + (i == j);
    }
    for (std::size_t i = 0; i < n; ++i) target[i] = Long(h_) * target[i] - last.x[i];
    const L c = hamflow::solve(k, target);

    const V middle = detail::midpoint<double>(q0, last.x);
    V new_middle{};
    for (std::size_t i = 0; i < n; ++i) new_middle[i] = q0[i] + 0.5 * d[i];
    L sum_of_products{};
    Matrix<double, n> new_stiffness{};
    for (std::size_t l = 0; l < rules_.in_use.b.size(); ++l) {
      const double offset = rules_.in_use.offset[l];
      const V q = detail::on_segment(middle, offset, last.x);
      V f{};
      Matrix<double, n> second{};
      force_and_hessian(problem_, q, f, second);
      L f_long{};
      force(precise_, to_long(q), f_long);
      const double product = detail::golden_ratio<double>() * rules_.in_use.b[l];
      const Long weight = Long(unit) * product / h_;
      const double wrong_weight = static_cast<double>(static_cast<Long>(rules_.exact.b[l]) - weight);
      const double wrong_offset = static_cast<double>(static_cast<Long>(rules_.exact.offset[l]) - offset);
      for (std::size_t i = 0; i < n; ++i) {
        const auto w = static_cast<double>(weight);
        sum_of_products[i] += Long(product) * f[i];
        parts[functions] -= d[i] * w * static_cast<double>(f_long[i] - f[i]);
        parts[rule] -= d[i] * wrong_weight * f[i];
        for (std::size_t j = 0; j < n; ++j) {
          const double along = static_cast<double>(Long(q0[j]) + (Long(0.5) + offset) * last.x[j] - q[j]);
          parts[points] += d[i] * w * second[i][j] * along;
          parts[rule] += d[i] * w * second[i][j] * wrong_offset * d[j];
          parts[read_q] += d[i] * w * second[i][j] * from.q[j].low;
        }
      }
      V unused{};
      force_and_hessian(problem_, detail::on_segment(new_middle, offset, d), unused, second);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) new_stiffness[i][j] += rules_.in_use.b[l] * (0.5 + offset) * second[i][j];
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      parts[sums] -= d[i] / h_ * static_cast<double>(Long(unit) * (sum_of_products[i] - last.at.sum[i]));
      Long impulse = exact_sum[i];
      for (std::size_t j = 0; j < n; ++j) {
        const double s = last.at.stiffness[i][j];
        impulse -= Long(h_) * s * c[j];
        parts[residual] += d[i] * s * static_cast<double>(Long(d[j]) - last.x[j] - c[j]);
        parts[undone] += d[i] * 0.5 * (new_stiffness[i][j] - s) * (d[j] - last.x[j]);
      }
      parts[rounded_p] -= d[i] / h_ * static_cast<double>(impulse - e[i]);
    }
    return parts;
  }

 private:
  const P& problem_;
  const Precise& precise_;
  double h_;
  Rules rules_;
};

/// Splits steps for any H(q, p).
template <class P, class Precise>
class GeneralParts {
 public:
  static constexpr std::size_t n = P::dimension;
  static constexpr std::size_t m = 2 * n;
  using E = GeneralElement<P, double>;
  GeneralParts(const P& problem, const Precise& precise, double h, int s)
      : problem_(problem), precise_(precise), h_(h), rules_(s) {}

  Parts operator()(const PhasePoint<A, n>& from, const typename RecordingEquations<E>::Last& last) const {
    using Z = Vector<double, m>;
    const Z u = detail::stacked(last.taken.q, last.taken.p);
    Z factor{};  // the change of the energy is factor . (a, b)
    for (std::size_t i = 0; i < n; ++i) {
      factor[i] = u[n + i] / h_;
      factor[n + i] = -u[i] / h_;
    }
    Z z0{};
    Z low{};
    for (std::size_t i = 0; i < n; ++i) {
      z0[i] = from.q[i].high;
      z0[n + i] = from.p[i].high;
      low[i] = from.q[i].low;
      low[n + i] = from.p[i].low;
    }
    const double unit = h_ / detail::golden_ratio<double>();
    const Z& x = last.x;

    Matrix<Long, m> k{};
    Vector<Long, m> right{};
    for (std::size_t i = 0; i < m; ++i) {
      right[i] = Long(unit) * last.at.sum[i] - x[i];
      for (std::size_t j = 0; j < m; ++j) k[i][j] = last.at.tangent[i][j];
    }
    const Vector<Long, m> c = hamflow::solve(k, right);

    Parts parts{};
    Vector<Long, m> sum_of_products{};
    const Increment<double, n> along = detail::halves<n>(x);
    const auto middle_q = detail::midpoint<double>(from.positions(), along.q);
    const auto middle_p = detail::midpoint<double>(from.momenta(), along.p);
    Matrix<double, m> slope_new{};  // T' = I - K at u
    for (std::size_t l = 0; l < rules_.in_use.b.size(); ++l) {
      const double offset = rules_.in_use.offset[l];
      const auto q = detail::on_segment(middle_q, offset, along.q);
      const auto p = detail::on_segment(middle_p, offset, along.p);
      const Z z = detail::stacked(q, p);
      Z f{};  // J grad H
      Matrix<double, m> slope{};
      field(problem_, q, p, f);
      slopes(q, p, slope);
      Vector<Long, m> f_long{};
      field(precise_, to_long(q), to_long(p), f_long);
      const double product = detail::golden_ratio<double>() * rules_.in_use.b[l];
      const Long weight = Long(unit) * product;
      const double wrong_weight = static_cast<double>(Long(h_) * static_cast<Long>(rules_.exact.b[l]) - weight);
      const double wrong_offset = static_cast<double>(static_cast<Long>(rules_.exact.offset[l]) - offset);
      const auto w = static_cast<double>(weight);
      for (std::size_t i = 0; i < m; ++i) {
        sum_of_products[i] += Long(product) * f[i];
        parts[functions] += factor[i] * w * static_cast<double>(f_long[i] - f[i]);
        parts[rule] += factor[i] * wrong_weight * f[i];
        for (std::size_t j = 0; j < m; ++j) {
          const double missed = static_cast<double>(Long(z0[j]) + (Long(0.5) + offset) * x[j] - z[j]);
          parts[points] += factor[i] * w * slope[i][j] * missed;
          parts[rule] += factor[i] * w * slope[i][j] * wrong_offset * u[j];
          parts[j < n ? read_q : read_p] += factor[i] * w * slope[i][j] * low[j];
        }
      }
      Z at{};
      for (std::size_t i = 0; i < m; ++i) at[i] = z0[i] + (0.5 + offset) * u[i];
      const Increment<double, n> there = detail::halves<n>(at);
      slopes(there.q, there.p, slope);
      for (std::size_t i = 0; i < m; ++i) {
        for (std::size_t j = 0; j < m; ++j) slope_new[i][j] += h_ * rules_.in_use.b[l] * (0.5 + offset) * slope[i][j];
      }
    }
    for (std::size_t i = 0; i < m; ++i) {
      parts[sums] += factor[i] * static_cast<double>(Long(unit) * (sum_of_products[i] - last.at.sum[i]));
      Long target = Long(unit) * last.at.sum[i];
      for (std::size_t j = 0; j < m; ++j) {
        const double s = (i == j) - last.at.tangent[i][j];
        target += Long(s) * c[j];
        parts[residual] += factor[i] * s * static_cast<double>(Long(u[j]) - x[j] - c[j]);
        parts[undone] += factor[i] * 0.5 * (slope_new[i][j] - s) * (u[j] - x[j]);
      }
      parts[i < n ? rounded_q : rounded_p] += factor[i] * static_cast<double>(target - u[i]);
    }
    return parts;
  }

 private:
  template <class Q, class S>
  static void field(const Q& problem, const Vector<S, n>& q, const Vector<S, n>& p, Vector<S, m>& f) {
    Vector<S, n> dq{};
    Vector<S, n> dp{};
    gradient(problem, q, p, dq, dp);
    for (std::size_t i = 0; i < n; ++i) {
      f[i] = dp[i];
      f[n + i] = -dq[i];
    }
  }
  void slopes(const Vector<double, n>& q, const Vector<double, n>& p, Matrix<double, m>& out) const {
    Matrix<double, n> qq{};
    Matrix<double, n> qp{};
    Matrix<double, n> pp{};
    hessian(problem_, q, p, qq, qp, pp);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        out[i][j] = qp[j][i];
        out[i][n + j] = pp[i][j];
        out[n + i][j] = -qq[i][j];
        out[n + i][n + j] = -qp[i][j];
      }
    }
  }

  const P& problem_;
  const Precise& precise_;
  double h_;
  Rules rules_;
};

}  // namespace hamflow::drift
