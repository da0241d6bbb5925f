// Double exponential quadrature to rounding, for integrands that are analytic inside the interval; at its ends they may
// be singular as long as they are integrable.   [TakahasiMori1974]   With x = L/(1 + exp(-pi sinh t)) the
// trapezoidal rule in t converges exponentially, its error is squared when the step is halved.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "hamflow/core/number.hpp"

namespace hamflow {

/// An integral and an estimate of its error.
template <class R>
struct Integral {
  R value{};
  R error{};
};

namespace detail {

/// The points of one refinement that the coarser ones have not: both points at +t and -t, as shares of the length.
template <class R>
struct DoubleExponentialLevel {
  struct Pair {
    R near;    // distance to the near end
    R far;     // distance to the other end, near + far = 1
    R weight;  // dx/dt
  };
  R step;
  std::vector<Pair> pairs;  // ascending in t > 0
};

inline constexpr int double_exponential_levels = 8;  // steps 1/2 .. 1/256

template <class R>
const std::vector<DoubleExponentialLevel<R>>& double_exponential_rule() {
  static const std::vector<DoubleExponentialLevel<R>> levels = [] {
    // The last point is so near to its end that even f = x^(-0.98) leaves no more than rounding behind it.
    const R reach = -log(std::numeric_limits<R>::epsilon()) * R(50);
    const R limit = -log(std::numeric_limits<R>::min()) / R(2);
    std::vector<DoubleExponentialLevel<R>> all;
    for (int level = 0; level < double_exponential_levels; ++level) {
      const R step = R(1) / R(2 << level);
      DoubleExponentialLevel<R> points{step, {}};
      for (int k = 1;; k += level == 0 ? 1 : 2) {
        const R t = R(k) * step;
        const R exponent = pi_value<R>() * sinh(t);
        if (exponent > reach || exponent > limit) break;
        const R q = exp(-exponent);
        const R far = R(1) / (R(1) + q);
        points.pairs.push_back({q * far, far, pi_value<R>() * cosh(t) * q * far * far});
      }
      all.push_back(std::move(points));
    }
    return all;
  }();
  return levels;
}

}  // namespace detail

/// The integral of f over an interval of the given length. f(from_left, to_right) gets the distances to both ends, each
/// to full relative precision: what vanishes or is singular at an end is written with its distance. A value that is not
/// finite counts as nothing (a point may fall on the end when f adds the distance to something).
template <class R, class F>
Integral<R> integrate_from_ends(F&& f, R length) {
  const R epsilon = std::numeric_limits<R>::epsilon();
  const R accepted = exp(log(epsilon) * R(0.6));  // the error is the square of the last change: beyond rounding
  const auto value_at = [&](R from_left, R to_right) {
    const R value = f(from_left, to_right);
    return isfinite(value) ? value : R(0);
  };
  R sum = value_at(length / R(2), length / R(2)) * pi_value<R>() / R(4);
  Integral<R> integral{};
  R previous_change = std::numeric_limits<R>::max();
  for (int level = 0; level < detail::double_exponential_levels; ++level) {
    const auto& points = detail::double_exponential_rule<R>()[static_cast<std::size_t>(level)];
    bool left = true;  // false when what is further out no longer counts
    bool right = true;
    for (const auto& at : points.pairs) {
      if (left) {
        const R term = value_at(length * at.near, length * at.far) * at.weight;
        sum += term;
        left = abs(term) > epsilon * epsilon * abs(sum) || at.near > R(0.001);
      }
      if (right) {
        const R term = value_at(length * at.far, length * at.near) * at.weight;
        sum += term;
        right = abs(term) > epsilon * epsilon * abs(sum) || at.near > R(0.001);
      }
      if (!left && !right) break;
    }
    const R value = sum * points.step * length;
    const R change = abs(value - integral.value);
    integral = {value, change};
    if (level >= 2) {
      const R size = abs(value);
      if (change <= accepted * size) {
        integral.error = larger(change * change / (size > R(0) ? size : R(1)), epsilon * size);
        break;
      }
      if (change >= previous_change && change <= sqrt(epsilon) * size) break;  // the noise of f
    }
    previous_change = change;
  }
  return integral;
}

/// The integral of f(x) over [a, b].
template <class R, class F>
Integral<R> integrate(F&& f, R a, R b) {
  return integrate_from_ends(
      [&](R from_left, R to_right) { return abs(from_left) < abs(to_right) ? f(a + from_left) : f(b - to_right); },
      b - a);
}

}  // namespace hamflow
