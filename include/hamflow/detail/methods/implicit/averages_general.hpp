// Averages for any H(q, p): Newton's method solves r_i = h sum_l W_il J grad H(y_l) - u_i = 0 for all of them, with the
// exact Jacobian
//     K_ij = delta_ij I - h sum_l W_il (e_j/2 + N_lj) J H''(y_l).   [average_table.hpp]
#pragma once

#include "hamflow/core/error.hpp"
#include "hamflow/detail/methods/implicit/averages_rows.hpp"

namespace hamflow {

template <class P, class R>
class GeneralAverages : public AverageEquations<P, R> {
  using Base = AverageEquations<P, R>;

 public:
  using typename Base::Memory;
  using typename Base::Real;
  using typename Base::V;
  using typename Base::Variables;
  static constexpr std::size_t n = P::dimension;
  using Point = detail::AveragesPoint<Real>;
  struct Setup : AverageSetup<Real> {
    Setup(const P&, const AverageOptions& options) : AverageSetup<Real>(options) {
      if (!Smooth<P> && options.element.iteration != Iteration::fixed_point) {
        throw Error("this H has no second derivatives, which Newton's iteration needs; allowed Iteration::fixed_point");
      }
    }
  };

  GeneralAverages(const Setup& setup, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : Base(problem, h, setup.table()),
        setup_(setup),
        q0_(q0),
        p0_(p0),
        effort_(effort),
        size_(q0.size()),
        m_(2 * q0.size()) {}

  const V& positions() const { return q0_; }
  const V& momenta() const { return p0_; }
  GeneralAverages from(const V& q0, const V& p0) const {
    return GeneralAverages(setup_, problem_, h_, q0, p0, effort_);
  }
  Variables last_state() const { return Variables(k_ * m_); }
  Variables predicted() const {
    V dq = zeros_like(q0_);
    V dp = zeros_like(q0_);
    gradient(problem_, q0_, p0_, dq, dp);
    ++effort_.gradient;
    Variables x(k_ * m_);
    for (std::size_t i = 0; i < k_; ++i) {
      const Real factor = h_ * (table_.scale[i] * table_.middle[i]);
      for (std::size_t a = 0; a < size_; ++a) {
        x[a * k_ + i] = factor * dp[a];
        x[(size_ + a) * k_ + i] = -factor * dq[a];
      }
    }
    return x;
  }
  Variables started(const Memory& last) const {
    if (last.size() != k_ * m_) return last_state();  // after restoring a state of another size
    return detail::continued(table_, last);
  }

  void evaluate(const Variables& x, Point& at) const {
    detail::clear(at, x.size(), 3 * size_ * size_ * k_ * k_);
    auto size_q = point_rows<Real, n>(size_);  // sizes of the terms of dH/dq; the same for p
    auto size_p = size_q;
    at_points(table_, x, at.linearised, [&](std::size_t first, std::size_t count, const Block& block) {
      for (std::size_t a = 0; a < size_; ++a) {
        for (std::size_t l = 0; l < count; ++l) {
          size_q[a * point_stride + l] = abs(block.dq[a * point_stride + l]);
          size_p[a * point_stride + l] = abs(block.dp[a * point_stride + l]);
        }
        if (!at.linearised) continue;
        for (std::size_t b = 0; b < size_; ++b) {
          const Real* const qq = &block.qq[(a * size_ + b) * point_stride];
          const Real* const qp = &block.qp[(a * size_ + b) * point_stride];
          const Real* const pq = &block.qp[(b * size_ + a) * point_stride];
          const Real* const pp = &block.pp[(a * size_ + b) * point_stride];
          for (std::size_t l = 0; l < count; ++l) {
            const Real& q = block.q[b * point_stride + l];
            const Real& p = block.p[b * point_stride + l];
            size_q[a * point_stride + l] += abs(qq[l] * q) + abs(qp[l] * p);
            size_p[a * point_stride + l] += abs(pq[l] * q) + abs(pp[l] * p);
          }
          Real* const curvatures = &at.curvatures[3 * (a * size_ + b) * k_ * k_];
          detail::add_curvatures(table_.tangent_weights, k_, first, count, qq, curvatures);
          detail::add_curvatures(table_.tangent_weights, k_, first, count, qp, curvatures + k_ * k_);
          detail::add_curvatures(table_.tangent_weights, k_, first, count, pp, curvatures + 2 * k_ * k_);
        }
      }
      detail::add_averages(table_, first, count, h_, Real(1), &block.dp[0], &size_p[0], 0, size_, at);
      detail::add_averages(table_, first, count, h_, Real(-1), &block.dq[0], &size_q[0], size_, size_, at);
    });
    effort_.gradient += table_.points;
    if (at.linearised) {
      effort_.hessian += table_.points;
      close_tangent(at);
    }
    detail::close(at, unit_, x);
  }
  const Matrix<Real, dynamic>& tangent(const Point& at) const { return at.tangent; }
  Real norm(const Variables&, const Point& at) const { return detail::two_norm(at.residual); }
  Correction<Real> measure(const Variables& x, const Point& at, const Variables& correction) const {
    return detail::in_units_of_noise(x, at, correction);
  }
  Real hidden_terms(const Variables& x, const Point& at, const Variables& correction) const {
    return detail::hiding_terms(x, at, correction);
  }

  Increment<Real, n> taken(Variables& x, const Point& at) const {
    x = at.target;
    return increment_of(x);
  }
  Increment<Real, n> taken(Variables& x, const Point& at, const Variables& correction) const {
    detail::move_to_target(x, at, unit_, correction);
    return increment_of(x);
  }
  Memory memory(const Variables& x, const Increment<Real, n>&) const { return x; }
  Vector<Real, dynamic> unknowns(const Variables& x, const Increment<Real, n>&) const { return x; }

  /// The energy gain of the step according to a finer quadrature.
  detail::Gain<Real> gain_of_energy(const Variables& x) const { return gain(x, setup_.finer()); }
  /// The energy gain according to the quadrature in use: the rounding of the solution.
  Real own_gain(const Variables& x) const { return gain(x, setup_.table()).gain; }
  bool too_coarse(const Variables& x, const Increment<Real, n>&) const {
    return detail::quadrature_misses_gain(
        gain(x, setup_.finer()), table_.points, [&] { return gain(x, setup_.finest()).gain; },
        [&] { return own_gain(x); },
        [&](std::uint64_t draw) { return detail::gain_of_neighbouring_step(*this, x, draw); });
  }
  /// Whether the energy error is below a hundredth of the work, for elements that conserve the energy.
  bool energy_error_acceptable(const Variables& x, const Increment<Real, n>&) const {
    if (!setup_.conserves()) return true;
    const detail::Gain<Real> seen = gain(x, setup_.finer());
    return Real(100) * abs(seen.gain) <= seen.size;
  }

 private:
  using Base::h_;
  using Base::k_;
  using Base::problem_;
  using Base::table_;
  using Base::unit_;
  static constexpr auto epsilon = Epsilon<Real>{};
  static constexpr std::size_t squared = n == dynamic ? dynamic : n * n;

  struct Block {
    PointRows<Real, n> q, p, dq, dp;
    PointRows<Real, squared> qq, qp, pp;
  };
  /// Calls take(first, count, block) for the points of a table with gradients and, if requested, second derivatives.
  template <class Take>
  void at_points(const AverageTable<Real>& table, const Variables& x, bool second, const Take& take) const {
    V middle_q = q0_;  // (z0 + z1)/2
    V middle_p = p0_;
    detail::add_half_increment(table, x, 0, middle_q);
    detail::add_half_increment(table, x, size_, middle_p);
    const auto rows = point_rows<Real, n>(size_);
    Block block{rows, rows, rows, rows, {}, {}, {}};
    if constexpr (n == dynamic) {
      if (second) block.qq = block.qp = block.pp = point_rows<Real, dynamic>(size_ * size_);
    }
    for_blocks(static_cast<std::size_t>(table.points), [&](std::size_t first, std::size_t count) {
      detail::place_points(table, x, 0, first, count, middle_q, &block.q[0]);
      detail::place_points(table, x, size_, first, count, middle_p, &block.p[0]);
      gradients_at(problem_, count, &block.q[0], &block.p[0], &block.dq[0], &block.dp[0]);
      if constexpr (Smooth<P>) {
        if (second) {
          hessians_at(problem_, count, &block.q[0], &block.p[0], &block.qq[0], &block.qp[0], &block.pp[0]);
        }
      }
      take(first, count, block);
    });
  }

  /// Computes K from the sums.
  void close_tangent(Point& at) const {
    const std::size_t kk = k_ * k_;
    for (std::size_t a = 0; a < size_; ++a) {
      for (std::size_t b = 0; b < size_; ++b) {
        const Real* const qq = &at.curvatures[3 * (a * size_ + b) * kk];
        const Real* const qp = qq + kk;
        const Real* const pq = &at.curvatures[3 * (b * size_ + a) * kk + kk];
        const Real* const pp = qq + 2 * kk;
        for (std::size_t i = 0; i < k_; ++i) {
          Real* const of_q = at.tangent[a * k_ + i];
          Real* const of_p = at.tangent[(size_ + a) * k_ + i];
          for (std::size_t j = 0; j < k_; ++j) {
            of_q[b * k_ + j] = -(h_ * pq[i * k_ + j]);
            of_q[(size_ + b) * k_ + j] = -(h_ * pp[i * k_ + j]);
            of_p[b * k_ + j] = h_ * qq[i * k_ + j];
            of_p[(size_ + b) * k_ + j] = h_ * qp[i * k_ + j];
          }
        }
      }
    }
    for (std::size_t i = 0; i < at.tangent.size(); ++i) at.tangent[i][i] += Real(1);
  }

  /// z1 - z0, each coordinate rounded once.
  Increment<Real, n> increment_of(const Variables& x) const {
    Increment<Real, n> taken{zeros_like(q0_), zeros_like(q0_)};
    for (std::size_t a = 0; a < m_; ++a) {
      detail::CompensatedSum<Real> sum;
      for (std::size_t j = 0; j < k_; ++j) {
        if (!(table_.increment[j] == Real(0))) sum.add(x[a * k_ + j]);  // other entries are 1
      }
      (a < size_ ? taken.q[a] : taken.p[a - size_]) = sum.high + sum.low;
    }
    return taken;
  }

  /// The energy gain of the step according to a rule with more points, sum_j u_j.(sum_l W'_jl grad H(y'_l)). With the
  /// points in use it is 0 for any averages. The rounding is estimated as in averages_natural.hpp.
  detail::Gain<Real> gain(const Variables& x, const AverageTable<Real>& finer) const {
    V first_q = zeros_like(q0_);
    V first_p = first_q;
    V last_q = first_q;
    V last_p = first_q;
    V end_q = first_q;
    V end_p = first_q;
    V work_q = first_q;
    V work_p = first_q;
    detail::Gain<Real> seen;
    at_points(finer, x, false, [&](std::size_t first, std::size_t count, const Block& block) {
      if (first == 0) {
        detail::take_point(&block.dq[0], 0, first_q);
        detail::take_point(&block.dp[0], 0, first_p);
      }
      detail::take_point(&block.dq[0], count - 1, last_q);
      detail::take_point(&block.dp[0], count - 1, last_p);
      detail::take_point(&block.q[0], count - 1, end_q);
      detail::take_point(&block.p[0], count - 1, end_p);
      for (std::size_t j = 0; j < k_; ++j) {
        for (std::size_t l = 0; l < count; ++l) {
          const Real& weight = finer.weight[(first + l) * k_ + j];
          for (std::size_t a = 0; a < size_; ++a) {
            const Real by_q = weight * block.dq[a * point_stride + l] * x[a * k_ + j];
            const Real by_p = weight * block.dp[a * point_stride + l] * x[(size_ + a) * k_ + j];
            seen.gain += by_q + by_p;
            work_q[a] += abs(by_q);
            work_p[a] += abs(by_p);
          }
        }
      }
    });
    effort_.gradient += finer.points;
    detail::RoundingOfWork<Real> rounding;
    for (std::size_t a = 0; a < size_; ++a) {
      seen.size += work_q[a] + work_p[a];
      rounding.add(work_q[a], (last_q[a] - first_q[a]) * end_q[a]);
      rounding.add(work_p[a], (last_p[a] - first_p[a]) * end_p[a]);
    }
    seen.noise = rounding.of_terms(finer.points + 4);
    return seen;
  }

  const Setup& setup_;
  const V& q0_;
  const V& p0_;
  Effort& effort_;
  const std::size_t size_;
  const std::size_t m_;
};

}  // namespace hamflow
