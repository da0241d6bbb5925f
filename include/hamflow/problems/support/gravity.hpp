// N bodies under gravity, H = sum |p_i|^2/(2 m_i) - G sum_{i<j} m_i m_j/sqrt(r_ij^2 + softening^2), in the plane or in
// space. q = [x1, y1(, z1), x2, ...], particle by particle.   [HLW2006, (I.2.11)]
// The force of a pair is computed once and given to both with opposite signs, so that the total momentum is kept to the
// last rounding of the sums.
#pragma once

#include <array>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/core/radial_forces.hpp"

namespace hamflow {

template <class R>
class Gravity {
 public:
  using Real = R;
  static constexpr std::size_t dimension = dynamic;
  static constexpr bool quadratic_kinetic = true;

  /// @param space 2 or 3
  Gravity(const std::vector<R>& masses, R gravitational_constant, R softening, std::size_t space)
      : masses_(masses.size()),
        inverse_masses_(masses.size()),
        space_(space),
        constant_(gravitational_constant),
        softening_squared_(softening * softening) {
    for (std::size_t i = 0; i < masses.size(); ++i) {
      masses_[i] = masses[i];
      inverse_masses_[i] = R(1) / masses[i];
      total_mass_ += masses[i];
    }
  }
  static std::vector<InvariantInfo> gravity_invariants() {
    return {{"angular_momentum", "sum x_i x p_i", Components::rotations, Terms::moments},
            {"linear_momentum", "P = sum p_i", Components::space, Terms::momenta},
            {"centre_of_mass", "sum m_i x_i/M - P t/M", Components::space, Terms::centre_of_mass}};
  }
  /// @param usual the frame of a start that the scenario does not give itself
  static OptionInfo frame_key(const char* usual) {
    return {.name = "frame",
            .default_value = usual,
            .meaning = "barycentric: the centre of mass of the start is moved to the origin, to rest",
            .type = OptionType::word,
            .words = {StartFrames::given, StartFrames::barycentric},
            .condition = "of a start by initial: given"};
  }
  std::size_t size() const { return masses_.size() * space_; }
  std::size_t space() const { return space_; }

