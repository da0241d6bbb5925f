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

/// a b + c rounded once, for c of at most the size of a b's rounding error or little more. a b alone would be rounded
/// first, and a smaller c mostly be lost. With hardware's types below 2^900 and no underflow; in others, which have
/// digits to spare, a b + c as it is.
template <class R>
[[gnu::always_inline]] constexpr R product_plus_small(const R& a, const R& b, const R& c) {
  const R product = a * b;
  if constexpr (std::is_floating_point_v<R>) {
    const detail::Halves<R> x(a);
    const detail::Halves<R> y(b);
    const R lost = ((x.high * y.high - product) + x.high * y.low + x.low * y.high) + x.low * y.low;
    const R sum = product + (lost + c);
    if (sum == sum) [[likely]]
      return sum;  // no half has overflown
  }
  return product + c;
}

}  // namespace hamflow
