// How many runs of the T-tube follow a trend of [Sonnleitner2010], page 94.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "t_tube_runs.hpp"

namespace hamflow::reproduction::t_tube_table {

/// Runs that follow a trend, that go against it, and that leave it open.
struct Count {
  int with = 0, against = 0, open = 0;

  int all() const { return with + against + open; }
  double share() const { return (with + open / 2.0) / all(); }
  void add(const Count& other) { with += other.with, against += other.against, open += other.open; }
};

/// Of each v1, for the starts of one are no independent sample of what the conditions allow.
struct Followers {
  std::vector<Count> of_starts;

  /// A run of the last v1, by 3 standard errors of its own blocks. @param excess > 0 is against the trend
  void count(double excess, double error) {
    Count& last = of_starts.back();
    ++(excess > 3 * error ? last.against : excess <= -3 * error ? last.with : last.open);
  }
  /// One that cannot be counted.
  void leave_open() { ++of_starts.back().open; }
  Count all() const {
    Count sum;
    for (const Count& one : of_starts) sum.add(one);
    return sum;
  }
  /// Half of the share that is open, since those may do either.
  double of_open() const { return all().open / 2.0 / all().all(); }
  /// 3 standard errors: other v1 may have another share.
  double of_v1() const {
    std::vector<double> shares;
    for (const Count& one : of_starts) shares.push_back(one.share());
    return 3 * spread_of(shares).standard_error();
  }
  /// The share that follows. @param cut so many of the open ones, since H was off
  Measured share(int cut) const {
    const auto less = [](const Count& a, const Count& b) { return a.share() < b.share(); };
    const auto [least, most] = std::minmax_element(of_starts.begin(), of_starts.end(), less);
    const Count sum = all();
    return {sum.share(), of_open() + of_v1(),
            fmt::format(
                "{} of {} runs follow, {} go against it, {} are open ({} of these cut where H was off by 1 %, which "
                "measure nothing); {:.0f} to {:.0f} % of the runs of one v1 follow",
                sum.with, sum.all(), sum.against, sum.open, cut, 100 * least->share(), 100 * most->share())};
  }
};

/// What is printed of a series of simulations is a trend: more than half of them follow it. The thesis' own table has
/// exceptions, 2 of 6 where the force attracts.
inline Rule trend_rule() {
  return at_least(0.5,
                  "share of the runs of a grid of v1 and Q1 that follow: a trend is what more than half do, for "
                  "the thesis' own table has exceptions where the force attracts (2 of 6)");
}

}  // namespace hamflow::reproduction::t_tube_table
