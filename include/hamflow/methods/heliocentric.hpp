// The Wisdom-Holman map in democratic heliocentric coordinates: positions from the first body, barycentric momenta.
// [DuncanEtAl1998] With Q_i = r_i - r_0, i >= 1, and barycentric velocities v_i,
//     A = P^2/(2 M) + sum_i (p_i^2/(2 m_i) - G m_0 m_i/Q_i),   J = |sum_i p_i|^2/(2 m_0),
//     B = -sum_(1 <= i < j) G m_i m_j/Q_ij.
// A step of dt is A(dt/2) J(dt/2) B(dt) J(dt/2) A(dt/2). J moves every Q_i by the velocity of the first body; B and J
// commute. No body has a place in an order, so that the orbits of planets may cross.
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

/// Entry 0 is the centre of mass; the others are bodies, r from the first body and v from the centre of mass.
template <class R>
struct HeliocentricState {
  using Space = Vector<R, 3>;
  PooledList<Space> r;
  PooledList<Space> v;
  PooledList<Space> added_r;
  PooledList<Space> added_v;
};

template <class R>
class HeliocentricSplitting {
 public:
  using Space = Vector<R, 3>;
  using Spaces = PooledList<Space>;

  /// @param masses the heaviest first; 0: a massless body   @param softening_squared as in JacobiSplitting
  HeliocentricSplitting(const std::vector<R>& masses, const R& gravitational_constant,
                        const R& softening_squared = R(0))
      : constant_(gravitational_constant),
        softening_squared_(softening_squared),
        is_softened_(R(0) < softening_squared),
        total_(R(0)),
        masses_(masses.begin(), masses.end()),
        encounters_(masses_) {
    for (const R& mass : masses_) total_ += mass;
  }

  HeliocentricState<R> state_of(const Spaces& positions, const Spaces& velocities) const {
    HeliocentricState<R> state;
    state_of(positions, velocities, state);
    return state;
  }
  void state_of(const Spaces& positions, const Spaces& velocities, HeliocentricState<R>& state) const {
    state.r.resize(positions.size());
    state.v.resize(positions.size());
    state.added_r.assign(positions.size(), {});
    state.added_v.assign(positions.size(), {});
    for (std::size_t k = 0; k < 3; ++k) {
      R moment(0);
      R momentum(0);
      for (std::size_t i = 0; i < masses_.size(); ++i) {
        moment += masses_[i] * positions[i][k];
        momentum += masses_[i] * velocities[i][k];
      }
      for (std::size_t i = 1; i < masses_.size(); ++i) {
        state.r[i][k] = positions[i][k] - positions[0][k];
        state.v[i][k] = velocities[i][k] - momentum / total_;
      }
      state.r[0][k] = moment / total_;
      state.v[0][k] = momentum / total_;
    }
  }

  /// What has been added becomes r and v, for positions and velocities of bodies.
  void inertial_increments(const HeliocentricState<R>& state, Spaces& r, Spaces& v) const {
    r = state.added_r;
    v = state.added_v;
    for (std::size_t k = 0; k < 3; ++k) {
      R moment(0);
      R momentum(0);
      for (std::size_t i = 1; i < masses_.size(); ++i) {
        moment += masses_[i] * state.added_r[i][k];
        momentum += masses_[i] * state.added_v[i][k];
      }
      r[0][k] = state.added_r[0][k] - moment / total_;
      v[0][k] = -(momentum / masses_[0]);
      for (std::size_t i = 1; i < masses_.size(); ++i) r[i][k] += r[0][k];
    }
  }

  /// Begins to watch for close encounters at the kicks of steps, or ends it.
  void watch_encounters(bool watches) { encounters_.watch(watches); }
  /// The first encounter since then; nullopt if there was none.
  const std::optional<EncounterOfTwo>& first_encounter() const { return encounters_.first(); }

  Outcome step(HeliocentricState<R>& state, const R& h) {
    const R half = h / R(2);
    const Outcome outcome = drift(state, half);
    if (outcome != Outcome::done) return outcome;
    jump(state, half);
    kick(state, h);
    jump(state, half);
    return drift(state, half);
  }

 private:
  static void add(R& value, R& added, const R& increment) {
    value += increment;
    added += increment;
  }

  Outcome drift(HeliocentricState<R>& state, const R& h) const {
    for (std::size_t k = 0; k < 3; ++k) add(state.r[0][k], state.added_r[0][k], h * state.v[0][k]);
    const R attraction = constant_ * masses_[0];
    for (std::size_t i = 1; i < masses_.size(); ++i) {
      KeplerIncrements<R, 3> by;
      const Outcome outcome = kepler_drift(state.r[i], state.v[i], attraction, h, by);
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

  void jump(HeliocentricState<R>& state, const R& h) const {
    for (std::size_t k = 0; k < 3; ++k) {
      R momentum(0);
      for (std::size_t i = 1; i < masses_.size(); ++i) momentum += masses_[i] * state.v[i][k];
      const R by = h * (momentum / masses_[0]);
      for (std::size_t i = 1; i < masses_.size(); ++i) add(state.r[i][k], state.added_r[i][k], by);
    }
  }

  void kick(HeliocentricState<R>& state, const R& h) {
    pulls_.assign(masses_.size(), {});
    const bool watches = encounters_.begin(state.r);
    for (std::size_t i = 1; i < masses_.size(); ++i) {
      for (std::size_t j = i + 1; j < masses_.size(); ++j) {
        if (!(R(0) < masses_[i] + masses_[j])) continue;
        Space d;
        R square = softening_squared_;
        for (std::size_t k = 0; k < 3; ++k) {
          d[k] = state.r[j][k] - state.r[i][k];
          square += d[k] * d[k];
        }
        if (watches) encounters_.look(i, j, square);
        const R factor = constant_ / (square * sqrt(square));
        for (std::size_t k = 0; k < 3; ++k) {
          pulls_[i][k] += factor * masses_[j] * d[k];
          pulls_[j][k] -= factor * masses_[i] * d[k];
        }
      }
      if (is_softened_) add_softening(state.r[i], pulls_[i]);
    }
    for (std::size_t i = 1; i < masses_.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) add(state.v[i][k], state.added_v[i][k], h * pulls_[i][k]);
    }
  }

  /// What softening changes of the attraction by the first body.
  void add_softening(const Space& r, Space& pull) const {
    R square(0);
    for (std::size_t k = 0; k < 3; ++k) square += r[k] * r[k];
    const R softened = square + softening_squared_;
    const R factor = constant_ * masses_[0] * (R(1) / (square * sqrt(square)) - R(1) / (softened * sqrt(softened)));
    for (std::size_t k = 0; k < 3; ++k) pull[k] += factor * r[k];
  }

  R constant_;
  R softening_squared_;
  bool is_softened_;
  R total_;
  PooledList<R> masses_;
  Spaces pulls_;
  EncounterWatch<R> encounters_;
};

}  // namespace hamflow
