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
#include <numbers>

#include "../experiment.hpp"
#include "../t_tube_runs.hpp"
#include "../time_panels.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/error.hpp"

namespace hamflow::reproduction {

namespace capture {

constexpr std::int64_t block_steps = 1000000;
constexpr std::size_t least_blocks = 20;
constexpr double unknown = std::numeric_limits<double>::infinity();  // an uncertainty: nothing follows

/// What is seen of one run.
struct Watch {
  TubeRun run;
  double q1 = 0;
  std::vector<double> blocks;            // means of kinetic1, from every tenth step
  std::vector<std::int64_t> two_to_one;  // steps of rejections whose image has a second preimage
  std::int64_t bounces = 0;
  double energy_error = 0;   // at the ends of blocks, of the scale
  bool stopped = false;      // its energy has wandered by 1 %
  std::vector<double> q, p;  // at the end
};

/// The step Psi_h without walls.
std::unique_ptr<StepMap> free_step(const TubeRun& run) {
  const ProblemEntry& problem = usual_problem("t-tube");
  const Texts given{{"masses", "[1, 100]"}, {"eps", fmt::format("{}", run.eps)}};
  return problem.step_map({.problem = "t-tube",
                           .variant = {{"walls", ""}},
                           .parameters = complete(problem.info, given),
                           .start = {},
                           .method = parse_method(run.method)},
                          2);
}

bool inside(const State<double>& z) { return std::abs(z[0]) <= 1 && z[1] >= 0.1 && z[1] <= 2.1; }

Watch watch(Study& study, TubeRun run, double q1, std::size_t blocks, const std::string& arithmetic = "double") {
  run.steps = block_steps;
  const Reading reading =
      read_scenario_text(tube_scenario(run), name_of(run),
                         {fmt::format("problem.initial.q[0]={:.17g}", q1), "run.arithmetic=" + arithmetic});
  if (!reading.scenario) throw Error(reading.complaints.at(0).text());
  Request request = reading.scenario->request;
  request.watch = false;
  const auto simulation = make_simulation(request);
  const auto map = free_step(run);
  const double h = std::stod(run.dt);
  Watch seen{.run = run, .q1 = q1};
  State<double> z(4);
  simulation->tell_bounces([&](const Bounce& bounce) {
    ++seen.bounces;
    if (run.rule != "reject") return;
    z = {bounce.q[0], bounce.q[1], bounce.p[0], bounce.p[1]};
    if (map->advance(z, -h, 1) && inside(z)) seen.two_to_one.push_back(bounce.step);
  });
  Frame frame;
  simulation->look(frame);
  seen.q = frame.q;
  seen.p = frame.p;
  const double start = frame.energy;
  for (std::size_t block = 0; block < blocks && !seen.stopped; ++block) {
    double sum = 0;
    for (std::int64_t i = 0; i < block_steps / 10; ++i) {
      if (simulation->advance(10) != Outcome::done) {  // of soft walls: through one
        seen.stopped = true;
        break;
      }
      simulation->look(frame);
      sum += frame.p[0] * frame.p[0] / 2;
      if (i % 1000 == 0) study.breathe();
    }
    seen.energy_error = std::max(seen.energy_error, std::abs(frame.energy - start) / std::abs(start));
    seen.stopped = run.rule == "mirror" && seen.energy_error > 0.01;
    seen.blocks.push_back(sum / (block_steps / 10));
  }
  seen.q = frame.q;
  seen.p = frame.p;
  return seen;
}

/// The first block from which on, to the end, the means scatter by less than 1e-3 of what they did before, for at least
/// 20 blocks; 0: there is none.
std::size_t captured_from(const Watch& seen) {
  const auto& x = seen.blocks;
  for (std::size_t b = 2; b + least_blocks <= x.size(); ++b) {
    const auto at = x.begin() + static_cast<std::ptrdiff_t>(b);
    const double before = spread_of({x.begin(), at}).deviation, after = spread_of({at, x.end()}).deviation;
    if (after < 1e-3 * before) return b;
  }
  return 0;
}

double median(std::vector<double> numbers) {
  if (numbers.empty()) return std::nan("");
  std::sort(numbers.begin(), numbers.end());
  return numbers[numbers.size() / 2];
}

/// A state on a late motion of +-0.6I, which reject has caught after 7.2 10^6 and 2.1 10^7 steps.
struct Late {
  const char* name;
  double eps;
  std::array<double, 2> q, p;
};
constexpr Late late_motions[] = {
    {"+0.6I", 0.6, {0.15814625933256049, 0.10189244782580631}, {4.2452748414207893, -93.438382498693628}},
    {"-0.6I", -0.6, {0.55143152800538775, 1.9976493956883772}, {-3.9788341526566837, 92.038549055583402}}};

/// How far two neighbours are apart in the later half of a run, over how far they were at first. Of a regular motion
/// that grows like t; of a chaotic one it ends where they are as far apart as they can be, near 1/shift.
double parting(Study& study, const std::string& name, TubeRun run, const Late& late, double shift) {
  run.eps = late.eps;
  run.steps = study.sized<std::int64_t>(20000, 100000, 1000000);
  run.record_every = run.steps / 200;
  const auto from = [&](double moved, const std::string& which) {
    return study.run(fmt::format("{}_{}_{}", late.name, name, which), tube_scenario(run),
                     {fmt::format("problem.initial={{ q = [{:.17g}, {:.17g}], p = [{:.17g}, {:.17g}] }}",
                                  late.q[0] + moved, late.q[1], late.p[0], late.p[1])});
  };
  const Trajectory one = from(0, "one"), other = from(shift, "other");
  std::vector<double> all;
  for (std::size_t k = 101; k < std::min(one.size(), other.size()); ++k) {
    all.push_back(std::hypot(one.q[k][0] - other.q[k][0], one.q[k][1] - other.q[k][1]));
  }
  return median(all) / std::abs(shift);
}

/// The same, and how much it depends on how far apart they were.
Measured measured_parting(Study& study, const std::string& name, const TubeRun& run, const Late& late,
                          const std::string& how) {
  const double one = parting(study, name, run, late, 1e-9), other = parting(study, name + "_wider", run, late, 2e-9);
  return {one, std::abs(one - other), how};
}

/// Whether the late motions are regular with the listing's rule, and whether the true flow has them.
void claim_late_motions(Study& study) {
  const std::string rule =
      "neighbours part like t where the motion is regular; a chaotic one has parted them 3e8 times and more";
  for (const Late& late : late_motions) {
    study.claim({fmt::format("regular_{}", late.name),
                 fmt::format("the late motion of {} is regular, with the rule of the listing", late.name), "regular"},
                at_most(1e6, rule),
                {measured_parting(study, "reject", {}, late, "reject, dt = 0.01, neighbours 1e-9 apart")});
    study.claim({fmt::format("true_flow_{}", late.name),
                 fmt::format("the late motion of {} is a regular orbit of the true flow", late.name), "an island"},
                at_most(1e6, rule),
                {measured_parting(study, "element", {.rule = "event", .method = "cg(3)"}, late,
                                  "continued with cg(3) and event, dt = 0.01"),
                 measured_parting(study, "event", {.rule = "event"}, late, "with stv4 and event")},
                Grounds::program, "longer runs, --full");
    std::string widths;
    for (const double shift : {1e-7, 1e-5, 1e-4, 1e-3}) {
      widths +=
          fmt::format(" {:.3g} ({:.0e})", parting(study, fmt::format("reject_{:.0e}", shift), {}, late, shift), shift);
    }
    study.note(fmt::format("{}: with reject neighbours part so many times, by how far they were apart:{}.", late.name,
                           widths));
  }
}

/// Two-to-one rejections over all, from the geometry: rejections lie in a layer h |v| before a wall; of it the part is
/// two-to-one where the step forward leaves and that backward from the image does not. Both are found by bisection
/// along the normal of the wall, for states spread evenly over the energy surface.
double geometric_rate(const Study& study, double eps, double energy, double h, int samples, int seed) {
  const auto map = free_step({.eps = eps});
  double layers = 0, parts = 0;
  std::uint64_t draw = 0;
  const auto uniform = [&] { return (1 + counter_uniform(static_cast<std::uint64_t>(seed), draw++)) / 2; };
  for (int k = 0; k < samples; ++k) {
    const std::size_t i = uniform() < 0.5 ? 0 : 1;
    const int side = uniform() < 0.5 ? -1 : 1;
    const double wall = i == 0 ? side : 1.1 + side, along = -1 + 2 * uniform() + (i == 0 ? 1.1 : 0);
    const double q1 = i == 0 ? wall : along, q2 = i == 0 ? along : wall;
    const double kinetic = energy + eps / std::hypot(q1, q2);
    const double angle = 2 * std::numbers::pi * uniform();
    if (!(kinetic > 0)) continue;
    State<double> z{q1, q2, std::sqrt(2 * kinetic) * std::cos(angle), std::sqrt(200 * kinetic) * std::sin(angle)};
    z[2 + i] = side * std::abs(z[2 + i]);
    // How far before the wall a state lies that just leaves, by a step h or by a step -h of its image.
    const auto layer = [&](bool image) {
      double low = 0, high = 3 * h * std::abs(z[2 + i]) / (i == 0 ? 1 : 100) + h * h * std::abs(eps) / 0.01;
      for (int bisection = 0; bisection < 60; ++bisection) {
        const double middle = (low + high) / 2;
        State<double> y = z;
        y[i] -= side * middle;
        if (image) y[2 + i] = -y[2 + i];
        map->advance(y, image ? -h : h, 1);
        ((y[i] - wall) * side > 0 ? low : high) = middle;
      }
      return low;
    };
    const double forward = layer(false), part = std::max(0.0, forward - layer(true));
    layers += forward;
    parts += part;
    if (k % 200 == 0) study.breathe();
  }
  return parts / layers;
}

void claim_two_to_one(Study& study) {
  constexpr std::array<double, 4> steps{0.02, 0.01, 0.005, 0.001};
  constexpr int batches = 8;
  const double energy = 50 - 0.6 / 1.1;
  std::array<std::vector<double>, 4> rates;
  std::vector<double> powers;
  for (int batch = 0; batch < batches; ++batch) {
    for (std::size_t i = 0; i < steps.size(); ++i) {
      rates[i].push_back(geometric_rate(study, 0.6, energy, steps[i], study.sized(400, 2500, 25000), 1 + batch));
    }
    powers.push_back(std::log(rates[1].back() / rates[3].back()) / std::log(steps[1] / steps[3]));
  }
  std::vector<double> means, errors;
  for (const auto& of_step : rates) {
    means.push_back(spread_of(of_step).mean);
    errors.push_back(spread_of(of_step).standard_error());
  }
  study.claim({"one_to_one",
               "with the rule of pages 84 and 103 each state is reached from one state only, as by every reversible or "
               "symplectic step",
               "nothing else is said", "83, 103"},
              none_of("two-to-one rejections of 10^9"),
              {{1e9 * means[1], 3e9 * errors[1], "share of the layer before the walls, dt = 0.01, StV4, eps = 0.6"},
               {1e9 * means[0], 3e9 * errors[0], "dt = 0.02"}},
              Grounds::ways);
  const Spread power = spread_of(powers);
  study.claim(
      {"power", "the share of two-to-one rejections falls as dt^2", "(a question of this project)"},
      within(2, 0.3, "forward and backward step differ by O(dt^3) in a layer of width O(dt)"),
      {{power.mean, 3 * power.standard_error(),
        fmt::format("from dt = 0.01 to 0.001; shares {:.3g}, {:.3g}, {:.3g}, {:.3g} at 0.02, 0.01, 0.005, 0.001",
                    means[0], means[1], means[2], means[3])}});
  study.keep({"two_to_one", {{"dt", {steps.begin(), steps.end()}}, {"share", means}, {"error", errors}}});
}

struct Counts {
  int captures = 0;
  double bounces = 0;
  int runs = 0;
  int stopped = 0;
  double energy_error = 0;  // the largest, of the scale
  std::vector<Watch> of_captured;
};

Counts all_of(Study& study, const std::string& rule, const std::string& method, int starts, std::size_t blocks,
              const std::string& arithmetic = "double") {
  Counts counts;
  for (const double eps : {0.6, -0.6}) {
    for (int s = 0; s < starts; ++s) {
      Watch seen = watch(study, {.eps = eps, .rule = rule, .method = method}, 0.01 + s * 1e-9 / 64, blocks, arithmetic);
      ++counts.runs;
      counts.bounces += static_cast<double>(seen.bounces);
      counts.stopped += seen.stopped;
      counts.energy_error = std::max(counts.energy_error, seen.energy_error);
      if (seen.stopped || captured_from(seen) == 0) continue;
      ++counts.captures;
      counts.of_captured.push_back(std::move(seen));
    }
  }
  return counts;
}

/// How far before its capture the last two-to-one rejection of a run lies, in blocks; not a number: there is none.
double last_before(const Watch& seen) {
  const auto from = static_cast<std::int64_t>(captured_from(seen)) * block_steps;
  double last = std::nan("");
  for (const std::int64_t step : seen.two_to_one) {
    if (step <= from) last = static_cast<double>(from - step) / static_cast<double>(block_steps);
  }
  return last;
}

void draw_blocks(Study& study, const Watch& seen) {
  std::vector<double> number, marked, mean;
  for (std::size_t i = 0; i < seen.blocks.size(); ++i) {
    number.push_back(static_cast<double>(i));
    const bool event = std::any_of(seen.two_to_one.begin(), seen.two_to_one.end(), [&](std::int64_t step) {
      return static_cast<std::size_t>(step / block_steps) == i;
    });
    if (event) marked.push_back(static_cast<double>(i)), mean.push_back(seen.blocks[i]);
  }
  figures::Panel panel = over_time("mean {/:Italic K}_1 of a block", number, seen.blocks);
  panel.x_label = "block of 10^6 steps";
  panel.series.push_back({figures::Ink::fine_dots, "two-to-one", {marked, mean}});
  study.keep({"blocks", {{"block", number}, {"kinetic1", seen.blocks}}});
  study.draw("figure",
             fmt::format("Block means of the light body's kinetic energy, {}; dots: blocks with a two-to-one rejection",
                         name_of(seen.run)),
             {study.info().title, {panel}});
}

void claim_of_others(Study& study, const Counts& reject, const Counts& others, const std::string& name,
                     const std::string& what) {
  const double expected = reject.captures * others.bounces / std::max(reject.bounces, 1.0);
  const std::string how = fmt::format(
      "{} captures in {:.3g} bounces of {} runs ({} stopped: mirror's energy off by 1 %, or through a wall; largest "
      "energy error {:.2g}); at reject's "
      "rate {:.3g} would be expected",
      others.captures, others.bounces, others.runs, others.stopped, others.energy_error, expected);
  // Exact Poisson: with c captures the mean is below bound_c at 99.9 %; with fewer than 10 expected nothing follows.
  const double bound = -std::log(1e-3);
  study.claim(
      {"captures_" + name, "the late motion is reached by " + what + ", as often a bounce as by the listing's rule",
       "physics"},
      at_least(0.5, "captures over those expected at reject's rate, at least 10 of them"),
      {{expected > 0 ? others.captures / expected : 0,
        expected >= 10 ? (others.captures == 0 ? bound : 3.3 * std::sqrt(others.captures)) / expected : unknown, how}},
      Grounds::program, "runs until at least 10 captures are expected: --full, or longer");
}

void carry_out(Study& study) {
  claim_two_to_one(study);
  claim_late_motions(study);
  const auto blocks = study.sized<std::size_t>(1, 50, 100);
  const int starts = study.sized(1, 8, 256);
  const Counts reject = all_of(study, "reject", "stv4", starts, blocks);
  study.claim({"captured", "after long transients the motion becomes regular for good", "symmetric time"},
              at_least(0.5, "runs that became regular by the rule of block means"),
              {{static_cast<double>(reject.captures), blocks < 2 * least_blocks ? unknown : 0.0,
                fmt::format("{} of {} runs of {} blocks with reject", reject.captures, reject.runs, blocks)}},
              Grounds::program, "runs of some 10^7 steps: the default size");
  double without = 0;
  std::string gaps;
  for (const Watch& seen : reject.of_captured) {
    const double gap = last_before(seen);
    without += std::isnan(gap) ? 1 : 0;
    gaps += fmt::format(" {:.3g}", gap);
  }
  study.claim({"cause", "captures follow a rejection that is two-to-one", "artefact"},
              none_of("captures without a two-to-one rejection before"),
              {{without, reject.captures == 0 ? unknown : 0.0,
                fmt::format("{} captures, blocks from the last such rejection to each:{}", reject.captures, gaps)}},
              Grounds::program, "runs in which reject captures: the default size");
  if (!reject.of_captured.empty()) draw_blocks(study, reject.of_captured.front());
  const Counts event = all_of(study, "event", "stv4", starts, blocks);
  claim_of_others(study, reject, event, "event", "an exactly located wall event");
  const Counts mirror = all_of(study, "mirror", "stv4", starts, blocks);
  claim_of_others(study, reject, mirror, "mirror", "the one-to-one mirror");
  const Counts lattice =
      all_of(study, "mirror", "stv4", study.sized(1, 2, 64), study.sized<std::size_t>(1, 5, 100), "lattice");
  claim_of_others(study, reject, lattice, "lattice", "the mirror on the lattice, a permutation");
  const Counts soft = all_of(study, "soft", "stv4", study.sized(0, 1, 64), study.sized<std::size_t>(0, 10, 100));
  claim_of_others(study, reject, soft, "soft", "soft walls");
  const Counts element = all_of(study, "event", "cg(2)", study.sized(0, 1, 8), study.sized<std::size_t>(0, 1, 20));
  claim_of_others(study, reject, element, "cg", "cg(2) with events, which keeps the energy");
  study.note(
      "A one-to-one map that preserves volume enters a set R of finite volume with Psi(R) in R from a null set only: "
      "the "
      "true flow and the mirror, on the lattice a permutation, capture nothing. Of event, which preserves no volume, "
      "only counts decide.");
}

}  // namespace capture

std::vector<Experiment> capture_experiments() {
  return {{{"S-capture", sonnleitner, "109", "T-tube: is the late periodic motion physics?"}, capture::carry_out}};
}

}  // namespace hamflow::reproduction
