// Counts the runs of the T-tube that follow a trend of [Sonnleitner2010], page 94.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "t_tube_runs.hpp"

namespace hamflow::reproduction::t_tube_table {

/// The numbers of runs that follow a trend, that go against it, and that are undecided.
struct Count {
  int with = 0, against = 0, open = 0;

  int all() const { return with + against + open; }
  double share() const { return (with + open / 2.0) / all(); }
  void add(const Count& other) { with += other.with, against += other.against, open += other.open; }
};

/// Counts separately for each v1, because the starts with one v1 are not independent samples of all conditions.
struct Followers {
  std::vector<Count> of_starts;

  /// Counts a run of the last v1. It is undecided within 3 standard errors, which come from the blocks of the run.
  /// @param excess a positive value is against the trend
  void count(double excess, double error) {
    Count& last = of_starts.back();
    ++(excess > 3 * error ? last.against : excess <= -3 * error ? last.with : last.open);
  }
  /// Counts a run as undecided.
  void leave_open() { ++of_starts.back().open; }
  Count all() const {
    Count sum;
    for (const Count& one : of_starts) sum.add(one);
    return sum;
  }
  /// The uncertainty from undecided runs: half of their share, because each of them may follow the trend or not.
  double of_open() const { return all().open / 2.0 / all().all(); }
  /// The uncertainty from the choice of v1: 3 standard errors of the share over all v1.
  double of_v1() const {
    std::vector<double> shares;
    for (const Count& one : of_starts) shares.push_back(one.share());
    return 3 * spread_of(shares).standard_error();
  }
  /// The share of runs that follow the trend.
  /// @param cut the number of undecided runs that were stopped because of their energy error
  Measured share(int cut) const {
    const auto less = [](const Count& a, const Count& b) { return a.share() < b.share(); };
    const auto [least, most] = std::minmax_element(of_starts.begin(), of_starts.end(), less);
    const Count sum = all();
    return {sum.share(), of_open() + of_v1(),
            fmt::format(
                "{} of {} runs follow the trend, {} go against it, {} are open ({} of these were cut when H was off by "
                "1 %, and measure nothing); {:.0f} to {:.0f} % of the runs with one v1 follow it",
                sum.with, sum.all(), sum.against, sum.open, cut, 100 * least->share(), 100 * most->share())};
  }
};

/// The thesis prints a trend of a series of simulations: more than half of them have to follow it. Its own table has
/// exceptions, 2 of 6 for attracting forces.
inline Rule trend_rule() {
  return at_least(0.5,
                  "share of the runs on a grid of v1 and Q1 that follow the trend. More than half have to follow it, "
                  "because the thesis' own table has exceptions if the force attracts (2 of 6)");
}

}  // namespace hamflow::reproduction::t_tube_table
