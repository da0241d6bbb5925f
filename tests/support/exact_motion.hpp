// An exact solution in time against the reference flow and against itself.
#pragma once

#include "engine/reference_flow.hpp"
#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"
#include "near.hpp"

namespace hamflow::test {

template <std::size_t N>
long double size_of(const Vector<long double, N>& x) {
  long double size = 0;
  for (const long double& entry : x) size = larger(size, static_cast<long double>(std::fabs(entry)));
  return size;
}

/// How much a small change of the start has grown by time t, at least 1.
template <class P, std::size_t N = P::dimension>
long double growth(const P& problem, const Start<long double, N>& start, long double t) {
  const long double nudge = 1e-9L * (1 + size_of(start.q) + size_of(start.p));
  const auto z = *problem.exact(start.q, start.p, t);
  long double largest = nudge;
  for (std::size_t k = 0; k < 2 * N; ++k) {
    auto moved = start;
    (k < N ? moved.q[k] : moved.p[k - N]) += nudge;
    const auto other = problem.exact(moved.q, moved.p, t);
    if (!other) continue;  // just beyond the bounded motions
    for (std::size_t i = 0; i < N; ++i) {
      largest = larger(largest, static_cast<long double>(std::fabs(other->q[i] - z.q[i])));
      largest = larger(largest, static_cast<long double>(std::fabs(other->p[i] - z.p[i])));
    }
  }
  return largest / nudge;
}

/// What `distance_from_reference` may come to: the reference keeps a step whose extrapolations stagnate a few roundings
/// apart. Measured against 34 digits, its own error was 7 of these units for a harmonic oscillator.
inline constexpr long double reference_units = 16;

/// The distance of the exact solution from the reference flow, in units of what both may err by: eps times the state
/// for every eighth of a unit of time (a step of the reference), grown by the motion.
template <class P, std::size_t N = P::dimension>
long double distance_from_reference(const P& problem, const Start<long double, N>& start, long double t) {
  const auto exact = problem.exact(start.q, start.p, t);
  if (!exact) return std::numeric_limits<long double>::infinity();
  Vector<long double, 2 * N> z{};
  for (std::size_t i = 0; i < N; ++i) {
    z[i] = start.q[i];
    z[N + i] = start.p[i];
  }
  z = reference_flow(problem, z, t);
  long double distance = 0;
  for (std::size_t i = 0; i < N; ++i) {
    const long double apart = std::fabs(exact->q[i] - z[i]) + std::fabs(exact->p[i] - z[N + i]);
    if (!std::isfinite(apart)) return std::numeric_limits<long double>::infinity();
    distance = larger(distance, apart);
  }
  const long double state = 1 + larger(size_of(start.q) + size_of(start.p), size_of(z));
  return distance / (long_epsilon * (1 + 8 * std::fabs(t)) * growth(problem, start, t) * state);
}

}  // namespace hamflow::test
