// cg(1) for H = p^T M^-1 p/2 + V(q) with constant M.   [Gross1999, (2.61)-(2.64), (2.71)-(2.76)]
//     q1 - q0 = h M^-1 (p0 + p1)/2,      p1 - p0 = h F,     F = -int_0^1 V'(q0 + alpha d) dalpha,  d = q1 - q0.
// p is eliminated: Newton runs in d alone, on r(d) = h M^-1 (p0 + h F/2) - d with the exact tangent
//     K = I + (h^2/2) M^-1 int alpha V''(q0 + alpha d) dalpha.
// p1 is p0 + h F, never 2 M d/h - p0, which would amplify rounding by 2 M/h.
#pragma once

#include <limits>

#include "hamflow/methods/element/context.hpp"

namespace hamflow {

/// Solves a step for its increments. It remembers the last impulses, from which the first guess is extrapolated.
template <class P, class Real>
class NaturalElement {
 public:
  static constexpr std::size_t n = P::dimension;
  using V = Vector<Real, n>;
  using Context = ElementContext<Real>;

  explicit NaturalElement(const P& problem)
      : inverse_mass_sizes_(inverse_mass_matrix(problem)), mass_(inverse(inverse_mass_sizes_)) {
    for (std::size_t i = 0; i < mass_.size(); ++i) {
      for (std::size_t j = 0; j < mass_.size(); ++j) inverse_mass_sizes_[i][j] = abs(inverse_mass_sizes_[i][j]);
    }
  }

  void guess(Context& context, const P& problem, const Real& h, const V& q0, const V& p0, Increment<Real, n>& u) {
    u.p = zeros_like(q0);
    if (memory_.empty()) {
      force(problem, q0, u.p);
      for (Real& x : u.p) x = h * x;
      ++context.effort.force;
    } else {
      memory_.predict(u.p);
    }
    u.q = displacement(problem, h, p0, u.p);
  }
  void remember(const Increment<Real, n>& u) { memory_.remember(u.p); }
  void forget() { memory_.forget(); }
  template <class Archive>
  void archive(Archive& ar) {
    ar(memory_);
  }

  /// Newton from u.q. On success u.p is h F at the solution.
  Outcome converge(Context& context, const P& problem, const Real& h, const V& q0, const V& p0, Increment<Real, n>& u,
                   std::string* history) {
    const CgOptions& options = context.options;
    V& d = u.q;
    V& impulse = u.p;
    Real previous(0);          // |correction| of the iteration before
    bool at_rounding = false;  // no further correction can be told from rounding
    int stalls = 0;
    // |h| |M^-1| |p0|: what the target rounds by, however far p0 and the impulse cancel at a turning point, and the
    // terms of M^-1 p with each other.
    const Real flight = max_norm(terms_of_flight(h, p0));
    for (int k = 0;; ++k) {
      Matrix<Real, n> stiffness = zero_matrix(q0);
      integrate(context, problem, h, q0, d, impulse, stiffness);
      const V target = displacement(problem, h, p0, impulse);
      V r = zeros_like(d);
      for (std::size_t i = 0; i < d.size(); ++i) r[i] = target[i] - d[i];
      if (options.tolerance || history != nullptr || options.diagnostics) {
        const Real norm = seed_residual(options, h, q0, d, r);
        if (history != nullptr) detail::note_residual(norm, k, *history);
        context.diagnostics.residual = static_cast<double>(norm);
        if (options.tolerance) {
          if (norm < static_cast<Real>(*options.tolerance)) return Outcome::done;
          if (at_rounding && !options.seed_criterion) {
            ++context.effort.stagnated;
            return Outcome::done;
          }
        }
      }
      if (k == options.max_iterations) return Outcome::not_converged;

      const Matrix<Real, n> k_t = tangent(problem, h, stiffness);
      if (options.diagnostics) detail::note_tangent<Real, n>(k_t, context.diagnostics);
      const V correction = solve(k_t, r);
      ++context.effort.linear_solves;
      for (std::size_t i = 0; i < d.size(); ++i) {
        d[i] += correction[i];
        Real change(0);
        for (std::size_t j = 0; j < d.size(); ++j) change += stiffness[i][j] * correction[j];
        impulse[i] -= h * change;  // h F at the new d, to second order
      }
      // The residual cannot be computed better than this; a correction of that size is noise.
      const Real size = max_norm(correction);
      const Real noise = epsilon * (larger(flight, max_norm(target)) + max_norm(d));
      if (!(size <= std::numeric_limits<Real>::max())) return Outcome::not_converged;  // not finite
      at_rounding = newton_at_rounding(size, previous, k == 0, noise, stalls);
      if (at_rounding && !options.tolerance) {
        // d + correction has just been rounded, mostly to the target of the *old* impulse: an error with the sign of
        // the correction, hence a drift (4e-20 a step at H = -0.25, measured). The new impulse gives d afresh.
        d = displacement(problem, h, p0, impulse);
        return Outcome::done;
      }
      previous = size;
    }
  }

