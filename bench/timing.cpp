#include "timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace bench {

namespace {

double quantile(const std::vector<double>& sorted, double at) {
  const double position = at * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (position - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double distance(const Orbit& a, const Orbit& b) {
  double largest = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    largest = std::max({largest, std::fabs(a.q[i] - b.q[i]), std::fabs(a.p[i] - b.p[i])});
  }
  return largest;
}

void check(const Workload& workload, const std::vector<Run>& runs, std::size_t i, std::int64_t steps) {
  const auto fail = [&](std::size_t other, double apart, double bound) {
    throw std::runtime_error(fmt::format("{}, h = {}: after {} steps '{}' ends {:.3g} away from '{}', allowed {:.3g}",
                                         workload.method, workload.h_text, steps, workload.contenders[i].name, apart,
                                         workload.contenders[other].name, bound));
  };
  const Contender& contender = workload.contenders[i];
  const double apart = distance(runs[0].end, runs[i].end);
  const double bound = contender.same_bits ? 0 : contender.slack * workload.bound(steps);
  if (!(contender.same_bits ? runs[0].end == runs[i].end : apart <= bound)) fail(0, apart, bound);  // NaN fails
  if (contender.bits_of.empty()) return;
  for (std::size_t j = 0; j < runs.size(); ++j) {
    if (workload.contenders[j].name == contender.bits_of && !(runs[i].end == runs[j].end)) {
      fail(j, distance(runs[i].end, runs[j].end), 0);
    }
  }
}

/// Chooses the number of steps of a block, rounded to three digits, by timing the hand-written loop.
std::int64_t calibrate(const Workload& workload, const Plan& plan) {
  const Contender& hand = workload.contenders.front();
  std::int64_t steps = 1000;
  double nanoseconds = hand.run(steps).nanoseconds;
  while (nanoseconds < plan.block_nanoseconds / 8) {
    steps *= 2;
    nanoseconds = hand.run(steps).nanoseconds;
  }
  const double wanted = static_cast<double>(steps) * plan.block_nanoseconds / nanoseconds;
  return std::max<std::int64_t>(1000, static_cast<std::int64_t>(wanted) / 1000 * 1000);
}

/// The times of one contender, one for each round.
struct Series {
  std::vector<double> ns_per_step;
  double forces_per_step = 0;
  double difference = 0;
};

std::vector<Series> play_round(const Workload& workload, std::int64_t steps, std::size_t turn) {
  const std::size_t count = workload.contenders.size();
  std::vector<Run> runs(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = (i + turn) % count;
    runs[at] = workload.contenders[at].run(steps);
  }
  std::vector<Series> round(count);
  for (std::size_t i = 0; i < count; ++i) {
    check(workload, runs, i, steps);
    round[i].ns_per_step = {runs[i].nanoseconds / static_cast<double>(steps)};
    round[i].forces_per_step = runs[i].forces / static_cast<double>(steps);
    round[i].difference = distance(runs[0].end, runs[i].end);
  }
  return round;
}

std::vector<double> divide(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) ratios[i] = a[i] / b[i];
  return ratios;
}

Table summarise(const Workload& workload, std::int64_t steps, const std::vector<Series>& all,
                const std::vector<Latencies>& latencies) {
  Table table{workload.method, workload.h_text, steps, workload.bound(steps), {}, {}};
  std::vector<double> limits;
  for (const Latencies& l : latencies) limits.push_back(l.of(workload.chain));
  table.limit = spread_of(limits);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Contender& contender = workload.contenders[i];
    Result result{contender.name, contender.against, contender.goal, spread_of(all[i].ns_per_step), {}, {}};
    std::vector<double> per_force = all[i].ns_per_step;
    for (double& x : per_force) x /= all[i].forces_per_step;
    result.ns_per_force = spread_of(per_force);
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (workload.contenders[j].name == contender.against) {
        result.ratio = spread_of(divide(all[i].ns_per_step, all[j].ns_per_step));
      }
    }
    result.forces_per_step = all[i].forces_per_step;
    result.difference = all[i].difference;
    table.results.push_back(result);
  }
  return table;
}

/// Returns the series of a contender, or null if it was not measured.
const Series* find(const std::vector<Workload>& workloads, const std::vector<std::vector<Series>>& all,
                   const std::string& h_text, const std::string& method, const std::string& contender) {
  for (std::size_t w = 0; w < workloads.size(); ++w) {
    if (workloads[w].method != method || workloads[w].h_text != h_text) continue;
    for (std::size_t i = 0; i < all[w].size(); ++i) {
      if (workloads[w].contenders[i].name == contender) return &all[w][i];
    }
  }
  return nullptr;
}

std::vector<Compared> compare(const std::vector<Workload>& workloads, const std::vector<std::vector<Series>>& all,
                              const std::vector<Comparison>& comparisons) {
  std::vector<Compared> compared;
  std::vector<std::string> seen;
  for (const Workload& workload : workloads) {
    const std::string& h = workload.h_text;
    if (std::find(seen.begin(), seen.end(), h) != seen.end()) continue;
    seen.push_back(h);
    for (const Comparison& c : comparisons) {
      const Series* mine = find(workloads, all, h, c.method, c.contender);
      const Series* theirs = find(workloads, all, h, c.peer_method, c.peer);
      if (mine == nullptr || theirs == nullptr) continue;
      std::vector<double> ratios = divide(mine->ns_per_step, theirs->ns_per_step);
      if (c.per_force) {
        for (double& x : ratios) x *= theirs->forces_per_step / mine->forces_per_step;
      }
      compared.push_back({c, h, spread_of(ratios)});
    }
  }
  return compared;
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75)};
}

Measured measure(const std::vector<Workload>& workloads, const std::vector<Comparison>& comparisons, const Plan& plan) {
  std::vector<std::int64_t> steps;
  std::vector<std::vector<Series>> all;
  for (const Workload& workload : workloads) {
    // A short run comes first, because the bound is tight for few steps.
    (void)play_round(workload, 1000, 0);
    steps.push_back(calibrate(workload, plan));
    all.emplace_back(workload.contenders.size());
  }
  std::vector<Latencies> latencies;
  for (int round = 0; round < plan.rounds; ++round) {
    latencies.push_back(measure_latencies());
    for (std::size_t w = 0; w < workloads.size(); ++w) {
      const auto played = play_round(workloads[w], steps[w], static_cast<std::size_t>(round));
      for (std::size_t i = 0; i < played.size(); ++i) {
        all[w][i].ns_per_step.push_back(played[i].ns_per_step.front());
        all[w][i].forces_per_step = played[i].forces_per_step;
        all[w][i].difference = played[i].difference;
      }
    }
  }
  Measured measured;
  for (std::size_t w = 0; w < workloads.size(); ++w) {
    measured.tables.push_back(summarise(workloads[w], steps[w], all[w], latencies));
  }
  measured.compared = compare(workloads, all, comparisons);
  return measured;
}

}  // namespace bench
