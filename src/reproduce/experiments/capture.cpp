// [Sonnleitner2010], the open question of page 109: is the late periodic motion of the T-tube physics, or does the wall
// rule of the listing catch it? That rule keeps the position and negates a momentum where a step Psi_h would leave the
// domain. A state R z so reached is reached a second time, from Psi_-h(R z), where that lies inside: there the rule is
// not one-to-one. A one-to-one map that preserves volume enters a set R of finite volume with Psi(R) in R from a null
// set only, since vol(Psi^-1(R) - R) = 0: it captures nothing.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>

#include "../experiment.hpp"
#include "../time_panels.hpp"
#include "../tube_watch.hpp"
#include "../two_to_one.hpp"
#include "json_text.hpp"

namespace hamflow::reproduction {

namespace capture {

constexpr double unknown = std::numeric_limits<double>::infinity();  // an uncertainty: nothing follows

double median(std::vector<double> numbers) {
  if (numbers.empty()) return std::nan("");
  std::sort(numbers.begin(), numbers.end());
  return numbers[numbers.size() / 2];
}

/// Largest Lyapunov exponents over T and 4 T time units from the end of a run. Of a regular motion neighbours part like
/// t, so that they fall like log T/T; three times that is allowed for the shear. A chaotic one has 50 times that.
struct Exponents {
  double shorter = 0, longer = 0, time = 0;
  bool regular() const {
    return std::abs(shorter) <= 3 * std::log(time) / time && std::abs(longer) <= 3 * std::log(4 * time) / (4 * time);
  }
};

/// Over so many steps, and four times as many: infinite where the motion ends, which a soft wall may do. In double,
/// since tangents of the lattice are none.
Exponents exponents_from(Study& study, const TubeSet& set, const TubeWatch& seen, const std::string& name,
                         std::int64_t steps) {
  std::vector<std::string> sets{"run.lyapunov=1"};
  for (const std::string& one : set.sets) {
    if (!one.starts_with("run.arithmetic=")) sets.push_back(one);
  }
  const auto over = [&](std::int64_t length, const char* which) {
    const Trajectory run = study.try_run(fmt::format("{}_{}", name, which),
                                         scenario_of_start(set, seen.start, length, seen.q, seen.p), sets);
    if (run.report.status != "done") return unknown;
    return read_json(run.report.json).at("lyapunov").at("exponents").at(0).get<double>();
  };
  return {over(steps, "shorter"), over(4 * steps, "longer"), static_cast<double>(steps) * std::stod(set.run.dt)};
}

/// @param moved by which Q1 is another
std::string initial_of(const LateMotion& late, double moved) {
  const std::vector<double>&q = late.q, &p = late.p;
  return fmt::format("problem.initial={{ q = [{:.17g}, {:.17g}], p = [{:.17g}, {:.17g}] }}", q[0] + moved, q[1], p[0],
                     p[1]);
}

/// How far two neighbours are apart in the later half of a run, over how far they were at first. Of a regular motion
/// that grows like t; of a chaotic one it ends where they are as far apart as they can be, near 1/shift.
double parting(Study& study, const std::string& name, TubeRun run, const LateMotion& late, double shift) {
  run.eps = late.eps;
  run.steps = study.sized<std::int64_t>(20000, 100000, 1000000);
  run.record_every = run.steps / 200;
  const auto from = [&](double moved, const std::string& which) {
    return study.run(fmt::format("{}_{}_{}", late.name, name, which), tube_scenario(run), {initial_of(late, moved)});
  };
  const Trajectory one = from(0, "one"), other = from(shift, "other");
  std::vector<double> all;
  for (std::size_t k = 101; k < std::min(one.size(), other.size()); ++k) {
    all.push_back(std::hypot(one.q[k][0] - other.q[k][0], one.q[k][1] - other.q[k][1]));
  }
  return median(all) / std::abs(shift);
}

/// The same, and how much it depends on how far apart they were.
Measured measured_parting(Study& study, const std::string& name, const TubeRun& run, const LateMotion& late,
                          const std::string& how) {
  const double one = parting(study, name, run, late, 1e-9), other = parting(study, name + "_wider", run, late, 2e-9);
  return {one, std::abs(one - other), how};
}

/// Of located bounces each costs a hundred steps, for tangents go through it in more digits.
std::int64_t steps_in_true_flow(const Study& study) { return study.sized<std::int64_t>(10000, 50000, 200000); }

/// How far around a late motion others are regular, as their own exponents tell: with the listing's rule, and in the
/// true flow, whose walls are located.
void tell_neighbourhood(Study& study, const LateMotion& late, Table& table) {
  std::vector<double> shifts{0};
  if (study.sized(0, 1, 1) > 0) shifts = {0, 1e-4, 1e-3, 1e-2, 0.1};
  for (const char* const rule : {"reject", "event"}) {
    for (const double moved : shifts) {
      TubeWatch beside{.start = {.eps = late.eps}, .q = late.q, .p = late.p};
      beside.q[0] += moved;
      const std::string name = fmt::format("{}_{}_moved_{:g}", late.name, rule, moved);
      const Exponents of = exponents_from(study, {.run = {.rule = rule}}, beside, name, steps_in_true_flow(study));
      table.rows.push_back({late.name, rule, fmt::format("{:g}", moved), fmt::format("{:.2g}", of.shorter),
                            fmt::format("{:.2g}", of.longer), of.regular() ? "yes" : "no"});
    }
  }
}

/// A motion goes round in up to 910 time units: what one round says of it is not known before some of them.
constexpr double some_rounds = 2000;

/// Regular with the rule of the listing: by the tangent of the motion itself. Of neighbours at any distance only those
/// within the regular set would tell, and how wide that is is not known before.
void claim_regular(Study& study, const LateMotion& late) {
  const auto steps = study.sized<std::int64_t>(20000, 200000, 1000000);
  const double time = 4 * 0.01 * static_cast<double>(steps);
  std::vector<Measured> measured;
  if (time >= some_rounds) {
    const TubeWatch own{.start = {.eps = late.eps}, .q = late.q, .p = late.p};
    const Exponents of =
        exponents_from(study, {.run = {.rule = "reject"}}, own, std::string(late.name) + "_own", steps);
    const auto units = [](double exponent, double t) { return std::abs(exponent) * t / std::log(t); };
    const double longer = units(of.longer, time), shorter = units(of.shorter, time / 4);
    measured.push_back({longer, std::abs(longer - shorter),
                        fmt::format("exponents {:.2g} over {:g} and {:.2g} over {:g} time units, reject, dt = 0.01",
                                    of.shorter, time / 4, of.longer, time)});
  }
  study.claim({fmt::format("regular_{}", late.name),
               fmt::format("a late motion of {} is regular, with the rule of the listing", late.name), "regular"},
              at_most(3,
                      "largest Lyapunov exponent over log T/T: 1 where tangents grow like t; a chaotic motion's is "
                      "beyond 30"),
              measured, Grounds::program, fmt::format("{:g} time units, some rounds: the default size", some_rounds));
}

/// Whether the late motions are regular with the listing's rule, and whether the true flow has them.
void claim_late_motions(Study& study) {
  const double time = 0.01 * static_cast<double>(steps_in_true_flow(study));
  Table table{"neighbourhood",
              "Motions beside a late one, Q1 moved: with the rule of the listing, and with located bounces (stv4)",
              {"late motion of", "rule", "moved by", fmt::format("exponent over {:g} time units", time),
               fmt::format("over {:g}", 4 * time), "by at most 3 log T/T"},
              {}};
  Table partings{"partings",
                 "How many times as far apart neighbours of a late motion are in the later half of a run as at first, "
                 "reject: of a chaotic one they end as far apart as they can be",
                 {"late motion of"},
                 {}};
  const std::vector<double> shifts{1e-11, -1e-11, 1e-9, -1e-9, 1e-7, -1e-7, 1e-5, 1e-3};
  for (const double shift : shifts) partings.headings.push_back(fmt::format("moved by {:.0e}", shift));
  for (const LateMotion& late : late_motions(study)) {
    claim_regular(study, late);
    study.claim({fmt::format("true_flow_{}", late.name),
                 fmt::format("a late motion of {} is a regular orbit of the true flow", late.name), "an island"},
                at_most(1e6,
                        "how many times as far apart neighbours come that were 1e-9 apart: a chaotic motion has "
                        "parted them 3e8 times and more"),
                {measured_parting(study, "element", {.rule = "event", .method = "cg(3)"}, late,
                                  "continued with cg(3) and event, dt = 0.01"),
                 measured_parting(study, "event", {.rule = "event"}, late, "with stv4 and event")},
                Grounds::program, "longer runs, --full");
    std::vector<std::string> row{late.name};
    for (const double shift : shifts) {
      row.push_back(fmt::format("{:.3g}", parting(study, fmt::format("reject_{:.0e}", shift), {}, late, shift)));
    }
    partings.rows.push_back(std::move(row));
    tell_neighbourhood(study, late, table);
  }
  study.table(std::move(partings));
  study.table(std::move(table));
}

void claim_two_to_one(Study& study) {
  constexpr std::array<double, 4> steps{0.02, 0.01, 0.005, 0.001};
  constexpr int batches = 8;
  const double energy = 50 - 0.6 / 1.1;
  std::array<std::vector<double>, 4> rates;
  std::vector<double> powers;
  for (int batch = 0; batch < batches; ++batch) {
    for (std::size_t i = 0; i < steps.size(); ++i) {
      rates[i].push_back(two_to_one_share(study, 0.6, energy, steps[i], study.sized(400, 2500, 25000), 1 + batch));
    }
    powers.push_back(std::log(rates[1].back() / rates[3].back()) / std::log(steps[1] / steps[3]));
  }
  std::vector<double> means, errors;
  for (const auto& of_step : rates) {
    means.push_back(spread_of(of_step).mean);
    errors.push_back(spread_of(of_step).standard_error());
  }
  study.claim(
      {"one_to_one",
       "each state is reached from one state only, as by every reversible or symplectic step, also with the rule "
       "of pages 84 and 103",
       "robust symplectic algorithms", "111"},
      none_of("two-to-one rejections of 10^9, or pairs of states that are sent to one"),
      {{1e9 * means[1], 3e9 * errors[1], "share of the layer before the walls, dt = 0.01, StV4, eps = 0.6"},
       explicit_pair()},
      Grounds::ways);
  const Spread power = spread_of(powers);
  Table rates_of{"two_to_one_rates",
                 "Two-to-one rejections of 10^9, by the geometry of the layers before the walls, StV4, eps = 0.6",
                 {"dt", "of 10^9", "standard error"},
                 {}};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    rates_of.rows.push_back(
        {fmt::format("{:g}", steps[i]), fmt::format("{:.3g}", 1e9 * means[i]), fmt::format("{:.2g}", 1e9 * errors[i])});
  }
  study.table(std::move(rates_of));
  study.note(
      fmt::format("Their share falls like dt to the power {:.2f} +- {:.2f} (3 standard errors) from dt = 0.01 to "
                  "0.001: forward and "
                  "backward step differ by O(dt^3) in a layer of width O(dt), so that 2 is expected.",
                  power.mean, 3 * power.standard_error()));
  study.keep({"two_to_one", {{"dt", {steps.begin(), steps.end()}}, {"share", means}, {"error", errors}}});
}

struct Captured {
  TubeWatch seen;
  std::size_t from = 0;  // block
  Exponents exponents;
};

/// What came of a set of runs.
struct Counts {
  std::string name;
  TubeSet set;
  double bounces = 0;
  double steps = 0;
  int runs = 0;
  int stopped = 0;
  double energy_error = 0;  // the largest, of the start's
  std::vector<Captured> captured;
  int regular_blocks_only = 0;  // whose exponents are those of chaos
  TubeWatch free;               // a run that was not captured, for comparison
};

Counts all_of(Study& study, const std::string& name, const TubeSet& set, int starts) {
  Counts counts{.name = name, .set = set};
  for (TubeWatch& seen : watch_tubes(study, "watched_" + name, set, tube_starts(starts))) {
    ++counts.runs;
    counts.bounces += static_cast<double>(seen.bounces);
    counts.steps += static_cast<double>(seen.blocks.size()) * tube_block;
    counts.stopped += seen.stopped;
    counts.energy_error = std::max(counts.energy_error, seen.energy_error);
    const std::size_t from = seen.stopped ? 0 : regular_from(seen.blocks);
    if (from == 0) {
      if (counts.free.blocks.empty() && seen.start.v1 == 0 && !seen.stopped) counts.free = std::move(seen);
      continue;
    }
    const std::string run = fmt::format("{}_captured_{}", name, counts.captured.size() + 1);
    const Exponents exponents = exponents_from(study, set, seen, run, study.sized<std::int64_t>(10000, 200000, 200000));
    if (exponents.regular()) {
      counts.captured.push_back({std::move(seen), from, exponents});
    } else {
      ++counts.regular_blocks_only;
    }
  }
  if (!set.run.rule.empty() && counts.runs > 0) {
    study.keep_scenario(name,
                        scenario_of_start(set, tube_starts(2)[0], static_cast<std::int64_t>(set.blocks) * tube_block));
  }
  return counts;
}

/// The first block from which on all means lie near the late one, within a twentieth of their scatter before: the rule
/// of capture allows no slower drift, and so finds a later block.
std::size_t settled_from(const Captured& one) {
  const auto& x = one.seen.blocks;
  const auto at = x.begin() + static_cast<std::ptrdiff_t>(one.from);
  const double late = spread_of({at, x.end()}).mean, before = spread_of({x.begin(), at}).deviation;
  std::size_t block = one.from;
  while (block > 0 && std::abs(x[block - 1] - late) < 0.05 * before) --block;
  return block;
}

/// How far before the first settled block the last two-to-one rejection of a run lies, in blocks; not a number: there
/// is none. In the block of the capture itself that is at most 1.
double last_before(const Captured& one) {
  const auto from = static_cast<std::int64_t>(settled_from(one)) * tube_block;
  double last = std::nan("");
  for (const std::int64_t step : one.seen.two_to_one) {
    if (step <= from) last = static_cast<double>(from - step) / static_cast<double>(tube_block);
  }
  return last;
}

std::string name_of_start(const TubeStart& start) {
  return fmt::format("eps = {:+.1f}, q1 = {:.15g}, v1 = {:g}", start.eps, start.q1, start.v1);
}

figures::Panel panel_of_blocks(const Captured& one) {
  const TubeWatch& seen = one.seen;
  std::vector<double> number, marked, mean;
  for (std::size_t i = 0; i < seen.blocks.size(); ++i) {
    number.push_back(static_cast<double>(i));
    const bool event = std::any_of(seen.two_to_one.begin(), seen.two_to_one.end(),
                                   [&](std::int64_t step) { return static_cast<std::size_t>(step / tube_block) == i; });
    if (event) marked.push_back(static_cast<double>(i)), mean.push_back(seen.blocks[i]);
  }
  figures::Panel panel = over_time("mean {/:Italic K}_1 of a block", number, seen.blocks);
  panel.x_label = "block of 10^6 steps";
  panel.series.push_back({figures::Ink::dots, "two-to-one", {marked, mean}});
  return panel;
}

/// At most six captured runs, each with its blocks, marked where a rejection was two-to-one.
void draw_blocks(Study& study, const Counts& reject) {
  figures::Page page{study.info().title, {}};
  std::string starts;
  for (std::size_t i = 0; i < std::min<std::size_t>(reject.captured.size(), 6); ++i) {
    const Captured& one = reject.captured[i];
    std::vector<double> number(one.seen.blocks.size()), steps(one.seen.two_to_one.begin(), one.seen.two_to_one.end());
    for (std::size_t k = 0; k < number.size(); ++k) number[k] = static_cast<double>(k);
    study.keep({fmt::format("blocks_{}", i + 1), {{"block", number}, {"kinetic1", one.seen.blocks}}});
    study.keep({fmt::format("two_to_one_{}", i + 1), {{"step", steps}}});
    page.panels.push_back(panel_of_blocks(one));
    starts += (starts.empty() ? "" : "; ") + name_of_start(one.seen.start);
  }
  study.draw("figure",
             "Block means of the light body's kinetic energy of captured runs, reject, up to the capture and on: large "
             "dots mark blocks with a two-to-one rejection (counted up to the capture). " +
                 starts,
             std::move(page));
}

void tell_captures(Study& study, const Counts& reject) {
  Table table{
      "captures",
      "Runs that reject captured, the first 16",
      {"start", "first regular block", "blocks from the last two-to-one rejection to it",
       "two-to-one rejections up to it", "exponent over 2000 time units", "over 8000", "mean K1 before", "after"},
      {}};
  for (const Captured& one : reject.captured) {
    if (one.seen.two_to_one.empty()) continue;  // not run again
    const auto& x = one.seen.blocks;
    const auto at = x.begin() + static_cast<std::ptrdiff_t>(one.from);
    table.rows.push_back({name_of_start(one.seen.start), fmt::format("{}", settled_from(one)),
                          fmt::format("{:.3g}", last_before(one)), fmt::format("{}", one.seen.two_to_one.size()),
                          fmt::format("{:.2g}", one.exponents.shorter), fmt::format("{:.2g}", one.exponents.longer),
                          fmt::format("{:.4g}", spread_of({x.begin(), at}).mean),
                          fmt::format("{:.6g}", spread_of({at, x.end()}).mean)});
  }
  if (!table.rows.empty()) study.table(std::move(table));
}

/// The largest rate over another that c captures beside c0 of the other leave at 3 standard deviations, where bounces
/// are x times the other's: of c + c0 captures, c or fewer fall to this side with probability 0.00135. Exact, for
/// Poisson numbers.
double highest_ratio(int c, int c0, double x) {
  const auto tail = [&](double ratio) {
    const double share = ratio * x / (1 + ratio * x);
    double sum = 0;
    for (int k = 0; k <= c; ++k) {
      sum += std::exp(std::lgamma(c + c0 + 1.0) - std::lgamma(k + 1.0) - std::lgamma(c + c0 - k + 1.0) +
                      k * std::log(share) + (c + c0 - k) * std::log1p(-share));
    }
    return sum;
  };
  double low = 1e-6, high = 1e6;
  for (int i = 0; i < 200; ++i) {
    const double middle = std::sqrt(low * high);
    (tail(middle) > 0.00135 ? low : high) = middle;
  }
  return high;
}

void claim_of_others(Study& study, const Counts& reject, const Counts& others, const std::string& what,
                     const std::string& decided_by) {
  const int first = static_cast<int>(reject.captured.size()), second = static_cast<int>(others.captured.size());
  const double share = others.bounces / std::max(reject.bounces, 1.0), expected = first * share;
  const double ratio = expected > 0 ? second / expected : 0;
  std::vector<Measured> measured;
  if (first > 0 && others.runs > 0) {
    const std::string stopped =
        others.stopped > 0 ? fmt::format(" ({} of them stopped early)", others.stopped) : std::string();
    measured.push_back(
        {ratio, expected >= 10 ? highest_ratio(second, first, share) - ratio : unknown,
         fmt::format("{} captures in {:.3g} bounces of {} runs{}; at reject's rate {:.3g} would be expected", second,
                     others.bounces, others.runs, stopped, expected)});
  }
  study.claim(
      {"captures_" + others.name,
       "the late motion is reached by " + what + ", as often in as many bounces as by the listing's rule", "physics"},
      at_least(0.5, "captures over those expected at reject's rate; of fewer than 10 expected nothing follows"),
      measured, Grounds::program, first == 0 ? "runs in which reject captures: the default size" : decided_by);
}

void tell_counts(Study& study, const std::vector<const Counts*>& all) {
  Table table{"rules",
              "Captures by wall rule: block means that stay, and exponents of at most 3 log T/T",
              {"rule", "dt", "runs", "steps", "bounces", "captures", "expected at reject's rate", "stopped early",
               "largest energy error"},
              {}};
  for (const Counts* one : all) {
    const double expected =
        static_cast<double>(all[0]->captured.size()) * one->bounces / std::max(all[0]->bounces, 1.0);
    table.rows.push_back({one->name, one->set.run.dt, fmt::format("{}", one->runs), fmt::format("{:.3g}", one->steps),
                          fmt::format("{:.3g}", one->bounces), fmt::format("{}", one->captured.size()),
                          fmt::format("{:.3g}", expected), fmt::format("{}", one->stopped),
                          fmt::format("{:.2g}", one->energy_error)});
  }
  study.table(std::move(table));
}

/// Bounces of soft walls are not counted: they are those of hard ones in the same time.
void count_as(Counts& soft, const Counts& hard) {
  if (hard.steps == 0) return;
  soft.bounces = hard.bounces / (hard.steps * std::stod(hard.set.run.dt)) * soft.steps * std::stod(soft.set.run.dt);
}

void claim_captures(Study& study, Counts& reject) {
  const std::size_t blocks = reject.set.blocks;
  study.claim(
      {"captured", "after long transients the motion becomes regular for good", "symmetric time"},
      at_least(0.5, "runs that became regular: block means, and exponents of at most 3 log T/T"),
      blocks < 2 * tube_least_blocks
          ? std::vector<Measured>{}
          : std::vector<Measured>{{static_cast<double>(reject.captured.size()), 0,
                                   fmt::format(
                                       "{} of {} runs of {} blocks with reject; {} more regular in their means alone",
                                       reject.captured.size(), reject.runs, blocks, reject.regular_blocks_only)}},
      Grounds::program, "runs of some 10^7 steps: the default size");
  double without = 0, events = 0, tried = 0, longest = 0;
  const auto looked_at = std::min<std::size_t>(reject.captured.size(), 16);  // each is run again
  study.each(looked_at, [&](std::size_t k) {
    find_two_to_one(study, reject.set, reject.captured[k].seen, reject.captured[k].from);
  });
  for (const Captured& one : std::span(reject.captured).first(looked_at)) {
    const double gap = last_before(one);
    without += gap <= 1 ? 0 : 1;
    longest = std::max(longest, gap);
    events += static_cast<double>(one.seen.two_to_one.size());
    tried += static_cast<double>(one.from);
  }
  std::vector<Measured> causes;
  if (looked_at > 0) {
    causes.push_back(
        {without, 0,
         fmt::format("the first {} captures, the rejection at most {:.2g} blocks before; one happens every {:.3g} "
                     "blocks, so that by chance a share of {:.2g} would have it there",
                     looked_at, longest, tried / std::max(events, 1.0), 1 - std::exp(-events / std::max(tried, 1.0)))});
  }
  study.claim({"cause", "each capture happens in the block of 10^6 steps of a two-to-one rejection", "artefact"},
              none_of("captures without such a rejection in the block before the first regular one"), causes,
              Grounds::program, "runs in which reject captures: the default size");
}

/// Whether what reject has caught is also a motion between walls that are located.
void claim_true_flow(Study& study, const Counts& reject) {
  const auto looked_at = std::min<std::size_t>(reject.captured.size(), 16);
  int others = 0;
  for (std::size_t k = 0; k < looked_at; ++k) {
    const Exponents of = exponents_from(study, {.run = {.rule = "event"}}, reject.captured[k].seen,
                                        fmt::format("captured_{}_in_true_flow", k + 1), steps_in_true_flow(study));
    if (!of.regular()) ++others;
  }
  study.claim(
      {"true_flow_of_captured", "the late motions are regular orbits of the true flow", "physics"},
      none_of("captured motions that are not, by their exponents: more than 3 log T/T with located bounces"),
      looked_at == 0
          ? std::vector<Measured>{}
          : std::vector<Measured>{{static_cast<double>(others), 0,
                                   fmt::format("the first {} that reject captured, continued with event and stv4",
                                               looked_at)}},
      Grounds::program, "runs in which reject captures: the default size");
}

void carry_out(Study& study) {
  claim_two_to_one(study);
  claim_late_motions(study);
  // Of the listing's rule more: its rate decides how many captures the others should have. Lanes make a step of it a
  // small part of what one of event costs, for its bounces are located. Of the others so many that no capture at all
  // would leave the ratio clearly below a half: some 17 expected ones. --full has more starts.
  const int starts = study.sized(2, 64, 512), of_reject = study.sized(2, 256, 512);
  const int of_event = study.sized(2, 112, 512), of_soft = study.sized(2, 96, 512);
  const auto set_of = [](const std::string& rule, const std::string& method, const std::string& dt, std::size_t blocks,
                         std::vector<std::string> sets = {}) {
    TubeSet set{.run = {.rule = rule, .method = method, .dt = dt}, .sets = std::move(sets), .blocks = blocks};
    // Another energy is another system; that of reject stays within 1 % by itself.
    set.most_energy_error = rule == "mirror" ? 0.01 : 0.1;
    return set;
  };
  Counts reject =
      all_of(study, "reject", set_of("reject", "stv4", "0.01", study.sized<std::size_t>(1, 100, 100)), of_reject);
  claim_captures(study, reject);
  claim_true_flow(study, reject);
  if (!reject.captured.empty()) draw_blocks(study, reject);
  tell_captures(study, reject);
  // With dt = 0.01 the energy of event walks off by a multiple of itself in that time.
  const Counts event =
      all_of(study, "event", set_of("event", "stv4", "0.0025", study.sized<std::size_t>(1, 400, 400)), of_event);
  Counts soft =
      all_of(study, "soft",
             set_of("soft", "stv4", "0.005", study.sized<std::size_t>(1, 240, 100), {"problem.exponent=6"}), of_soft);
  count_as(soft, event);
  const Counts mirror =
      all_of(study, "mirror", set_of("mirror", "stv4", "0.01", study.sized<std::size_t>(1, 100, 100)), starts);
  const Counts lattice =
      all_of(study, "lattice",
             set_of("mirror", "stv4", "0.01", study.sized<std::size_t>(1, 5, 100), {"run.arithmetic=lattice"}),
             study.sized(2, 4, 64));
  const Counts element =
      all_of(study, "cg", set_of("event", "cg(2)", "0.01", study.sized<std::size_t>(0, 1, 20)), study.sized(0, 2, 16));
  claim_of_others(study, reject, event, "an exactly located wall event", "longer runs: --full");
  claim_of_others(study, reject, soft, "soft walls of exponent 6", "longer runs: --full");
  const std::string walk =
      "no longer run, since its energy walks off by 1 % before: the theorem decides, which has no exception";
  claim_of_others(study, reject, mirror, "the one-to-one mirror", walk);
  claim_of_others(study, reject, lattice, "the mirror on the lattice, a permutation", walk);
  claim_of_others(study, reject, element, "cg(2) with events, which keeps the energy",
                  "10^10 steps of cg(2), some 40 hours on a processor");
  tell_counts(study, {&reject, &event, &soft, &mirror, &lattice, &element});
  study.note(
      "A one-to-one map that preserves volume enters a set R of finite volume with Psi(R) in R from a null set only: "
      "the true flow and the mirror, on the lattice a permutation, capture nothing. Of event, which preserves no "
      "volume, only counts decide.");
}

}  // namespace capture

std::vector<Experiment> capture_experiments() {
  return {{{"S-capture", sonnleitner, "109", "T-tube: is the late periodic motion physics?"}, capture::carry_out}};
}

}  // namespace hamflow::reproduction
