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
  explicit constexpr Halves(R x) {
    constexpr R splitter = static_cast<R>(1ULL << ((std::numeric_limits<R>::digits + 1) / 2)) + 1;
    const R large = splitter * x;
    high = large - (large - x);
    low = x - high;
  }
};
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
