// What one more Gauss point sees of the energy that a step gains: how quadrature = "auto" judges.
#pragma once

#include <concepts>
#include <cstddef>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/methods/implicit/equations.hpp"
#include "hamflow/detail/methods/implicit/within_rounding.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow::detail {

/// The rounding of a sum of work, that of its terms and that of the coordinates at which forces are evaluated, which
/// adds up as independent roundings do.
template <class Real>
struct RoundingOfWork {
  Real works{0};
  Real force_changes{0};
  /// @param force_change (V'' d) q: the change of a force along the step times the coordinate
  void add(const Real& work, const Real& force_change) {
    works += work * work;
    force_changes += force_change * force_change;
  }
  Real of_terms(int terms) const {
    constexpr auto epsilon = Epsilon<Real>{};
    return epsilon * Real(Real(terms) * sqrt(works) + Real(4) * sqrt(force_changes));
  }
};

/// What points see of the energy that a step gains, and what rounding makes of it.
template <class Real>
struct Gain {
  Real gain{0};
  Real size{0};   // of its terms
  Real noise{0};  // that rounding explains
};

/// From so many points on it takes more than two rules that agree, which noise brings about once in a while: up to
/// there a point too many costs little.
inline constexpr int points_enough = 16;

/// Whether a rule of points overlooks energy that a step gains: one more point sees more than rounding explains, and
/// two more see the same. Where the estimate of rounding is too small, they see different noise; where they are still
/// far from converged they differ, too, but each sees the same along neighbouring steps, which noise does not. What
/// the rule itself sees of the energy is no fault of its points: it is the rounding of the solution, which in a stiff
/// step is far more than that of the work, and which every rule sees alike.
/// @param points of the rule   @param two_more(): the gain as two more points see it
/// @param own(): the gain as the rule itself sees it
/// @param nearby(draw): what one point more sees along a neighbouring step beyond what the rule itself sees there;
/// null: is not asked
template <class Real, class TwoMore, class Own, class Nearby = std::nullptr_t>
bool overlooks_a_gain(const Gain<Real>& one, int points, const TwoMore& two_more, const Own& own,
                      const Nearby& nearby = nullptr) {
  if (abs(one.gain) <= one.noise) return false;
  const Real of_solution = own();
  const bool rounds = abs(of_solution) <= one.size / (1 << 20);  // more is no rounding, of whatever step
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

/// What one point more sees along a step beside that of the averages x, beyond what the rule itself sees there. It is
/// so far away (2^-24 of state and averages) that forces round otherwise, however much they hide of the last digits of
/// a state (exp(x) - 1), and so near that a gain is the same.
template <class E>
[[gnu::cold, gnu::noinline]] typename E::Real gain_nearby(const E& step, const typename E::Variables& x,
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

/// What H rounds by near a state: it has terms that cancel, of which those of the virial tell.
template <class P, class Real, std::size_t N>
Real size_of_terms(const P& problem, const Vector<Real, N>& q, const Vector<Real, N>& p) {
  Vector<Real, N> dq = zeros_like(q);
  Vector<Real, N> dp = zeros_like(p);
  gradient(problem, q, p, dq, dp);
  Real size = abs(energy(problem, q, p));
  for (std::size_t i = 0; i < q.size(); ++i) size += abs(q[i] * dq[i]) + abs(p[i] * dp[i]);
  return size;
}

/// What the change of H along a step rounds by where |H| and the virial do not tell of it, since H has terms that
/// cancel (exp(x) - x - 1 of small x) or a constant, when both ends move by small parts of the step. 0 where it is not
/// rounding that is seen, and where so small a part of the step changes H by much: a step that long leads nowhere.
/// @param size of H and its virial at the start
template <class P, class Real, std::size_t N>
[[gnu::cold, gnu::noinline]] Real rounding_of_change(const P& problem, const Vector<Real, N>& q0,
                                                     const Vector<Real, N>& p0, const Increment<Real, N>& taken,
                                                     const Real& size) {
  using One = Vector<Real, 1>;
  Real ends[2];  // H there
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

/// Whether H has changed by 256 roundings of its terms along a step that no rule of points sees any gain in. Either
/// both rules are far from converged, so that what they see differs as noise does, or H is not smooth: where it has a
/// kink (abs(x)) beyond the outermost points, two rules agree about what neither has seen.
/// @param own(): the gain as the rule in use sees it, which is no more than the rounding of the solution
/// @param most_roundings of the terms of H that are no change
template <class P, class Real, std::size_t N, class Own>
bool overlooks_a_change(const P& problem, const Vector<Real, N>& q0, const Vector<Real, N>& p0,
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
  if (abs(change) <= epsilon * Real(most_roundings * abs(before))) return false;  // most steps need to know no more
  const Real size = size_of_terms(problem, q0, p0);
  const Real explained = epsilon * Real(most_roundings * (size + size_of_terms(problem, q1, p1)));
  if (!(abs(change) > explained)) return false;
  const bool rounds = abs(change) <= size / (1 << 20);  // more is no rounding of a solution, of whatever step
  const Real beyond = rounds ? Real(abs(change - own())) : abs(change);
  return beyond > explained && beyond > Real(16) * rounding_of_change(problem, q0, p0, taken, size);
}

}  // namespace hamflow::detail
