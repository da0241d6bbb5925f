// Statistics of samples: the sign test, and the largest share of counter-examples that a search without a finding
// allows.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "claim.hpp"

namespace hamflow::reproduction {

/// The confidence level of all conclusions: chance alone causes a wrong conclusion in one of twenty studies.
inline constexpr double confidence = 0.95;

/// The probability of at most `heads` heads in n tosses of a fair coin.
inline double chance_of_at_most(int heads, int n) {
  double sum = 0;
  for (int k = 0; k <= heads; ++k) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) - n * std::log(2.0));
  }
  return sum;
}

/// The largest distance of a count from n/2 that chance explains, by the two-sided sign test, plus one half. If n cases
/// are too few for any conclusion, it is larger than n/2.
inline double sign_test_uncertainty(int n) {
  int fewest = n / 2;  // ends one below the smallest count that chance explains
  while (fewest >= 0 && 2 * chance_of_at_most(fewest, n) > 1 - confidence) --fewest;
  return n / 2.0 - (fewest + 1) + 0.5;
}

/// Counts the cases for and against a statement "more than half ...". Ties do not count. The rule asks for more than
/// half of the cases by more than the uncertainty of the sign test, so that slightly more than half leave it undecided.
struct Majority {
  int with = 0, against = 0;

  void count(double a, double b) {  // a < b counts for the statement
    with += a < b ? 1 : 0;
    against += a > b ? 1 : 0;
  }
  Rule rule(const std::string& what) const {
    Rule all{"number of " + what +
             "; it has to exceed half of those that differ by more than chance allows (two-sided sign test, 5 %)"};
    all.low = (with + against) / 2.0;
    return all;
  }
  Measured measured(const std::string& how) const {
    return {static_cast<double>(with), sign_test_uncertainty(with + against),
            std::to_string(with) + " with, " + std::to_string(against) + " against; " + how + "; +- by the sign test"};
  }
};

/// The upper bound (95 % confidence) for the share of counter-examples after a search of n cases found none. This is
/// the exact binomial bound; it is about 3/n for large n ("rule of three").
inline double largest_share_unseen(int n) { return n > 0 ? 1 - std::pow(1 - confidence, 1.0 / n) : 1; }

/// The rule for the statement that no case does something. One counter-example refutes it. If the cases searched have
/// none, the uncertainty is the number of counter-examples that the bound allows in ten other cases. The statement
/// holds if this is below 1/2, that is one in twenty, which needs 59 cases.
inline Rule none_of_all(const std::string& what) {
  Rule rule = none_of(what);
  rule.text += "; with 95 % confidence fewer than one in twenty of all cases, which takes 59 cases without one";
  return rule;
}
inline Measured seen_among(int number, int of, const std::string& how) {
  return {static_cast<double>(number), number > 0 ? 0 : 10 * largest_share_unseen(of), how};
}

}  // namespace hamflow::reproduction
