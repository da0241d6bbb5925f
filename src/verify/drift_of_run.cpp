// Finds the drift class of a single run from the energies of its blocks.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "drift_class.hpp"
#include "hamflow/detail/verify/oscillation_counter.hpp"

namespace hamflow {

namespace {

/// Structure function S(m), the mean square of changes over m blocks.
double structure_function(const std::vector<double>& x, std::size_t lag) {
  double sum = 0;
  for (std::size_t i = 0; i + lag < x.size(); ++i) sum += (x[i + lag] - x[i]) * (x[i + lag] - x[i]);
  return sum / static_cast<double>(x.size() - lag);
}

/// Variance of ln S(m) for a random walk of `blocks` increments.
double variance_of_log(std::size_t lag, std::size_t blocks) {
  const double m = static_cast<double>(lag);
  return 2 * (2 * m * m + 1) / (3 * m * static_cast<double>(blocks));
}

struct Growth {
  double exponent = 0;
  double uncertainty = 0;
};

/// @param x deviations from the start, in [-1, 1]
Growth growth(const std::vector<double>& x) {
  const std::size_t blocks = x.size() - 1;
  const std::size_t longest = blocks / 2;
  std::size_t shortest = 1;
  for (; 4 * shortest <= longest; shortest *= 2) {  // until neighbouring increments are no longer correlated
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
  if (log_lag.size() < 2) return {};  // no energy has changed
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
  // Lags share their increments, so the errors of the points are not independent. The constant was measured on random
  // walks of 32 to 128 increments (tests/unit/drift_test.cpp).
  constexpr double measured = 0.9;
  return {xy / xx / 2, measured * std::sqrt(static_cast<double>(shortest) / static_cast<double>(blocks))};
}

/// Returns the probability of at most this many positive, or negative, increments among those that are not 0: both
/// tails of the binomial distribution for 1/2.
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

/// The straight line through a series, and statistics of the residuals.
struct Trend {
  double size = 0;  // change along the line over the whole series, divided by the deviation of the residuals
  // Spearman's rank correlation with time, which does not depend on the height of rare excursions
  double rank = 0;
  double roughness = 0;  // S(1)/(2 variance) of the residuals: 1 for independent values, about 8/B for a random walk
  // of neighbouring increments of the residuals: -1/2 independent values, 0 random walk, 1 smooth
  double correlation = 0;
  double wandering = 0;  // variation between the means of eight parts, see wandering()
};

std::vector<double> ranks(const std::vector<double>& x) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  std::vector<double> rank(x.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && x[order[end]] == x[order[i]]) ++end;
    // equal values share the mean of their ranks
    for (std::size_t k = i; k < end; ++k) rank[order[k]] = static_cast<double>(i + end - 1) / 2;
    i = end;
  }
  return rank;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double count = static_cast<double>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / count;
  const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / count;
  double ab = 0;
  double aa = 0;
  double bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return aa * bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

double increment_correlation(const std::vector<double>& x) {
  const double now = structure_function(x, 1);
  return now > 0 ? (structure_function(x, 2) - 2 * now) / (2 * now) : 0;
}

/// Returns the variance between the means of eight parts of a series, divided by its expected value for independent
/// values: Fisher's F with 7 and B - 8 degrees of freedom. It is the most sensitive test for a random walk beneath
/// noise.
double wandering(const std::vector<double>& x) {
  constexpr std::size_t parts = 8;
  const std::size_t length = x.size() / parts;
  std::vector<double> means;
  double within = 0;
  for (std::size_t part = 0; part < parts; ++part) {
    double mean = 0;
    for (std::size_t i = 0; i < length; ++i) mean += x[part * length + i] / static_cast<double>(length);
    for (std::size_t i = 0; i < length; ++i) within += std::pow(x[part * length + i] - mean, 2);
    means.push_back(mean);
  }
  const double all = std::accumulate(means.begin(), means.end(), 0.0) / parts;
  double between = 0;
  for (const double mean : means) between += (mean - all) * (mean - all);
  within /= static_cast<double>(parts * (length - 1));
  if (within == 0) return between > 0 ? std::numeric_limits<double>::infinity() : 0;
  return between / (parts - 1) * static_cast<double>(length) / within;
}

Trend trend(const std::vector<double>& x) {
  const double count = static_cast<double>(x.size());
  std::vector<double> time(x.size());
  std::iota(time.begin(), time.end(), 0.0);
  const double slope = fitted_slope(time, x);
  std::vector<double> rest(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) rest[i] = x[i] - slope * time[i];
  const double mean = std::accumulate(rest.begin(), rest.end(), 0.0) / count;
  double squares = 0;
  for (const double r : rest) squares += (r - mean) * (r - mean);
  const double variance = squares / (count - 1);
  Trend found;
  const double change = std::abs(slope) * (count - 1);
  found.size = variance > 0 ? change / std::sqrt(variance) : change > 0 ? std::numeric_limits<double>::infinity() : 0;
  found.rank = std::abs(correlation(time, ranks(x)));
  found.roughness = variance > 0 ? structure_function(rest, 1) / (2 * variance) : 0;
  found.correlation = increment_correlation(rest);
  found.wandering = wandering(x);
  return found;
}

/// Returns the periods of an oscillation of the energy that the blocks resolve: its increments are correlated, whereas
/// those of a random walk are not. Turning points are counted in ranks, because the peak at a pericentre of an
/// eccentric orbit is shorter than a block, so its sampled height is random.
std::optional<double> periods_of(const std::vector<double>& x, double correlation) {
  constexpr double resolved = 0.4;
  if (correlation < resolved) return std::nullopt;
  OscillationCounter swings;
  const std::vector<double> rank = ranks(x);
  for (std::size_t i = 0; i < x.size(); ++i) swings.look(static_cast<std::int64_t>(i), rank[i]);
  const auto seen = swings.seen(static_cast<std::int64_t>(x.size()) - 1);
  return seen ? std::optional<double>(seen->periods) : std::nullopt;
}

// Limits between the classes. The confusion table (tools/confusion_table.py) justifies them; HACKING.md shows its
// quantiles.
constexpr double clear_trend = 3;   // Trend::size; an oscillation of two periods has less than 2
constexpr double clear_rank = 0.7;  // of Trend::rank
constexpr double rank_of_a_drift = 0.9;
constexpr double usual_in_walks = 15;  // limits of trend_of_walks()
constexpr double rare_in_walks = 30;
constexpr double no_trend = 1;               // independent values have at most 0.3, rare resonances 0.8
constexpr double no_rank = 0.3;              // 3.4/sqrt(128): four standard deviations of independent values
constexpr double bounded_below = 0.2;        // growth exponent of the class bounded,
constexpr double bounded_below_rough = 0.3;  // the same if the residuals are rougher than those of any random walk
constexpr double rougher_than_walks = 0.3;
constexpr double walk_above = 0.35;
constexpr double walk_below = 0.65;
constexpr double roughest_walk = 0.2;
constexpr double steady_means = 3;  // F(7, B - 8) exceeds it once in 150 to 250 cases
constexpr double rare_means = 6;    // exceeded once in 10^5 cases; needed for an error that does not grow
constexpr double white = 0.25;      // correlation of a random walk's increments: three standard deviations for 128

/// Returns the trend relative to the trend that a random walk, with or without noise, has by chance. For a walk of
/// variance w beneath noise of variance n that chance trend is about sqrt(w/(w + n)), which 1 - roughness measures. Of
/// 20 000 walks of 64 to 255 blocks beneath any noise, 1 in 100 was above 16 and 1 in 10 000 above 30 (walks whose rank
/// correlation with time is above 0.9).
double trend_of_walks(const Trend& t) { return t.size / std::sqrt(std::max(1 - t.roughness, 0.15)); }

/// Returns whether all deviations in the second half of the run are larger than half of the largest deviation.
bool stays_far_from_start(const std::vector<double>& deviations, double largest) {
  return std::all_of(deviations.begin() + static_cast<std::ptrdiff_t>(deviations.size() / 2), deviations.end(),
                     [&](double x) { return std::abs(x) > largest / 2; });
}

/// Returns whether both halves of the run have a trend in the same direction. A single close encounter only leaves a
/// jump in one half.
bool has_trend_in_both_halves(const std::vector<double>& x) {
  constexpr double least = 1.0 / 8;  // fraction of the overall slope, because a drift may slow down
  const auto slope = [&](std::size_t begin, std::size_t end) {
    std::vector<double> time(end - begin);
    std::iota(time.begin(), time.end(), 0.0);
    return fitted_slope(time,
                        {x.begin() + static_cast<std::ptrdiff_t>(begin), x.begin() + static_cast<std::ptrdiff_t>(end)});
  };
  const double whole = slope(0, x.size());
  const double sign = whole < 0 ? -1 : 1;
  const std::size_t middle = x.size() / 2;
  return std::min(sign * slope(0, middle), sign * slope(middle, x.size())) > least * sign * whole;
}

/// Returns whether a trend cannot last, because the method is symplectic: it is too large for roundings to the same
/// side in every operation, and too small for a step size at which the method breaks down.
bool contradicts_symplecticity(const EnergySeries& series, double largest) {
  constexpr double resolved = 1.0 / 16;
  return series.symplectic && largest > 16 * series.rounding * (1 + series.roundings) &&
         largest < resolved * series.scale;
}

struct Conclusion {
  std::optional<DriftClass> drift;
  std::string reason;
};

/// Rounds down, so that a number below a limit is also printed as a number below the limit.
double rounded_down(double x, double unit) { return std::floor(x / unit) * unit; }

Conclusion undecided(std::string reason) { return {std::nullopt, std::move(reason)}; }

Conclusion concluded(const EnergySeries& series, double largest, const RunDrift& found, const Trend& t) {
  const bool t_rejects = found.p_value < DriftStatistics::level;
  const bool sign_rejects = found.sign_p_value < RunDrift::sign_level;
  const double e = found.growth_exponent;
  const char* const steadily = found.mean_increment < 0 ? "the energy falls steadily" : "the energy rises steadily";
  const bool rejected = (t_rejects || sign_rejects) && t.size >= clear_trend && t.rank >= clear_rank;
  const bool is_clear_trend = t.rank > rank_of_a_drift && t.size > clear_trend && trend_of_walks(t) > rare_in_walks;
  if ((rejected || is_clear_trend) && contradicts_symplecticity(series, largest)) {
    return undecided(
        "the energy changes in one direction over the run, but the method is symplectic, so it may be the beginning of "
        "a "
        "slow oscillation");
  }
  if ((rejected || is_clear_trend) && !has_trend_in_both_halves(series.deviations)) {
    return undecided("there is a trend, but in one half of the run the energy does not change");
  }
  if (rejected) {
    return {DriftClass::linear, t_rejects ? steadily : "nearly all increments have one sign"};
  }
  if (is_clear_trend) {
    return {DriftClass::linear,
            fmt::format("a trend of {:.0f} standard deviations of the residuals, more than a random walk has", t.size)};
  }
  if (sign_rejects && series.outgrown && stays_far_from_start(series.deviations, largest)) {
    return {DriftClass::linear, "the energy left its initial value permanently, and the range of the motion grew"};
  }
  if (t_rejects) {
    return undecided(fmt::format("the energy {} on average from block to block, but has no clear trend over the run",
                                 found.mean_increment < 0 ? "falls" : "rises"));
  }
  if (largest > series.scale) return undecided("the energy error is above the scale of the energy itself");
  const std::string grows = fmt::format("the error grows like t^{:.2f}", e);
  const double walk = 16 * series.rounding * (1 + std::sqrt(series.roundings));  // the same bound as for momentum maps
  const bool like_walk =
      e > walk_above && e < walk_below && t.roughness < roughest_walk && std::abs(t.correlation) < white;
  const auto random_walk = [&](const std::string& how) -> Conclusion {
    if (series.rounding_grows) {
      return undecided(how + ", like a random walk so far, but a coordinate and its rounding errors keep growing");
    }
    if (*found.periods < RunDrift::periods_to_be_told) {
      return undecided(how +
                       fmt::format(", like a random walk, but only over {:.1f} periods of the slowest oscillation; "
                                   "this class needs {}",
                                   rounded_down(*found.periods, 0.1), RunDrift::periods_to_be_told));
    }
    return {DriftClass::random_walk, how};
  };
  if (like_walk && largest <= walk) return random_walk(grows);
  if (like_walk) {
    return undecided(
        grows + fmt::format(", like a random walk, but is {:.1e} times larger than rounding explains", largest / walk));
  }
  const bool rounding_alone = largest <= walk && t.correlation < white;
  if (rounding_alone && t.wandering > steady_means && e < walk_below && trend_of_walks(t) < usual_in_walks) {
    const std::string wander = "errors at rounding level vary from part to part of the run";
    // If the error does not grow, stronger evidence is needed, because parts as long as a few periods always differ.
    if (e < bounded_below && !(t.wandering > rare_means && *found.periods >= RunDrift::periods_to_be_told)) {
      return undecided(wander + ", but do not grow; a longer run would decide");
    }
    return random_walk(wander + "; " + grows);
  }
  if (t.size >= no_trend || t.rank >= no_rank) {
    return undecided(fmt::format(
        "there is a trend (rank correlation with time {:.2f}), but the increments do not prove a drift", t.rank));
  }
  const bool grows_not = e < bounded_below || (e < bounded_below_rough && t.roughness > rougher_than_walks);
  if (!grows_not) {
    return undecided(grows + fmt::format(" +- {:.2f}, which is between the classes", found.growth_uncertainty));
  }
  // At this error level a random walk or a trend of the roundings would not be visible. Roundings that grow with a
  // coordinate sum up like t^(3/2), to 64 times as much in a run 16 times as long; `walk` already includes a factor of
  // 16.
  if (largest <= std::max(32 * series.rounding, series.rounding_grows ? 4 * walk : walk / 4)) {
    return undecided("errors at rounding level; only a longer run can show how they sum up");
  }
  if (series.still > 0) {
    return undecided(
        fmt::format("the oscillations have ended: there was no turning point in the last {:.2g} % of the run",
                    rounded_down(100 * series.still, 0.1)));
  }
  if (series.bounces) {
    return undecided("no drift is seen, but the energy of this method makes a random walk from bounce to bounce");
  }
  if (series.copies) {
    return undecided(
        "no drift is seen, but in a longer run the state may separate from the copy that the method carries");
  }
  if (!series.steady) return undecided("the range of the motion has grown beyond the oscillations that were seen");
  if (*found.periods < RunDrift::periods_to_be_told) {
    return undecided(
        fmt::format("no drift is seen, but over only {:.1f} periods of the slowest oscillation a small one cannot be "
                    "excluded; the class bounded needs {}",
                    rounded_down(*found.periods, 0.1), RunDrift::periods_to_be_told));
  }
  return {DriftClass::bounded, grows + fmt::format(" over {:.0f} {}", *found.periods, series.counted)};
}

}  // namespace

RunDrift classify_run(const EnergySeries& series) {
  RunDrift found;
  found.periods = series.periods;
  found.blocks = std::max(0, static_cast<int>(series.deviations.size()) - 1);
  if (found.blocks < RunDrift::fewest_blocks) {
    found.reason = fmt::format("{} block{} of steps {} too few; a drift class needs {}", found.blocks,
                               found.blocks == 1 ? "" : "s", found.blocks == 1 ? "is" : "are", RunDrift::fewest_blocks);
    return found;
  }
  double largest = 0;
  bool finite = true;
  for (const double h : series.deviations) {
    finite = finite && std::isfinite(h);
    largest = std::max(largest, std::abs(h));
  }
  Conclusion conclusion;
  if (!finite) {
    found.p_value = found.sign_p_value = 0;
    found.growth_exponent = std::numeric_limits<double>::infinity();
    conclusion = {DriftClass::linear, "the energy is not finite"};
  } else {
    std::vector<double> x;  // scaled, so that squares neither overflow nor underflow
    for (const double h : series.deviations) x.push_back(largest > 0 ? h / largest : 0);
    // The test uses the smallest number of blocks. An oscillation of amplitude A changes an increment by at most 2 A
    // for any length of the block, whereas a drift grows with the length. For a random walk 32 blocks are nearly as
    // good as 128.
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
    found.trend_not_excluded =
        std::abs(found.mean_increment) +
        student_quantile(DriftStatistics::level, static_cast<int>(tested) - 1) * found.mean_increment_error;
    found.p_value = increments_p_value(ends);
    found.sign_p_value = sign_test(x);
    const Growth g = growth(x);
    found.growth_exponent = g.exponent;
    found.growth_uncertainty = g.uncertainty;
    const Trend t = trend(x);
    const auto own = periods_of(x, t.correlation);
    if (own && (!found.periods || *own < *found.periods)) found.periods = own;
    if (found.periods) conclusion = concluded(series, largest, found, t);
  }
  if (!found.periods) {
    conclusion = undecided("no oscillation was seen: there was no turning point");
  } else if (*found.periods <= 0.5) {  // only a single turn is known
    conclusion = undecided(fmt::format("the slowest oscillation has turned only once; a drift class needs {} periods",
                                       RunDrift::fewest_periods));
  } else if (*found.periods == 1) {
    conclusion = undecided(fmt::format("1 period of the slowest oscillation is too few; a drift class needs {}",
                                       RunDrift::fewest_periods));
  } else if (*found.periods < RunDrift::fewest_periods) {
    conclusion = undecided(fmt::format("{:.3g} periods of the slowest oscillation are too few; a drift class needs {}",
                                       rounded_down(*found.periods, 0.01), RunDrift::fewest_periods));
  }
  found.drift = conclusion.drift;
  found.reason = conclusion.reason;
  return found;
}

}  // namespace hamflow
