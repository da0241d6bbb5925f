// wisdom-holman and saba as methods of the catalogue: one step in Jacobi or in democratic heliocentric coordinates.
// A step computes what is to be added to q and p, which every arithmetic adds in its own way.
//
// With a corrector C a step is C^-1 M C, M the step without it. In a run C^-1 and C of successive steps cancel: a
// simulation takes steps of M from C z, and applies C^-1 to the states that it shows
// (src/engine/corrected_simulation.hpp).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "hamflow/core/method_info.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/capability.hpp"
#include "hamflow/methods/heliocentric.hpp"
#include "hamflow/methods/kepler_tables.hpp"
#include "hamflow/methods/wisdom_holman.hpp"
#include "hamflow/methods/wisdom_holman_lattice.hpp"
#include "hamflow/orbits/kepler_tangent.hpp"

namespace hamflow {

enum class WisdomHolmanCoordinates { jacobi, heliocentric };

struct WisdomHolmanOptions {
  WisdomHolmanCoordinates coordinates = WisdomHolmanCoordinates::jacobi;
  int corrector = 0;  // its order: a key of corrector_stages(), or 0
  WisdomHolmanKernel kernel = WisdomHolmanKernel::standard;
  std::size_t table = 0;  // of kepler_tables()
};

/// The number of pairs of stages of the corrector of each order.
inline const std::map<int, std::size_t>& corrector_stages() {
  static const std::map<int, std::size_t> all{{3, 1}, {5, 2}, {7, 3}, {11, 5}, {17, 8}};
  return all;
}

inline MethodInfo describe(const WisdomHolmanOptions& options) {
  const bool is_jacobi = options.coordinates == WisdomHolmanCoordinates::jacobi;
  const bool is_lazy = options.kernel == WisdomHolmanKernel::lazy;
  const bool is_corrected = options.corrector != 0;
  std::vector<std::string> given;
  if (!is_jacobi) given.emplace_back("coordinates=democratic-heliocentric");
  if (is_corrected) given.push_back("corrector=" + std::to_string(options.corrector));
  if (is_lazy) given.emplace_back("kernel=lazy");
  return {.name = "wisdom-holman" + (given.empty() ? std::string() : "(" + joined(given, ",") + ")"),
          .summary = std::string("Kepler drifts and kicks by the planets, in ") +
                     (is_jacobi ? "Jacobi coordinates" : "democratic heliocentric coordinates") +
                     (is_lazy ? ", lazy kernel" : "") +
                     (is_corrected ? ", corrector of order " + std::to_string(options.corrector) : ""),
          .reference = std::string(is_lazy     ? "WisdomEtAl1996; ReinEtAl2019"
                                   : is_jacobi ? "WisdomHolman1991"
                                               : "DuncanEtAl1998") +
                       (is_corrected ? "; Wisdom2006" : ""),
          .order = 2,
          // The lazy kick is even in dt and changes velocities by a function of positions, which is no gradient.
          .symplectic = !is_lazy,
          .weakly_reversible = true,
          // The stages of C(-dt) are those of C(dt) in the other order.
          .symmetric = !is_corrected,
          .reversible = !is_corrected,
          .forces_per_step = is_lazy ? 2 : 1};
}

/// saba(...): Jacobi coordinates and a table.
inline MethodInfo describe_saba(std::size_t table) {
  const KeplerTable& chosen = kepler_tables()[table];
  return {.name = "saba(" + std::string(chosen.name) + ")",
          .summary = std::to_string(chosen.kicks) + (chosen.kicks == 1 ? " kick" : " kicks") +
                     " by the planets between Kepler drifts, in Jacobi coordinates",
          .reference = chosen.reference,
          .order = chosen.order,
          .symplectic = true,
          .weakly_reversible = true,
          .symmetric = true,
          .reversible = true,
          .forces_per_step = static_cast<int>(chosen.kicks)};
}

template <class P, Arithmetic A>
class WisdomHolmanStep {
 public:
  static_assert(GravitatingBodies<P>, "hamflow: wisdom-holman needs bodies that attract each other as points");
  static_assert(!A::exact_undo, "hamflow: see WisdomHolmanOnLattice");
  static constexpr std::size_t n = P::dimension;
  static constexpr bool memory_depends_on_positions_only = true;
  using Real = typename A::Real;
  using Base = base_scalar<Real>;
  using State = PhasePoint<A, n>;

