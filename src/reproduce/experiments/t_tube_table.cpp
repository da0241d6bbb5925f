// [Sonnleitner2010], table of pages 99 and 100: mean kinetic energies of long runs of the T-tube minus those of the
// start, and the two trends of page 94. The energies in brackets tell the start: 0, 0.5, 18, 50 are v1 = 0, 1, 6, 10.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "../experiment.hpp"
#include "../tube_watch.hpp"

namespace hamflow::reproduction {

namespace t_tube_table {

struct Pair {
  const char* name;
  double eps;
  const char* v1;  // by the energy in brackets
  const char* change1;
  const char* change2;
};
/// As they stand in one column.
constexpr Pair columns[] = {{"-0.6I", -0.6, "0", "3.0192", "-3.0910"},   {"-0.6III", -0.6, "6", "0.8575", "-2.4128"},
                            {"-0.6IV", -0.6, "10", "0.1756", "-0.9333"}, {"+0.6I", 0.6, "0", "1.9576", "-1.9695"},
                            {"+0.6III", 0.6, "1", "6.1182", "-6.0625"},  {"+0.6IV", 0.6, "6", "2.3424", "-2.3620"}};

/// The mean of -eps/r over the rectangle of the positions: what a motion that fills it evenly has.
double mean_potential(double eps, int cells) {
  double sum = 0;
  for (int i = 0; i < cells; ++i) {
    for (int k = 0; k < cells; ++k) {
      sum += 1 / std::hypot(-1 + 2 * (i + 0.5) / cells, 0.1 + 2 * (k + 0.5) / cells);
    }
  }
  return -eps * sum / (static_cast<double>(cells) * cells);
}
double start_potential(double eps) { return -eps / std::hypot(0.01, 1.1); }

/// H is constant: the changes add up to the start's potential energy minus the mean one.
void claim_sum(Study& study, const Pair& pair, const Spread& sum_of_runs) {
  const double printed = std::stod(pair.change1) + std::stod(pair.change2);
  const double even = start_potential(pair.eps) - mean_potential(pair.eps, 2000);
  study.claim(
      {fmt::format("column_{}", pair.name),
       fmt::format("both numbers of column {} belong to one run: their sum, {:+.4f}, is a change of potential energy",
                   pair.name, printed),
       fmt::format("{}, {}", pair.change1, pair.change2)},
      at_most(0.3, "sum of the changes against V0 - <V>; energies that reject loses in a long run are below it"),
      {{std::abs(printed - sum_of_runs.mean), 3 * sum_of_runs.deviation,
        fmt::format("runs have {:+.4f}", sum_of_runs.mean)},
       {std::abs(printed - even), std::abs(mean_potential(pair.eps, 2000) - mean_potential(pair.eps, 1000)),
        fmt::format("a motion that fills the rectangle evenly has {:+.4f}", even)}},
      Grounds::ways);
}

/// Means of the starts of an ensemble, and how far they moved in its later half.
struct Changes {
  Spread first, second, both;
  double moved1 = 0, moved2 = 0;
  double energy_error = 0;  // the largest
};

constexpr double energy_of_heavy = 50;  // v2 = 1

/// Means of both kinetic energies over so many blocks, minus those of the start.
std::pair<double, double> mean_changes(const TubeWatch& one, std::size_t blocks) {
  const auto mean = [&](const std::vector<double>& x) { return spread_of({x.data(), x.data() + blocks}).mean; };
  return {mean(one.blocks) - one.start.v1 * one.start.v1 / 2, mean(one.heavy) - energy_of_heavy};
}

Changes changes_over(const std::vector<TubeWatch>& all, std::size_t blocks) {
  Changes changes;
  std::vector<double> a, b, both;
  for (const TubeWatch& one : all) {
    if (one.blocks.size() < blocks) continue;
    const auto [light, heavy] = mean_changes(one, blocks);
    a.push_back(light), b.push_back(heavy), both.push_back(light + heavy);
    changes.energy_error = std::max(changes.energy_error, one.energy_error);
  }
  changes.first = spread_of(a), changes.second = spread_of(b), changes.both = spread_of(both);
  return changes;
}

/// The thesis' start has Q1 = 0.01: 64 starts within 1e-9 of it, which rounding could have made of it, and as many on a
/// grid of 1 % around it, for neighbours part within some bounces only where the motion is chaotic.
struct Starts {
  const char* name;
  const char* told;
  double from, width;  // of Q1
};
constexpr Starts beside_start{"near", "within 1e-9 of q1 = 0.01", 0.01 - 5e-10, 1e-9};
constexpr Starts around_start{"grid", "on a grid of 1 % around it", 0.0099, 2e-4};

Changes changes_of(Study& study, const TubeRun& run, const std::string& name, const Starts& around, int members) {
  constexpr std::size_t blocks = 10;
  const TubeSet set{.run = run, .blocks = blocks, .block = run.steps / static_cast<int>(blocks), .both_bodies = true};
  std::vector<TubeStart> starts;
  for (int k = 0; k < members; ++k) {
    starts.push_back({run.eps, around.from + around.width * k / (members - 1), std::stod(run.v1)});
  }
  const std::vector<TubeWatch> all = watch_tubes(study, name + "_" + around.name, set, starts);
  const Changes half = changes_over(all, blocks / 2);
  Changes whole = changes_over(all, blocks);
  whole.moved1 = std::abs(whole.first.mean - half.first.mean);
  whole.moved2 = std::abs(whole.second.mean - half.second.mean);
  return whole;
}

struct Ensembles {
  Changes near, grid;
  std::int64_t steps_of_grid = 0;
};

/// The number of a pair that is farther from its printed value than it is uncertain: a run may lie 3 standard
/// deviations of single starts from their mean, which may still move as far as it did in its later half, twice. Of the
/// starts that rounding could have made of the printed one; the grid stands beside them.
void claim_pair(Study& study, const Pair& pair, const TubeRun& run, const std::optional<Ensembles>& changes) {
  std::vector<Measured> worst;
  if (changes) {
    const Changes &own = changes->near, &wide = changes->grid;
    const auto off = [&](const char* printed, const Spread& spread, double moved) {
      return Measured{std::abs(std::stod(printed) - spread.mean), 3 * spread.deviation + 2 * moved,
                      fmt::format("{} starts {}, {:g} steps: {:+.4f} and {:+.4f}; {} {}, {:g} steps: {:+.4f} and "
                                  "{:+.4f}; H off by at most {:.2g} of its size",
                                  spread.members, beside_start.told, static_cast<double>(run.steps), own.first.mean,
                                  own.second.mean, wide.first.members, around_start.told,
                                  static_cast<double>(changes->steps_of_grid), wide.first.mean, wide.second.mean,
                                  std::max(own.energy_error, wide.energy_error))};
    };
    const Measured one = off(pair.change1, own.first, own.moved1);
    const Measured two = off(pair.change2, own.second, own.moved2);
    worst.push_back(one.value - one.uncertainty > two.value - two.uncertainty ? one : two);
  }
  study.claim({fmt::format("pair_{}_{}_{}", pair.name, run.rule, run.dt),
               fmt::format("changes of both kinetic energies, {} with v = ({}, 1), {}, dt = {}", pair.name, pair.v1,
                           run.rule, run.dt),
               fmt::format("{}, {}", pair.change1, pair.change2)},
              at_most(5e-5, "distance from the printed number, half a unit of its last digit"), worst, Grounds::program,
              study.sized<const char*>("longer runs: the default size, --full", "longer runs: --full",
                                       "the thesis' own start to its last digit: late motions differ from start to "
                                       "start with reject, and with the other rules H wanders"));
}

/// All that was measured, a row for each ensemble.
struct Rows {
  std::vector<std::pair<std::string, std::vector<double>>> columns{{"eps", {}},
                                                                   {"v1", {}},
                                                                   {"dt", {}},
                                                                   {"rule_reject_mirror_event", {}},
                                                                   {"starts_near_grid", {}},
                                                                   {"change1", {}},
                                                                   {"deviation1", {}},
                                                                   {"change2", {}},
                                                                   {"deviation2", {}},
                                                                   {"energy_error", {}}};

