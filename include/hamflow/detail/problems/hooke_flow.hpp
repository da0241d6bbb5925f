// Exact motion in the Hooke potential V(r) = -k r^2/2, for k of any sign: q'' = (k/mu) q, so that
//     q(t) = C q0 + S v0,   v(t) = (k/mu) S q0 + C v0
// with C, S = cos wt, sin(wt)/w, or cosh, sinh/w, or 1, t.   [Gross1999, Sect. 2.9]
#pragma once

#include "hamflow/core/math.hpp"
#include "hamflow/core/problem_info.hpp"

namespace hamflow {

template <class R>
Start<R, 2> hooke_flow(R k, R mass, const Vector<R, 2>& q0, const Vector<R, 2>& p0, R t) {
  const R rate = k / mass;
  const R w = sqrt(R(abs(rate)));
  const R x = w * t;
  const R c = rate < R(0) ? cos(x) : cosh(x);
  R s = t;  // sin(x)/w has no cancellation as w -> 0
  if (x != R(0)) s = (rate < R(0) ? sin(x) : sinh(x)) / w;
  Start<R, 2> now{};
  for (std::size_t i = 0; i < 2; ++i) {
    now.q[i] = c * q0[i] + s * (p0[i] / mass);
    now.p[i] = c * p0[i] + k * s * q0[i];
  }
  return now;
}

}  // namespace hamflow
