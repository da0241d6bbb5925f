// Products whose rounding error is known.   [Dekker1971]
#pragma once

#include <limits>
#include <type_traits>

namespace hamflow {

namespace detail {
/// x as a sum of two numbers of half its digits each, whose products are exact.
template <class R>
struct Halves {
  R high;
  R low;
  /// Inlined always: a call in the middle of an iteration empties the registers, which costs a step of cg a fifth.
  [[gnu::always_inline]] explicit constexpr Halves(R x) {
    constexpr R splitter = static_cast<R>(1ULL << ((std::numeric_limits<R>::digits + 1) / 2)) + 1;
    const R large = splitter * x;
    high = large - (large - x);
    low = x - high;
  }
};

/// Sums over the Gauss points are taken of kappa b_l, and multiplied by h/kappa in the end. The rounding of that
/// product decides whether the last correction of Newton, which is mostly smaller, counts or is lost; so that it counts
/// on average, what is rounded has to have random digits, whatever h is. With h = 1/8 alone there would be none. The
/// golden ratio is the number whose multiples are spread most evenly.
template <class Real>
inline Real golden_ratio() {
  return Real(1.6180339887498949);
}
}  // namespace detail

/// a b - product, where `product` is a b rounded. With hardware's types below 2^900 and no underflow; 0 beyond, and in
/// others, which have digits to spare.
template <class R>
[[gnu::always_inline]] constexpr R product_error(const R& a, const R& b, const R& product) {
  if constexpr (std::is_floating_point_v<R>) {
    const detail::Halves<R> x(a);
    const detail::Halves<R> y(b);
    const R lost = ((x.high * y.high - product) + x.high * y.low + x.low * y.high) + x.low * y.low;
    if (lost == lost) [[likely]]
      return lost;  // no half has overflown
  }
  return R(0);
}

}  // namespace hamflow
