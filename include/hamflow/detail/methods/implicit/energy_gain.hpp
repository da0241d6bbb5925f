// The criterion of quadrature = "auto": the energy gain of a step according to a rule with one more Gauss point.
#pragma once

#include <concepts>
#include <cstddef>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/methods/implicit/equations.hpp"
#include "hamflow/detail/methods/implicit/within_rounding.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow::detail {

/// The rounding of a sum of work: of its terms and of the coordinates at which forces are evaluated, summed like
/// independent errors.
template <class Real>
struct RoundingOfWork {
  Real works{0};
  Real force_changes{0};
  /// @param force_change (V'' d) q, the change of a force along the step times the coordinate
  void add(const Real& work, const Real& force_change) {
    works += work * work;
    force_changes += force_change * force_change;
  }
  Real of_terms(int terms) const {
    constexpr auto epsilon = Epsilon<Real>{};
    return epsilon * Real(Real(terms) * sqrt(works) + Real(4) * sqrt(force_changes));
  }
};

/// The energy gain of a step according to some points, and its rounding.
template <class Real>
struct Gain {
  Real gain{0};
  Real size{0};   // size of its terms
  Real noise{0};  // the gain that rounding can explain
};

/// From this number of points on the test requires more than the agreement of two rules, which noise can cause by
/// chance; with fewer points an unnecessary point costs little.
inline constexpr int points_enough = 16;

/// Whether a rule misses an energy gain of the step: the gain with one more point is more than rounding explains, and
/// two more points agree. If the estimate of rounding is too small, the two rules see different noise. If they are far
/// from converged, they differ, too, but each gives the same gain along neighbouring steps, unlike noise. The gain
/// according to the rule itself is not an error of the rule: it is the rounding of the solution, which in a stiff step
/// is far larger than that of the work and the same for every rule.
/// @param points of the rule @param two_more() the gain with two more points
/// @param own() the gain with the rule itself
/// @param nearby(draw) the gain with one more point minus that with the rule itself, along a neighbouring step; null:
/// unused
template <class Real, class TwoMore, class Own, class Nearby = std::nullptr_t>
bool quadrature_misses_gain(const Gain<Real>& one, int points, const TwoMore& two_more, const Own& own,
                            const Nearby& nearby = nullptr) {
  if (abs(one.gain) <= one.noise) return false;
  const Real of_solution = own();
  const bool rounds = abs(of_solution) <= one.size / (1 << 20);  // a larger value is never rounding
  const Real overlooked = rounds ? Real(one.gain - of_solution) : one.gain;
  if (abs(overlooked) <= one.noise) return false;
  if (abs(overlooked) > Real(4096) * one.noise || points + 2 > most_gauss_points) return true;
  const bool agree = abs(two_more() - one.gain) <= abs(overlooked) / 2;
  if constexpr (std::same_as<Nearby, std::nullptr_t>) {
    return agree;
  } else {
    if (!rounds || (agree && points < points_enough)) return agree;
    for (std::uint64_t draw = 0; draw < rounding_draws; ++draw) {
      if (!(abs(nearby(draw) - overlooked) <= abs(overlooked) / 4)) return false;
    }
    return true;
  }
}

/// The gain with one more point minus that with the rule itself, along a step next to that of the averages x. It is at
/// a distance of 2^-24 of state and averages: far enough that forces have other rounding errors, even if they lose the
/// last digits of a state (exp(x) - 1), and close enough that the gain is the same.
template <class E>
[[gnu::cold, gnu::noinline]] typename E::Real gain_of_neighbouring_step(const E& step, const typename E::Variables& x,
                                                                        std::uint64_t draw) {
  using Real = typename E::Real;
  const Real unit = Real(1) / Real(1 << 24);
  auto q = step.positions();
  auto p = step.momenta();
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] = moved_by(unit, q[i], draw, 2 * i);
    p[i] = moved_by(unit, p[i], draw, 2 * i + 1);
  }
  typename E::Variables moved = x;
  for (std::size_t i = 0; i < x.size(); ++i) moved[i] = moved_by(unit, x[i], draw, 2 * q.size() + i);
  const E there = step.from(q, p);
  return there.gain_of_energy(moved).gain - there.own_gain(moved);
}

