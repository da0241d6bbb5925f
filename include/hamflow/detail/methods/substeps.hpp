// The sub-steps of one step of an adaptive method. Lengths are fractions of the step, in double for every arithmetic,
// and multiples of 2^-50, so that their sums are exact and the last sub-step ends exactly at the end of the step.
#pragma once

#include <cmath>
#include <type_traits>

namespace hamflow {

/// Converts a finite double exactly to R, which has at least 53 bits but may convert only from int.
template <class R>
R exact_number(double x) {
  if constexpr (std::is_floating_point_v<R>) {
    return static_cast<R>(x);
  } else {
    int exponent = 0;
    const double mantissa = std::frexp(x, &exponent) * 0x1p26;  // 53 bits: 26 before the binary point and 27 after it
    const int high = static_cast<int>(mantissa);
    const int low = static_cast<int>((mantissa - high) * 0x1p27);
    R value = R(high) + R(low) / R(1 << 27);
    for (exponent -= 26; exponent > 0; --exponent) value = value * R(2);
    for (; exponent < 0; ++exponent) value = value / R(2);
    return value;
  }
}

class Substeps {
 public:
  static constexpr double shortest = 0x1p-50;

  bool finished() const { return done_ >= 1; }
  int taken() const { return taken_; }
  double done() const { return done_; }

  /// The next sub-step: the rest of the step in equal parts not longer than `allowed`; 0 if `allowed` is too short.
  double next(double allowed) const {
    const double rest = 1 - done_;
    if (allowed >= rest) return rest;
    if (!(allowed >= shortest)) return 0;
    return std::floor(rest / std::ceil(rest / allowed) * 0x1p50) * 0x1p-50;
  }
  void take(double part) {
    done_ += part;
    ++taken_;
  }

 private:
  double done_ = 0;
  int taken_ = 0;
};

}  // namespace hamflow
