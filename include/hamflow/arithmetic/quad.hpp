// Quadruple precision, IEEE binary128, about 34 digits, by the compiler and libquadmath; in a portable build in
// software.
#pragma once

#include "hamflow/detail/arithmetic/extended.hpp"
#include "hamflow/detail/arithmetic/number_types.hpp"

#ifndef HAMFLOW_PORTABLE
// Declared here and not by <quadmath.h>, which only GCC finds; both compilers link GCC's library.
extern "C" {
__float128 fabsq(__float128) noexcept;
__float128 sqrtq(__float128) noexcept;
__float128 expq(__float128) noexcept;
__float128 logq(__float128) noexcept;
__float128 sinq(__float128) noexcept;
__float128 cosq(__float128) noexcept;
__float128 tanq(__float128) noexcept;
__float128 asinq(__float128) noexcept;
__float128 acosq(__float128) noexcept;
__float128 atanq(__float128) noexcept;
__float128 sinhq(__float128) noexcept;
__float128 coshq(__float128) noexcept;
__float128 tanhq(__float128) noexcept;
__float128 atan2q(__float128, __float128) noexcept;
__float128 powq(__float128, __float128) noexcept;
__float128 ldexpq(__float128, int) noexcept;
__float128 strtoflt128(const char*, char**) noexcept;
int quadmath_snprintf(char*, std::size_t, const char*, ...) noexcept;
}

namespace hamflow {

template <>
struct ExtendedTraits<QuadNumber> {
  using T = QuadNumber;
  static constexpr int digits = 113;
  template <class U>
  static T made(U x) {
    return static_cast<T>(x);
  }
  template <class U>
  static U as(const T& x) {
    return static_cast<U>(x);
  }
  static T add(const T& a, const T& b) { return a + b; }
  static T subtract(const T& a, const T& b) { return a - b; }
  static T multiply(const T& a, const T& b) { return a * b; }
  static T divide(const T& a, const T& b) { return a / b; }
  static T abs(const T& x) { return fabsq(x); }
  static T sqrt(const T& x) { return sqrtq(x); }
  static T exp(const T& x) { return expq(x); }
  static T log(const T& x) { return logq(x); }
  static T sin(const T& x) { return sinq(x); }
  static T cos(const T& x) { return cosq(x); }
  static T tan(const T& x) { return tanq(x); }
  static T asin(const T& x) { return asinq(x); }
  static T acos(const T& x) { return acosq(x); }
  static T atan(const T& x) { return atanq(x); }
  static T sinh(const T& x) { return sinhq(x); }
  static T cosh(const T& x) { return coshq(x); }
  static T tanh(const T& x) { return tanhq(x); }
  static T atan2(const T& y, const T& x) { return atan2q(y, x); }
  static T pow(const T& x, const T& y) { return powq(x, y); }
  static T read(std::string_view text) { return strtoflt128(std::string(text).c_str(), nullptr); }
  /// @param places significant decimal digits; 36 read back as the same number
  static std::string written(const T& x, int places = 36) {
    char buffer[64];
    const int length = quadmath_snprintf(buffer, sizeof buffer, "%.*Qg", places, x);
    return {buffer, static_cast<std::size_t>(length)};
  }
  static T power_of_two(int exponent) { return ldexpq(static_cast<T>(1), exponent); }
  static T epsilon() { return power_of_two(-112); }
  static T max() { return (static_cast<T>(2) - power_of_two(-112)) * power_of_two(16383); }
  static T min() { return power_of_two(-16382); }
  static T infinity() { return static_cast<T>(std::numeric_limits<double>::infinity()); }
  static T nan() { return static_cast<T>(std::numeric_limits<double>::quiet_NaN()); }
};

}  // namespace hamflow
#endif

namespace hamflow {

using Quad = Extended<QuadNumber>;

template <>
inline Quad parse_decimal<Quad>(std::string_view text) {
  return Quad(ExtendedTraits<QuadNumber>::read(text));
}
extern template Quad evaluate_number<Quad>(std::string_view);  // in src/arithmetic/numbers.cpp

}  // namespace hamflow
