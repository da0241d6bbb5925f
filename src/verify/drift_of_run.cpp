// The drift of a single run, from its own blocks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "drift_class.hpp"

namespace hamflow {

namespace {

/// S(m), the mean square of the changes over m blocks.
double structure_function(const std::vector<double>& x, std::size_t lag) {
  double sum = 0;
  for (std::size_t i = 0; i + lag < x.size(); ++i) sum += (x[i + lag] - x[i]) * (x[i + lag] - x[i]);
  return sum / static_cast<double>(x.size() - lag);
}

/// var(ln S(m)) for a walk of `blocks` increments.
double variance_of_log(std::size_t lag, std::size_t blocks) {
  const double m = static_cast<double>(lag);
  return 2 * (2 * m * m + 1) / (3 * m * static_cast<double>(blocks));
}

struct Growth {
  double exponent = 0;
  double uncertainty = 0;
};

/// @param x deviations from the start, at most 1
Growth growth(const std::vector<double>& x) {
  const std::size_t blocks = x.size() - 1;
  const std::size_t longest = blocks / 2;
  std::size_t shortest = 1;
  for (; 4 * shortest <= longest; shortest *= 2) {  // to where neighbouring increments no longer go the same way
    const double now = structure_function(x, shortest);
    if (now == 0) break;
    const double correlation = (structure_function(x, 2 * shortest) - 2 * now) / (2 * now);
    if (correlation <= 2 * std::sqrt(static_cast<double>(shortest) / static_cast<double>(blocks))) break;
  }
  std::vector<double> log_lag;
  std::vector<double> log_s;
  std::vector<double> weight;
  std::size_t last = 0;
  for (double exact = static_cast<double>(shortest); std::lround(exact) <= static_cast<long>(longest);
       exact *= std::sqrt(2.0)) {
    const auto lag = static_cast<std::size_t>(std::lround(exact));
    const double s = structure_function(x, lag);
    if (lag == last || s == 0) continue;
    log_lag.push_back(std::log(static_cast<double>(lag)));
    log_s.push_back(std::log(s));
    weight.push_back(1 / variance_of_log(lag, blocks));
    last = lag;
  }
  if (log_lag.size() < 2) return {};  // not one bit has changed
  double all = 0;
  double mean_x = 0;
  double mean_y = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    all += weight[i];
    mean_x += weight[i] * log_lag[i];
    mean_y += weight[i] * log_s[i];
  }
  mean_x /= all;
  mean_y /= all;
  double xy = 0;
  double xx = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    xy += weight[i] * (log_lag[i] - mean_x) * (log_s[i] - mean_y);
    xx += weight[i] * (log_lag[i] - mean_x) * (log_lag[i] - mean_x);
  }
  // Lags share their increments, so that the errors of the points are not independent. The constant is measured, on
  // walks of 32 to 128 increments (tests/unit/drift_test.cpp).
  constexpr double measured = 0.9;
  return {xy / xx / 2, measured * std::sqrt(static_cast<double>(shortest) / static_cast<double>(blocks))};
}

/// P of as few ups, or as few downs, among those that changed: both tails of the binomial distribution for 1/2.
double sign_test(const std::vector<double>& x) {
  int up = 0;
  int down = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    up += x[i + 1] > x[i] ? 1 : 0;
    down += x[i + 1] < x[i] ? 1 : 0;
  }
  const int n = up + down;
  double tail = 0;
  for (int k = 0; k <= std::min(up, down); ++k) {
    tail += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) - n * std::log(2.0));
  }
  return std::min(1.0, 2 * tail);
}

}  // namespace

RunDrift classify_run(const std::vector<double>& energies) {
  RunDrift found;
  found.blocks = std::max(0, static_cast<int>(energies.size()) - 1);
  if (found.blocks < RunDrift::fewest_blocks) {
    found.reason =
        fmt::format("{} blocks of steps are too few; a drift class needs {}", found.blocks, RunDrift::fewest_blocks);
    return found;
  }
  double largest = 0;
  bool finite = true;
  for (const double h : energies) {
    finite = finite && std::isfinite(h - energies.front());
    largest = std::max(largest, std::abs(h - energies.front()));
  }
  if (!finite) {
    found.drift = DriftClass::linear;
    found.p_value = found.sign_p_value = 0;
    found.growth_exponent = std::numeric_limits<double>::infinity();
    found.reason = "the energy is not finite";
    return found;
  }
  std::vector<double> x;  // squares neither overflow nor underflow
  for (const double h : energies) x.push_back(largest > 0 ? (h - energies.front()) / largest : 0);

  // The test takes as few blocks as it may: an oscillation of amplitude A leaves 2 A in an increment however long the
  // block, a drift grows with it, and against a walk 32 blocks are nearly as good as 128.
  const std::size_t stride = (x.size() - 1) / RunDrift::fewest_blocks;
  std::vector<double> ends;
  for (std::size_t i = 0; i < x.size(); i += stride) ends.push_back(x[i]);
  const double tested = static_cast<double>(ends.size() - 1);
  const double mean = ends.back() / tested;
  double squares = 0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) squares += std::pow(ends[i + 1] - ends[i] - mean, 2);
  const double per_block = largest / static_cast<double>(stride);
  found.mean_increment = mean * per_block;
  found.mean_increment_error = std::sqrt(squares / (tested - 1) / tested) * per_block;
  found.p_value = increments_p_value(ends);
  found.sign_p_value = sign_test(x);
  const Growth g = growth(x);
  found.growth_exponent = g.exponent;
  found.growth_uncertainty = g.uncertainty;
  const bool one_way = found.sign_p_value < RunDrift::sign_level;
  found.drift = one_way ? DriftClass::linear : drift_class(found.p_value, g.exponent);
  found.reason = found.p_value < DriftStatistics::level ? "the mean increment of a block is not 0"
                 : one_way                              ? "nearly all increments have one sign"
                                                        : fmt::format("the error grows like t^{:.2f}", g.exponent);
  return found;
}

}  // namespace hamflow
