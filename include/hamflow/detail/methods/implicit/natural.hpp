// cg(1) for H = p^T M^-1 p/2 + V(q) with constant M.   [Gross1999, (2.61)-(2.64), (2.71)-(2.76)]
//     q1 - q0 = h M^-1 (p0 + p1)/2,      p1 - p0 = h F,     F = -int_0^1 V'(q0 + alpha d) dalpha,  d = q1 - q0.
// p is eliminated: Newton's method solves r(d) = h M^-1 (p0 + h F/2) - d = 0 for d with the exact Jacobian
//     K = I + (h^2/2) M^-1 int alpha V''(q0 + alpha d) dalpha.
// p1 is computed as p0 + h F, because 2 M d/h - p0 would amplify rounding by 2 M/h.
#pragma once

#include <algorithm>

#include "hamflow/detail/methods/implicit/energy_gain.hpp"
#include "hamflow/detail/methods/implicit/segment.hpp"
#include "hamflow/detail/methods/implicit/two_variable_fast_path.hpp"

namespace hamflow {

/// The variables are d; the memory consists of impulses h F, from which the next one is extrapolated.
template <class P, class R>
class NaturalElement : public SegmentEquations<P, R> {
  using Base = SegmentEquations<P, R>;

 public:
  using typename Base::Real;
  using typename Base::V;
  static constexpr std::size_t n = P::dimension;
  using Variables = V;
  using Memory = V;

  struct Setup : SegmentSetup<Real> {
    Setup(const P& problem, const CgOptions& options)
        : SegmentSetup<Real>(options),
          inverse_mass_sizes(inverse_mass_matrix(problem)),
          mass(inverse(inverse_mass_sizes)) {
      for (std::size_t i = 0; i < mass.size(); ++i) {
        for (std::size_t j = 0; j < mass.size(); ++j) inverse_mass_sizes[i][j] = abs(inverse_mass_sizes[i][j]);
      }
    }
    Matrix<Real, n> inverse_mass_sizes;  // |M^-1| entry by entry
    Matrix<Real, n> mass;
  };
  struct Point {
    V residual{};
    V sum{};     // kappa F
    V target{};  // the d that follows from it, h M^-1 (p0 + h F/2)
    Matrix<Real, n> stiffness{};
  };

