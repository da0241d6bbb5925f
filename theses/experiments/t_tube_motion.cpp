// [Sonnleitner2010], figures 3.4 and 3.5: momenta and positions of the T-tube soon after the start and late, with the
// ranges that are printed in their titles, for each wall rule.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "../experiment.hpp"
#include "../time_panels.hpp"
#include "../tube_runs.hpp"

namespace hamflow::reproduction {

namespace t_tube_motion {

constexpr std::array<const char*, 3> rules{"reject", "mirror", "event"};

constexpr std::int64_t ten_minutes = 60000;  // steps: 600 time units, the thesis' seconds
constexpr int windows = 5;                   // of ten minutes

Trajectory from_start(Study& study, const std::string& rule, double eps, std::int64_t steps, const std::string& name) {
  TubeRun run{.eps = eps, .rule = rule};
  run.steps = steps;
  run.record_every = 1;
  return study.run(fmt::format("{}_{}_{:+.1f}", name, rule, eps), tube_scenario(run));
}

/// The first ten minutes.
Trajectory early(Study& study, const std::string& rule, double eps = -0.6) {
  return from_start(study, rule, eps, ten_minutes, "early");
}

double largest(const std::vector<double>& numbers) {
  double all = 0;
  for (const double x : numbers) all = std::max(all, std::abs(x));
  return all;
}

/// How far the largest of a quantity depends on when one looks: its difference between both halves.
Measured range(const std::vector<double>& numbers, const std::string& how) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  const double first = largest({numbers.begin(), middle}), second = largest({middle, numbers.end()});
  return {std::max(first, second), std::abs(first - second), how};
}

/// The largest of the first ten minutes of a chaotic motion is one of many that there may be: how far the largest of
/// the next ones differ from it.
Measured range_of_windows(const std::vector<double>& numbers, const std::string& how) {
  std::vector<double> all;
  for (int k = 0; k < windows; ++k) {
    const auto first = numbers.begin() + k * ten_minutes;
    all.push_back(largest({first, first + ten_minutes}));
  }
  double off = 0;
  for (const double other : all) off = std::max(off, std::abs(other - all[0]));
  return {all[0], off,
          fmt::format("{}; +-: the largest difference from {} later windows of the same length", how, windows - 1)};
}

/// No |P2| is larger than that with P1 = 0 at the place of least potential energy.
double bound_of_heavy(double eps) {
  const double start = 50 - eps / std::hypot(0.01, 1.1);
  const double r = eps < 0 ? std::hypot(1, 2.1) : 0.1;
  return std::sqrt(200 * (start + eps / r));
}

/// Scatter of the means of kinetic1 over blocks of run.steps steps, each continued from the end of the one before, over
/// their mean. Means of a wandering energy depend on each other, so that their number says nothing about how certain
/// their scatter is; other starts within 1e-9 do: the uncertainty is the largest difference to one of theirs.
Measured scatter_of_blocks(Study& study, const TubeRun& run, std::size_t blocks) {
  constexpr int others = 7;
  std::string velocities = run.v1;
  for (int k = 1; k <= others; ++k) velocities += fmt::format(",{:.17g}", std::stod(run.v1) + k * 1e-9 / others);
  std::vector<TubeMember> members = ensemble(study, run, {"problem.initial.v[0]=" + velocities});
  std::vector<std::vector<double>> means(members.size());
  for (std::size_t block = 0; block < blocks; ++block) {
    if (block > 0) members = continued(study, run, members);
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (members[i].done) means[i].push_back(members[i].kinetic1 + members[i].change1);
    }
  }
  const auto scatter = [](const std::vector<double>& some) { return spread_of(some).deviation / spread_of(some).mean; };
  const double of_start = scatter(means[0]);
  double uncertainty = 0;
  for (const auto& some : means) uncertainty = std::max(uncertainty, std::abs(scatter(some) - of_start));
  return {of_start, uncertainty,
          fmt::format("{} blocks of {} steps from the start; +-: the largest difference from {} starts within 1e-9",
                      blocks, run.steps, others)};
}

