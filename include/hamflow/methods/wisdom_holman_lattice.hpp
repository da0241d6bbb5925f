// wisdom-holman on the lattice, in democratic heliocentric coordinates.
//
// These need no change of variables. With V the velocity of the centre of mass, A moves body i by (p_i/m_i - V) and
// kicks it and the first body, J moves the first body by (p_0/m_0 - V), and B kicks pairs of the others.
// [DuncanEtAl1998] Increments of positions are functions of momenta and increments of momenta functions of positions,
// each rounded to an integer. A kick adds the same integer to one body as it subtracts from the other, so that the
// total momentum, and with it V, is constant to the last bit. All of this depends on differences of positions only. At
// the end of a step all bodies are shifted together, so that their centre of mass moves by V dt: by a function of
// differences before and after, which the way back subtracts again.
//
// The Kepler drift of a body in A is a sequence of shears (kepler_shears.hpp), in so many parts that its error is below
// the rounding of a double. Their number is chosen at the first step and stays: the way back takes the same parts.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/core/point_masses.hpp"
#include "hamflow/detail/methods/close_encounter.hpp"
#include "hamflow/detail/methods/kepler_shears.hpp"

namespace hamflow {

template <class P, Arithmetic A>
class WisdomHolmanOnLattice {
 public:
  static_assert(GravitatingBodies<P> && IntegerSums<A>, "hamflow: point masses on the lattice");
  static constexpr std::size_t n = P::dimension;
  static constexpr bool memory_depends_on_positions_only = true;
  using Real = typename A::Real;
  using Stored = typename A::Stored;
  using State = PhasePoint<A, n>;

  WisdomHolmanOnLattice(const P& problem, MethodInfo info)
      : WisdomHolmanOnLattice(problem.point_masses(), std::move(info)) {}

  MethodInfo info() const { return *info_; }
  Effort effort() const { return {.force = forces_}; }
  void invalidate() {}
  template <class Archive>
  void archive(Archive& ar) {
    ar(forces_, encounter_.step, encounter_.one, encounter_.other, parts_);
  }

  const FirstEncounter& first_encounter() const { return encounter_; }

  Outcome step(const P&, const Real& h, State& z) {
    if (parts_.size() == 0 && !choose_parts(z, h / 2)) return Outcome::not_converged;
    find_frame_velocity(z);
    const Place first = place_of_first(z);
    for (std::size_t i = 1; i < masses_.size(); ++i) drift(z, i, h / 2);
    move(z, 0, h);
    kick_by_planets(z, h);
    for (std::size_t i = 1; i < masses_.size(); ++i) drift(z, i, h / 2);
    move_centre(z, first, h);
    ++forces_;
    if (const auto& met = encounters_.first()) encounter_ = {forces_, met->first, met->second};
    return Outcome::done;
  }

  std::string failure(const P&, const Real&, const State&) const {
    return "the orbit of a body passes so near to the first one that a drift of half a step would need more than 4096 "
           "parts on the lattice";
  }

 private:
  static constexpr Real most_shift = 0x1p60;  // sums of a few shifts fit into 64 bits

  WisdomHolmanOnLattice(const PointMasses<Real>& bodies, MethodInfo info)
      : info_(std::make_shared<const MethodInfo>(std::move(info))),
        space_(bodies.space),
        constant_(bodies.gravitational_constant),
        masses_(bodies.masses.begin(), bodies.masses.end()),
        encounters_(masses_),
        drifts_(kepler_shears().drifts.begin(), kepler_shears().drifts.end()),
        kicks_(kepler_shears().kicks.begin(), kepler_shears().kicks.end()),
        positions_(masses_.size()) {
    if (Real(0) < bodies.softening_squared) throw Error("hamflow: wisdom-holman on the lattice has no softening");
    for (const Real mass : masses_) total_ += mass;
  }

  Real inertia(std::size_t i) const { return Real(0) < masses_[i] ? masses_[i] : Real(1); }
  std::size_t index(std::size_t body, std::size_t k) const { return body * space_ + k; }

  /// Whether there is a number of parts for each body.
  bool choose_parts(const State& z, Real t) {
    find_frame_velocity(z);
    Vector<std::int64_t, dynamic> found(masses_.size());
    for (std::size_t i = 1; i < masses_.size(); ++i) {
      double r[3] = {}, v[3] = {};
      for (std::size_t k = 0; k < space_; ++k) {
        r[k] = distance(z, i, 0, k);
        v[k] = z.arithmetic.momentum.read(z.p[index(i, k)]) / inertia(i) - frame_[k];
      }
      const std::optional<std::size_t> parts = kepler_shear_parts(constant_ * masses_[0], r, v, space_, std::fabs(t));
      if (!parts) return false;
      found[i] = static_cast<std::int64_t>(*parts);
    }
    parts_ = found;
    return true;
  }

  /// The velocity of the centre of mass, from the sum of the integers of all momenta, which no kick changes. Its halves
  /// are exact in double, and it is rounded once.
  void find_frame_velocity(const State& z) {
    constexpr Stored half = Stored{1} << 31;
    for (std::size_t k = 0; k < space_; ++k) {
      Stored high = 0;
      Stored low = 0;
      for (std::size_t i = 0; i < masses_.size(); ++i) {
        if (!(Real(0) < masses_[i])) continue;
        high += z.p[index(i, k)] / half;
        low += z.p[index(i, k)] % half;
      }
      const Real sum = static_cast<Real>(high) * static_cast<Real>(half) + static_cast<Real>(low);
      frame_[k] = sum * z.arithmetic.momentum.unit / total_;
    }
  }

