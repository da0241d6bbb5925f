// Dual numbers: a value and its derivatives in N directions, carried exactly through + - * / and the elementary
// functions. Nested, Dual<Dual<R, N>, N> carries second derivatives. They differentiate Hamiltonians without a
// gradient, check gradients written by hand, and give the verification the Jacobian of a whole step.
#pragma once

#include <cstddef>
#include <type_traits>

#include "hamflow/core/math.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/detail/core/operation.hpp"

namespace hamflow {

template <class T, std::size_t N>
struct Dual {
  T value{};
  Vector<T, N> slope{};  // slope[k] = d value / d x_k

  constexpr Dual() = default;
  constexpr Dual(const T& v) : value(v) {}  // NOLINT: a constant is a dual number
  template <class U>
  requires(!std::is_same_v<U, T> && std::is_arithmetic_v<U>) constexpr Dual(U v)
      : value(static_cast<T>(v)) {}  // NOLINT

  /// The k-th independent variable at v.
  static constexpr Dual variable(const T& v, std::size_t k) {
    Dual x(v);
    x.slope[k] = T(1);
    return x;
  }

  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }
};

template <class T>
struct IsDual : std::false_type {};
template <class T, std::size_t N>
struct IsDual<Dual<T, N>> : std::true_type {};

/// The number type below any nesting of dual numbers.
template <class T>
struct BaseScalar {
  using type = T;
};
template <class T, std::size_t N>
struct BaseScalar<Dual<T, N>> {
  using type = typename BaseScalar<T>::type;
};
template <class T>
using base_scalar = typename BaseScalar<T>::type;

/// The plain value below any nesting.
template <class T>
constexpr base_scalar<T> value_of(const T& x) {
  if constexpr (IsDual<T>::value) {
    return value_of(x.value);
  } else {
    return x;
  }
}

namespace detail {
/// f(x) with f'(x) = factor: the chain rule.
template <class T, std::size_t N>
constexpr Dual<T, N> chain(const Dual<T, N>& x, const T& value, const T& factor) {
  Dual<T, N> y(value);
  for (std::size_t k = 0; k < N; ++k) y.slope[k] = factor * x.slope[k];
  return y;
}
/// f(x) with the derivative from the table of functions (detail/core/operation.hpp).
template <class T, std::size_t N>
Dual<T, N> follow_rule(Operation function, const Dual<T, N>& x, const T& value) {
  const DerivativeRule<T> rule = derivative_rule(function, x.value, value, T(1));
  return chain(x, value, rule.divides ? T(T(1) / rule.by) : rule.by);
}
/// Whether S carries no derivative.
template <class S>
bool carries_nothing(const S& x) {
  if constexpr (IsDual<S>::value) {
    for (const auto& slope : x.slope) {
      if (!carries_nothing(slope) || !(value_of(slope) == base_scalar<S>(0))) return false;
    }
    return carries_nothing(x.value);
  } else {
    return true;
  }
}
}  // namespace detail

template <class T, std::size_t N>
constexpr Dual<T, N> operator-(const Dual<T, N>& a) {
  return detail::chain(a, -a.value, T(-1));
}
template <class T, std::size_t N>
constexpr Dual<T, N> operator+(const Dual<T, N>& a, const Dual<T, N>& b) {
  Dual<T, N> c(a.value + b.value);
  for (std::size_t k = 0; k < N; ++k) c.slope[k] = a.slope[k] + b.slope[k];
  return c;
}
template <class T, std::size_t N>
constexpr Dual<T, N> operator-(const Dual<T, N>& a, const Dual<T, N>& b) {
  Dual<T, N> c(a.value - b.value);
  for (std::size_t k = 0; k < N; ++k) c.slope[k] = a.slope[k] - b.slope[k];
  return c;
}
template <class T, std::size_t N>
constexpr Dual<T, N> operator*(const Dual<T, N>& a, const Dual<T, N>& b) {
  Dual<T, N> c(a.value * b.value);
  for (std::size_t k = 0; k < N; ++k) c.slope[k] = a.value * b.slope[k] + a.slope[k] * b.value;
  return c;
}
template <class T, std::size_t N>
constexpr Dual<T, N> operator/(const Dual<T, N>& a, const Dual<T, N>& b) {
  Dual<T, N> c(a.value / b.value);
  for (std::size_t k = 0; k < N; ++k) c.slope[k] = (a.slope[k] - c.value * b.slope[k]) / b.value;
  return c;
}