/// Of cells x cells of the rectangle of positions, those that the points of a trajectory visit.
int visited_cells(const std::vector<double>& x, const std::vector<double>& y, int cells) {
  constexpr double x_size = 1, y_low = 0.1, y_high = 2.1;
  std::set<int> visited;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const int a = std::clamp(static_cast<int>((x[i] + x_size) / (2 * x_size) * cells), 0, cells - 1);
    const int b = std::clamp(static_cast<int>((y[i] - y_low) / (y_high - y_low) * cells), 0, cells - 1);
    visited.insert(a * cells + b);
  }
  return static_cast<int>(visited.size());
}

/// A late motion, continued. Its start is what a capture by "reject" has left.
Trajectory continued_late(Study& study, const LateMotion& from, std::int64_t steps, const std::string& name) {
  TubeRun run{.eps = from.eps};
  run.steps = steps;
  run.record_every = 1;
  return study.run(fmt::format("{}_{}", from.name, name), tube_scenario(run),
                   {fmt::format("problem.initial={{ q = [{:.17g}, {:.17g}], p = [{:.17g}, {:.17g}] }}", from.q[0],
                                from.q[1], from.p[0], from.p[1])});
}

/// For a figure: every tenth.
std::vector<double> thinned(const std::vector<double>& numbers) {
  std::vector<double> some;
  for (std::size_t i = 0; i < numbers.size(); i += 10) some.push_back(numbers[i]);
  return some;
}

/// The first numbers, up to a time.
std::vector<double> up_to(double t, const Trajectory& path, const std::vector<double>& numbers) {
  const auto end = std::upper_bound(path.t.begin(), path.t.end(), t + 1e-9) - path.t.begin();
  return {numbers.begin(), numbers.begin() + end};
}

/// Figures 3.4b, c and e: a day of the thesis is 86 400 time units, of which the first 600 are shown and kept.
void late_momenta(Study& study) {
  const LateMotion late = late_motions(study).front();
  const Trajectory path = continued_late(study, late, 60000, "late");
  const std::vector<double> light = path.momentum(0), heavy = path.momentum(1);
  study.claim(
      {"late_heavy_captured", "P2 stays between its start values also late, in a motion that reject has captured",
       "[-100, 100]", "89"},
      at_most(110, "100 and a small deviation; the text does not say how small, a tenth is allowed"),
      {range(heavy, "600 time units of the late motion +0.6I of S3.5")});
  study.note(fmt::format(
      "P1 of the late motion drawn here stays within {:.4g}, not 4.29: each capture has a range of its own.",
      largest(light)));
  study.keep({"late", {{"t", path.t}, {"P1", light}, {"P2", heavy}}});
  constexpr double minutes = 180;
  study.draw("late", "Late: P1 over 600 time units (3.4b) and over 180 (3.4c), P2 over 600 (3.4e); +0.6I, reject",
             {"T-tube: late momenta",
              {over_time("{/:Italic P}_1", thinned(path.t), thinned(light)),
               over_time("{/:Italic P}_1", up_to(minutes, path, path.t), up_to(minutes, path, light)),
               over_time("{/:Italic P}_2", thinned(path.t), thinned(heavy))}});
}

