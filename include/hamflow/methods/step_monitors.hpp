// Monitors: functions that give the step size up to a factor (detail/methods/step_density.hpp).
//     simulation.vary_steps(arclength_monitor(problem));
#pragma once

#include <limits>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/methods/step_density.hpp"
#include "hamflow/methods/step_control.hpp"

namespace hamflow {

namespace detail {
/// With more degrees of freedom, second derivatives are computed only along the motion, if dual numbers can do that.
inline constexpr std::size_t most_with_hessian = 12;

/// q'' and p'', the gradient of H differentiated along (q', p').
template <class P, class R, std::size_t N>
void acceleration(const P& problem, const Vector<R, N>& q, const Vector<R, N>& p, const Vector<R, N>& dq,
                  const Vector<R, N>& dp, Vector<R, N>& ddq, Vector<R, N>& ddp) {
  using D = Dual<R, 1>;
  if constexpr (requires { requires P::template knows<D>; }) {
    if (q.size() > most_with_hessian) {
      const auto along = [](const R& x, const R& slope) {
        D all(x);
        all.slope[0] = slope;
        return all;
      };
      Vector<D, N> x = zeros<D, N>(q.size());
      Vector<D, N> y = x;
      Vector<D, N> by_q = x;
      Vector<D, N> by_p = x;
      for (std::size_t i = 0; i < q.size(); ++i) {
        x[i] = along(q[i], dq[i]);
        y[i] = along(p[i], dp[i]);
      }
      gradient(problem, x, y, by_q, by_p);
      for (std::size_t i = 0; i < q.size(); ++i) {
        ddq[i] = by_p[i].slope[0];
        ddp[i] = -by_q[i].slope[0];
      }
      return;
    }
  }
  Matrix<R, N> qq = zero_matrix(q);
  if constexpr (QuadraticKinetic<P> && TwiceDifferentiable<P>) {
    Vector<R, N> f = zeros_like(q);
    force_and_hessian(problem, q, f, qq);
    velocity(problem, dp, ddq);  // M^-1 p'
    for (std::size_t i = 0; i < q.size(); ++i) {
      ddp[i] = -(qq[i][0] * dq[0]);
      for (std::size_t j = 1; j < q.size(); ++j) ddp[i] -= qq[i][j] * dq[j];
    }
  } else {
    Matrix<R, N> qp = qq;
    Matrix<R, N> pp = qq;
    hessian(problem, q, p, qq, qp, pp);
    for (std::size_t i = 0; i < q.size(); ++i) {
      ddq[i] = R(0);
      ddp[i] = R(0);
      for (std::size_t j = 0; j < q.size(); ++j) {
        ddq[i] += qp[j][i] * dq[j] + pp[i][j] * dp[j];
        ddp[i] -= qq[i][j] * dq[j] + qp[i][j] * dp[j];
      }
    }
  }
}
}  // namespace detail

/// **arclength**: every step covers the same length of the trajectory in phase space, sigma = 1/S with
///     S^2 = |q'|^2 + |p'|^2   [HairerSoederlind2005]
/// in the units of the problem, which determine the weights of q and p. For any H with second derivatives. At rest, S =
/// 0, any length is allowed, and G is 0.
template <class P>
StepMonitor<RealOf<P>, P::dimension> arclength_monitor(const P& problem) {
  using R = RealOf<P>;
  using V = VectorOf<P>;
  return {default_monitor, [problem](const V& q, const V& p) {
            V dq = zeros_like(q);
            V dp = dq;
            V ddq = dq;
            V ddp = dq;
            motion(problem, q, p, dq, dp);
            detail::acceleration(problem, q, p, dq, dp, ddq, ddp);
            R square(0);
            R half_rate(0);
            for (std::size_t i = 0; i < q.size(); ++i) {
              square += dq[i] * dq[i] + dp[i] * dp[i];
              half_rate += dq[i] * ddq[i] + dp[i] * ddp[i];
            }
            return square > R(0) ? R(half_rate / square) : R(0);
          }};
}

/// **distance**: sigma = d^(3/2), d the distance to the centre or between the two closest bodies (distance_rate in
/// detail/core/optional_functions.hpp). By Kepler's third law the time scale of a motion at distance d is proportional
/// to d^(3/2), so that a close encounter of two bodies has the same number of steps at any distance.
template <class P>
requires HasDistanceRate<P> StepMonitor<RealOf<P>, P::dimension> distance_monitor(const P& problem) {
  using R = RealOf<P>;
  using V = VectorOf<P>;
  return {distance_monitor_name, [problem](const V& q, const V& p) {
            V dq = zeros_like(q);
            if constexpr (Separable<P>) {
              velocity(problem, p, dq);
            } else {
              V by_q = dq;
              gradient(problem, q, p, by_q, dq);
            }
            return R(R(-1.5) * problem.distance_rate(q, dq));
          }};
}

}  // namespace hamflow
