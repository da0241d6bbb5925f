// What rounding makes of the residual of a step's equations where its terms do not tell.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>

#include "hamflow/detail/methods/implicit/equations.hpp"
#include "hamflow/detail/methods/implicit/within_rounding.hpp"

namespace hamflow::detail {

/// Whose residual can be asked for from a state nearby, too.
template <class E>
concept EvaluatesNearbyStates = requires(const E& step, typename E::Point& at) {
  step.from(step.positions(), step.momenta());
  at.noise;
};

/// By how much the residual moves, entry by entry and in units of epsilon, when the state moves within its rounding, by
/// one or two units, and when the unknowns move by that: sixteen times the largest of eight draws, as an iteration sums
/// up several such roundings. What an iteration takes for noise are the terms of a force; where coordinates are large
/// beside their differences (bodies far from the origin, a smooth chain) rounding is far more.
template <class E>
[[gnu::cold, gnu::noinline]] typename E::Variables rounding_by_state(const E& step, const typename E::Variables& x) {
  using Real = typename E::Real;
  const Real epsilon = Epsilon<Real>{} * Real(1);
  typename E::Point at, there;
  at.linearised = there.linearised = false;
  step.evaluate(x, at);
  typename E::Variables most = at.residual;
  for (Real& each : most) each = Real(0);
  const auto note = [&] {
    for (std::size_t i = 0; i < most.size(); ++i) {
      const Real size = Real(16) * abs(there.residual[i] - at.residual[i]) / epsilon;
      if (size > most[i]) most[i] = size;
    }
  };
  for (std::uint64_t draw = 0; draw < rounding_draws; ++draw) {
    auto q = step.positions();
    auto p = step.momenta();
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] = within_rounding(q[i], draw, 2 * i);
      p[i] = within_rounding(p[i], draw, 2 * i + 1);
    }
    step.from(q, p).evaluate(x, there);
    note();
    typename E::Variables moved = x;
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += there.residual[i] - at.residual[i];
    step.evaluate(moved, there);
    note();
  }
  return most;
}

/// What the residual rounds by where neither its terms nor a state moved within its rounding tell of it: exp(x) -
/// exp(y) of small x and y rounds by a unit of 1, and of many particles, most of them nearly at rest, a few are where a
/// bit of that unit comes and goes with any correction. The largest entry of eight second differences, when the
/// unknowns move by 2^-26 of themselves and more. Those of rounding are as large for moves 16 times as large, where
/// those of a smooth residual are 256 times as large, and differ from draw to draw, where those of a jump do not; 0
/// where that is not seen.
template <class E>
[[gnu::cold, gnu::noinline]] typename E::Real rounding_by_unknowns(const E& step, const typename E::Variables& x) {
  using Real = typename E::Real;
  typename E::Point at, there;
  at.linearised = there.linearised = false;
  step.evaluate(x, at);
  const auto residual_of = [&](const Real& part, std::uint64_t draw) {
    typename E::Variables moved = x;
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = moved_by(part, x[i], draw, i);
    step.evaluate(moved, there);
    return there.residual;
  };
  return plateau_of_rounding<Real>([&](const Real& part, std::uint64_t draw) {
    typename E::Variables second = residual_of(part, draw);
    const typename E::Variables other = residual_of(-part, draw);
    for (std::size_t i = 0; i < second.size(); ++i)
      second[i] = (second[i] - at.residual[i]) + (other[i] - at.residual[i]);
    return second;
  });
}

/// Of what the terms of forces round by, entry by entry: how large they are at an iterate.
template <class R, std::size_t N>
R sum_of(const Vector<R, N>& all) {
  R sum(0);
  for (const R& each : all) sum += each;
  return sum;
}

}  // namespace hamflow::detail
