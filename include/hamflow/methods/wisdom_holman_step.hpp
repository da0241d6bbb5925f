// wisdom-holman and saba as methods of the catalogue: one step in Jacobi or in democratic heliocentric coordinates.
// A step computes what is to be added to q and p, which every arithmetic adds in its own way.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "hamflow/core/method_info.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/core/capability.hpp"
#include "hamflow/methods/heliocentric.hpp"
#include "hamflow/methods/kepler_tables.hpp"
#include "hamflow/methods/wisdom_holman.hpp"
#include "hamflow/orbits/kepler_tangent.hpp"

namespace hamflow {

enum class WisdomHolmanCoordinates { jacobi, heliocentric };

struct WisdomHolmanOptions {
  WisdomHolmanCoordinates coordinates = WisdomHolmanCoordinates::jacobi;
  WisdomHolmanKernel kernel = WisdomHolmanKernel::standard;
  std::size_t table = 0;  // of kepler_tables()
};

inline MethodInfo describe(const WisdomHolmanOptions& options) {
  const bool is_jacobi = options.coordinates == WisdomHolmanCoordinates::jacobi;
  const bool is_lazy = options.kernel == WisdomHolmanKernel::lazy;
  return {.name = std::string("wisdom-holman") + (!is_jacobi ? "(coordinates=democratic-heliocentric)"
                                                  : is_lazy  ? "(kernel=lazy)"
                                                             : ""),
          .summary = std::string("Kepler drifts and kicks by the planets, in ") +
                     (is_jacobi ? "Jacobi coordinates" : "democratic heliocentric coordinates") +
                     (is_lazy ? ", lazy kernel" : ""),
          .reference = is_lazy     ? "WisdomEtAl1996; ReinEtAl2019"
                       : is_jacobi ? "WisdomHolman1991"
                                   : "DuncanEtAl1998",
          .order = 2,
          // The lazy kick is even in dt and changes velocities by a function of positions, which is no gradient.
          .symplectic = !is_lazy,
          .weakly_reversible = true,
          .symmetric = true,
          .reversible = true,
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
  static_assert(!A::exact_undo, "hamflow: wisdom-holman is no bijection of the lattice");
  static constexpr std::size_t n = P::dimension;
  static constexpr bool memory_depends_on_positions_only = true;
  using Real = typename A::Real;
  using Base = base_scalar<Real>;
  using State = PhasePoint<A, n>;

  WisdomHolmanStep(const P& problem, const WisdomHolmanOptions& options, MethodInfo info)
      : options_(options), info_(std::move(info)), splitting_(splitting_of(problem, options)) {
    const KeplerTable& table = kepler_tables()[options.table];
    for (std::size_t k = 0; k <= table.kicks; ++k) {
      drifts_by_.push_back(evaluate_number<Base>(table.drifts_by[table.drift_index(k)]));
      if (k < table.kicks) kicks_by_.push_back(evaluate_number<Base>(table.kicks_by[table.kick_index(k)]));
    }
    const PointMasses<RealOf<P>> bodies = problem.point_masses();
    space_ = bodies.space;
    for (const auto& mass : bodies.masses) inertia_.push_back(RealOf<P>(0) < mass ? Base(mass) : Base(1));
  }

  MethodInfo info() const { return info_; }
  Effort effort() const { return {.force = forces_}; }
  void invalidate() {}
  template <class Archive>
  void archive(Archive& ar) {
    ar(forces_);
  }

  Outcome step(const P&, const Base& h, State& z) {
    const Vector<Real, n> q = z.positions();
    const Vector<Real, n> p = z.momenta();
    Spaces r(inertia_.size());
    Spaces v(inertia_.size());
    for (std::size_t i = 0; i < inertia_.size(); ++i) {
      for (std::size_t k = 0; k < space_; ++k) {
        r[i][k] = q[i * space_ + k];
        v[i][k] = p[i * space_ + k] / inertia_[i];
      }
    }
    Outcome outcome;
    std::pair<Spaces, Spaces> by;
    if (auto* const jacobi = std::get_if<Jacobi>(&splitting_)) {
      auto state = jacobi->state_of(r, v);
      outcome = compose(*jacobi, h, state);
      by = {jacobi->inertial_of(state.added_r), jacobi->inertial_of(state.added_v)};
    } else {
      auto& splitting = std::get<Heliocentric>(splitting_);
      auto state = splitting.state_of(r, v);
      outcome = splitting.step(state, Real(h));
      by = splitting.inertial_increments(state);
    }
    if (outcome != Outcome::done) return outcome;
    forces_ += info_.forces_per_step;
    Vector<Real, n> dq = zeros_like(q);
    Vector<Real, n> dp = zeros_like(q);
    for (std::size_t i = 0; i < inertia_.size(); ++i) {
      for (std::size_t k = 0; k < space_; ++k) {
        dq[i * space_ + k] = by.first[i][k];
        dp[i * space_ + k] = inertia_[i] * by.second[i][k];
      }
    }
    z.move(dq);
    z.push(dp);
    return Outcome::done;
  }

  std::string failure(const P&, const Base&, const State&) const {
    return "a Kepler drift of wisdom-holman has no solution: a body meets the centre of its orbit, or left the range "
           "of "
           "numbers";
  }

 private:
  using Jacobi = JacobiSplitting<Real>;
  using Heliocentric = HeliocentricSplitting<Real>;
  using Splitting = std::variant<Jacobi, Heliocentric>;
  using Spaces = std::vector<Vector<Real, 3>>;

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
    const PointMasses<RealOf<P>> bodies = problem.point_masses();
    std::vector<Real> masses;
    for (const auto& mass : bodies.masses) masses.push_back(Real(Base(mass)));
    const Real constant{Base(bodies.gravitational_constant)};
    const Real softening{Base(bodies.softening_squared)};
    if (options.coordinates == WisdomHolmanCoordinates::jacobi) return Jacobi(std::move(masses), constant, softening);
    return Heliocentric(std::move(masses), constant, softening);
  }

  WisdomHolmanOptions options_;
  MethodInfo info_;
  Splitting splitting_;
  std::vector<Base> drifts_by_;
  std::vector<Base> kicks_by_;
  std::size_t space_ = 3;
  std::vector<Base> inertia_;
  long long forces_ = 0;
};

/// The recipe of wisdom-holman.
struct WisdomHolman {
  static constexpr bool implicit = false;
  static constexpr bool bijective = false;
  static constexpr Capability capability_sets[] = {Capability::separable | Capability::quadratic_kinetic |
                                                   Capability::gravitating};
  template <class P>
  static constexpr bool accepts = GravitatingBodies<P>;
  WisdomHolmanOptions options{};
  template <class P, class A>
  using Stepper = WisdomHolmanStep<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, options, describe(options));
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
