// The elementary functions of hamflow. Numeric code calls sqrt(x), never std::sqrt(x): dual numbers and extended
// precision types bring their own overloads into this namespace.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <type_traits>

#include "hamflow/core/function_set.hpp"
#include "hamflow/detail/core/portable_functions.hpp"

namespace hamflow {

using std::abs;
using std::copysign;
using std::isfinite;
using std::nearbyint;
using std::sqrt;

// Templates, so that a program that uses both this namespace and the functions of C finds no two equal ones.
#define HAMFLOW_OF_ONE(name)                                              \
  template <std::floating_point T>                                        \
  T name(T x) {                                                           \
    if constexpr (std::is_same_v<T, double>) {                            \
      return functions_are_portable() ? portable::name(x) : std::name(x); \
    } else {                                                              \
      return std::name(x);                                                \
    }                                                                     \
  }
HAMFLOW_OF_ONE(exp)
HAMFLOW_OF_ONE(log)
HAMFLOW_OF_ONE(sin)
HAMFLOW_OF_ONE(cos)
HAMFLOW_OF_ONE(tan)
HAMFLOW_OF_ONE(asin)
HAMFLOW_OF_ONE(acos)
HAMFLOW_OF_ONE(atan)
HAMFLOW_OF_ONE(sinh)
HAMFLOW_OF_ONE(cosh)
HAMFLOW_OF_ONE(tanh)
#undef HAMFLOW_OF_ONE

#define HAMFLOW_OF_TWO(name)                                                         \
  template <class T, class U>                                                        \
  requires(std::is_arithmetic_v<T> && std::is_arithmetic_v<U>) auto name(T x, U y) { \
    if constexpr (std::is_same_v<decltype(std::name(x, y)), double>) {               \
      return functions_are_portable() ? portable::name(x, y) : std::name(x, y);      \
    } else {                                                                         \
      return std::name(x, y);                                                        \
    }                                                                                \
  }
HAMFLOW_OF_TWO(atan2)
HAMFLOW_OF_TWO(pow)
HAMFLOW_OF_TWO(hypot)
#undef HAMFLOW_OF_TWO

inline double exp2(double x) { return functions_are_portable() ? portable::pow(2, x) : std::exp2(x); }

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
  if constexpr (std::is_same_v<R, double>) {
    if (functions_are_portable()) {
      int exponent = 0;
      const double part = std::frexp(abs(x), &exponent);
      return exponent + log(part) / log(2.0);  // exact for powers of 2
    }
  }
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