  template <class S>
  S kinetic(const Vector<S, dynamic>& p) const {
    S sum(0);
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      S square(0);
      for (std::size_t k = 0; k < space_; ++k) square += p[i * space_ + k] * p[i * space_ + k];
      sum += square * (inverse_masses_[i] / R(2));
    }
    return sum;
  }
  template <class S>
  S potential(const Vector<S, dynamic>& q) const {
    S sum(0);
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      for (std::size_t j = i + 1; j < masses_.size(); ++j) {
        S u(softening_squared_);
        for (std::size_t k = 0; k < space_; ++k) {
          const S d = q[i * space_ + k] - q[j * space_ + k];
          u += d * d;
        }
        sum -= (constant_ * masses_[i] * masses_[j]) / sqrt(u);
      }
    }
    return sum;
  }
  template <class S>
  void velocity(const Vector<S, dynamic>& p, Vector<S, dynamic>& v) const {
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      for (std::size_t k = 0; k < space_; ++k) v[i * space_ + k] = p[i * space_ + k] * inverse_masses_[i];
    }
  }
  template <class S>
  void force(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    if (space_ == 2) {
      pair_forces<2>(q, f);
    } else {
      pair_forces<3>(q, f);
    }
  }
  /// The kick, pair by pair: row i holds the pairs i, j > i. Every operation is symmetric in i and j or changes its
  /// sign, so that numbering the bodies otherwise changes no bit of a contribution.
  template <class F, class Difference, class Sink>
  void pair_kicks(const F& factor, const Difference& difference, std::size_t first, std::size_t last,
                  Sink& sink) const {
    if (space_ == 2) {
      pair_kicks_in<2>(factor, difference, first, last, sink);
    } else {
      pair_kicks_in<3>(factor, difference, first, last, sink);
    }
  }
  /// The same of -third V''(q) v besides.
  template <class F, class Difference, class Sink>
  void pair_gradient_kicks(const F& factor, const F& third, const Vector<F, dynamic>& v, const Difference& difference,
                           std::size_t first, std::size_t last, Sink& sink) const {
    const F strength = constant_;
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = i + 1; j < masses_.size(); ++j) {
        F d[3]{};
        F w[3]{};  // v_i - v_j
        F u(softening_squared_);
        F dw(0);
        for (std::size_t k = 0; k < space_; ++k) {
          d[k] = difference(i * space_ + k, j * space_ + k);
          w[k] = v[i * space_ + k] - v[j * space_ + k];
          u += d[k] * d[k];
          dw += d[k] * w[k];
        }
        const F c = (strength * (masses_[i] * masses_[j])) / (u * sqrt(u));
        for (std::size_t k = 0; k < space_; ++k) {
          sink(j * space_ + k, i * space_ + k, factor * (c * d[k]) + third * (c * (w[k] - F(3) * d[k] * dw / u)));
        }
      }
    }
  }
  std::size_t pair_rows() const { return masses_.size(); }
  std::size_t pairs_in_row(std::size_t i) const { return masses_.size() - 1 - i; }

  /// The pair i, j adds c (I - 3 d d^T/u) with d = x_i - x_j, u = d^2 + softening^2, c = G m_i m_j u^(-3/2) to the
  /// blocks ii and jj and subtracts it from ij and ji.
  template <class S>
  void force_and_hessian(const Vector<S, dynamic>& q, Vector<S, dynamic>& f, Matrix<S, dynamic>& hessian) const {
    force(q, f);
    for (std::size_t i = 0; i < size(); ++i) {
      for (std::size_t j = 0; j < size(); ++j) hessian[i][j] = S(0);
    }
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      for (std::size_t j = i + 1; j < masses_.size(); ++j) add_pair(q, i, j, hessian);
    }
  }

  // As RadialForces.
  std::size_t radial_space() const { return space_; }
  std::vector<RadialTerm<R>> radial_terms() const {
    std::vector<RadialTerm<R>> terms;
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      for (std::size_t j = i + 1; j < masses_.size(); ++j) {
        terms.push_back({i * space_, j * space_, constant_ * masses_[i] * masses_[j]});
      }
    }
    return terms;
  }
  template <class S>
  RadialLaw<S> radial_law(const S& u) const {
    const S inverse = R(1) / (u + softening_squared_);
    const S root = sqrt(inverse);
    const S first = inverse * root / R(2);
    return {-root, first, R(-1.5) * first * inverse};
  }

  /// Of d = (sum_{i<j} u_ij^-3)^(-1/6), u = r^2 + softening^2: the distance of the nearest two bodies, as they would be
  /// alone, and smooth where another pair becomes the nearest one. Their least distance is at most (N (N - 1)/2)^(1/6)
  /// d.
  template <class S>
  S distance_rate(const Vector<S, dynamic>& q, const Vector<S, dynamic>& v) const {
    S approach(0);
    S closeness(0);
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      for (std::size_t j = i + 1; j < masses_.size(); ++j) {
        S u(softening_squared_);
        S half_rate(0);  // of u
        for (std::size_t k = 0; k < space_; ++k) {
          const S d = q[i * space_ + k] - q[j * space_ + k];
          u += d * d;
          half_rate += d * (v[i * space_ + k] - v[j * space_ + k]);
        }
        const S inverse = R(1) / u;
        const S weight = inverse * inverse * inverse;
        closeness += weight;
        approach += weight * inverse * half_rate;
      }
    }
    return masses_.size() > 1 ? S(approach / closeness) : S(0);
  }

  const R& total_mass() const { return total_mass_; }
  /// q_i <- q_i - sum m q/M, p_i <- p_i - m_i P/M. Done twice: what rounding leaves of the first is taken by the
  /// second.
  void to_barycentre(Vector<R, dynamic>& q, Vector<R, dynamic>& p) const {
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t k = 0; k < space_; ++k) {
        R moment(0);
        R momentum(0);
        for (std::size_t i = 0; i < masses_.size(); ++i) {
          moment += masses_[i] * q[i * space_ + k];
          momentum += p[i * space_ + k];
        }
        for (std::size_t i = 0; i < masses_.size(); ++i) {
          q[i * space_ + k] -= moment / total_mass_;
          p[i * space_ + k] -= masses_[i] * (momentum / total_mass_);
        }
      }
    }
  }
  std::array<std::size_t, 3> invariant_sizes() const { return {space_ == 2 ? 1u : 3u, space_, space_}; }
  template <class S>
  Vector<S, dynamic> invariants(const Vector<S, dynamic>& q, const Vector<S, dynamic>& p, const S& t) const {
    const std::size_t rotations = space_ == 2 ? 1 : 3;
    Vector<S, dynamic> all(rotations + 2 * space_);
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      const std::size_t at = i * space_;
      if (space_ == 2) {
        all[0] += q[at] * p[at + 1] - q[at + 1] * p[at];
      } else {
        for (std::size_t k = 0; k < 3; ++k) {
          const std::size_t a = at + (k + 1) % 3;
          const std::size_t b = at + (k + 2) % 3;
          all[k] += q[a] * p[b] - q[b] * p[a];
        }
      }
      for (std::size_t k = 0; k < space_; ++k) {
        all[rotations + k] += p[at + k];
        all[rotations + space_ + k] += q[at + k] * masses_[i];
      }
    }
    for (std::size_t k = 0; k < space_; ++k) {
      S& centre = all[rotations + space_ + k];
      centre = (centre - all[rotations + k] * t) / total_mass_;
    }
    return all;
  }

 private:
  template <std::size_t Space, class F, class Difference, class Sink>
  void pair_kicks_in(const F& factor, const Difference& difference, std::size_t first, std::size_t last,
                     Sink& sink) const {
    const F strength = factor * constant_;
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t j = i + 1; j < masses_.size(); ++j) {
        F d[Space];
        F u(softening_squared_);
        for (std::size_t k = 0; k < Space; ++k) {
          d[k] = difference(i * Space + k, j * Space + k);
          u += d[k] * d[k];
        }
        const F c = (strength * (masses_[i] * masses_[j])) / (u * sqrt(u));
        for (std::size_t k = 0; k < Space; ++k) sink(j * Space + k, i * Space + k, c * d[k]);
      }
    }
  }
  template <std::size_t Space, class S>
  void pair_forces(const Vector<S, dynamic>& q, Vector<S, dynamic>& f) const {
    for (S& x : f) x = S(0);
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      const S* const a = q.begin() + i * Space;
      S* const on_a = f.begin() + i * Space;
      S total[Space]{};
      for (std::size_t j = i + 1; j < masses_.size(); ++j) {
        const S* const b = q.begin() + j * Space;
        S* const on_b = f.begin() + j * Space;
        S d[Space];
        S u(softening_squared_);
        for (std::size_t k = 0; k < Space; ++k) {
          d[k] = a[k] - b[k];
          u += d[k] * d[k];
        }
        const S c = (constant_ * masses_[i] * masses_[j]) / (u * sqrt(u));
        for (std::size_t k = 0; k < Space; ++k) {
          const S pull = c * d[k];
          total[k] += pull;
          on_b[k] += pull;
        }
      }
      for (std::size_t k = 0; k < Space; ++k) on_a[k] -= total[k];
    }
  }
  template <class S>
  void add_pair(const Vector<S, dynamic>& q, std::size_t i, std::size_t j, Matrix<S, dynamic>& hessian) const {
    S d[3]{};
    S u(softening_squared_);
    for (std::size_t k = 0; k < space_; ++k) {
      d[k] = q[i * space_ + k] - q[j * space_ + k];
      u += d[k] * d[k];
    }
    const S c = (constant_ * masses_[i] * masses_[j]) / (u * sqrt(u));
    for (std::size_t k = 0; k < space_; ++k) {
      for (std::size_t l = 0; l < space_; ++l) {
        const S h = (k == l ? c : S(0)) - R(3) * c * d[k] * d[l] / u;
        hessian[i * space_ + k][i * space_ + l] += h;
        hessian[j * space_ + k][j * space_ + l] += h;
        hessian[i * space_ + k][j * space_ + l] -= h;
        hessian[j * space_ + k][i * space_ + l] -= h;
      }
    }
  }

  Vector<R, dynamic> masses_;
  Vector<R, dynamic> inverse_masses_;
  std::size_t space_;
  R constant_;
  R softening_squared_;
  R total_mass_{};
};

}  // namespace hamflow