  void add(const TubeRun& run, int rule, int starts, const Changes& of) {
    const double row[] = {
        run.eps,       std::stod(run.v1),  std::stod(run.dt), static_cast<double>(rule), static_cast<double>(starts),
        of.first.mean, of.first.deviation, of.second.mean,    of.second.deviation,       of.energy_error};
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].second.push_back(row[i]);
  }
};

void compare_starts(Study& study) {
  const int members = study.sized(6, 64, 64);
  Rows rows;
  for (const char* const dt : {"0.01", "0.001"}) {
    int rule_number = 0;
    for (const char* const rule : {"reject", "mirror", "event"}) {
      ++rule_number;
      for (const Pair& pair : columns) {
        TubeRun run{.eps = pair.eps, .v1 = pair.v1, .rule = rule, .dt = dt};
        // A hundred times as long where H is kept: with the other rules it has walked off by then.
        run.steps = study.sized<std::int64_t>(10000, 10000000, run.rule == "reject" ? 1000000000 : 100000000);
        // How starts of the grid scatter is known long before.
        TubeRun shorter = run;
        shorter.steps = std::min<std::int64_t>(run.steps, 10000000);
        const bool is_usual = run.rule == "reject" && run.dt == "0.01";
        std::optional<Ensembles> changes;
        // Nothing follows from averages over less than some hundred bounces of the heavy body.
        const bool is_long = static_cast<double>(run.steps) * std::stod(run.dt) > 400;
        if (is_long || is_usual) {
          const std::string name = fmt::format("{}_{}_{}", pair.name, rule, dt);
          changes = {changes_of(study, run, name, beside_start, members),
                     changes_of(study, shorter, name, around_start, members), shorter.steps};
        }
        claim_pair(study, pair, run, is_long ? changes : std::nullopt);
        if (!changes) continue;
        study.keep_scenario(name_of(run), tube_scenario(run));
        if (is_usual) claim_sum(study, pair, changes->near.both);
        rows.add(run, rule_number, 1, changes->near);
        rows.add(run, rule_number, 2, changes->grid);
      }
    }
  }
  study.keep({"changes", rows.columns});
}

/// A single run as the thesis' program takes it, in double, and how far its mean depends on rounding.
void the_thesis_own_run(Study& study) {
  TubeRun run{.eps = -0.6, .v1 = "6"};
  run.steps = 1000000;
  const auto short_runs = ensemble(study, run, {"run.arithmetic=double,compensated"});
  run.steps = 10000000;
  const TubeMember whole = ensemble(study, run, {"run.arithmetic=double"}).at(0);
  study.keep_scenario("own_run", tube_scenario(run));
  const auto measured = [&](double TubeMember::*change) {
    return Measured{whole.*change, 10 * std::abs(short_runs[0].*change - short_runs[1].*change) + 1e-10,
                    "v = (6, 1), reject, dt = 0.01: mean of 10^7 steps; of 10^6 also in compensated arithmetic"};
  };
  study.claim({"own_dKx", "dkinEnKx of Sim-0.6III", "+0.8575"}, as_printed("0.8575"), {measured(&TubeMember::change1)});
  study.claim({"own_dKy", "dkinEnKy of Sim-0.6III, as printed in its column", "-2.4128"}, as_printed("-2.4128"),
              {measured(&TubeMember::change2)});
  study.claim({"own_dKy_shifted", "dkinEnKy of Sim-0.6III, if it stands in the column of Sim-0.6IV", "-0.9333"},
              as_printed("-0.9333"), {measured(&TubeMember::change2)});
}

/// The relative change is the change over the energy in brackets.
void claim_relative(Study& study, const char* name, const std::string& change, double from, const std::string& relative,
                    const std::string& fits) {
  study.claim({fmt::format("relative_{}", name),
               fmt::format("relative change of column {}: {} (from {:g})", name, change, from), relative + " fold"},
              as_printed(relative), {{std::stod(change) / from, 0, "of the numbers printed above it; " + fits}},
              Grounds::identity);
}

/// The start velocity printed in a column and the start energy in its brackets, m1 = 1.
void claim_start(Study& study, const char* name, double v1, const std::string& from) {
  study.claim(
      {fmt::format("start_{}", name), fmt::format("column {}: vKx = {:g} and kinEnKx (from {})", name, v1, from), from},
      at_most(0.05, "v^2/2 against the energy in brackets, to its digits"),
      {{std::abs(v1 * v1 / 2 - std::stod(from)), 0, "two printed numbers of one column"}}, Grounds::identity);
}

void table(Study& study) {
  claim_start(study, "-0.6I", 0, "0");
  claim_start(study, "-0.6III", 6, "18");
  claim_start(study, "-0.6IV", 10, "50");
  claim_start(study, "+0.6I", 0, "0");
  claim_start(study, "+0.6III", 6, "0.5");
  claim_start(study, "+0.6IV", 10, "18");
  claim_relative(study, "-0.6III", "0.8575", 18, "5.2", "no legible number fits it");
  claim_relative(study, "-0.6IV", "0.1756", 50, "0.13", "it is 2.3424/18, of +0.6IV");
  claim_relative(study, "+0.6III", "6.1182", 0.5, "-0.12", "it is -6.1182/50, of v1 = 10");
  claim_relative(study, "+0.6IV", "2.3424", 18, "0.004", "it is 0.1756/50, of -0.6IV");
  study.claim({"masses", "the listing of page 102 has the masses of the table", "1/100, 10000 and 1, 100"},
              at_most(0.005, "two printed lists of masses, relative"), {{1 - 0.01, 0, "m1 = 0.01 against 1"}},
              Grounds::identity);
  the_thesis_own_run(study);
  compare_starts(study);
}

/// Starts for which a trend does not hold by more than 3 standard errors, and those that leave it open.
struct Count {
  int against = 0;
  int open = 0;
};

void trend(Study& study, double eps, const std::vector<std::string>& starts, const std::string& rule) {
  const bool repels = eps < 0;
  Count first, second, same;
  std::vector<double> v1, change1, error1, change2, error2;
  const auto count = [](Count& all, double excess, double error) {  // excess > 0 is against the trend
    if (excess > 3 * error) {
      ++all.against;
    } else if (!(excess <= -3 * error)) {  // of one run nothing follows
      ++all.open;
    }
  };
  std::size_t runs = 0, counted_runs = 0;
  for (const std::string& start : starts) {
    const TubeSet set{.run = {.eps = eps, .v1 = start, .rule = rule},
                      .blocks = 10,
                      .most_energy_error = 0.01,
                      .block = study.sized<std::int64_t>(500, 200000, 1000000),
                      .both_bodies = true};
    std::vector<TubeStart> grid;
    const int members = study.sized(8, 16, 64);
    for (int k = 0; k < members; ++k) grid.push_back({eps, -0.9 + 1.8 * k / (members - 1), std::stod(start)});
    std::vector<double> a, b, both;
    for (const TubeWatch& seen : watch_tubes(study, fmt::format("{:+.1f}_{}_{}", eps, start, rule), set, grid)) {
      const std::size_t kept = seen.blocks.size() - (seen.stopped && !seen.blocks.empty() ? 1 : 0);
      if (kept == 0) continue;
      const auto [light, heavy] = mean_changes(seen, kept);
      a.push_back(light), b.push_back(heavy);
      both.push_back(std::abs(light + heavy) - 0.2 * std::abs(light));
    }
    runs += grid.size(), counted_runs += a.size();
    const Spread one = spread_of(a), two = spread_of(b), sum = spread_of(both);
    const double kinetic = grid[0].v1 * grid[0].v1 / 2;
    // Repelling: kinetic1 grows to a multiple, at least twice; attracting: it stays within 5 % or falls.
    count(first, repels ? kinetic - one.mean : one.mean - 0.05 * kinetic, one.standard_error());
    count(second, repels ? two.mean : -two.mean, two.standard_error());
    count(same, sum.mean, sum.standard_error());
    v1.push_back(std::stod(start));
    change1.push_back(one.mean), error1.push_back(one.standard_error());
    change2.push_back(two.mean), error2.push_back(two.standard_error());
  }
  const std::string side = repels ? "repelling" : "attracting";
  const auto claim = [&](const std::string& name, const std::string& statement, const Count& counted) {
    study.claim(
        {fmt::format("{}_{}_{}", side, name, rule), statement + ", " + rule, "of all that start so"},
        none_of("starts v1 against it by 3 standard errors"),
        {{static_cast<double>(counted.against), counted.against > 0 ? 0.0 : counted.open,
          fmt::format("{} of {} against it, {} open; {} of {} runs, each until its H is off by 1 %", counted.against,
                      starts.size(), counted.open, counted_runs, runs)}},
        Grounds::program,
        study.sized<const char*>("longer runs: the default size, --full", "longer runs: --full", "still longer runs"));
  };
  claim("light",
        repels ? "repelling, v1 < v2: kinEnKx grows to a multiple"
               : "attracting, v1 > v2, kinEnKx < kinEnKy: kinEnKx stays or falls",
        first);
  claim("heavy", repels ? "repelling, v1 < v2: kinEnKy falls" : "attracting, v1 > v2: kinEnKy grows", second);
  claim("same", side + ": kinEnKy changes by (almost) the same amount, within 20 %", same);
  study.keep({side + "_" + rule,
              {{"v1", v1}, {"change1", change1}, {"error1", error1}, {"change2", change2}, {"error2", error2}}});
}

void trends(Study& study) {
  for (const char* const rule : {"reject", "event"}) {
    trend(study, -0.6, {"0", "0.2", "0.4", "0.6", "0.8"}, rule);
    trend(study, 0.6, {"1.5", "2", "3", "4", "5", "6", "7", "8", "9", "9.9"}, rule);
  }
}

}  // namespace t_tube_table

std::vector<Experiment> t_tube_table_experiments() {
  using namespace t_tube_table;
  return {{{"S-T99", sonnleitner, "99, 100", "T-tube: changes of the kinetic energies"}, table},
          {{"S-C94", sonnleitner, "94", "T-tube: the two trends of the kinetic energies"}, trends}};
}

}  // namespace hamflow::reproduction
