// Hamilton's equations and H as recordings (detail/core/tape.hpp).
#pragma once

#include <vector>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/core/tape.hpp"

namespace hamflow {

/// **Traceable**: the derivatives of H are templates that can be recorded.
template <class P, class R>
concept Traceable = Differentiable<P> &&
    ((HasVelocity<P, Trace<R>> && HasForce<P, Trace<R>>) || HasGradient<P, Trace<R>> ||
     (P::dimension != dynamic &&
      (detail::HasParts<P, Dual<Trace<R>, P::dimension>> || detail::HasEnergy<P, Dual<Trace<R>, 2 * P::dimension>>)));

namespace detail {
/// Calls outputs(x, y) with the inputs q and p, and records the returned values.
template <class R, std::size_t N, class Outputs>
Tape<R> tape_at(Recorder<R>& recorder, const Vector<R, N>& q, const Vector<R, N>& p, const Outputs& outputs) {
  Vector<Trace<R>, N> x = zeros<Trace<R>, N>(q.size());
  Vector<Trace<R>, N> y = zeros_like(x);
  for (std::size_t i = 0; i < q.size(); ++i) x[i] = recorder.input(q[i]);
  for (std::size_t i = 0; i < q.size(); ++i) y[i] = recorder.input(p[i]);
  return recorder.finish(outputs(x, y));
}

/// A generic state, at which an H that cannot be recorded is refused before the run.
template <class R, std::size_t N, class P>
std::pair<Vector<R, N>, Vector<R, N>> any_state(const P& problem) {
  Vector<R, N> q = zeros<R, N>(degrees_of_freedom(problem));
  Vector<R, N> p = q;
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] = R(static_cast<int>(5 + 2 * i)) / R(7);
    p[i] = R(static_cast<int>(4 + 3 * i)) / R(11);
  }
  return {q, p};
}
}  // namespace detail

/// q' = dH/dp, p' = -dH/dq on a tape, recorded at (q, p).
template <class R, class P, std::size_t N>
Tape<R> tape_of_motion(const P& problem, const Vector<R, N>& q, const Vector<R, N>& p) {
  Recorder<R> recorder;
  return detail::tape_at(recorder, q, p, [&](const auto& x, const auto& y) {
    Vector<Trace<R>, N> dq = zeros_like(x);
    Vector<Trace<R>, N> dp = zeros_like(x);
    motion(problem, x, y, dq, dp);
    std::vector<Trace<R>> outputs(dq.begin(), dq.end());
    outputs.insert(outputs.end(), dp.begin(), dp.end());
    return outputs;
  });
}

/// H, with branches as guards, so that |x| and similar functions can be recorded.
template <class R, class P, std::size_t N>
Tape<R> tape_of_energy(const P& problem, const Vector<R, N>& q, const Vector<R, N>& p) {
  Recorder<R> recorder(Folding::exact);
  return detail::tape_at(recorder, q, p,
                         [&](const auto& x, const auto& y) { return std::vector{Trace<R>(energy(problem, x, y))}; });
}
/// dH/dq and dH/dp, with branches as guards.
template <class R, class P, std::size_t N>
Tape<R> tape_of_gradient(const P& problem, const Vector<R, N>& q, const Vector<R, N>& p) {
  Recorder<R> recorder(Folding::exact);
  return detail::tape_at(recorder, q, p, [&](const auto& x, const auto& y) {
    Vector<Trace<R>, N> dq = zeros_like(x);
    Vector<Trace<R>, N> dp = zeros_like(x);
    gradient(problem, x, y, dq, dp);
    std::vector<Trace<R>> outputs(dq.begin(), dq.end());
    outputs.insert(outputs.end(), dp.begin(), dp.end());
    return outputs;
  });
}

}  // namespace hamflow
