#include "hamflow/verify/log_certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/detail/verify/oscillation_counter.hpp"
#include "rounding.hpp"

namespace hamflow {

namespace {

constexpr std::size_t most_log_blocks = 256;  // the same as in EnergyBlocks
constexpr std::uint64_t log_seed = 1686;  // arbitrary but fixed, because the places of the samples affect the result

/// Returns a random place in the first half of a block, from 0 to 1/2. With equidistant samples, nearly a whole number
/// of periods apart, an oscillation would look like a drift.
double place_in_block(std::size_t block) { return static_cast<double>(counter_bits(log_seed, block) >> 11) * 0x1p-54; }

void check_finite(const std::vector<double>& numbers, const char* name) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::isfinite(numbers[i])) continue;
    throw Error(fmt::format("{}[{}]: found {}; allowed finite numbers", name, i, numbers[i]));
  }
}

void check_log(const std::vector<double>& t, const std::vector<double>& energy, const std::optional<double>& scale) {
  if (t.size() != energy.size()) {
    throw Error(fmt::format("found {} times and {} energies; allowed equal numbers", t.size(), energy.size()));
  }
  if (t.size() < 2) {
    throw Error(fmt::format("found {} sample{}; allowed at least 2, and a drift class needs {}", t.size(),
                            t.size() == 1 ? "" : "s", RunDrift::fewest_blocks + 1));
  }
  check_finite(t, "t");
  check_finite(energy, "energy");
  if (const auto at = first_time_that_does_not_rise(t)) {
    throw Error(fmt::format("t[{}]: found {} after {}; allowed strictly increasing times", *at, t[*at], t[*at - 1]));
  }
  if (scale && !(*scale > 0 && std::isfinite(*scale))) {
    throw Error(fmt::format("scale: found {}; allowed a positive number", *scale));
  }
}

/// Returns whether the times are equidistant up to the rounding of printed numbers.
bool is_equidistant(const std::vector<double>& t) {
  constexpr double rounded = 1e-3;  // relative to the spacing
  const double apart = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (std::abs(t[i] - t.front() - static_cast<double>(i) * apart) > rounded * apart) return false;
  }
  return true;
}

/// Returns the indices of one sample in each of up to 256 blocks of equal duration, starting with the first sample.
std::vector<std::size_t> equidistant_blocks(std::size_t samples) {
  const std::size_t stride = (samples - 1 + most_log_blocks - 1) / most_log_blocks;
  std::vector<std::size_t> chosen{0};
  for (std::size_t block = 1; block * stride < samples; ++block) {
    const auto moved = static_cast<std::size_t>(place_in_block(block) * static_cast<double>(stride));
    chosen.push_back(std::min(block * stride + moved, samples - 1));
  }
  return chosen;
}

/// The same for times that are not equidistant. Empty if a gap is so long that a block has no sample in its first half.
std::vector<std::size_t> resampled_blocks(const std::vector<double>& t) {
  double longest = 0;
  for (std::size_t i = 1; i < t.size(); ++i) longest = std::max(longest, t[i] - t[i - 1]);
  const double whole = t.back() - t.front();
  const auto blocks = static_cast<std::size_t>(std::min(whole / (2 * longest), static_cast<double>(most_log_blocks)));
  std::vector<std::size_t> chosen;
  if (blocks <= static_cast<std::size_t>(RunDrift::fewest_blocks)) return chosen;
  chosen.push_back(0);
  for (std::size_t block = 1; block < blocks; ++block) {
    const double at =
        t.front() + whole * (static_cast<double>(block) + place_in_block(block)) / static_cast<double>(blocks);
    const auto next = std::lower_bound(t.begin(), t.end(), at);
    const auto place = static_cast<std::size_t>(next - t.begin());
    if (place > chosen.back() && place < t.size()) chosen.push_back(place);
  }
  return chosen;
}

std::vector<double> ranks_of(const std::vector<double>& x) {
  std::vector<double> sorted = x;
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> ranks;
  for (const double each : x) {
    const auto [first, last] = std::equal_range(sorted.begin(), sorted.end(), each);
    ranks.push_back(static_cast<double>((first - sorted.begin()) + (last - sorted.begin()) - 1) / 2);
  }
  return ranks;
}

