// [Sonnleitner2010], table of pages 99 and 100: mean kinetic energies of long runs of the T-tube minus those of the
// start, and the two trends of page 94. The energies in brackets tell the start: 0, 0.5, 18, 50 are v1 = 0, 1, 6, 10.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "../experiment.hpp"
#include "../trend_counts.hpp"
#include "../tube_changes.hpp"

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

Changes changes_of(Study& study, const TubeRun& run, const std::string& name, const Starts& around, int members) {
  constexpr std::size_t blocks = 10;
  const TubeSet set{.run = run,
                    .blocks = blocks,
                    .most_energy_error = most_energy_error,
                    .block = run.steps / static_cast<int>(blocks),
                    .both_bodies = true};
  std::vector<TubeStart> starts;
  for (int k = 0; k < members; ++k) {
    starts.push_back({run.eps, around.from + around.width * k / (members - 1), std::stod(run.v1)});
  }
  return changes_over(watch_tubes(study, name + "_" + around.name, set, starts), blocks);
}

/// H is constant: the changes add up to the start's potential energy minus the mean one.
void claim_sum(Study& study, const Pair& pair, const Ensembles& changes) {
  const Spread& sum = changes.near.both;
  const double printed = std::stod(pair.change1) + std::stod(pair.change2);
  const double even = start_potential(pair.eps) - mean_potential(pair.eps, 2000);
  study.claim(
      {fmt::format("column_{}", pair.name),
       fmt::format("both numbers of column {} belong to one run: their sum, {:+.4f}, is a change of potential energy",
                   pair.name, printed),
       fmt::format("{}, {}", pair.change1, pair.change2)},
      at_most(
          0.3,
          "difference of the sum of the changes and V0 - <V>; reject loses less energy than this limit in a long run"),
      {{std::abs(printed - sum.mean), changes.scatter(&Changes::both), fmt::format("runs have {:+.4f}", sum.mean)},
       {std::abs(printed - even), std::abs(mean_potential(pair.eps, 2000) - mean_potential(pair.eps, 1000)),
        fmt::format("a motion that fills the rectangle evenly has {:+.4f}", even)}},
      Grounds::ways);
}

/// The thesis' rule is that of its listing. Its table has "mit dt = 0,01" where the force attracts; where it repels no
/// step is printed: its listing has 0.001, and what the table says of III comes out with 0.01.
bool is_of_the_table(const Pair& pair, const TubeRun& run) {
  return run.rule == "reject" && (run.dt == "0.01" || pair.eps < 0);
}

/// @param usual what the table's rule and step came to, for the claims of others
void claim_pair(Study& study, const Pair& pair, const TubeRun& run, const std::optional<Ensembles>& changes,
                const std::optional<Ensembles>& usual) {
  const bool own = is_of_the_table(pair, run);
  const std::string how = fmt::format("{} with v = ({}, 1), {}, dt = {}", pair.name, pair.v1, run.rule, run.dt);
  const std::string table_has = pair.eps > 0 ? "reject, dt = 0.01" : "reject";
  std::vector<Measured> measured;
  std::string decided_by = "longer runs: the default size, --full";
  if (changes && changes->measured() && (own || (usual && usual->measured()))) {
    decided_by = own ? "the thesis' own start to its last digit and its number of steps; nearby starts have other means"
                     : "nothing with this rule and step size, which are not the table's";
    Measured first = distance_of(pair.change1, *changes, &Changes::first, "kinEnKx");
    Measured second = distance_of(pair.change2, *changes, &Changes::second, "kinEnKy");
    if (!own) {
      first = by_another_way(first, *changes, *usual, &Changes::first);
      second = by_another_way(second, *changes, *usual, &Changes::second);
    }
    measured.push_back(worse_of(first, second));
  } else if (changes) {
    decided_by = "runs that keep H, with a smaller step: " + changes->left_out();
  }
  study.claim(
      {fmt::format("pair_{}_{}_{}", pair.name, run.rule, run.dt),
       own ? "changes of both kinetic energies, " + how
           : fmt::format("a run with another rule or step size has the same changes as with {}: {}", table_has, how),
       fmt::format("{}, {}", pair.change1, pair.change2)},
      at_most(half_a_unit, own ? "distance from the printed number, half a unit of its last digit"
                               : "distance from the printed number, half a unit of its last digit; +- includes the "
                                 "difference from runs with the table's rule and step size"),
      measured, Grounds::program, decided_by);
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
                                                                   {"energy_error", {}},
                                                                   {"left_out", {}}};

  void add(const TubeRun& run, int rule, int starts, const Changes& of) {
    const double row[] = {run.eps,
                          std::stod(run.v1),
                          std::stod(run.dt),
                          static_cast<double>(rule),
                          static_cast<double>(starts),
                          of.first.mean,
                          of.first.deviation,
                          of.second.mean,
                          of.second.deviation,
                          of.energy_error,
                          static_cast<double>(of.left_out)};
    for (std::size_t i = 0; i < columns.size(); ++i) columns[i].second.push_back(row[i]);
  }
};

