// Products with their rounding errors.   [Dekker1971]
#pragma once

#include <limits>
#include <type_traits>

namespace hamflow {

namespace detail {
/// x as a sum of two numbers with half of its digits each, whose products are exact.
template <class R>
struct Halves {
  R high;
  R low;
  /// Always inlined: a call within the iteration spills the registers, which costs a fifth of a step of cg.
  [[gnu::always_inline]] explicit constexpr Halves(R x) {
    constexpr R splitter = static_cast<R>(1ULL << ((std::numeric_limits<R>::digits + 1) / 2)) + 1;
    const R large = splitter * x;
    high = large - (large - x);
    low = x - high;
  }
};

/// kappa. Sums over the Gauss points use the weights kappa b_l and are multiplied by h/kappa at the end. The last
/// correction of Newton's method is usually smaller than the rounding of this product, which decides whether the
/// correction counts or is lost. It counts on average only if the digits of the product are random for any h; without
/// kappa, h = 1/8 would not change a digit. Multiples of the golden ratio are distributed most evenly.
template <class Real>
inline Real golden_ratio() {
  return Real(1.6180339887498949);
}
}  // namespace detail

/// a b - product, where `product` is a b rounded. For hardware types below 2^900 without underflow; 0 beyond that and
/// for other types, which have enough digits.
template <class R>
[[gnu::always_inline]] constexpr R product_error(const R& a, const R& b, const R& product) {
  if constexpr (std::is_floating_point_v<R>) {
    const detail::Halves<R> x(a);
    const detail::Halves<R> y(b);
    const R lost = ((x.high * y.high - product) + x.high * y.low + x.low * y.high) + x.low * y.low;
    if (lost == lost) [[likely]]
      return lost;  // no half has overflowed
  }
  return R(0);
}

}  // namespace hamflow
