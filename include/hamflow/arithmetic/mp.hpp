// Multiple precision with a number of digits chosen at run time, by MPFR.
// The number of digits is a property of the thread. Code that computes in Mp runs inside an MpDigits scope, and every
// number made there, including results, has these digits. A number beyond 10^(10^6) becomes infinite. Operations are
// compiled only once (src/arithmetic/mp.cpp): the cost of a call is negligible, and problems compile faster.
#pragma once

#include <mpfr.h>

#include <utility>

#include "hamflow/detail/arithmetic/extended.hpp"
#include "hamflow/detail/core/archive.hpp"

namespace hamflow {

/// An MPFR number with value semantics. MPFR does not throw; out of memory, it ends the program. Functions are declared
/// noexcept, so that the compiler needs no unwinding code within expressions.
class MpNumber {
 public:
  MpNumber() noexcept;  // 0
  MpNumber(const MpNumber& other) noexcept;
  MpNumber(MpNumber&& other) noexcept;
  MpNumber& operator=(const MpNumber& other) noexcept;
  MpNumber& operator=(MpNumber&& other) noexcept {
    std::swap(*number_, *other.number_);
    return *this;
  }
  ~MpNumber();
  mpfr_ptr raw() noexcept { return number_; }
  mpfr_srcptr raw() const noexcept { return number_; }

  friend MpNumber operator-(const MpNumber& a) noexcept;
  friend bool operator==(const MpNumber& a, const MpNumber& b) noexcept { return mpfr_equal_p(a.raw(), b.raw()) != 0; }
  friend bool operator<(const MpNumber& a, const MpNumber& b) noexcept { return mpfr_less_p(a.raw(), b.raw()) != 0; }
  friend bool operator>(const MpNumber& a, const MpNumber& b) noexcept { return mpfr_greater_p(a.raw(), b.raw()) != 0; }
  friend bool operator<=(const MpNumber& a, const MpNumber& b) noexcept {
    return mpfr_lessequal_p(a.raw(), b.raw()) != 0;
  }
  friend bool operator>=(const MpNumber& a, const MpNumber& b) noexcept {
    return mpfr_greaterequal_p(a.raw(), b.raw()) != 0;
  }

 private:
  mpfr_t number_;
};

/// The decimal digits of numbers made in this thread, until the scope ends.
class MpDigits {
 public:
  static constexpr int fewest = 2;
  static constexpr int most = 100000;
  explicit MpDigits(int digits);
  ~MpDigits();
  MpDigits(const MpDigits&) = delete;
  MpDigits& operator=(const MpDigits&) = delete;
  /// The binary digits in use in this thread.
  static mpfr_prec_t bits();

 private:
  mpfr_prec_t before_;
};

/// The number of decimal digits from which a number with the given bits reads back.
std::size_t decimal_places(mpfr_prec_t bits);

template <>
struct ExtendedTraits<MpNumber> {
  using T = MpNumber;
  static constexpr int digits = 0;
  template <class U>
  static T made(U x) noexcept {
    if constexpr (std::is_same_v<U, long double>) {
      return from(x);
    } else if constexpr (std::is_integral_v<U>) {
      return from(static_cast<long>(x));
    } else {
      return from(static_cast<double>(x));
    }
  }
  template <class U>
  static U as(const T& x) noexcept {
    return static_cast<U>(mpfr_get_ld(x.raw(), MPFR_RNDN));
  }
  static T from(long x) noexcept;
  static T from(double x) noexcept;
  static T from(long double x) noexcept;
  static T add(const T& a, const T& b) noexcept;
  static T subtract(const T& a, const T& b) noexcept;
  static T multiply(const T& a, const T& b) noexcept;
  static T divide(const T& a, const T& b) noexcept;
  static T abs(const T& x) noexcept;
  static T sqrt(const T& x) noexcept;
  static T exp(const T& x) noexcept;
  static T log(const T& x) noexcept;
  static T sin(const T& x) noexcept;
  static T cos(const T& x) noexcept;
  static T tan(const T& x) noexcept;
  static T asin(const T& x) noexcept;
  static T acos(const T& x) noexcept;
  static T atan(const T& x) noexcept;
  static T sinh(const T& x) noexcept;
  static T cosh(const T& x) noexcept;
  static T tanh(const T& x) noexcept;
  static T atan2(const T& y, const T& x) noexcept;
  static T pow(const T& x, const T& y) noexcept;
  static T pi() noexcept;
  static T read(std::string_view text);
  /// The number in decimal, with enough digits to read back as the same number.
  static std::string written(const T& x);
  /// 1 and the next larger number differ by this.
  static T epsilon() noexcept;
  static T max() noexcept;
  static T min() noexcept;
  static T infinity() noexcept;
  static T nan() noexcept;
};

template <>
inline double ExtendedTraits<MpNumber>::as<double>(const MpNumber& x) noexcept {
  return mpfr_get_d(x.raw(), MPFR_RNDN);  // one rounding, not two
}

using Mp = Extended<MpNumber>;

/// log2 |x| as for other numbers (core/math.hpp).
double binary_logarithm(const Mp& x);

/// The text of a number in a checkpoint: hexadecimal, with its precision.
std::string exact_text(const Mp& x);
void from_exact_text(const std::string& text, Mp& x);
template <>
struct ArchivedNumber<Mp> : ArchivedText<Mp> {};

template <>
inline long precision_in_use<Mp>() {
  return static_cast<long>(MpDigits::bits());
}
template <>
inline Mp pi_value<Mp>() {
  return Mp(ExtendedTraits<MpNumber>::pi());
}
template <>
inline Mp parse_decimal<Mp>(std::string_view text) {
  return Mp(ExtendedTraits<MpNumber>::read(text));
}
extern template Mp evaluate_number<Mp>(std::string_view);  // in src/arithmetic/numbers.cpp

}  // namespace hamflow