  NaturalElement(const Setup& setup, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : Base(problem, h, setup.rule()),
        setup_(setup),
        q0_(q0),
        p0_(p0),
        effort_(effort),
        flight_(max_norm(displacement_terms())) {}

  V last_state() const { return zeros_like(q0_); }
  V predicted() const {
    V impulse = zeros_like(q0_);
    force(problem_, q0_, impulse);
    for (Real& x : impulse) x = h_ * x;
    ++effort_.force;
    return displacement(impulse, Real(0.5));
  }
  [[gnu::always_inline]] V started(const V& impulse) const { return displacement(impulse, Real(0.5)); }

  /// The whole iteration for an ordinary step (two_variable_fast_path.hpp). If the step is not ordinary, nothing is
  /// counted.
  [[gnu::always_inline]] FastPathResult fast_path(const V& impulse,
                                                  int most) const requires TakesTwo<P> && std::same_as<Real, double> {
    const FastPathResult end = two_variable_fast_path(problem_, rule_, h_, q0_, p0_, impulse, flight_, most);
    const long long evaluations = static_cast<long long>(end.corrections) * rule_.points;
    effort_.force += evaluations;
    effort_.hessian += evaluations;
    effort_.linear_solves += end.corrections;
    return end;
  }
  [[gnu::always_inline]] void evaluate(const V& d, Point& at) const {
    at.stiffness = zero_matrix(q0_);
    integrate(d, at.sum, at.stiffness);
    at.target = displacement(at.sum, Real(0.5) * unit_);
    at.residual = zeros_like(d);
    for (std::size_t i = 0; i < d.size(); ++i) at.residual[i] = at.target[i] - d[i];
  }
  /// Removes the rounding of the residual. In the plane taken() does this, outside the chain of dependent operations.
  void remove_residual_rounding(const V& d, Point& at) const requires(n > 2) {
    const V lost = residual_rounding(at, half_impulse(at));
    for (std::size_t i = 0; i < d.size(); ++i) at.residual[i] += lost[i];
  }
  [[gnu::always_inline]] Matrix<Real, n> tangent(const Point& at) const {
    Matrix<Real, n> k = at.stiffness;
    const Real factor = h_ * h_ / 2;
    const std::size_t size = k.size();
    V row = zeros<Real, n>(size);
    V column = zeros<Real, n>(size);
    for (std::size_t j = 0; j < size; ++j) {
      for (std::size_t i = 0; i < size; ++i) row[i] = at.stiffness[j][i];
      velocity(problem_, row, column);  // M^-1 times column j; stiffness is symmetric
      for (std::size_t i = 0; i < size; ++i) k[i][j] = factor * column[i];
      k[j][j] += Real(1);
    }
    return k;
  }
  /// The residual is accurate at best to epsilon |target|; the terms of M^-1 p, |h| |M^-1| |p0|, count as well, because
  /// p0 and the impulse cancel at a turning point, and the terms of M^-1 p may cancel each other.
  [[gnu::always_inline]] Correction<Real> measure(const V& d, const Point& at, const V& correction) const {
    return measured(flight_, at.target, d, correction);
  }
  template <class X>
  [[gnu::always_inline]] static Correction<Real> measured(const Real& free_displacement, const X& target, const X& d,
                                                          const X& correction) {
    X next = d;
    for (std::size_t i = 0; i < d.size(); ++i) next[i] += correction[i];
    return {max_norm(correction), epsilon * (larger(free_displacement, max_norm(target)) + max_norm(next))};
  }
  /// The size of the target if its rounding hides the step, else 0. At a guess so bad that forces round by more than
  /// the whole step, any correction looks small.
  [[gnu::always_inline]] Real hidden_terms(const V& d, const Point& at, const V& correction) const {
    return hidden_terms_of(flight_, at.target, d, correction);
  }
  template <class X>
  [[gnu::always_inline]] static Real hidden_terms_of(const Real& free_displacement, const X& target, const X& d,
                                                     const X& correction) {
    X next = d;
    for (std::size_t i = 0; i < d.size(); ++i) next[i] += correction[i];
    const Real size = max_norm(target);
    return hidden_by_rounding(Real(epsilon * size), larger(free_displacement, max_norm(next))) ? size : Real(0);
  }

  [[gnu::always_inline]] Increment<Real, n> taken(V& d, const Point& at) const {
    V impulse = at.sum;
    for (Real& x : impulse) x = unit_ * x;
    return {d, impulse};
  }
  /// The last correction is usually less than half a unit in the last place of d and of the impulse. Added to rounded
  /// values it would be lost, an error with the sign of the correction and hence a drift (3.5e-19 of the scale per step
  /// on a pendulum, measured). Therefore both are rounded only once, together with the correction. The rounding of the
  /// residual from which the correction was solved must be removed, too (1.3e-21, measured).
  [[gnu::always_inline]] Increment<Real, n> taken(V& d, const Point& at, const V& correction) const {
    const Expanded half = half_impulse(at);
    V c = correction;
    if constexpr (n <= 2) {
      const V more = made_up_for(tangent(at), residual_rounding(at, half));
      for (std::size_t i = 0; i < n; ++i) c[i] += more[i];
    }
    return taken(d, at, half, c);
  }
  /// The change of the solution by the rounding error of the residual, in the plane.
  template <class M, class X>
  [[gnu::always_inline]] static X made_up_for(const M& k, const X& lost) {
    Real from_identity(0);
    for (std::size_t i = 0; i < lost.size(); ++i) {
      for (std::size_t j = 0; j < lost.size(); ++j) from_identity += abs(k[i][j] - Real(i == j));
    }
    // If steps resolve the motion, a division costs more than the thirtieth part that it would add.
    return from_identity < Real(0.03125) ? lost : hamflow::solve(k, lost);
  }
  V memory(const V&, const Increment<Real, n>& taken) const { return taken.p; }

  /// The 2-norm of the residual (2.63) of [Gross1999], (2/h) M (d - h M^-1 (p0 + h F/2)). The programs of that thesis
  /// iterate in q1 and compute d = q1 - q0 again, which limits their residual to about (2/h) M |q| epsilon; criterion
  /// "seed" does the same.
  Real norm(const V& d, const Point& at) const {
    V r = at.residual;
    if (setup_.options().seed_criterion) {
      for (std::size_t i = 0; i < d.size(); ++i) r[i] += d[i] - ((q0_[i] + d[i]) - q0_[i]);
    }
    const V scaled = apply(setup_.mass, r);
    Real sum(0);
    for (std::size_t i = 0; i < d.size(); ++i) sum += scaled[i] * scaled[i];
    return abs(Real(2) / h_) * sqrt(sum);
  }

  /// Whether one more point changes the work of the mean force, that is, the energy error of the step, by more than
  /// rounding can. Two sums of at most s + 1 terms round by less than s + 4 units of |F| <= |F(middle)| + |V''| |d|.
  /// Forces have the error |V''| |q| epsilon from rounded coordinates, and three times that if terms cancel as in a
  /// Lennard-Jones well. A bias of that size accumulates to some tens of roundings of H over a part of an orbit, for
  /// any h; a bias in units of H would accumulate to 1/h of them. With many coordinates the sum of absolute values is
  /// far larger than that of independent rounding errors; then energy_gain.hpp is used. (For up to four it is at most
  /// twice the root of the sum of squares.)
  bool too_coarse(const V&, const Increment<Real, n>& taken) const {
    if (q0_.size() > 4) {
      return detail::quadrature_misses_gain(
          finer_work(taken, 1), rule_.points, [&] { return finer_work(taken, 2).gain; }, [] { return Real(0); },
          [&](std::uint64_t draw) { return gain_of_neighbouring_step(taken, draw); });
    }
    const Real rounding = rounding_of_work(taken);
    return abs(finer_work(taken).gain) > rounding;
  }
  Real rounding_of_work(const Increment<Real, n>& taken) const {
    const V& d = taken.q;
    const Real terms(rule_.points + 5);
    const V middle = detail::midpoint<Real>(q0_, d);
    V f = zeros_like(d);
    Matrix<Real, n> second = zero_matrix(d);
    force_and_hessian(problem_, middle, f, second);
    ++effort_.force;
    ++effort_.hessian;
    const V free_displacement = displacement_terms();  // terms that determine the rounding of d
    Real rounding(0);
    for (std::size_t i = 0; i < d.size(); ++i) {
      Real units = terms * abs(f[i]);
      for (std::size_t j = 0; j < d.size(); ++j) {
        units += abs(second[i][j]) * (3 * abs(middle[j]) + terms * abs(d[j]) + 4 * free_displacement[j]);
      }
      rounding += epsilon * abs(d[i]) * units;
    }
    return rounding;
  }
  /// Whether the energy error is below a hundredth of the work. The midpoint rule does not conserve the energy.
  bool energy_error_acceptable(const V&, const Increment<Real, n>& taken) const {
    if (rule_.points == 1) return true;
    const detail::Gain<Real> work = finer_work(taken, 1);
    return Real(100) * abs(work.gain) <= work.size;
  }

  /// The gain with one more point minus that with the rule itself, along a neighbouring segment (energy_gain.hpp).
  [[gnu::cold, gnu::noinline]] Real gain_of_neighbouring_step(const Increment<Real, n>& taken,
                                                              std::uint64_t draw) const {
    const Real unit = Real(1) / Real(1 << 24);
    V q = q0_;
    V d = taken.q;
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] = detail::moved_by(unit, q[i], draw, 2 * i);
      d[i] = detail::moved_by(unit, d[i], draw, 2 * i + 1);
    }
    const V middle = detail::midpoint<Real>(q, d);
    const auto work = [&](const GaussRule<Real>& rule) {
      V f = zeros_like(d);
      Real sum(0);
      for (std::size_t l = 0; l < rule.c.size(); ++l) {
        force(problem_, detail::on_segment(middle, rule.offset[l], d), f);
        for (std::size_t i = 0; i < d.size(); ++i) sum += rule.b[l] * d[i] * f[i];
      }
      effort_.force += static_cast<long long>(rule.c.size());
      return sum;
    };
    return work(gauss_rule<Real>(std::min(rule_.points + 1, most_gauss_points))) - work(rule_);
  }

