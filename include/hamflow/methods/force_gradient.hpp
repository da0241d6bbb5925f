// The kernel of symmetric splittings whose kicks may carry the gradient of the squared force.   [Chin1997]
//     kick (b, g):  p <- p - b h V'(q) + g h^3 (|V'|^2)'(q)          drift d:  q <- q + d h M^-1 p
// |V'|^2 = V'^T M^-1 V' with constant M. As vector fields, B = -V' d/dp and A = M^-1 p d/dq, [B, [A, B]] is
// (|V'|^2)' d/dp: the kick is the flow of the potential b V - g h^2 |V'|^2. With F = -V',
//     (|V'|^2)' = 2 V'' M^-1 V' = -2 V'' M^-1 F,
// so that such a kick needs force and Hessian at one q. It is symplectic, and one-to-one on the lattice. Its advantage
// is fourth order without negative coefficients. A last kick equal to the first is reused by the next step.
#pragma once

#include <array>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/methods/pair_sums.hpp"
#include "hamflow/methods/tables.hpp"

namespace hamflow {

/// Whether the first and last action of a step are kicks without gradient.
constexpr bool keeps_last_kick(const ForceGradientTable& table) {
  return !table.half[0].kick.empty() && table.half[0].gradient.empty();
}

inline MethodInfo describe(const ForceGradientTable& table) {
  int forces = keeps_last_kick(table) ? -1 : 0;
  int hessians = 0;
  for (int i = 0; i < table.count(); ++i) {
    forces += table.action(i).kick.empty() ? 0 : 1;
    hessians += table.action(i).gradient.empty() ? 0 : 1;
  }
  return {.name = std::string(table.name),
          .summary = std::string("splitting with force gradient, ") +
                     (table.half[0].drift.empty() ? "kick first, " : "drift first, ") + std::to_string(hessians) +
                     (hessians > 1 ? " Hessians" : " Hessian") +
                     " per step, for T quadratic in p with constant mass matrix",
          .reference = std::string(table.reference),
          .order = table.order,
          .symplectic = true,
          .weakly_reversible = true,
          .symmetric = true,
          .reversible = true,
          .forces_per_step = forces};
}

template <class P, Arithmetic A>
class ForceGradientStep {
 public:
  static_assert(QuadraticKinetic<P> && TwiceDifferentiable<P>,
                "hamflow: a method with force gradient needs a QuadraticKinetic problem, T = p^T M^-1 p/2, with a "
                "twice differentiable V");
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = base_scalar<Real>;
  static constexpr bool sums_integers = PairwiseGradients<P> && IntegerSums<A>;

  explicit ForceGradientStep(const ForceGradientTable& table) : table_(&table), keeps_(keeps_last_kick(table)) {
    if (!table.is_consistent()) {
      throw Error("hamflow: the kicks or the drifts of the table " + std::string(table.name) + " do not add up to 1");
    }
    for (int i = 0; i < table.count(); ++i) {
      const ForceGradientAction& from = table.action(i);
      Action& to = actions_[count_++];
      if (!from.drift.empty()) to.drift = evaluate_number<Base>(from.drift);
      to.kicks = !from.kick.empty();
      if (to.kicks) to.kick = evaluate_number<Base>(from.kick);
      to.has_gradient = !from.gradient.empty();
      if (to.has_gradient) to.gradient = evaluate_number<Base>(from.gradient);
    }
  }

  MethodInfo info() const { return describe(*table_); }

  Outcome step(const P& problem, const Base& h, PhasePoint<A, n>& z) {
    for (std::size_t i = 0; i < count_; ++i) {
      const Action& action = actions_[i];
      if (!action.kicks) {
        Vector<Real, n> v = zeros<Real, n>(z.q.size());
        velocity(problem, z.momenta(), v);
        z.move(action.drift * h, v);
      } else if constexpr (sums_integers) {
        kick_by_pairs(problem, h, action, i == 0, z);
      } else if (action.has_gradient) {
        kick_with_gradient(problem, h, action, z);
      } else {
        if (!(i == 0 && force_is_current_)) {
          if constexpr (n == dynamic) {
            if (force_.size() == 0) force_ = zeros<Real, n>(z.q.size());
          }
          force(problem, z.positions(), force_);
          ++forces_;
        }
        z.push(action.kick * h, force_);
      }
    }
    force_is_current_ = keeps_;
    if constexpr (sums_integers) kept_step_ = h;
    return Outcome::done;
  }

