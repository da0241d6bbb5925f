// Comparisons with a stated bound.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hamflow::test {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();
inline constexpr long double long_epsilon = std::numeric_limits<long double>::epsilon();

/// |a - b| <= bound. The bound is a multiple of epsilon times the size of the terms, said at the place of use.
inline ::testing::AssertionResult within(long double a, long double b, long double bound) {
  const long double distance = std::fabs(a - b);
  if (distance <= bound) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << static_cast<double>(a) << " and " << static_cast<double>(b) << " are "
                                       << static_cast<double>(distance) << " apart, allowed "
                                       << static_cast<double>(bound);
}

/// a == b to `units` roundings of R at the size of b.
template <class R>
::testing::AssertionResult same_to_rounding(R a, R b, R units) {
  return within(a, b, units * std::numeric_limits<R>::epsilon() * std::fabs(b));
}

/// What f throws, as text; "nothing thrown" when it does not.
template <class E, class F>
std::string message_of(F&& f) {
  try {
    f();
  } catch (const E& error) {
    return error.what();
  }
  return "nothing thrown";
}

}  // namespace hamflow::test