  /// Whether one more point changes the work done by the mean force, which is the energy error of the step, by more
  /// than rounding can: two sums of at most s + 1 terms round by less than s + 4 units of |F| <= |F(middle)| + |V''|
  /// |d|, the forces by what rounded coordinates make of them, |V''| |q| epsilon, three times that where terms cancel
  /// as in a Lennard-Jones well. A bias of that size adds up to some tens of roundings of H over a part of an orbit,
  /// however small h is; one in units of H would add up to 1/h of them.
  bool too_coarse(Context& context, const P& problem, const Real& h, const V& q0, const V& p0,
                  const Increment<Real, n>& u) {
    const GaussRule<Real>& finer = gauss_rule<Real>(context.rule->points + 1);
    const V& d = u.q;
    const V middle = detail::midpoint<Real>(q0, d);
    V f = zeros_like(d);
    Matrix<Real, n> second = zero_matrix(d);
    force_and_hessian(problem, middle, f, second);
    const V flight = terms_of_flight(h, p0);  // d itself rounds by these
    Real rounding(0);
    for (std::size_t i = 0; i < d.size(); ++i) {
      Real units = Real(finer.points + 4) * abs(f[i]);
      for (std::size_t j = 0; j < d.size(); ++j) {
        units += abs(second[i][j]) * (3 * abs(middle[j]) + Real(finer.points + 4) * abs(d[j]) + 4 * flight[j]);
      }
      rounding += epsilon * abs(d[i]) * units;
    }
    Real difference(0);
    for (std::size_t l = 0; l < finer.c.size(); ++l) {
      force(problem, detail::on_segment(middle, finer.offset[l], d), f);
      for (std::size_t i = 0; i < d.size(); ++i) difference += finer.b[l] * d[i] * (f[i] - u.p[i] / h);
    }
    context.effort.force += finer.points + 1;
    ++context.effort.hessian;
    return abs(difference) > rounding;
  }

 private:
  /// |h| |M^-1| |p|, coordinate by coordinate.
  V terms_of_flight(const Real& h, const V& p) const {
    V sizes = zeros_like(p);
    for (std::size_t i = 0; i < p.size(); ++i) {
      for (std::size_t j = 0; j < p.size(); ++j) sizes[i] += inverse_mass_sizes_[i][j] * abs(p[j]);
      sizes[i] = abs(h) * sizes[i];
    }
    return sizes;
  }

  static constexpr auto epsilon = Epsilon<Real>{};

