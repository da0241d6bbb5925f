// The numbers behind Mp: MPFR's or, in a portable build, numbers of one length.
#pragma once

#include "hamflow/detail/arithmetic/extended.hpp"

#ifdef HAMFLOW_PORTABLE
#include "hamflow/detail/arithmetic/soft_float.hpp"

namespace hamflow {

/// Of 126 decimal digits, whatever MpDigits says: what is computed with the digits of texts, but no run.
using MpNumber = SoftFloat<420, 1 << 28>;

}  // namespace hamflow
#else
#include <mpfr.h>

#include <utility>

namespace hamflow {

/// An MPFR number as a value. MPFR throws nothing: where memory ends, it ends the program. Said here, it spares what
/// computes with such numbers a way out of the middle of every expression.
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
  /// As many decimal digits as read back as the same number.
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

}  // namespace hamflow
#endif