void momenta(Study& study) {
  Measured heavy_attracted;
  for (const char* const rule : rules) {
    const Trajectory path = early(study, rule);
    const Trajectory longer = from_start(study, rule, -0.6, windows * ten_minutes, "windows");
    study.claim(
        {fmt::format("heavy_{}", rule),
         fmt::format("P2 stays within its start value, up to a small deviation, {}", rule), "[-100, 100]", "85, 89"},
        at_most(110, "100 and a small deviation; the text does not say how small, a tenth is allowed"),
        {range_of_windows(longer.momentum(1), "eps = -0.6, first 600 time units")}, Grounds::program,
        "other starts: a longer run of mirror has another energy");
    if (std::string(rule) == "reject") {
      study.keep(
          {"early", {{"t", thinned(path.t)}, {"P1", thinned(path.momentum(0))}, {"P2", thinned(path.momentum(1))}}});
      study.draw("figure", "P1 (3.4a) and P2 during the first 600 time units, reject",
                 {study.info().title,
                  {over_time("{/:Italic P}_1", thinned(path.t), thinned(path.momentum(0))),
                   over_time("{/:Italic P}_2", thinned(path.t), thinned(path.momentum(1)))}});
      study.draw("first_minute", "P2 during the first 60 time units (3.4d), reject",
                 {study.info().title,
                  {over_time("{/:Italic P}_2", up_to(60, path, path.t), up_to(60, path, path.momentum(1)))}});
    }
    const Trajectory attracted = from_start(study, rule, 0.6, windows * ten_minutes, "windows");
    heavy_attracted = range_of_windows(attracted.momentum(1), fmt::format("eps = 0.6, first 600 time units, {}", rule));
    study.claim({fmt::format("late_light_{}", rule),
                 fmt::format("P1 of Sim+0.6I lies between -4.29 and 4.29, {}", rule), "4.29", "88"},
                as_printed("4.29"),
                {range_of_windows(attracted.momentum(0), "first 600 time units; the thesis looks at day 6")},
                Grounds::program,
                "the thesis' own start to its last digit: late motions differ from each other, as the captures in "
                "S-capture show");
  }
  study.claim({"heavy_bound", "P2 stays within its start value, up to a small deviation: the bound by the energy",
               "[-100, 100]", "85, 89"},
              at_most(110, "100 and a small deviation; the text does not say how small, a tenth is allowed"),
              {{bound_of_heavy(-0.6), 1e-10, "eps = -0.6, with P1 = 0 at (1, 2.1)"}});
  study.claim({"heavy_attracted", "P2 stays within its start value also where the force attracts", "[-100, 100]", "85"},
              at_most(110, "100 and a small deviation; the text does not say how small, a tenth is allowed"),
              {heavy_attracted, {bound_of_heavy(0.6), 1e-10, "what the energy allows: with P1 = 0 at (0, 0.1)"}},
              Grounds::program);
  late_momenta(study);
  // Whether the motion becomes regular: S-capture has the rule; here block means as they come.
  TubeRun run{.eps = -0.6, .v1 = "6"};
  run.steps = study.sized<std::int64_t>(20000, 500000, 5000000);
  for (const char* const rule : rules) {
    run.rule = rule;
    study.claim({fmt::format("regular_{}", rule), fmt::format("late motion is regular: Sim-0.6III, {}", rule),
                 "regular", "87, 88"},
                at_most(0.002, "scatter of 20 block means over their mean; a wandering energy is not regular"),
                {scatter_of_blocks(study, run, 20)}, Grounds::program, "longer blocks: --full");
  }
}

/// The curve of positions over the first 75 time units, as a line through every step: a bounce is a corner.
figures::Panel positions(const Trajectory& path) {
  figures::Panel panel =
      phase_plane("{/:Italic Q}_1", "{/:Italic Q}_2", path.coordinate(0), path.coordinate(1), {}, {});
  figures::Curve curve;
  for (std::size_t i = 0; i < std::min<std::size_t>(path.size(), 7500); ++i) curve.add(path.q[i][0], path.q[i][1]);
  panel.series = {{figures::Ink::line, "", curve}};
  return panel;
}

/// Positions over so many steps, and the cells that they visit in these and in four times as many.
struct Followed {
  Trajectory path;
  Measured growth;
};
Followed followed(Study& study, const LateMotion& from, std::int64_t steps) {
  const Trajectory path = continued_late(study, from, steps, "once");
  const Trajectory longer = continued_late(study, from, 4 * steps, "longer");
  const int once = visited_cells(path.coordinate(0), path.coordinate(1), 200);
  const int later = visited_cells(longer.coordinate(0), longer.coordinate(1), 200);
  return {path,
          {static_cast<double>(later) / once, 0,
           fmt::format("cells of 200 x 200: {} in {:g}, {} in {:g} time units, reject", once, path.t.back(), later,
                       longer.t.back())}};
}