/// Counts oscillations of the rate at which the energy changes from block to block, in the ranks of the rates. So a
/// drift has no influence on the count, and the height of rare peaks has little.
std::optional<double> periods_of_rate(const std::vector<double>& t, const std::vector<double>& x) {
  std::vector<double> rate;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) rate.push_back((x[i + 1] - x[i]) / (t[i + 1] - t[i]));
  const std::vector<double> rank = ranks_of(rate);
  OscillationCounter swings;
  for (std::size_t i = 0; i < rank.size(); ++i) swings.look(static_cast<std::int64_t>(i), rank[i]);
  const auto seen = swings.seen(static_cast<std::int64_t>(rank.size()) - 1);
  return seen ? std::optional<double>(seen->periods) : std::nullopt;
}

/// Returns the smallest difference of two different energies. If the numbers have few digits, it is one unit of the
/// last digit.
double smallest_difference(std::vector<double> energy) {
  std::sort(energy.begin(), energy.end());
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < energy.size(); ++i) {
    if (energy[i] > energy[i - 1]) smallest = std::min(smallest, energy[i] - energy[i - 1]);
  }
  return std::isfinite(smallest) ? smallest : 0;
}

/// Least-squares line, with its residuals.
struct Line {
  double slope = 0;
  double slope_error = 0;  // standard error, for independent values
  double deviation = 0;    // standard deviation of the residuals
  std::vector<double> rest{};
};
Line fitted_line(const std::vector<double>& t, const std::vector<double>& x) {
  const double count = static_cast<double>(t.size());
  const double mean_t = std::accumulate(t.begin(), t.end(), 0.0) / count;
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / count;
  Line line{fitted_slope(t, x)};
  double squares = 0;
  double tt = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    line.rest.push_back(x[i] - mean_x - line.slope * (t[i] - mean_t));
    squares += line.rest.back() * line.rest.back();
    tt += (t[i] - mean_t) * (t[i] - mean_t);
  }
  line.deviation = std::sqrt(squares / (count - 2));
  line.slope_error = line.deviation / std::sqrt(tt);
  return line;
}

/// Returns whether x is a straight line in time, to a ten-thousandth of its change. An oscillation that looks straight,
/// sin(phi) with |phi| < 1/40, takes more than a hundred times as long as the log.
bool is_straight(const std::vector<double>& t, const std::vector<double>& x) {
  constexpr double straight = 1e-4;
  const Line line = fitted_line(t, x);
  const double most = straight * std::abs(x.back() - x.front());
  return std::all_of(line.rest.begin(), line.rest.end(), [&](double rest) { return std::abs(rest) < most; });
}

/// Returns whether E is a straight line, or log |E| for an energy that decays or grows exponentially.
bool is_straight_or_exponential(const std::vector<double>& t, const std::vector<double>& energy) {
  if (is_straight(t, energy)) return true;
  std::vector<double> logarithms;
  for (const double e : energy) {
    if (!(e * energy.front() > 0)) return false;
    logarithms.push_back(std::log(e / energy.front()));
  }
  return is_straight(t, logarithms);
}

/// Returns whether the energy is a straight line plus independent noise. Unlike those of a random walk or a slow
/// oscillation, neighbouring values of the noise are not correlated, and the mean of each eighth of the log lies on the
/// line.
bool is_line_beneath_noise(const std::vector<double>& t, const std::vector<double>& x) {
  constexpr double clear_change = 4;  // standard deviations of the noise
  constexpr double most_correlation = 0.2;
  constexpr double errors = 4;
  constexpr std::size_t parts = 8;
  const Line line = fitted_line(t, x);
  if (!(std::abs(line.slope) * (t.back() - t.front()) > clear_change * line.deviation)) return false;
  double neighbours = 0;
  double squares = 0;
  for (std::size_t i = 0; i < line.rest.size(); ++i) {
    squares += line.rest[i] * line.rest[i];
    if (i > 0) neighbours += line.rest[i] * line.rest[i - 1];
  }
  if (std::abs(neighbours) > most_correlation * squares) return false;
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = part * t.size() / parts;
    const std::size_t end = (part + 1) * t.size() / parts;
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += line.rest[i];
    if (std::abs(sum) > errors * line.deviation * std::sqrt(static_cast<double>(end - begin))) return false;
  }
  return line.deviation > 0;
}