  WisdomHolmanStep(const P& problem, const WisdomHolmanOptions& options, MethodInfo info)
      : options_(options),
        info_(std::make_shared<const MethodInfo>(std::move(info))),
        splitting_(splitting_of(problem, options)) {
    const KeplerTable& table = kepler_tables()[options.table];
    for (std::size_t k = 0; k <= table.kicks; ++k) {
      drifts_by_.push_back(evaluate_number<Base>(table.drifts_by[table.drift_index(k)]));
      if (k < table.kicks) kicks_by_.push_back(evaluate_number<Base>(table.kicks_by[table.kick_index(k)]));
    }
    if (options.corrector != 0) {
      for (const Base& weight : corrector_weights<Base>(corrector_stages().at(options.corrector))) {
        weights_.push_back(Real(weight));
        negative_weights_.push_back(Real(Base(-weight)));
      }
    }
    const PointMasses<Base> bodies = problem.point_masses();
    space_ = bodies.space;
    for (const auto& mass : bodies.masses) inertia_.push_back(Base(0) < mass ? mass : Base(1));
    r_.resize(inertia_.size());
    v_.resize(inertia_.size());
  }

  MethodInfo info() const { return *info_; }
  Effort effort() const { return {.force = forces_}; }
  void invalidate() {}
  template <class Archive>
  void archive(Archive& ar) {
    ar(forces_, encounter_.step, encounter_.one, encounter_.other);
  }

  /// From now on a step is M.
  void step_without_corrector() { corrects_ = false; }
  bool has_corrector() const { return !weights_.empty(); }
  /// z <- C z for steps of length h.
  Outcome correct(const Base& h, State& z) {
    return change(z, [&](Jacobi& s, auto& state) { return s.correct(state, Real(h), weights_); });
  }
  /// z <- C^-1 z.
  Outcome undo_corrector(const Base& h, State& z) {
    return change(z, [&](Jacobi& s, auto& state) { return s.correct(state, Real(h), negative_weights_); });
  }

  const FirstEncounter& first_encounter() const { return encounter_; }

  Outcome step(const P&, const Base& h, State& z) {
    std::visit([&](auto& splitting) { splitting.watch_encounters(encounter_.step == 0); }, splitting_);
    const bool corrects = corrects_ && has_corrector();
    const Outcome outcome = change(z, [&]<class S>(S& splitting, auto& state) {
      if constexpr (std::is_same_v<S, Jacobi>) {
        Outcome part = corrects ? splitting.correct(state, Real(h), weights_) : Outcome::done;
        if (part == Outcome::done) part = compose(splitting, h, state);
        return part == Outcome::done && corrects ? splitting.correct(state, Real(h), negative_weights_) : part;
      } else {
        return splitting.step(state, Real(h));
      }
    });
    if (outcome != Outcome::done) return outcome;
    forces_ += info_->forces_per_step;
    const auto met = std::visit([](const auto& splitting) { return splitting.first_encounter(); }, splitting_);
    if (met) {
      // In a recording the comparisons of distances are guards that hold as long as there is no encounter.
      if constexpr (detail::is_recording<Real>) return Outcome::not_converged;
      encounter_ = {forces_ / info_->forces_per_step, met->first, met->second};
    }
    return Outcome::done;
  }

  std::string failure(const P&, const Base&, const State&) const {
    return "a Kepler drift has no solution: a body meets the centre of its orbit, or left the range of numbers";
  }

 private:
  using Jacobi = JacobiSplitting<Real>;
  using Heliocentric = HeliocentricSplitting<Real>;
  using Splitting = std::variant<Jacobi, Heliocentric>;
  using Spaces = PooledList<Vector<Real, 3>>;

