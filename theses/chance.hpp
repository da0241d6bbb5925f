// What a few samples say of all: the sign test, and the share of counter-examples that a search without one leaves
// open.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "claim.hpp"

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

/// The largest share of counter-examples with which a search of n cases finds none in one of twenty searches: the exact
/// binomial bound, 3/n for many ("rule of three").
inline double largest_share_unseen(int n) { return n > 0 ? 1 - std::pow(1 - confidence, 1.0 / n) : 1; }

/// "None does", of all cases there are: one that does refutes it. Where none of those looked at does, as many as the
/// bound leaves among ten others: it holds where that is below a half, one case in twenty, from 59 on.
inline Rule none_of_all(const std::string& what) {
  Rule rule = none_of(what);
  rule.text += "; of those not looked at fewer than one in twenty, 95 % confidence: 59 without one";
  return rule;
}
inline Measured seen_among(int number, int of, const std::string& how) {
  return {static_cast<double>(number), number > 0 ? 0 : 10 * largest_share_unseen(of), how};
}

}  // namespace hamflow::reproduction
