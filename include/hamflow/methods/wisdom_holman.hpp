// The Wisdom-Holman map in Jacobi coordinates, H = A + B. A has the Kepler motion of each body about the centre of mass
// of the bodies before it. B is the interaction, which is smaller by the ratio of planet to star masses.
// [WisdomHolman1991]
//
// With the position r'_i of body i relative to the centre of mass of the bodies before it, and M_i = m_0 + ... + m_i,
//     A = P^2/(2 M) + sum_i (p'_i^2/(2 m'_i) - G m_i M_(i-1)/r'_i),   m'_i = m_i M_(i-1)/M_i,
//     B = sum_(i >= 1) G m_i M_(i-1)/r'_i - sum_(i < j) G m_i m_j/r_ij.
// In A body i moves on a conic with mu = G M_i. In B the terms of the first two bodies cancel exactly. Massless bodies
// are relative to the centre of mass of all others, and exert no force.
//
// A step of dt is A(dt/2) B(dt) A(dt/2). With the lazy kernel the forces of B are evaluated at r + (dt^2/12) a, where a
// is the acceleration of B. Together with a corrector this removes the error quadratic in the masses of the planets, at
// the lowest order in dt.   [WisdomEtAl1996; ReinEtAl2019] The corrector is a change of variables that removes the
// error linear in these masses.   [Wisdom2006]
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "hamflow/core/outcome.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/detail/methods/close_encounter.hpp"
#include "hamflow/orbits/kepler_drift.hpp"

namespace hamflow {

enum class WisdomHolmanKernel { standard, lazy };

/// b_1 ... b_m of a corrector with m pairs of stages: the solution of
///     4 sum_k b_k (k sqrt(7/40))^n/n! = (1 - 2^-n) B_(n+1)/(n+1)!, n = 1, 3, ..., 2 m - 1, B the Bernoulli numbers.
/// @param stages from 1 to 8
template <class R>
std::vector<R> corrector_weights(std::size_t stages) {
  // For w_k = k b_k the matrix is a Vandermonde matrix of the squares k^2, which is solved without loss of digits.
  // [BjorckPereyra1970]
  constexpr int numerator[8] = {1, -1, 1, -1, 5, -691, 7, -3617};  // B_2, B_4, ...
  constexpr int denominator[8] = {6, 30, 42, 30, 66, 2730, 6, 510};
  const R unit = sqrt(R(7) / R(40));
  std::vector<R> w;
  R power = R(4) * unit;  // 4 unit^n
  R half(0.5);            // 2^-n
  for (std::size_t j = 0; j < stages; ++j) {
    const R order(static_cast<int>(2 * j + 2));
    w.push_back((R(1) - half) * R(numerator[j]) / (R(denominator[j]) * order * power));
    power = power * R(7) / R(40);
    half = half / R(4);
  }
  const auto node = [](std::size_t k) { return R(static_cast<int>((k + 1) * (k + 1))); };
  for (std::size_t k = 0; k + 1 < stages; ++k) {
    for (std::size_t i = stages - 1; i > k; --i) w[i] -= node(k) * w[i - 1];
  }
  for (std::size_t k = stages - 1; k-- > 0;) {
    for (std::size_t i = k + 1; i < stages; ++i) w[i] = w[i] / (node(i) - node(i - k - 1));
    for (std::size_t i = k; i + 1 < stages; ++i) w[i] -= w[i + 1];
  }
  for (std::size_t k = 0; k < stages; ++k) w[k] = w[k] / R(static_cast<int>(k + 1));
  return w;
}

/// Positions and velocities in Jacobi coordinates, and what has been added to them since they were made. The first
/// entry is the centre of mass.
template <class R>
struct JacobiState {
  using Space = Vector<R, 3>;
  PooledList<Space> r;
  PooledList<Space> v;
  PooledList<Space> added_r;
  PooledList<Space> added_v;
};

/// Bodies of given masses in Jacobi coordinates, and the two parts of their motion.
template <class R>
class JacobiSplitting {
 public:
  using Space = Vector<R, 3>;
  using Spaces = PooledList<Space>;