/// Returns the lines through the four quarters of the log.
std::vector<Line> quarters(const std::vector<double>& t, const std::vector<double>& x) {
  std::vector<Line> all;
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    const auto begin = static_cast<std::ptrdiff_t>(quarter * t.size() / 4);
    const auto end = static_cast<std::ptrdiff_t>((quarter + 1) * t.size() / 4);
    all.push_back(fitted_line({t.begin() + begin, t.begin() + end}, {x.begin() + begin, x.begin() + end}));
  }
  return all;
}

/// Returns the rate of the drift in a quarter of the log, divided by the overall rate. nullopt: the rates differ only
/// as much as noise or the change of the energy itself explains. (After a large change of the energy the motion
/// differs, and so does its rate.)
/// @param change change of the energy, divided by the scale
std::optional<double> unsteady_rate(const std::vector<double>& t, const std::vector<double>& x, double change) {
  constexpr double steady = 0.05;  // a fifth of a period of an oscillation is as straight as this
  constexpr double of_the_change = 16;
  constexpr double errors = 3;
  const double whole = fitted_line(t, x).slope;
  for (const Line& part : quarters(t, x)) {
    const double off = std::abs(part.slope - whole);
    if (off > (steady + of_the_change * change) * std::abs(whole) && off > errors * part.slope_error) {
      return part.slope / whole;
    }
  }
  return std::nullopt;
}

/// Returns whether the energy changes in one direction throughout a quarter of the log.
bool has_trend_in_a_quarter(const std::vector<double>& t, const std::vector<double>& x) {
  constexpr double errors = 4;
  const std::vector<Line> all = quarters(t, x);
  return std::any_of(all.begin(), all.end(),
                     [&](const Line& part) { return std::abs(part.slope) > errors * part.slope_error; });
}

/// Returns the mean absolute deviation in each of `parts` parts of the log of equal duration. On an eccentric orbit the
/// sampled height of the rare peaks is random; it influences the mean absolute deviation less than the RMS or the
/// range.
std::vector<double> deviations_of_parts(const std::vector<double>& t, const std::vector<double>& x, std::size_t parts) {
  std::vector<double> all;
  const double whole = t.back() - t.front();
  std::size_t begin = 0;
  for (std::size_t part = 1; part <= parts; ++part) {
    const double until = t.front() + whole * (static_cast<double>(part) / static_cast<double>(parts));
    const auto end =
        part == parts ? t.size() : static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), until) - t.begin());
    const double count = static_cast<double>(end - begin);
    double mean = 0;
    for (std::size_t i = begin; i < end; ++i) mean += x[i] / count;
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += std::abs(x[i] - mean) / count;
    all.push_back(sum);
    begin = end;
  }
  return all;
}

/// Returns a text that describes how an oscillation of the energy error grows; empty if it grows no more than noise
/// explains. An amplitude that changes periodically, as in a beat, has no trend.
std::string growth_of_oscillation(const std::vector<double>& t, const std::vector<double>& x, double periods) {
  constexpr double level = 1e-4;          // significance level of the t-test
  constexpr double clear = 1.1;           // parts that are not a whole number of periods differ by a few per cent
  constexpr double clearly_at_end = 1.5;  // for an oscillation that starts to grow late
  constexpr std::size_t coarse = 8;       // at least two periods in each
  const std::size_t parts = periods >= 64 && t.size() >= 256 ? 2 * coarse : coarse;
  const std::vector<double> sizes = deviations_of_parts(t, x, parts);
  std::vector<double> place;      // for amplitudes like exp(ct)
  std::vector<double> log_place;  // for amplitudes like t^c
  std::vector<double> logarithm;
  for (std::size_t k = 0; k < parts; ++k) {
    if (!(sizes[k] > 0)) return {};
    place.push_back(static_cast<double>(k));
    log_place.push_back(std::log(static_cast<double>(k) + 0.5));
    logarithm.push_back(std::log(sizes[k]));
  }
  const auto rises_along = [&](const std::vector<double>& along) {
    const Line line = fitted_line(along, logarithm);
    return line.slope * (along.back() - along.front()) > std::log(clear) &&
           line.slope > student_quantile(level, static_cast<int>(parts) - 2) * line.slope_error;
  };
  const bool has_trend = rises_along(place) || rises_along(log_place);
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(parts / 2);
  const bool ends_larger =
      std::min(sizes[parts - 1], sizes[parts - 2]) > clearly_at_end * *std::max_element(sizes.begin(), middle);
  if (!has_trend && !ends_larger) return {};
  return fmt::format(
      "the oscillation of the energy error grows over the log, from {:.2g} to {:.2g} (mean deviation in the first and "
      "in "
      "the last of {} parts)",
      sizes.front(), sizes.back(), parts);
}

