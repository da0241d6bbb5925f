// Binary floating point in software, for builds without libquadmath, MPFR and the 80-bit long double of x86
// (HAMFLOW_PORTABLE). Sums, products, quotients and square roots are rounded correctly, to even. Computed by
// Boost.Multiprecision in src/portable/soft_float.cpp, so that its headers and operators stay there.
#pragma once

#include <cstddef>

#include "hamflow/detail/arithmetic/extended.hpp"

namespace hamflow {

/// @param binary digits of the mantissa   @param largest_exponent exponents reach from 1 - largest_exponent to it
template <int binary, int largest_exponent>
class SoftFloat {
 public:
  SoftFloat() : SoftFloat(0LL) {}
  explicit SoftFloat(double x);
  explicit SoftFloat(long double x);
  explicit SoftFloat(long long x);
  explicit SoftFloat(unsigned long long x);
  explicit SoftFloat(const std::string& decimal);
  explicit operator double() const;
  explicit operator long double() const;

  SoftFloat operator-() const;
  SoftFloat operator+(const SoftFloat& b) const;
  SoftFloat operator-(const SoftFloat& b) const;
  SoftFloat operator*(const SoftFloat& b) const;
  SoftFloat operator/(const SoftFloat& b) const;
  bool operator==(const SoftFloat& b) const;
  bool operator<(const SoftFloat& b) const;
  bool operator>(const SoftFloat& b) const { return b < *this; }
  bool operator<=(const SoftFloat& b) const;
  bool operator>=(const SoftFloat& b) const { return b <= *this; }

  /// The number of Boost, of which this holds the bytes; defined in src/portable/boost_float.hpp.
  template <class Boost>
  static SoftFloat holding(const Boost& x);
  template <class Boost>
  Boost held() const;

 private:
  struct Nothing {};
  explicit SoftFloat(Nothing) {}
  std::byte bytes_[static_cast<std::size_t>(binary + 63) / 64 * 8 + 40];
};

template <int binary, int largest_exponent>
struct ExtendedTraits<SoftFloat<binary, largest_exponent>> {
  using T = SoftFloat<binary, largest_exponent>;
  static constexpr int digits = binary;
  template <class U>
  static T made(U x) {
    if constexpr (std::is_same_v<U, long double>)
      return T(x);
    else if constexpr (std::is_floating_point_v<U>)
      return T(static_cast<double>(x));
    else if constexpr (std::is_signed_v<U>)
      return T(static_cast<long long>(x));
    else
      return T(static_cast<unsigned long long>(x));
  }
  template <class U>
  static U as(const T& x) {
    if constexpr (std::is_same_v<U, double>)
      return static_cast<double>(x);
    else
      return static_cast<U>(static_cast<long double>(x));
  }
  static T add(const T& a, const T& b) { return a + b; }
  static T subtract(const T& a, const T& b) { return a - b; }
  static T multiply(const T& a, const T& b) { return a * b; }
  static T divide(const T& a, const T& b) { return a / b; }
  static T abs(const T& x);
  static T sqrt(const T& x);
  static T exp(const T& x);
  static T log(const T& x);
  static T sin(const T& x);
  static T cos(const T& x);
  static T tan(const T& x);
  static T asin(const T& x);
  static T acos(const T& x);
  static T atan(const T& x);
  static T sinh(const T& x);
  static T cosh(const T& x);
  static T tanh(const T& x);
  static T atan2(const T& y, const T& x);
  static T pow(const T& x, const T& y);
  static T pi();
  static T read(std::string_view text) { return T(std::string(text)); }
  /// With as many decimal digits as read back as the same number.
  static std::string written(const T& x);
  static T epsilon();
  static T max();
  static T min();
  static T infinity();
  static T nan();
};

}  // namespace hamflow
