// The fast path of cg(1) for two coordinates, which nearly every step takes: Newton's corrections from the extrapolated
// initial guess until NewtonProgress ends them, in double, without reports. It has the same operations in the same
// order as natural.hpp and newton.hpp, on plain numbers that stay in registers: a step is one chain of dependent
// operations from guess to guess, and passing numbers through memory, or reading pairs that were written separately,
// costs a fifth. Two Gauss points are evaluated in one register and summed one after the other. All other steps are
// left to Newton.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/detail/core/two.hpp"
#include "hamflow/detail/methods/implicit/newton.hpp"
#include "hamflow/detail/numerics/exact_product.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow {

/// A problem in the plane with a constant `takes_two`: its `force_and_hessian` accepts Two as a number type, and has no
/// branches and no functions except roots.
template <class P>
concept TakesTwo = P::dimension == 2 && requires {
  requires P::takes_two;
};

namespace detail {

/// Sums over the points, kappa F and the entries of int alpha V''.
struct TwoVariableSums {
  double fx = 0, fy = 0, xx = 0, xy = 0, yy = 0;
  [[gnu::always_inline]] void add(double more_fx, double more_fy, double more_xx, double more_xy, double more_yy) {
    fx += more_fx;
    fy += more_fy;
    xx += more_xx;
    xy += more_xy;
    yy += more_yy;
  }
};

/// The last of an odd number of points is in both lanes.
template <class P>
[[gnu::always_inline]] inline TwoVariableSums plane_sums(const P& problem, const GaussRule<double>& rule,
                                                         double middle_x, double middle_y, double dx, double dy) {
  TwoVariableSums sums;
  const double* offset = rule.offset.data();
  const double* b = rule.b.data();
  const int s = rule.points;
  for (int l = 0; l < s; l += 2) {
    const int next = l + 1 < s ? l + 1 : l;
    const Two offsets{offset[l], offset[next]};
    const Two weights{b[l], b[next]};
    const Vector<Two, 2> q{middle_x + offsets * dx, middle_y + offsets * dy};
    Vector<Two, 2> f;
    Matrix<Two, 2> second;
    problem.force_and_hessian(q, f, second);
    const Two of_force = golden_ratio<double>() * weights;
    const Two of_second = weights * (0.5 + offsets);
    const Two fx = of_force * f[0], fy = of_force * f[1];
    const Two xx = of_second * second[0][0], xy = of_second * second[0][1], yy = of_second * second[1][1];
    sums.add(fx[0], fy[0], xx[0], xy[0], yy[0]);
    if (next > l) sums.add(fx[1], fy[1], xx[1], xy[1], yy[1]);
  }
  return sums;
}

}  // namespace detail

/// The result of the fast path: z1 - z0 and the number of corrections, 0 if it did not converge. Plain numbers instead
/// of vectors, so that they stay in registers.
struct FastPathResult {
  int corrections = 0;
  Two d{};
  Two impulse{};
};

/// @param guess the extrapolated impulse @param free_displacement the largest |h| |M^-1| |p0|
template <class P>
[[gnu::always_inline]] inline FastPathResult two_variable_fast_path(const P& problem, const GaussRule<double>& rule,
                                                                    double h, const Vector<double, 2>& q0,
                                                                    const Vector<double, 2>& p0,
                                                                    const Vector<double, 2>& guess,
                                                                    double free_displacement, int most) {
  using V = Vector<double, 2>;
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const auto velocity_of = [&](double x, double y) __attribute__((always_inline)) {
    V v{};
    velocity(problem, V{x, y}, v);
    return v;
  };
  const double unit = 0.5 * (h / detail::golden_ratio<double>());
  const double factor = h * h / 2;
  const V start = velocity_of(p0[0] + 0.5 * guess[0], p0[1] + 0.5 * guess[1]);
  double dx = h * start[0], dy = h * start[1];
  NewtonProgress<double> progress;
  for (int k = 0; k < most; ++k) {
    const detail::TwoVariableSums sums = detail::plane_sums(problem, rule, q0[0] + 0.5 * dx, q0[1] + 0.5 * dy, dx, dy);
    const double half_x = unit * sums.fx, half_y = unit * sums.fy;
    const double middle_x = p0[0] + half_x, middle_y = p0[1] + half_y;
    const V v = velocity_of(middle_x, middle_y);
    const double target_x = h * v[0], target_y = h * v[1];
    const double rx = target_x - dx, ry = target_y - dy;
    const V column_x = velocity_of(sums.xx, sums.xy), column_y = velocity_of(sums.xy, sums.yy);
    const double xx = factor * column_x[0] + 1, yx = factor * column_x[1];
    const double xy = factor * column_y[0], yy = factor * column_y[1] + 1;
    const double inverse_determinant = 1 / (xx * yy - xy * yx);
    const double ex = (rx * yy - ry * xy) * inverse_determinant, ey = (ry * xx - rx * yx) * inverse_determinant;

    const double size = std::max(std::abs(ex), std::abs(ey));
    const double noise = epsilon * (std::max(free_displacement, std::max(std::abs(target_x), std::abs(target_y))) +
                                    std::max(std::abs(dx + ex), std::abs(dy + ey)));
    const NewtonDecision decision = progress.judge(size, size + std::abs(ex) + std::abs(ey), noise);
    if (decision == NewtonDecision::not_finite) return {};
    if (decision == NewtonDecision::settled) {
      if (progress.began_far_away(noise)) return {};
      const double terms = std::max(std::abs(target_x), std::abs(target_y));
      if (hidden_by_rounding(epsilon * terms,
                             std::max(free_displacement, std::max(std::abs(dx + ex), std::abs(dy + ey))))) {
        return {};
      }
      const double low_x = product_error(unit, sums.fx, half_x), low_y = product_error(unit, sums.fy, half_y);
      const double part_x = middle_x - p0[0], part_y = middle_y - p0[1];
      const V rest = velocity_of(((p0[0] - (middle_x - part_x)) + (half_x - part_x)) + low_x,
                                 ((p0[1] - (middle_y - part_y)) + (half_y - part_y)) + low_y);
      double cx = product_error(h, v[0], target_x) + h * rest[0], cy = product_error(h, v[1], target_y) + h * rest[1];
      if (!(((std::abs(xx - 1) + std::abs(xy)) + std::abs(yx)) + std::abs(yy - 1) < 0.03125)) {
        const double x = (cx * yy - cy * xy) * inverse_determinant;
        cy = (cy * xx - cx * yx) * inverse_determinant;
        cx = x;
      }
      cx += ex;
      cy += ey;
      const double impulse_x = 2 * half_x + (2 * low_x - h * ((0 + sums.xx * cx) + sums.xy * cy));
      const double impulse_y = 2 * half_y + (2 * low_y - h * ((0 + sums.xy * cx) + sums.yy * cy));
      return {k + 1, Two{dx + cx, dy + cy}, Two{impulse_x, impulse_y}};
    }
    dx += ex;
    dy += ey;
  }
  return {};
}

}  // namespace hamflow