/// The rounding of H near a state, estimated from the virial, because terms of H may cancel.
template <class P, class Real, std::size_t N>
Real size_of_terms(const P& problem, const Vector<Real, N>& q, const Vector<Real, N>& p) {
  Vector<Real, N> dq = zeros_like(q);
  Vector<Real, N> dp = zeros_like(p);
  gradient(problem, q, p, dq, dp);
  Real size = abs(energy(problem, q, p));
  for (std::size_t i = 0; i < q.size(); ++i) size += abs(q[i] * dq[i]) + abs(p[i] * dp[i]);
  return size;
}

/// The rounding of the change of H along a step if |H| and the virial do not show it, because H has terms that cancel
/// (exp(x) - x - 1 for small x) or a constant. It is measured by moving both ends by small parts of the step. 0 if the
/// differences are not rounding, or if such a small part of the step changes H by much, since such a step is too long
/// anyway.
/// @param size of H and its virial at the start
template <class P, class Real, std::size_t N>
[[gnu::cold, gnu::noinline]] Real rounding_of_change(const P& problem, const Vector<Real, N>& q0,
                                                     const Vector<Real, N>& p0, const Increment<Real, N>& taken,
                                                     const Real& size) {
  using One = Vector<Real, 1>;
  Real ends[2];  // H at the ends
  bool is_near = true;
  const auto change_from = [&](const Real& part, std::uint64_t draw) {
    Vector<Real, N> q = q0;
    Vector<Real, N> p = p0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] += moved_by(part, taken.q[i], draw, 2 * i) - taken.q[i];
      p[i] += moved_by(part, taken.p[i], draw, 2 * i + 1) - taken.p[i];
    }
    const Real before = energy(problem, q, p);
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] += taken.q[i];
      p[i] += taken.p[i];
    }
    const Real behind = energy(problem, q, p);
    if (part == Real(0)) {
      ends[0] = before;
      ends[1] = behind;
    }
    is_near = is_near && abs(before - ends[0]) <= size / 128 && abs(behind - ends[1]) <= size / 128;
    return Real(behind - before);
  };
  const Real here = change_from(Real(0), 0);
  const Real rounding = plateau_of_rounding<Real>([&](const Real& part, std::uint64_t draw) {
    return One{(change_from(part, draw) - here) + (change_from(-part, draw) - here)};
  });
  return is_near ? rounding : Real(0);
}

/// Whether H has changed by 256 roundings of its terms along a step in which no rule finds a gain. Either both rules
/// are far from converged, so that their results differ like noise, or H is not smooth: two rules agree if H has a kink
/// (abs(x)) beyond their outermost points.
/// @param own() the gain with the rule in use, which is only the rounding of the solution
/// @param most_roundings number of roundings of the terms of H that do not count as a change
template <class P, class Real, std::size_t N, class Own>
bool energy_test_misses_change(const P& problem, const Vector<Real, N>& q0, const Vector<Real, N>& p0,
                               const Increment<Real, N>& taken, const Own& own, int most_roundings = 256) {
  constexpr auto epsilon = Epsilon<Real>{};
  Vector<Real, N> q1 = q0;
  Vector<Real, N> p1 = p0;
  for (std::size_t i = 0; i < q1.size(); ++i) {
    q1[i] += taken.q[i];
    p1[i] += taken.p[i];
  }
  const Real before = energy(problem, q0, p0);
  const Real change = energy(problem, q1, p1) - before;
  if (abs(change) <= epsilon * Real(most_roundings * abs(before))) return false;  // sufficient for most steps
  const Real size = size_of_terms(problem, q0, p0);
  const Real explained = epsilon * Real(most_roundings * (size + size_of_terms(problem, q1, p1)));
  if (!(abs(change) > explained)) return false;
  const bool rounds = abs(change) <= size / (1 << 20);  // a larger value is never the rounding of a solution
  const Real beyond = rounds ? Real(abs(change - own())) : abs(change);
  return beyond > explained && beyond > Real(16) * rounding_of_change(problem, q0, p0, taken, size);
}

}  // namespace hamflow::detail
