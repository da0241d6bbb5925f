// Absolute angles (each from the vertical) and relative ones (the second from the first rod) of a double pendulum.
// [Gross1999, Sect. 3] Positions change by A = [[1, 0], [1, 1]], absolute = A relative, momenta by its inverse
// transpose, so that p^T dq is unchanged and the transformation is canonical.
#pragma once

#include "hamflow/core/problem_info.hpp"

namespace hamflow {

enum class Angles { absolute, relative };

template <class S>
constexpr Vector<S, 2> absolute_angles(const Vector<S, 2>& relative) {
  return {relative[0], relative[0] + relative[1]};
}
template <class S>
constexpr Vector<S, 2> relative_angles(const Vector<S, 2>& absolute) {
  return {absolute[0], absolute[1] - absolute[0]};
}
template <class S>
constexpr Vector<S, 2> absolute_momenta(const Vector<S, 2>& relative) {
  return {relative[0] - relative[1], relative[1]};
}
template <class S>
constexpr Vector<S, 2> relative_momenta(const Vector<S, 2>& absolute) {
  return {absolute[0] + absolute[1], absolute[1]};
}

/// Absolute angles are the reference chart.
template <class R, Angles>
struct PendulumChart {};
template <class R>
struct PendulumChart<R, Angles::relative> {
  static Start<R, 2> to_reference(const Start<R, 2>& s) { return {absolute_angles(s.q), absolute_momenta(s.p)}; }
  static Start<R, 2> from_reference(const Start<R, 2>& s) { return {relative_angles(s.q), relative_momenta(s.p)}; }
};

}  // namespace hamflow