// Mixed operations with a constant of any type below the dual number.
template <class T, std::size_t N, class U>
concept ConstantFor = (!IsDual<U>::value || !std::is_same_v<U, Dual<T, N>>)&&std::is_convertible_v<U, T>;

template <class T, std::size_t N, class U>
requires ConstantFor<T, N, U>
constexpr Dual<T, N> operator+(const Dual<T, N>& a, const U& b) {
  Dual<T, N> c(a);
  c.value = a.value + T(b);
  return c;
}
template <class T, std::size_t N, class U>
requires ConstantFor<T, N, U>
constexpr Dual<T, N> operator+(const U& a, const Dual<T, N>& b) { return b + a; }
template <class T, std::size_t N, class U>
requires ConstantFor<T, N, U>
constexpr Dual<T, N> operator-(const Dual<T, N>& a, const U& b) {
  Dual<T, N> c(a);
  c.value = a.value - T(b);
  return c;
}
template <class T, std::size_t N, class U>
requires ConstantFor<T, N, U>
constexpr Dual<T, N> operator-(const U& a, const Dual<T, N>& b) { return -b + a; }
template <class T, std::size_t N, class U>
requires ConstantFor<T, N, U>
constexpr Dual<T, N> operator*(const Dual<T, N>& a, const U& b) { return detail::chain(a, a.value * T(b), T(b)); }
template <class T, std::size_t N, class U>
requires ConstantFor<T, N, U>
constexpr Dual<T, N> operator*(const U& a, const Dual<T, N>& b) { return b * a; }
template <class T, std::size_t N, class U>
requires ConstantFor<T, N, U>
constexpr Dual<T, N> operator/(const Dual<T, N>& a, const U& b) {
  return detail::chain(a, a.value / T(b), T(1) / T(b));
}
template <class T, std::size_t N, class U>
requires ConstantFor<T, N, U>
constexpr Dual<T, N> operator/(const U& a, const Dual<T, N>& b) { return Dual<T, N>(T(a)) / b; }

// Comparisons compare values; derivatives follow the branch that is taken.
template <class T, std::size_t N>
constexpr bool operator<(const Dual<T, N>& a, const Dual<T, N>& b) {
  return a.value < b.value;
}
template <class T, std::size_t N>
constexpr bool operator>(const Dual<T, N>& a, const Dual<T, N>& b) {
  return b < a;
}
template <class T, std::size_t N>
constexpr bool operator<=(const Dual<T, N>& a, const Dual<T, N>& b) {
  return a.value <= b.value;
}

template <class T, std::size_t N>
Dual<T, N> sqrt(const Dual<T, N>& x) {
  const T root = sqrt(x.value);
  return detail::chain(x, root, T(1) / (T(2) * root));
}
#define HAMFLOW_DUAL_FUNCTION(name, symmetry, rule, series)           \
  template <class T, std::size_t N>                                   \
  Dual<T, N> name(const Dual<T, N>& x) {                              \
    return detail::follow_rule(Operation::name, x, T(name(x.value))); \
  }
HAMFLOW_FUNCTIONS(HAMFLOW_DUAL_FUNCTION)
#undef HAMFLOW_DUAL_FUNCTION
template <class T, std::size_t N>
Dual<T, N> abs(const Dual<T, N>& x) {
  return x.value < T(0) ? -x : x;
}
/// x^y for a constant exponent.
template <class T, std::size_t N>
Dual<T, N> pow(const Dual<T, N>& x, const base_scalar<T>& y) {
  return detail::chain(x, T(pow(x.value, y)), T(y) * T(pow(x.value, y - base_scalar<T>(1))));
}
/// x^y; computed with the logarithm if y carries derivatives.
template <class T, std::size_t N>
Dual<T, N> pow(const Dual<T, N>& x, const Dual<T, N>& y) {
  if (detail::carries_nothing(y)) return pow(x, value_of(y));
  return exp(y * log(x));
}
/// The angle of (x, y).
template <class T, std::size_t N>
Dual<T, N> atan2(const Dual<T, N>& y, const Dual<T, N>& x) {
  const T square = x.value * x.value + y.value * y.value;
  Dual<T, N> angle(T(atan2(y.value, x.value)));
  for (std::size_t k = 0; k < N; ++k) angle.slope[k] = (x.value * y.slope[k] - y.value * x.slope[k]) / square;
  return angle;
}

}  // namespace hamflow