  Real distance(const State& z, std::size_t i, std::size_t j, std::size_t k) const {
    return z.arithmetic.position.difference(z.q[index(i, k)], z.q[index(j, k)]);
  }

  /// Moves body i by its velocity in the frame of the centre of mass.
  void move(State& z, std::size_t i, Real by) const {
    for (std::size_t k = 0; k < space_; ++k) {
      const Real velocity = z.arithmetic.momentum.read(z.p[index(i, k)]) / inertia(i) - frame_[k];
      z.arithmetic.position.add(z.q[index(i, k)], by * velocity);
    }
  }
  /// Where the first body is, and where it is relative to the centre of mass: a rounded function of differences.
  struct Place {
    std::array<Stored, 3> position{};
    std::array<Stored, 3> from_centre{};
  };
  Place place_of_first(State& z) const {
    Place place;
    for (std::size_t k = 0; k < space_; ++k) {
      Real moment = 0;
      for (std::size_t i = 1; i < masses_.size(); ++i) moment += masses_[i] * distance(z, i, 0, k);
      place.position[k] = z.q[k];
      if (!z.arithmetic.position.units(-moment / total_, most_shift, place.from_centre[k]))
        z.arithmetic.position.lost = true;
    }
    return place;
  }
  /// Moves all bodies, so that their centre of mass has moved by V alone since the first body was at that place.
  void move_centre(State& z, const Place& before, Real by) const {
    const Place now = place_of_first(z);
    for (std::size_t k = 0; k < space_; ++k) {
      Stored with_frame = 0;
      if (!z.arithmetic.position.units(by * frame_[k], most_shift, with_frame)) z.arithmetic.position.lost = true;
      if (z.arithmetic.lost()) return;
      const Stored wanted = before.position[k] + with_frame + (now.from_centre[k] - before.from_centre[k]);
      const Stored shift = wanted - now.position[k];
      for (std::size_t i = 0; i < masses_.size(); ++i) z.arithmetic.position.add_units(z.q[index(i, k)], shift);
    }
  }

  void drift(State& z, std::size_t i, Real t) const {
    const Real part = t / static_cast<Real>(parts_[i]);
    const Real within = drifts_.front() + drifts_.back();  // the last drift of a part and the first of the next
    for (std::int64_t count = 0; count < parts_[i]; ++count) {
      for (std::size_t s = 0; s < kicks_.size(); ++s) {
        move(z, i, part * (s == 0 && count > 0 ? within : drifts_[s]));
        attract(z, 0, i, part * kicks_[s]);
      }
    }
    move(z, i, part * drifts_.back());
  }

  void kick_by_planets(State& z, Real h) {
    for (std::size_t i = 1; i < masses_.size(); ++i) {
      for (std::size_t k = 0; k < space_; ++k) positions_[i][k] = distance(z, i, 0, k);
    }
    encounters_.watch(encounter_.step == 0);
    const bool watches = encounters_.begin(positions_);
    for (std::size_t i = 1; i < masses_.size(); ++i) {
      for (std::size_t j = i + 1; j < masses_.size(); ++j) {
        if (!(Real(0) < masses_[i] + masses_[j])) continue;
        const Real square = attract(z, i, j, h);
        if (watches) encounters_.look(i, j, square);
      }
    }
  }

  /// The attraction of bodies i and j during `by`: the same integer is added to one and subtracted from the other, as
  /// far as the other has mass.
  /// @returns the square of their distance
  Real attract(State& z, std::size_t i, std::size_t j, Real by) const {
    Real d[3];
    Real square = 0;
    for (std::size_t k = 0; k < space_; ++k) {
      d[k] = distance(z, j, i, k);
      square += d[k] * d[k];
    }
    const bool both = Real(0) < masses_[i] && Real(0) < masses_[j];
    const Real strength = by * constant_ * (both ? masses_[i] * masses_[j] : masses_[i] + masses_[j]);
    const Real factor = strength / (square * std::sqrt(square));
    for (std::size_t k = 0; k < space_; ++k) {
      Stored units = 0;
      if (!z.arithmetic.momentum.units(factor * d[k], static_cast<Real>(A::range), units)) {
        z.arithmetic.momentum.lost = true;
        return square;
      }
      if (Real(0) < masses_[j]) z.arithmetic.momentum.add_units(z.p[index(i, k)], units);
      if (Real(0) < masses_[i]) z.arithmetic.momentum.add_units(z.p[index(j, k)], -units);
    }
    return square;
  }

  std::shared_ptr<const MethodInfo> info_;
  std::size_t space_ = 3;
  Real constant_{};
  Real total_{};
  PooledList<Real> masses_;
  EncounterWatch<Real> encounters_;
  PooledList<Real> drifts_;
  PooledList<Real> kicks_;
  Vector<std::int64_t, dynamic> parts_;  // of the drift of each body
  PooledList<Vector<Real, 3>> positions_;
  std::array<Real, 3> frame_{};
  long long forces_ = 0;
  FirstEncounter encounter_;  // seen in a kick
};

}  // namespace hamflow