  /// impulse = -h int V'(q0 + alpha d), stiffness = int alpha V''(q0 + alpha d).
  [[gnu::always_inline]] static void integrate(Context& context, const P& problem, const Real& h, const V& q0,
                                               const V& d, V& impulse, Matrix<Real, n>& stiffness) {
    if constexpr (n == dynamic) {
      sum_points(context, problem, h, q0, d, impulse, stiffness);
    } else {
      sum_blocks(context, problem, h, q0, d, impulse, stiffness);
    }
    context.effort.force += context.rule->points;
    context.effort.hessian += context.rule->points;
  }
  /// Large systems, point after point.
  static void sum_points(const Context& context, const P& problem, const Real& h, const V& q0, const V& d, V& impulse,
                         Matrix<Real, n>& stiffness) {
    const GaussRule<Real>& rule = *context.rule;
    const V middle = detail::midpoint<Real>(q0, d);
    V f = zeros_like(d);
    Matrix<Real, n> second = zero_matrix(d);
    impulse = zeros_like(d);
    for (std::size_t l = 0; l < rule.c.size(); ++l) {
      force_and_hessian(problem, detail::on_segment(middle, rule.offset[l], d), f, second);
      const Real force_weight = h * rule.b[l];
      const Real weight = rule.b[l] * (Real(0.5) + rule.offset[l]);
      for (std::size_t i = 0; i < d.size(); ++i) {
        impulse[i] += force_weight * f[i];
        for (std::size_t j = 0; j < d.size(); ++j) stiffness[i][j] += weight * second[i][j];
      }
    }
  }
  /// The points of a block come first, side by side, so that the compiler can evaluate several at once in vector
  /// registers; then the sums, point after point. h is multiplied into the weights, so that the increment of p is a
  /// plain sum of the points' contributions.
  [[gnu::always_inline]] static void sum_blocks(const Context& context, const P& problem, const Real& h, const V& q0,
                                                const V& d, V& impulse, Matrix<Real, n>& stiffness) {
    constexpr std::size_t block = 32;  // more than a step commonly has; shorter ones get unrolled to no good
    const GaussRule<Real>& rule = *context.rule;
    const auto s = static_cast<std::size_t>(rule.points);
    Real forces[n][block];
    Real hessians[n][n][block];
    V sum{};
    const V middle = detail::midpoint<Real>(q0, d);
    constexpr Real half = Real(1) / Real(2);
    for (std::size_t first = 0; first < s; first += block) {
      const Real* offset = rule.offset.data() + first;
      const Real* b = rule.b.data() + first;
      const std::size_t count = s - first < block ? s - first : block;
      for (std::size_t l = 0; l < count; ++l) {
        V q{};
        V f{};
        Matrix<Real, n> second{};
        for (std::size_t i = 0; i < n; ++i) q[i] = middle[i] + offset[l] * d[i];
        force_and_hessian(problem, q, f, second);
        const Real force_weight = h * b[l];
        const Real weight = b[l] * (half + offset[l]);
        for (std::size_t i = 0; i < n; ++i) {
          forces[i][l] = force_weight * f[i];
          for (std::size_t j = 0; j < n; ++j) hessians[i][j][l] = weight * second[i][j];
        }
      }
      for (std::size_t l = 0; l < count; ++l) {
        for (std::size_t i = 0; i < n; ++i) {
          sum[i] += forces[i][l];
          for (std::size_t j = 0; j < n; ++j) stiffness[i][j] += hessians[i][j][l];
        }
      }
    }
    impulse = sum;
  }

  static Matrix<Real, n> tangent(const P& problem, const Real& h, const Matrix<Real, n>& stiffness) {
    Matrix<Real, n> k = stiffness;
    const Real factor = h * h / 2;
    const std::size_t size = stiffness.size();
    V row = zeros<Real, n>(size);
    V column = zeros<Real, n>(size);
    for (std::size_t j = 0; j < size; ++j) {
      for (std::size_t i = 0; i < size; ++i) row[i] = stiffness[j][i];
      velocity(problem, row, column);  // M^-1 applied to column j; stiffness is symmetric
      for (std::size_t i = 0; i < size; ++i) k[i][j] = factor * column[i];
      k[j][j] += Real(1);
    }
    return k;
  }

  /// h M^-1 (p0 + impulse/2).
  static V displacement(const P& problem, const Real& h, const V& p0, const V& impulse) {
    V middle = zeros_like(p0);
    V v = zeros_like(p0);
    for (std::size_t i = 0; i < p0.size(); ++i) middle[i] = p0[i] + Real(0.5) * impulse[i];
    velocity(problem, middle, v);
    for (std::size_t i = 0; i < p0.size(); ++i) v[i] = h * v[i];
    return v;
  }

  /// The 2-norm of the seed's residual (2.63), (2/h) M (d - h M^-1 (p0 + h F/2)). The seed's programs iterate in q1 and
  /// form d = q1 - q0 anew, which is what limits their residual to about (2/h) M |q| epsilon; so does its criterion
  /// here.
  Real seed_residual(const CgOptions& options, const Real& h, const V& q0, const V& d, V r) const {
    if (options.seed_criterion) {
      for (std::size_t i = 0; i < d.size(); ++i) r[i] += d[i] - ((q0[i] + d[i]) - q0[i]);
    }
    const V scaled = apply(mass_, r);
    Real sum(0);
    for (std::size_t i = 0; i < d.size(); ++i) sum += scaled[i] * scaled[i];
    return abs(Real(2) / h) * sqrt(sum);
  }

  Matrix<Real, n> inverse_mass_sizes_;  // |M^-1| entry by entry
  Matrix<Real, n> mass_;
  Extrapolation<V> memory_;
};

}  // namespace hamflow
