// Averages for H = p^T M^-1 p/2 + V(q) with constant M: Newton's method solves only for the impulses u^p_i = h sum_l
// W_il F(q_l), since
//     u^q_j = h beta_j M^-1 (omega_j (p0 + p1)/2 + sum_i A_ji u^p_i),   q_l = (q0 + q1)/2 + sum_j N_lj u^q_j,
// with the exact Jacobian K_ij = delta_ij I + h^2 (sum_l W_il dq_l/du^p_j V''(q_l)) M^-1. For cg(1) the residual is
// that of (2.63) in Gross1999.   [average_table.hpp]
#pragma once

#include "hamflow/detail/methods/implicit/averages_rows.hpp"

namespace hamflow {

template <class P, class R>
class NaturalAverages : public AverageEquations<P, R> {
  using Base = AverageEquations<P, R>;

 public:
  using typename Base::Memory;
  using typename Base::Real;
  using typename Base::V;
  using typename Base::Variables;
  static constexpr std::size_t n = P::dimension;
  using Point = detail::AveragesPoint<Real>;

  struct Setup : AverageSetup<Real> {
    Setup(const P& problem, const AverageOptions& options) : AverageSetup<Real>(options) {
      if (options.element.iteration == Iteration::fixed_point) return;
      inverse_mass = inverse_mass_matrix(problem);
      for (std::size_t a = 0; a < inverse_mass.size(); ++a) {
        for (std::size_t b = 0; b < inverse_mass.size(); ++b) {
          if (a != b && !(inverse_mass[a][b] == Real(0))) diagonal = false;
        }
      }
    }
    Matrix<Real, n> inverse_mass{};  // for the Jacobian only
    bool diagonal = true;
  };

  NaturalAverages(const Setup& setup, const P& problem, const Real& h, const V& q0, const V& p0, Effort& effort)
      : Base(problem, h, setup.table()), setup_(setup), q0_(q0), p0_(p0), effort_(effort), size_(q0.size()) {}

  const V& positions() const { return q0_; }
  const V& momenta() const { return p0_; }
  NaturalAverages from(const V& q0, const V& p0) const {
    return NaturalAverages(setup_, problem_, h_, q0, p0, effort_);
  }
  Variables last_state() const { return Variables(k_ * size_); }
  Variables predicted() const {
    V f = zeros_like(q0_);
    force(problem_, q0_, f);
    ++effort_.force;
    Variables x(k_ * size_);
    for (std::size_t a = 0; a < size_; ++a) {
      for (std::size_t i = 0; i < k_; ++i) x[a * k_ + i] = h_ * (table_.scale[i] * table_.middle[i]) * f[a];
    }
    return x;
  }
  Variables started(const Memory& last) const {
    if (last.size() != k_ * size_) return last_state();  // after restoring a state of another size
    return detail::continued(table_, last);
  }