  /// z <- z + what `action` adds to it in the coordinates of the splitting.
  template <class Action>
  Outcome change(State& z, const Action& action) {
    const Vector<Real, n> q = z.positions();
    const Vector<Real, n> p = z.momenta();
    for (std::size_t i = 0; i < inertia_.size(); ++i) {
      for (std::size_t k = 0; k < space_; ++k) {
        r_[i][k] = q[i * space_ + k];
        v_[i][k] = p[i * space_ + k] / inertia_[i];
      }
    }
    Outcome outcome;
    if (auto* const jacobi = std::get_if<Jacobi>(&splitting_)) {
      jacobi->state_of(r_, v_, jacobi_state_);
      outcome = action(*jacobi, jacobi_state_);
      if (outcome != Outcome::done) return outcome;
      jacobi->inertial_of(jacobi_state_.added_r, r_);
      jacobi->inertial_of(jacobi_state_.added_v, v_);
    } else {
      auto& splitting = std::get<Heliocentric>(splitting_);
      splitting.state_of(r_, v_, heliocentric_state_);
      if constexpr (std::is_invocable_v<const Action&, Heliocentric&, HeliocentricState<Real>&>) {
        outcome = action(splitting, heliocentric_state_);
      } else {
        throw std::logic_error("hamflow: a corrector needs Jacobi coordinates");
      }
      if (outcome != Outcome::done) return outcome;
      splitting.inertial_increments(heliocentric_state_, r_, v_);
    }
    Vector<Real, n> dq = zeros_like(q);
    Vector<Real, n> dp = zeros_like(q);
    for (std::size_t i = 0; i < inertia_.size(); ++i) {
      for (std::size_t k = 0; k < space_; ++k) {
        dq[i * space_ + k] = r_[i][k];
        dp[i * space_ + k] = inertia_[i] * v_[i][k];
      }
    }
    z.move(dq);
    z.push(dp);
    return Outcome::done;
  }

  Outcome compose(Jacobi& splitting, const Base& h, JacobiState<Real>& state) const {
    for (std::size_t k = 0; k < kicks_by_.size(); ++k) {
      const Outcome outcome = splitting.drift(state, Real(Base(drifts_by_[k] * h)));
      if (outcome != Outcome::done) return outcome;
      const Real by(Base(kicks_by_[k] * h));
      if (options_.kernel == WisdomHolmanKernel::lazy) {
        splitting.lazy_kick(state, by);
      } else {
        splitting.kick(state, by);
      }
    }
    return splitting.drift(state, Real(Base(drifts_by_.back() * h)));
  }

  static Splitting splitting_of(const P& problem, const WisdomHolmanOptions& options) {
    const PointMasses<Base> bodies = problem.point_masses();
    std::vector<Real> masses;
    for (const auto& mass : bodies.masses) masses.push_back(Real(mass));
    const Real constant{bodies.gravitational_constant};
    const Real softening{bodies.softening_squared};
    if (options.coordinates == WisdomHolmanCoordinates::jacobi) return Jacobi(masses, constant, softening);
    return Heliocentric(masses, constant, softening);
  }

  WisdomHolmanOptions options_;
  std::shared_ptr<const MethodInfo> info_;
  Splitting splitting_;
  PooledList<Base> drifts_by_;
  PooledList<Base> kicks_by_;
  std::size_t space_ = 3;
  PooledList<Base> inertia_;
  PooledList<Real> weights_;  // of the corrector
  PooledList<Real> negative_weights_;
  bool corrects_ = true;
  long long forces_ = 0;
  FirstEncounter encounter_;  // seen in a kick
  // Memory of `change`, kept from step to step.
  Spaces r_;
  Spaces v_;
  JacobiState<Real> jacobi_state_;
  HeliocentricState<Real> heliocentric_state_;
};

/// The recipe of wisdom-holman.
struct WisdomHolman {
  static constexpr bool implicit = false;
  static constexpr bool bijective = true;  // in democratic heliocentric coordinates
  static constexpr Capability capability_sets[] = {Capability::separable | Capability::quadratic_kinetic |
                                                   Capability::gravitating};
  template <class P>
  static constexpr bool accepts = GravitatingBodies<P>;
  WisdomHolmanOptions options{};
  template <class P, class A>
  using Stepper = std::conditional_t<A::exact_undo, WisdomHolmanOnLattice<P, A>, WisdomHolmanStep<P, A>>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    if constexpr (!A::exact_undo) {
      return Stepper<P, A>(problem, options, describe(options));
    } else if (options.coordinates == WisdomHolmanCoordinates::jacobi) {
      throw Error("hamflow: Jacobi coordinates are no bijection of the lattice; democratic-heliocentric ones are");
    } else {
      return Stepper<P, A>(problem, describe(options));
    }
  }
};

/// The recipe of saba.
struct Saba {
  static constexpr bool implicit = false;
  static constexpr bool bijective = false;
  static constexpr Capability capability_sets[] = {Capability::separable | Capability::quadratic_kinetic |
                                                   Capability::gravitating};
  template <class P>
  static constexpr bool accepts = GravitatingBodies<P>;
  std::size_t table = 0;
  template <class P, class A>
  using Stepper = WisdomHolmanStep<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, {.table = table}, describe_saba(table));
  }
};

}  // namespace hamflow