  /// @param masses the heaviest first; 0: a massless body
  /// @param softening_squared B has what softening changes: the splitting is then right, but the error of a step is no
  /// longer proportional to the masses of the planets
  JacobiSplitting(const std::vector<R>& masses, const R& gravitational_constant, const R& softening_squared = R(0))
      : constant_(gravitational_constant),
        softening_squared_(softening_squared),
        is_softened_(R(0) < softening_squared),
        total_(R(0)),
        masses_(masses.begin(), masses.end()),
        encounters_(masses_) {
    share_.resize(masses_.size());
    attraction_.resize(masses_.size());
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      if (!(R(0) < masses_[i])) continue;
      massive_.push_back(i);
      total_ += masses_[i];
      share_[i] = masses_[i] / total_;
      attraction_[i] = constant_ * total_;
    }
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      if (R(0) < masses_[i]) continue;
      massless_.push_back(i);
      attraction_[i] = constant_ * total_;
    }
  }

  /// Returns Jacobi coordinates of positions or, because the map is linear, of velocities or accelerations. They are in
  /// the order of the bodies; the first massive body is replaced by the centre of mass.
  Spaces jacobi_of(const Spaces& inertial) const {
    Spaces out;
    jacobi_of(inertial, out);
    return out;
  }
  void jacobi_of(const Spaces& inertial, Spaces& out) const {
    out.resize(inertial.size());
    Space centre = inertial[massive_[0]];
    for (std::size_t j = 1; j < massive_.size(); ++j) {
      const std::size_t i = massive_[j];
      for (std::size_t k = 0; k < 3; ++k) {
        out[i][k] = inertial[i][k] - centre[k];
        centre[k] += share_[i] * out[i][k];
      }
    }
    for (const std::size_t i : massless_) {
      for (std::size_t k = 0; k < 3; ++k) out[i][k] = inertial[i][k] - centre[k];
    }
    out[massive_[0]] = centre;
  }
  Spaces inertial_of(const Spaces& jacobi) const {
    Spaces out;
    inertial_of(jacobi, out);
    return out;
  }
  void inertial_of(const Spaces& jacobi, Spaces& out) const {
    out.resize(jacobi.size());
    Space centre = jacobi[massive_[0]];
    for (const std::size_t i : massless_) {
      for (std::size_t k = 0; k < 3; ++k) out[i][k] = jacobi[i][k] + centre[k];
    }
    for (std::size_t j = massive_.size(); j-- > 1;) {
      const std::size_t i = massive_[j];
      for (std::size_t k = 0; k < 3; ++k) {
        centre[k] -= share_[i] * jacobi[i][k];
        out[i][k] = centre[k] + jacobi[i][k];
      }
    }
    out[massive_[0]] = centre;
  }

  JacobiState<R> state_of(const Spaces& positions, const Spaces& velocities) const {
    JacobiState<R> state;
    state_of(positions, velocities, state);
    return state;
  }
  void state_of(const Spaces& positions, const Spaces& velocities, JacobiState<R>& state) const {
    jacobi_of(positions, state.r);
    jacobi_of(velocities, state.v);
    state.added_r.assign(positions.size(), {});
    state.added_v.assign(positions.size(), {});
  }

  /// Begins to watch for close encounters at the kicks of steps, or ends it.
  void watch_encounters(bool watches) { encounters_.watch(watches); }
  /// The first encounter since then; nullopt if there was none.
  const std::optional<EncounterOfTwo>& first_encounter() const { return encounters_.first(); }

  /// Applies A over a time h. The state is only partly changed if the outcome is not `done`.
  Outcome drift(JacobiState<R>& state, const R& h) const {
    const std::size_t first = massive_[0];
    for (std::size_t k = 0; k < 3; ++k) add(state.r[first][k], state.added_r[first][k], h * state.v[first][k]);
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      if (i == first) continue;
      KeplerIncrements<R, 3> by;
      const Outcome outcome = kepler_drift(state.r[i], state.v[i], attraction_[i], h, by);
      if (outcome != Outcome::done) return outcome;
      for (std::size_t k = 0; k < 3; ++k) {
        add(state.r[i][k], state.added_r[i][k], by.position[k]);
        add(state.r[i][k], state.added_r[i][k], by.position_rest[k]);
        add(state.v[i][k], state.added_v[i][k], by.velocity[k]);
        add(state.v[i][k], state.added_v[i][k], by.velocity_rest[k]);
      }
    }
    return Outcome::done;
  }

  /// B over a time h.
  void kick(JacobiState<R>& state, const R& h) {
    interaction(state.r, true);
    push(state, h);
  }

  /// B over a time h, with the forces at r + (h^2/12) a.
  void lazy_kick(JacobiState<R>& state, const R& h) {
    interaction(state.r, true);
    moved_ = state.r;
    const R factor = h * h / R(12);
    for (std::size_t i = 0; i < moved_.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) moved_[i][k] += factor * acceleration_[i][k];
    }
    interaction(moved_, false);
    push(state, h);
  }

  Outcome step(JacobiState<R>& state, const R& h, WisdomHolmanKernel kernel) {
    const R half = h / R(2);
    Outcome outcome = drift(state, half);
    if (outcome != Outcome::done) return outcome;
    if (kernel == WisdomHolmanKernel::lazy) {
      lazy_kick(state, h);
    } else {
      kick(state, h);
    }
    return drift(state, half);
  }

  /// C = Z(-m) ... Z(-1) Z(1) ... Z(m) from left to right, Z(k) = A(k s) B(-b_k dt) A(-2 k s) B(b_k dt) A(k s), s =
  /// sqrt(7/40) dt, b_-k = -b_k: to the variables in which the map runs. Undone with the weights negated.
  template <class List>
  Outcome correct(JacobiState<R>& state, const R& dt, const List& weights) {
    const int stages = static_cast<int>(weights.size());
    const R unit = sqrt(R(7) / R(40)) * dt;
    const auto corrector_kick = [&](const R& h) {
      interaction(state.r, false);
      push(state, h);
    };
    R before(0);  // the last drift of Z(k - 1), which is joined with the first one of Z(k)
    for (int k = -stages; k <= stages; ++k) {
      if (k == 0) continue;
      const R move = R(k) * unit;
      const R push_by = (k < 0 ? R(-1) : R(1)) * weights[static_cast<std::size_t>(k < 0 ? -k : k) - 1] * dt;
      if (k != 1) {  // the drifts between Z(-1) and Z(1) cancel
        const Outcome outcome = drift(state, before + move);
        if (outcome != Outcome::done) return outcome;
      }
      corrector_kick(-push_by);
      const Outcome outcome = drift(state, R(-2) * move);
      if (outcome != Outcome::done) return outcome;
      corrector_kick(push_by);
      before = move;
    }
    return stages > 0 ? drift(state, before) : Outcome::done;
  }

 private:
  static void add(R& value, R& added, const R& increment) {
    value += increment;
    added += increment;
  }

  void push(JacobiState<R>& state, const R& h) const {
    for (std::size_t i = 0; i < acceleration_.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) add(state.v[i][k], state.added_v[i][k], h * acceleration_[i][k]);
    }
  }

  /// The acceleration of B, in Jacobi coordinates, becomes acceleration_.
  /// @param in_step whether a step needs it; encounters within a corrector do not count
  void interaction(const Spaces& jacobi, bool in_step) {
    const std::size_t first = massive_[0];
    relative_ = jacobi;
    relative_[first] = {};  // the centre of mass, far from which differences would lose digits
    Spaces& r = inertial_;
    inertial_of(relative_, r);
    pulls_.assign(r.size(), {});
    const bool watches = in_step && encounters_.begin(jacobi);
    const auto attract = [&](std::size_t i, std::size_t j) {
      Space d;
      R square = softening_squared_;
      for (std::size_t k = 0; k < 3; ++k) {
        d[k] = r[j][k] - r[i][k];
        square += d[k] * d[k];
      }
      if (watches && i != first) encounters_.look(i, j, square);
      const R factor = constant_ / (square * sqrt(square));
      for (std::size_t k = 0; k < 3; ++k) {
        pulls_[i][k] += factor * masses_[j] * d[k];
        pulls_[j][k] -= factor * masses_[i] * d[k];
      }
    };
    for (std::size_t a = 0; a < massive_.size(); ++a) {
      for (std::size_t b = a + 1; b < massive_.size(); ++b) {
        if (is_softened_ || a != 0 || b != 1) attract(massive_[a], massive_[b]);
      }
      for (const std::size_t i : massless_) attract(massive_[a], i);
    }
    jacobi_of(pulls_, acceleration_);
    acceleration_[first] = {};
    for (std::size_t i = 0; i < jacobi.size(); ++i) {
      if (i == first || (!is_softened_ && massive_.size() > 1 && i == massive_[1])) continue;
      R square(0);
      for (std::size_t k = 0; k < 3; ++k) square += jacobi[i][k] * jacobi[i][k];
      const R factor = attraction_[i] / (square * sqrt(square));
      for (std::size_t k = 0; k < 3; ++k) acceleration_[i][k] += factor * jacobi[i][k];
    }
  }

  R constant_;
  R softening_squared_;
  bool is_softened_;
  R total_;
  PooledList<R> masses_;
  PooledList<R> share_;       // m_i/M_i
  PooledList<R> attraction_;  // of each body about the centre of mass of those before it, G M_i
  PooledList<std::size_t> massive_;
  PooledList<std::size_t> massless_;
  // Memory of `interaction`, kept from step to step.
  Spaces acceleration_;
  Spaces relative_;
  Spaces inertial_;
  Spaces pulls_;
  Spaces moved_;
  EncounterWatch<R> encounters_;
};

}  // namespace hamflow
