// The elementary functions of hamflow. Numeric code calls sqrt(x), never std::sqrt(x): dual numbers and extended
// precision types bring their own overloads into this namespace.
#pragma once

#include <cmath>
#include <limits>

namespace hamflow {

using std::abs;
using std::acos;
using std::asin;
using std::atan;
using std::atan2;
using std::copysign;
using std::cos;
using std::cosh;
using std::exp;
using std::hypot;
using std::isfinite;
using std::log;
using std::nearbyint;
using std::pow;
using std::sin;
using std::sinh;
using std::sqrt;
using std::tan;
using std::tanh;

/// Binary digits of a number type whose digits are chosen at run time; 0 for the others.
template <class R>
long precision_in_use() {
  return 0;
}

/// The larger of two numbers of any ordered scalar type (std::max takes references, and needs equal types).
template <class R>
constexpr R larger(R a, R b) {
  return a < b ? b : a;
}

/// log2 |x| with the digits of a double, also for numbers beyond its range; -infinity for 0.
template <class R>
double binary_logarithm(const R& x) {
  return static_cast<double>(std::log2(static_cast<long double>(abs(x))));
}

/// x^n for a whole n, by squaring; n = 0 gives 1.
template <class S>
S whole_power(const S& x, int n) {
  if (n < 0) return S(1) / whole_power(x, -n);
  if (n == 0) return S(1);
  if (n == 1) return x;
  const S half = whole_power(x, n / 2);
  const S even = half * half;
  return n % 2 == 1 ? S(even * x) : even;
}

/// a > 0 ? b : c. Recordings compute it without a branch (detail/core/tape.hpp).
template <class S>
S choose(const S& a, const S& b, const S& c) {
  return S(0) < a ? b : c;
}

}  // namespace hamflow