  static constexpr bool memory_depends_on_positions_only = true;
  /// Mirrors the kept kick after the i-th position was mirrored.
  void mirror_kept(std::size_t i) {
    if (i < force_.size()) force_[i] = -force_[i];
  }
  /// Call this after the state was changed from outside.
  void invalidate() { force_is_current_ = false; }
  /// Sets the number of threads for the forces; the bits do not depend on it.
  void use_threads(std::size_t count) requires sums_integers { sums_.use_threads(count); }
  Effort effort() const { return {.force = forces_, .hessian = hessians_}; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(force_is_current_, force_, kick_, kept_step_, forces_, hessians_);
  }

 private:
  using Increment = typename detail::PairSumsOf<P, A, sums_integers>::Increment;

  struct Action {
    Base drift{};
    Base kick{};
    Base gradient{};
    bool kicks = false;
    bool has_gradient = false;
  };

  /// On an integer lattice, rounded and summed pair by pair. M^-1 F is computed from rounded integers, too, so that it
  /// does not depend on the order of pairs: h M^-1 F from the kick of factor h, then 2 h^2 g V'' (h M^-1 F).
  void kick_by_pairs(const P& problem, const Base& h, const Action& action, bool first, PhasePoint<A, n>& z) {
    if constexpr (sums_integers) {
      if constexpr (n == dynamic) {
        if (kick_.size() == 0) kick_ = zeros<Increment, n>(z.q.size());
      }
      bool sound = true;
      if (action.has_gradient) {
        Vector<Real, n> f = zeros<Real, n>(z.q.size());
        Vector<Real, n> a = zeros<Real, n>(z.q.size());
        sound = sums_.evaluate(problem, h, z, kick_);
        for (std::size_t i = 0; i < f.size(); ++i) f[i] = z.arithmetic.momentum.read(kick_[i]);
        velocity(problem, f, a);
        sound =
            sums_.evaluate_with_gradient(problem, action.kick * h, Base(2) * action.gradient * (h * h), a, z, kick_) &&
            sound;
        ++forces_;
        ++hessians_;
      } else if (!(first && force_is_current_ && kept_step_ == h)) {
        sound = sums_.evaluate(problem, action.kick * h, z, kick_);
        ++forces_;
      }
      if (!sound) z.arithmetic.momentum.lost = true;
      z.push(kick_);
    }
  }

  /// p <- p + h b F - 2 h^3 g V'' M^-1 F.
  void kick_with_gradient(const P& problem, const Base& h, const Action& action, PhasePoint<A, n>& z) {
    const auto& q = z.positions();
    Vector<Real, n> f = zeros<Real, n>(q.size());
    Vector<Real, n> a = zeros<Real, n>(q.size());  // M^-1 F: the velocity of a p like F
    Matrix<Real, n> hessian = zero_matrix(f);
    force_and_hessian(problem, q, f, hessian);
    if constexpr (requires { problem.inverse_mass_times(f, a); }) {
      problem.inverse_mass_times(f, a);
    } else {
      velocity(problem, f, a);
    }
    const Base first = action.kick * h;
    const Base third = Base(2) * action.gradient * (h * h * h);
    for (std::size_t i = 0; i < f.size(); ++i) {
      Real product(0);
      for (std::size_t j = 0; j < a.size(); ++j) product += hessian[i][j] * a[j];
      f[i] = first * f[i] - third * product;
    }
    z.push(f);
    ++forces_;
    ++hessians_;
  }

  const ForceGradientTable* table_;
  bool keeps_;
  bool force_is_current_ = false;
  [[no_unique_address]] typename detail::PairSumsOf<P, A, sums_integers>::type sums_;
  Vector<Increment, n> kick_{};  // on the lattice: the last kick of a step of length kept_step_
  Base kept_step_{};
  Vector<Real, n> force_{};  // force of the last kick without gradient
  long long forces_ = 0;
  long long hessians_ = 0;
  std::size_t count_ = 0;
  std::array<Action, 2 * ForceGradientTable::most> actions_{};
};

/// The recipe: ForceGradient{&force_gradient::chin4a}.
struct ForceGradient {
  template <class P>
  static constexpr bool accepts = QuadraticKinetic<P>&& TwiceDifferentiable<P>;
  static constexpr bool implicit = false;
  static constexpr bool bijective = true;
  static constexpr bool recorded = true;
  const ForceGradientTable* table;
  template <class P, class A>
  using Stepper = ForceGradientStep<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P&) const {
    return Stepper<P, A>(*table);
  }
};

}  // namespace hamflow