  void evaluate(const Variables& x, Point& at) const {
    detail::clear(at, x.size(), size_ * size_ * k_ * k_);
    const Variables u = displacements(x);
    auto sizes = point_rows<Real, n>(size_);  // sizes of the terms of a force
    at_points(table_, u, at.linearised ? With::hessians : With::forces,
              [&](std::size_t first, std::size_t count, const Block& block) {
                for (std::size_t a = 0; a < size_; ++a) {
                  Real* const size = &sizes[a * point_stride];
                  for (std::size_t l = 0; l < count; ++l) size[l] = abs(block.f[a * point_stride + l]);
                  if (!at.linearised) continue;
                  for (std::size_t b = 0; b < size_; ++b) {
                    const Real* const second = &block.h[(a * size_ + b) * point_stride];
                    for (std::size_t l = 0; l < count; ++l) size[l] += abs(second[l] * block.q[b * point_stride + l]);
                    if (b <= a) {
                      detail::add_curvatures(table_.natural_tangent_weights, k_, first, count, second,
                                             &at.curvatures[(a * size_ + b) * k_ * k_]);
                    }
                  }
                }
                detail::add_averages(table_, first, count, h_, Real(1), &block.f[0], &sizes[0], 0, size_, at);
              });
    effort_.force += table_.points;
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
  Vector<Real, dynamic> unknowns(const Variables& x, const Increment<Real, n>&) const {
    const Variables u = displacements(x);
    Vector<Real, dynamic> all(2 * x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      all[i] = u[i];
      all[x.size() + i] = x[i];
    }
    return all;
  }

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

  /// A block of points with the functions evaluated there, in the layout of points.hpp.
  struct Block {
    PointRows<Real, n> q, f;
    PointRows<Real, n == dynamic ? dynamic : n * n> h;
  };
  /// The displacements u^q_j for given impulses.
  Variables displacements(const Variables& x) const {
    V middle = p0_;  // (p0 + p1)/2
    detail::add_half_increment(table_, x, 0, middle);
    Variables u(x.size());
    for (std::size_t a = 0; a < size_; ++a) {
      Real* const row = &u[a * k_];
      for (std::size_t i = 0; i < k_; ++i) {  // A is antisymmetric
        for (std::size_t j = 0; j < k_; ++j) row[j] -= table_.coupling[i * k_ + j] * x[a * k_ + i];
      }
      for (std::size_t j = 0; j < k_; ++j) row[j] += table_.middle[j] * middle[a];
    }
    V p = middle;
    V v = middle;
    for (std::size_t j = 0; j < k_; ++j) {
      for (std::size_t a = 0; a < size_; ++a) p[a] = u[a * k_ + j];
      velocity(problem_, p, v);
      const Real length = h_ * table_.scale[j];
      for (std::size_t a = 0; a < size_; ++a) u[a * k_ + j] = length * v[a];
    }
    return u;
  }
  enum class With { points, forces, hessians };
  /// Calls take(first, count, block) for the points of a table with the requested functions.
  template <class Take>
  void at_points(const AverageTable<Real>& table, const Variables& u, With with, const Take& take) const {
    V middle = q0_;  // (q0 + q1)/2
    detail::add_half_increment(table, u, 0, middle);
    Block block{point_rows<Real, n>(size_), point_rows<Real, n>(size_), {}};
    if constexpr (n == dynamic) {
      if (with == With::hessians) block.h = point_rows<Real, dynamic>(size_ * size_);
    }
    for_blocks(static_cast<std::size_t>(table.points), [&](std::size_t first, std::size_t count) {
      detail::place_points(table, u, 0, first, count, middle, &block.q[0]);
      if (with == With::hessians) {
        forces_and_hessians_at(problem_, count, &block.q[0], &block.f[0], &block.h[0]);
      } else if (with == With::forces) {
        forces_at(problem_, count, &block.q[0], &block.f[0]);
      }
      take(first, count, block);
    });
  }

 private:
  using Base::h_;
  using Base::k_;
  using Base::problem_;
  using Base::table_;
  using Base::unit_;
  static constexpr auto epsilon = Epsilon<Real>{};

  /// Computes K from the sums.
  void close_tangent(Point& at) const {
    const Real factor = h_ * h_;
    const std::size_t kk = k_ * k_;
    for (std::size_t a = 0; a < size_; ++a) {
      for (std::size_t b = 0; b < size_; ++b) {
        for (std::size_t i = 0; i < k_; ++i) {
          Real* const row = &at.tangent[a * k_ + i][b * k_];
          for (std::size_t j = 0; j < k_; ++j) row[j] = Real(0);
          for (std::size_t c = setup_.diagonal ? b : 0; c < (setup_.diagonal ? b + 1 : size_); ++c) {
            const Real* const curvatures = &at.curvatures[curvature_index(a, c) * kk + i * k_];
            const Real inverse_mass = factor * setup_.inverse_mass[c][b];
            for (std::size_t j = 0; j < k_; ++j) row[j] += curvatures[j] * inverse_mass;
          }
        }
      }
    }
    for (std::size_t i = 0; i < at.tangent.size(); ++i) at.tangent[i][i] += Real(1);
  }
  /// Index of an entry of V''. V'' is symmetric, so only the lower half is summed.
  std::size_t curvature_index(std::size_t a, std::size_t b) const { return a < b ? b * size_ + a : a * size_ + b; }

  /// z1 - z0, each coordinate rounded once, because rounding errors of a step can have a fixed sign, see natural.hpp.
  Increment<Real, n> increment_of(const Variables& x) const {
    Increment<Real, n> taken{zeros_like(q0_), zeros_like(q0_)};
    V lost_q = zeros_like(q0_);
    V lost_p = lost_q;
    V high = lost_q;
    V low = lost_q;
    V v = lost_q;
    V rest = lost_q;
    for (std::size_t j = 0; j < k_; ++j) {
      if (table_.increment[j] == Real(0)) continue;  // other entries are 1, and so is omega
      const Real length = h_ * table_.scale[j];
      for (std::size_t a = 0; a < size_; ++a) {
        detail::CompensatedSum<Real> p{p0_[a], Real(0)};
        for (std::size_t i = 0; i < k_; ++i) {
          const Real factor = table_.increment[i] / Real(2) + table_.coupling[j * k_ + i];
          if (!(factor == Real(0))) p.add(factor * x[a * k_ + i]);
        }
        high[a] = p.high;
        low[a] = p.low;
        detail::CompensatedSum<Real> impulse{taken.p[a], lost_p[a]};
        impulse.add(x[a * k_ + j]);
        taken.p[a] = impulse.high;
        lost_p[a] = impulse.low;
      }
      velocity(problem_, high, v);
      velocity(problem_, low, rest);
      for (std::size_t a = 0; a < size_; ++a) {
        const Real d = length * v[a];
        detail::CompensatedSum<Real> sum{taken.q[a], lost_q[a]};
        sum.add(d);
        taken.q[a] = sum.high;
        lost_q[a] = sum.low + (product_error(length, v[a], d) + length * rest[a]);
      }
    }
    for (std::size_t a = 0; a < size_; ++a) {
      taken.q[a] += lost_q[a];
      taken.p[a] += lost_p[a];
    }
    return taken;
  }

  /// The energy gain of the step according to a rule with more points, sum_j u^q_j.(u^p_j - h sum_l W'_jl F(q'_l))/h.
  /// With the points in use it is 0. Its rounding comes from sums of s terms and from coordinates rounded to epsilon,
  /// which change the work by V'' d, the difference of forces along the step.
  detail::Gain<Real> gain(const Variables& x, const AverageTable<Real>& finer) const {
    const Variables u = displacements(x);
    V first_force = zeros_like(q0_);
    V last_force = first_force;
    V last_point = first_force;
    V work = first_force;
    Variables sum(x.size());
    at_points(finer, u, With::forces, [&](std::size_t first, std::size_t count, const Block& block) {
      if (first == 0) detail::take_point(&block.f[0], 0, first_force);
      detail::take_point(&block.f[0], count - 1, last_force);
      detail::take_point(&block.q[0], count - 1, last_point);
      for (std::size_t j = 0; j < k_; ++j) {
        for (std::size_t l = 0; l < count; ++l) {
          const Real& weight = finer.weight[(first + l) * k_ + j];
          for (std::size_t a = 0; a < size_; ++a) {
            const Real impulse = weight * block.f[a * point_stride + l];
            sum[a * k_ + j] += impulse;
            work[a] += abs(impulse * u[a * k_ + j]);
          }
        }
      }
    });
    effort_.force += finer.points;
    detail::Gain<Real> seen;
    for (std::size_t i = 0; i < x.size(); ++i) seen.gain += u[i] * (x[i] / h_ - sum[i]);
    detail::RoundingOfWork<Real> rounding;
    for (std::size_t a = 0; a < size_; ++a) {
      seen.size += work[a];
      rounding.add(work[a], (last_force[a] - first_force[a]) * last_point[a]);
    }
    seen.noise = rounding.of_terms(finer.points + 4);
    return seen;
  }

  const Setup& setup_;
  const V& q0_;
  const V& p0_;
  Effort& effort_;
  const std::size_t size_;
};

}  // namespace hamflow
