// Measures the rounding of the residual of a step's equations if its terms do not show it.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>

#include "hamflow/detail/methods/implicit/equations.hpp"
#include "hamflow/detail/methods/implicit/within_rounding.hpp"

namespace hamflow::detail {

/// Equations whose residual can be evaluated at a neighbouring state.
template <class E>
concept EvaluatesNearbyStates = requires(const E& step, typename E::Point& at) {
  step.from(step.positions(), step.momenta());
  at.noise;
};

/// The change of the residual, entry by entry and in units of epsilon, if the state and the unknowns change within
/// their rounding, by one or two units: sixteen times the largest of eight draws, since an iteration sums several such
/// roundings. An iteration estimates noise from the terms of a force; if coordinates are large compared with their
/// differences (bodies far from the origin, a smooth chain), the rounding is far larger.
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

/// The rounding of the residual if neither its terms nor changes of the state within its rounding show it: exp(x) -
/// exp(y) for small x and y rounds by a unit of 1, and among many particles nearly at rest a few lie where a correction
/// switches a bit of that unit. It is the largest entry of eight second differences, for relative changes of the
/// unknowns by 2^-26 and more. Rounding gives equal second differences for changes 16 times as large, while a smooth
/// residual gives 256 times as large ones; and rounding differs from draw to draw, while a jump does not. 0 if this is
/// not found.
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

/// The sum of the rounding of the terms of forces at an iterate.
template <class R, std::size_t N>
R sum_of(const Vector<R, N>& all) {
  R sum(0);
  for (const R& each : all) sum += each;
  return sum;
}

}  // namespace hamflow::detail