/// A curve that is run through again and again visits no new place behind its first round, which takes up to 910 time
/// units.
void claim_discrete(Study& study, const LateMotion& late) {
  const auto [path, growth] = followed(study, late, 100000);
  const std::string motion = late.name;
  study.claim(
      {"discrete_" + motion,
       "late positions are a discrete curve that is passed periodically: a late motion of " + motion, "discrete", "92"},
      at_most(1.01, "no new cells in four times the time"), {growth});
  study.draw(motion, fmt::format("Positions (3.5c) and momenta (3.5d) of a late motion of {}, reject", motion),
             {fmt::format("T-tube: late, {}", motion),
              {positions(path), phase_plane("{/:Italic P}_1", "{/:Italic P}_2", thinned(path.momentum(0)),
                                            thinned(path.momentum(1)), {}, {})}});
}

void curves(Study& study) {
  for (const char* const rule : rules) {
    const Trajectory path = early(study, rule);
    const Trajectory longer = from_start(study, rule, -0.6, windows * ten_minutes, "windows");
    const double heavy = largest(path.momentum(1));
    study.claim(
        {fmt::format("heavy_{}", rule), fmt::format("range of P2 during the transient, {}", rule), "100.3"},
        as_printed("100.3"),
        {{heavy, std::abs(bound_of_heavy(-0.6) - heavy), "first 600 time units; +-: up to the bound by the energy"}},
        Grounds::program, "the part of the run that the thesis shows: its 'Tag2' is not the first ten minutes");
    study.claim({fmt::format("light_{}", rule), fmt::format("range of P1 during the transient, {}", rule), "4.5"},
                as_printed("4.5"), {range_of_windows(longer.momentum(0), "first 600 time units")}, Grounds::program,
                "the part of the run that the thesis shows: its 'Tag2' is not the first ten minutes");
    const double of_positions = visited_cells(path.coordinate(0), path.coordinate(1), 30) / 900.0;
    study.claim({fmt::format("dense_{}", rule), fmt::format("the curve of positions fills the rectangle, {}", rule),
                 "densely", "90"},
                at_least(0.99, "share of 30 x 30 cells that are visited in 600 time units"),
                {{of_positions, 0, "cells"}});
    if (std::string(rule) == "reject") {
      study.draw("figure", "Positions (3.5a) and momenta (3.5b), first 600 time units, reject",
                 {study.info().title,
                  {positions(path),
                   phase_plane("{/:Italic P}_1", "{/:Italic P}_2", path.momentum(0), path.momentum(1), {}, {})}});
    }
  }
  for (const LateMotion& late : late_motions(study)) claim_discrete(study, late);
  study.note(
      "The thesis does not say which late motion it shows. Three of those here are motions that reject captures early; "
      "Sim-0.6III, which reproduces the table, is regular from its start.");
  claim_discrete(study, {"-0.6III", -0.6, 0, {0.01, 1.1}, {6, 100}});
  study.claim({"no_curve", "in the transient positions fill the rectangle, not a curve", "filling the area", "90"},
              at_least(1.1, "new cells in four times the time"),
              {followed(study, {"early", -0.6, 0, {0.01, 1.1}, {0, 100}}, 40000).growth});
}

}  // namespace t_tube_motion

std::vector<Experiment> t_tube_motion_experiments() {
  using namespace t_tube_motion;
  return {{{"S3.4", sonnleitner, "86 to 89", "T-tube: momenta over time"}, momenta},
          {{"S3.5", sonnleitner, "90 to 92", "T-tube: curves of positions and of momenta"}, curves}};
}

}  // namespace hamflow::reproduction
