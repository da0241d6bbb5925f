// What a few samples say of all: the sign test, and the share of counter-examples that a search without one leaves
// open.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "hamflow/reproduce/claim.hpp"

namespace hamflow::reproduction {

/// Of what is concluded; chance alone leads to the opposite in one of twenty studies.
inline constexpr double confidence = 0.95;

/// P of so many heads or fewer among n tosses of a fair coin.
inline double chance_of_at_most(int heads, int n) {
  double sum = 0;
  for (int k = 0; k <= heads; ++k) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) - n * std::log(2.0));
  }
  return sum;
}

/// How far from n/2 a count may be before chance does not explain it, the sign test on both sides: half a case beyond
/// the farthest count that chance explains. What n cases cannot show at all is beyond n.
inline double sign_test_uncertainty(int n) {
  int fewest = n / 2;  // of the counts up to n/2 the least that chance explains
  while (fewest >= 0 && 2 * chance_of_at_most(fewest, n) > 1 - confidence) --fewest;
  return n / 2.0 - (fewest + 1) + 0.5;
}

/// "More than half": of the cases that differ at all. At least half of them by more than the sign test's uncertainty,
/// which half of them, or a few more, never are.
struct Majority {
  int with = 0, against = 0;

  void count(double a, double b) {  // a < b is with it
    with += a < b ? 1 : 0;
    against += a > b ? 1 : 0;
  }
  Rule rule(const std::string& what) const {
    Rule all{"number of " + what +
             " above half of those that differ by more than chance allows: sign test, two-sided, 5 %"};
    all.low = (with + against) / 2.0;
    return all;
  }
  Measured measured(const std::string& how) const {
    return {static_cast<double>(with), sign_test_uncertainty(with + against),
            std::to_string(with) + " with, " + std::to_string(against) + " against; " + how + "; +- of the sign test"};
  }
};

}  // namespace hamflow::reproduction