void leave_undecided(RunDrift& drift, std::string reason) {
  drift.drift.reset();
  drift.reason = std::move(reason);
}

}  // namespace

std::optional<std::size_t> first_time_that_does_not_rise(const std::vector<double>& t) {
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (!(t[i] > t[i - 1])) return i;
  }
  return std::nullopt;
}

LogCertificate certify_log(const std::vector<double>& t, const std::vector<double>& energy,
                           std::optional<double> scale) {
  check_log(t, energy, scale);
  LogCertificate found;
  found.samples = t.size();
  double largest_energy = 0;
  double largest_deviation = 0;
  for (const double e : energy) {
    largest_energy = std::max(largest_energy, std::abs(e));
    largest_deviation = std::max(largest_deviation, std::abs(e - energy.front()));
  }
  if (scale) {
    found.scale = scale;
  } else if (energy.front() != 0) {
    found.scale = std::abs(energy.front());
  }
  if (found.scale) found.energy_level = largest_deviation / *found.scale;
  if (t.size() <= static_cast<std::size_t>(RunDrift::fewest_blocks)) {
    leave_undecided(found.drift, fmt::format("{} samples are too few; a drift class needs {}", t.size(),
                                             RunDrift::fewest_blocks + 1));
    return found;
  }
  const std::vector<std::size_t> chosen = is_equidistant(t) ? equidistant_blocks(t.size()) : resampled_blocks(t);
  if (chosen.size() <= static_cast<std::size_t>(RunDrift::fewest_blocks)) {
    leave_undecided(
        found.drift,
        fmt::format("the samples are too unevenly spaced; a drift class needs one in the first half of each "
                    "of {} parts of the log of equal duration",
                    RunDrift::fewest_blocks + 1));
    return found;
  }
  std::vector<double> times;
  std::vector<double> energies;
  EnergySeries series;
  for (const std::size_t i : chosen) {
    times.push_back(t[i]);
    energies.push_back(energy[i]);
    series.deviations.push_back(energy[i] - energy.front());
  }
  series.periods = periods_of_rate(times, series.deviations);
  series.counted = "oscillations of the energy";
  constexpr double parts_over_whole = 4;  // assumed size of kinetic and potential energy, relative to the total energy
  series.rounding = std::max(parts_over_whole * epsilon * largest_energy, smallest_difference(energy) / 2);
  series.roundings = static_cast<double>(t.size() - 1);
  series.scale = found.scale.value_or(largest_energy);
  found.drift = classify_run(series);
  if (largest_deviation == 0) {
    leave_undecided(found.drift, "all energies of the log are equal; a log with more digits would decide");
  } else if (found.drift.drift == DriftClass::linear) {
    if (const auto rate = unsteady_rate(times, series.deviations, largest_deviation / series.scale)) {
      leave_undecided(
          found.drift,
          fmt::format("the energy changes in one direction, but in a quarter of the log at {:.2g} times the "
                      "mean rate, so it may be a part of an oscillation slower than the log",
                      *rate));
    }
  } else if (found.drift.drift == DriftClass::bounded) {
    if (has_trend_in_a_quarter(times, series.deviations)) {
      leave_undecided(
          found.drift,
          "no drift is seen, but the energy changes in one direction throughout a quarter of the log; such a slow "
          "oscillation must be seen 16 times");
    } else if (const std::string grows = growth_of_oscillation(t, energy, found.drift.periods.value_or(0));
               !grows.empty()) {
      leave_undecided(found.drift, grows);
    }
  } else if (!found.drift.drift && is_straight_or_exponential(times, energies)) {
    found.drift.drift = DriftClass::linear;
    found.drift.reason = "the energy changes at a constant rate, to a ten-thousandth of its change";
  } else if (!found.drift.drift && largest_deviation > 64 * series.rounding * (1 + std::sqrt(series.roundings)) &&
             is_line_beneath_noise(t, energy)) {  // more than roundings to one side explain
    found.drift.drift = DriftClass::linear;
    found.drift.reason = "a straight line plus independent noise";
  }
  return found;
}

}  // namespace hamflow