  /// The energy gain with more points.
  detail::Gain<Real> finer_work(const Increment<Real, n>& taken, int more = 1) const {
    const GaussRule<Real>& finer = gauss_rule<Real>(std::min(rule_.points + more, most_gauss_points));
    const V& d = taken.q;
    const V middle = detail::midpoint<Real>(q0_, d);
    V f = zeros_like(d);
    detail::Gain<Real> work;
    V first = f;
    V q = f;
    for (std::size_t l = 0; l < finer.c.size(); ++l) {
      q = detail::on_segment(middle, finer.offset[l], d);
      force(problem_, q, f);
      if (l == 0) first = f;
      for (std::size_t i = 0; i < d.size(); ++i) {
        work.gain += finer.b[l] * d[i] * (f[i] - taken.p[i] / h_);
        work.size += abs(finer.b[l] * d[i] * f[i]);
      }
    }
    effort_.force += finer.points;
    detail::RoundingOfWork<Real> rounding;
    for (std::size_t i = 0; i < d.size(); ++i) rounding.add(d[i] * f[i], (f[i] - first[i]) * q[i]);
    work.noise = rounding.of_terms(finer.points + 4);
    return work;
  }

 protected:
  using Base::h_;
  using Base::problem_;
  using Base::rule_;
  using Base::unit_;
  static constexpr auto epsilon = Epsilon<Real>{};