/// Time units: nothing follows from averages over less than some hundred bounces of the heavy body.
constexpr double some_hundred_bounces = 400;

void compare_starts(Study& study) {
  const int members = study.sized(6, 64, 64);
  Rows rows;
  std::map<std::string, Ensembles> usual;  // of each column, with the table's rule and step
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
        const bool is_long = static_cast<double>(run.steps) * std::stod(run.dt) > some_hundred_bounces;
        if (is_long || is_usual) {
          const std::string name = fmt::format("{}_{}_{}", pair.name, rule, dt);
          changes = {changes_of(study, run, name, beside_start, members),
                     changes_of(study, shorter, name, around_start, members), run.steps, shorter.steps};
        }
        if (is_usual) usual.emplace(pair.name, *changes);
        claim_pair(study, pair, run, is_long ? changes : std::nullopt, usual.at(pair.name));
        if (!changes) continue;
        study.keep_scenario(name_of(run), tube_scenario(run));
        if (is_usual) claim_sum(study, pair, *changes);
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
              as_printed(relative), {{std::stod(change) / from, 0, "from the numbers printed above it; " + fits}},
              Grounds::identity);
}

/// The start velocity printed in a column and the start energy in its brackets, m1 = 1.
void claim_start(Study& study, const char* name, double v1, const std::string& from) {
  study.claim(
      {fmt::format("start_{}", name), fmt::format("column {}: vKx = {:g} and kinEnKx (from {})", name, v1, from), from},
      at_most(0.05, "difference of v^2/2 and the energy in brackets, to its digits"),
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
  study.nothing_to_test("masses",
                        "the listing of page 102 has the masses 1/100 and 10000, the table 1 and 100: two printed "
                        "lists, and no run can tell which one was meant");
  the_thesis_own_run(study);
  compare_starts(study);
}

/// Of a run: the mean of one of its quantities over its blocks, and how far that is uncertain.
struct MeanOfRun {
  double value, error;
};
MeanOfRun mean_of_run(const std::vector<double>& blocks, double start) {
  const Spread spread = spread_of(blocks);
  return {spread.mean - start, spread.standard_error()};
}

/// What "bleibt fast gleich" leaves to kinEnKx: no number is printed, and the table calls 12 % a fall.
constexpr double almost_unchanged = 0.05;
/// What "(fast) denselben Betrag" leaves: twice the difference in the thesis' own Sim-0.6III, +0.8575 and -0.9333.
constexpr double almost_the_same = 0.2;

void trend(Study& study, double eps, const std::vector<std::string>& starts, const std::string& rule) {
  const bool repels = eps < 0;
  const auto block = study.sized<std::int64_t>(500, 200000, 1000000);
  constexpr std::size_t blocks = 10;
  const bool is_long = static_cast<double>(blocks) * static_cast<double>(block) * 0.01 > some_hundred_bounces;
  Followers first, second, same;
  int not_measured = 0;
  std::vector<double> v1, change1, error1, change2, error2;
  for (const std::string& start : starts) {
    const TubeSet set{.run = {.eps = eps, .v1 = start, .rule = rule},
                      .blocks = blocks,
                      .most_energy_error = 0.01,
                      .block = block,
                      .both_bodies = true};
    std::vector<TubeStart> grid;
    const int members = study.sized(8, 16, 64);
    for (int k = 0; k < members; ++k) grid.push_back({eps, -0.9 + 1.8 * k / (members - 1), std::stod(start)});
    const double kinetic = grid[0].v1 * grid[0].v1 / 2;
    const double unchanged = repels ? 0 : almost_unchanged * kinetic;
    for (Followers* one : {&first, &second, &same}) one->of_starts.emplace_back();
    std::vector<double> a, b;
    for (const TubeWatch& seen : watch_tubes(study, fmt::format("{:+.1f}_{}_{}", eps, start, rule), set, grid)) {
      if (seen.stopped) {
        ++not_measured;
        for (Followers* one : {&first, &second, &same}) one->leave_open();
        continue;
      }
      std::vector<double> both(seen.blocks);
      for (std::size_t i = 0; i < both.size(); ++i) both[i] += seen.heavy[i];
      const MeanOfRun light = mean_of_run(seen.blocks, kinetic), heavy = mean_of_run(seen.heavy, energy_of_heavy),
                      sum = mean_of_run(both, kinetic + energy_of_heavy);
      // Repelling: kinetic1 grows to a multiple, at least twice.
      first.count(repels ? kinetic - light.value : light.value - unchanged, light.error);
      second.count(repels ? heavy.value : -heavy.value - unchanged, heavy.error);
      same.count(std::abs(sum.value) - std::max(almost_the_same * std::abs(light.value), unchanged),
                 sum.error + almost_the_same * light.error);
      a.push_back(light.value), b.push_back(heavy.value);
    }
    const Spread one = spread_of(a), two = spread_of(b);
    v1.push_back(std::stod(start));
    change1.push_back(one.mean), error1.push_back(one.standard_error());
    change2.push_back(two.mean), error2.push_back(two.standard_error());
  }
  const std::string side = repels ? "repelling" : "attracting";
  const std::string exceptions = repels ? "0 of 4" : "2 of 6";
  const auto claim = [&](const std::string& name, const std::string& statement, const Followers& followers) {
    const std::string decided_by = !is_long ? "longer runs: the default size, --full"
                                   : followers.of_v1() > followers.of_open()
                                       ? "the v1 of the thesis' own series, because the result depends on them"
                                   : not_measured > followers.all().open / 2 ? "runs that keep H, with a smaller step"
                                                                             : "still longer runs";
    std::vector<Measured> measured;
    if (is_long) measured.push_back(followers.share(not_measured));
    study.claim({fmt::format("{}_{}_{}", side, name, rule), statement + ", " + rule,
                 "the result of a series of simulations; exceptions in its table: " + exceptions},
                trend_rule(), measured, Grounds::program, decided_by);
  };
  claim("light",
        repels ? "repelling, v1 < v2: kinEnKx grows to a multiple, at least twice"
               : "attracting, v1 > v2, kinEnKx < kinEnKy: kinEnKx stays within 5 % or falls",
        first);
  claim("heavy",
        repels ? "repelling, v1 < v2: kinEnKy falls"
               : "attracting, v1 > v2: kinEnKy grows, or stays within 5 % of kinEnKx where that stays",
        second);
  claim("same",
        side + ": kinEnKy changes by (almost) the same amount, within 20 %" +
            (repels ? "" : ", or within 5 % of kinEnKx where that stays"),
        same);
  Curves curves{side + "_" + rule,
                {{"v1", v1}, {"change1", change1}, {"error1", error1}, {"change2", change2}, {"error2", error2}}};
  const std::pair<const char*, const Followers*> all[] = {{"light", &first}, {"heavy", &second}, {"same", &same}};
  for (const auto& [name, followers] : all) {
    for (const auto& [what, number] :
         {std::pair{"with", &Count::with}, std::pair{"against", &Count::against}, std::pair{"open", &Count::open}}) {
      std::vector<double> column;
      for (const Count& one : followers->of_starts) column.push_back(one.*number);
      curves.columns.emplace_back(fmt::format("{}_{}", name, what), column);
    }
  }
  study.keep(std::move(curves));
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
