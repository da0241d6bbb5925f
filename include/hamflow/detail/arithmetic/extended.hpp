// Number types with more digits than double, in one wrapper: Extended<T> around QD's dd_real, libquadmath's __float128
// or an MPFR number gives them the same operators, conversions and functions, so that problems and methods do not
// depend on the type. The differences are in ExtendedTraits<T> (double_double.hpp, quad.hpp, mp.hpp).
#pragma once

#include <compare>
#include <limits>
#include <string>
#include <type_traits>

#include "hamflow/core/math.hpp"
#include "hamflow/core/number.hpp"

namespace hamflow {

/// The functions that a library provides for its numbers: made(x) from any built-in number, as<U>(x) back, add,
/// subtract, multiply, divide, the elementary functions, read(text), written(x) with all digits, and the limits.
template <class T>
struct ExtendedTraits;

template <class T>
class Extended {
  using Traits = ExtendedTraits<T>;
  template <class U>
  static constexpr bool built_in = std::is_arithmetic_v<U>;

 public:
  T value{};

  Extended() = default;
  explicit Extended(const T& x) : value(x) {}
  template <class U>
  requires built_in<U> Extended(U x) : value(Traits::made(x)) {}  // NOLINT: every built-in number is one of these
  template <class U>
  requires built_in<U>
  explicit operator U() const { return Traits::template as<U>(value); }

  friend Extended operator-(const Extended& a) { return Extended(-a.value); }
  friend Extended operator+(const Extended& a) { return a; }
  friend Extended operator+(const Extended& a, const Extended& b) { return Extended(Traits::add(a.value, b.value)); }
  friend Extended operator-(const Extended& a, const Extended& b) {
    return Extended(Traits::subtract(a.value, b.value));
  }
  friend Extended operator*(const Extended& a, const Extended& b) {
    return Extended(Traits::multiply(a.value, b.value));
  }
  friend Extended operator/(const Extended& a, const Extended& b) { return Extended(Traits::divide(a.value, b.value)); }
  Extended& operator+=(const Extended& b) { return *this = *this + b; }
  Extended& operator-=(const Extended& b) { return *this = *this - b; }
  Extended& operator*=(const Extended& b) { return *this = *this * b; }
  Extended& operator/=(const Extended& b) { return *this = *this / b; }

  friend constexpr bool operator==(const Extended& a, const Extended& b) { return a.value == b.value; }
  friend bool operator<(const Extended& a, const Extended& b) { return a.value < b.value; }
  friend bool operator>(const Extended& a, const Extended& b) { return a.value > b.value; }
  friend bool operator<=(const Extended& a, const Extended& b) { return a.value <= b.value; }
  friend bool operator>=(const Extended& a, const Extended& b) { return a.value >= b.value; }

  friend Extended abs(const Extended& x) { return Extended(Traits::abs(x.value)); }
  friend Extended sqrt(const Extended& x) { return Extended(Traits::sqrt(x.value)); }
  friend Extended exp(const Extended& x) { return Extended(Traits::exp(x.value)); }
  friend Extended log(const Extended& x) { return Extended(Traits::log(x.value)); }
  friend Extended sin(const Extended& x) { return Extended(Traits::sin(x.value)); }
  friend Extended cos(const Extended& x) { return Extended(Traits::cos(x.value)); }
  friend Extended tan(const Extended& x) { return Extended(Traits::tan(x.value)); }
  friend Extended asin(const Extended& x) { return Extended(Traits::asin(x.value)); }
  friend Extended acos(const Extended& x) { return Extended(Traits::acos(x.value)); }
  friend Extended atan(const Extended& x) { return Extended(Traits::atan(x.value)); }
  friend Extended sinh(const Extended& x) { return Extended(Traits::sinh(x.value)); }
  friend Extended cosh(const Extended& x) { return Extended(Traits::cosh(x.value)); }
  friend Extended tanh(const Extended& x) { return Extended(Traits::tanh(x.value)); }
  friend Extended atan2(const Extended& y, const Extended& x) { return Extended(Traits::atan2(y.value, x.value)); }
  friend Extended pow(const Extended& x, const Extended& y) { return Extended(Traits::pow(x.value, y.value)); }
};

template <class R>
struct IsExtended : std::false_type {};
template <class T>
struct IsExtended<Extended<T>> : std::true_type {};

/// Returns a number as text with enough digits to read back as the same number.
template <class T>
std::string written_digits(const Extended<T>& x) {
  return ExtendedTraits<T>::written(x.value);
}

}  // namespace hamflow

template <class T>
struct std::numeric_limits<hamflow::Extended<T>> {
  using R = hamflow::Extended<T>;
  using Traits = hamflow::ExtendedTraits<T>;
  static constexpr bool is_specialized = true;
  static constexpr bool is_signed = true;
  static constexpr bool is_integer = false;
  static constexpr bool is_exact = false;
  static constexpr bool has_infinity = true;
  static constexpr bool has_quiet_NaN = true;
  static constexpr int digits = Traits::digits;  // binary; 0: chosen at run time
  static R epsilon() { return R(Traits::epsilon()); }
  static R max() { return R(Traits::max()); }
  static R lowest() { return R(-Traits::max()); }
  static R min() { return R(Traits::min()); }
  static R infinity() { return R(Traits::infinity()); }
  static R quiet_NaN() { return R(Traits::nan()); }
};