  /// |h| |M^-1| |p0|, coordinate by coordinate.
  V displacement_terms() const {
    V sizes = zeros_like(p0_);
    for (std::size_t i = 0; i < p0_.size(); ++i) {
      for (std::size_t j = 0; j < p0_.size(); ++j) sizes[i] += setup_.inverse_mass_sizes[i][j] * abs(p0_[j]);
      sizes[i] = abs(h_) * sizes[i];
    }
    return sizes;
  }

  /// sum = -kappa int V'(q0_ + alpha d), stiffness = int alpha V''(q0_ + alpha d).
  [[gnu::always_inline]] void integrate(const V& d, V& sum, Matrix<Real, n>& stiffness) const {
    if constexpr (n == dynamic) {
      sum_points(d, sum, stiffness);
    } else {
      sum_blocks(d, sum, stiffness);
    }
    effort_.force += rule_.points;
    effort_.hessian += rule_.points;
  }
  /// Computes these sums point by point, for large systems.
  void sum_points(const V& d, V& sum, Matrix<Real, n>& stiffness) const {
    const V middle = detail::midpoint<Real>(q0_, d);
    V f = zeros_like(d);
    Matrix<Real, n> second = zero_matrix(d);
    sum = zeros_like(d);
    for (std::size_t l = 0; l < rule_.c.size(); ++l) {
      force_and_hessian(problem_, detail::on_segment(middle, rule_.offset[l], d), f, second);
      const Real force_weight = detail::golden_ratio<Real>() * rule_.b[l];
      const Real weight = rule_.b[l] * (Real(0.5) + rule_.offset[l]);
      for (std::size_t i = 0; i < d.size(); ++i) {
        sum[i] += force_weight * f[i];
        for (std::size_t j = 0; j < d.size(); ++j) stiffness[i][j] += weight * second[i][j];
      }
    }
  }
  /// Evaluates the points of a block together, so that the compiler can use vector registers, and then sums point by
  /// point.
  [[gnu::always_inline]] void sum_blocks(const V& d, V& out, Matrix<Real, n>& stiffness) const {
    constexpr std::size_t block =
        32;  // more points than a step usually has; shorter blocks are unrolled without benefit
    const auto s = static_cast<std::size_t>(rule_.points);
    Real forces[n][block];
    Real hessians[n][n][block];
    V sum{};
    const V middle = detail::midpoint<Real>(q0_, d);
    constexpr Real half = Real(1) / Real(2);
    for (std::size_t first = 0; first < s; first += block) {
      const Real* offset = rule_.offset.data() + first;
      const Real* b = rule_.b.data() + first;
      const std::size_t count = s - first < block ? s - first : block;
      for (std::size_t l = 0; l < count; ++l) {
        V q{};
        V f{};
        Matrix<Real, n> second{};
        for (std::size_t i = 0; i < n; ++i) q[i] = middle[i] + offset[l] * d[i];
        force_and_hessian(problem_, q, f, second);
        const Real force_weight = detail::golden_ratio<Real>() * b[l];
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
    out = sum;
  }

  /// h M^-1 (p0 + factor x); 2 factor x is an impulse.
  [[gnu::always_inline]] V displacement(const V& x, const Real& factor) const {
    V middle = zeros_like(p0_);
    V v = zeros_like(p0_);
    for (std::size_t i = 0; i < p0_.size(); ++i) middle[i] = p0_[i] + factor * x[i];
    velocity(problem_, middle, v);
    for (std::size_t i = 0; i < p0_.size(); ++i) v[i] = h_ * v[i];
    return v;
  }

  /// A rounded value and its rounding error.
  struct Expanded {
    V high{};
    V low{};
  };
  [[gnu::always_inline]] Expanded half_impulse(const Point& at) const {
    Expanded half{zeros_like(p0_), zeros_like(p0_)};
    const Real unit = Real(0.5) * unit_;
    for (std::size_t i = 0; i < p0_.size(); ++i) {
      half.high[i] = unit * at.sum[i];
      half.low[i] = product_error(unit, at.sum[i], half.high[i]);
    }
    return half;
  }
  /// The rounding error of the residual h M^-1 (p0 + h F/2) - d, which is that of its first term, epsilon |h M^-1 p0|,
  /// because the difference is exact near the solution.
  [[gnu::always_inline]] V residual_rounding(const Point& at, const Expanded& half) const {
    V middle = zeros_like(p0_);
    V lost = zeros_like(p0_);  // middle + lost = p0 + h F/2
    for (std::size_t i = 0; i < p0_.size(); ++i) {
      middle[i] = p0_[i] + half.high[i];
      const Real part = middle[i] - p0_[i];
      lost[i] = ((p0_[i] - (middle[i] - part)) + (half.high[i] - part)) + half.low[i];
    }
    V v = zeros_like(p0_);
    V rest = zeros_like(p0_);
    velocity(problem_, middle, v);
    velocity(problem_, lost, rest);
    for (std::size_t i = 0; i < p0_.size(); ++i) rest[i] = product_error(h_, v[i], at.target[i]) + h_ * rest[i];
    return rest;
  }

  /// As above, with the complete correction c.
  [[gnu::always_inline]] Increment<Real, n> taken(V& d, const Point& at, const Expanded& half, const V& c) const {
    V impulse = zeros_like(d);
    for (std::size_t i = 0; i < d.size(); ++i) {
      Real change(0);
      for (std::size_t j = 0; j < d.size(); ++j) change += at.stiffness[i][j] * c[j];
      impulse[i] = 2 * half.high[i] + (2 * half.low[i] - h_ * change);
    }
    for (std::size_t i = 0; i < d.size(); ++i) d[i] += c[i];
    return {d, impulse};
  }

  const Setup& setup_;
  const V& q0_;
  const V& p0_;
  Effort& effort_;
  Real flight_;
};

}  // namespace hamflow
