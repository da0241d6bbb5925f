// Multiple precision with a number of digits chosen at run time, by MPFR.
// The number of digits is a property of the thread. Code that computes in Mp runs inside an MpDigits scope, and every
// number made there, including results, has these digits. A number beyond 10^(10^6) becomes infinite. Operations are
// compiled only once (src/arithmetic/mp.cpp): the cost of a call is negligible, and problems compile faster.
#pragma once

#include "hamflow/detail/arithmetic/extended.hpp"
#include "hamflow/detail/arithmetic/mp_number.hpp"
#include "hamflow/detail/core/archive.hpp"

namespace hamflow {

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
  static long bits();

 private:
  long before_;
};

/// The number of decimal digits from which a number with the given bits reads back.
std::size_t decimal_places(long bits);

using Mp = Extended<MpNumber>;

/// log2 |x| as for other numbers (core/math.hpp).
double binary_logarithm(const Mp& x);

/// In scientific notation. @param places behind the point
std::string scientific_text(const Mp& x, int places);

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
