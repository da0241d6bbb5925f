#include "tube_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "hamflow/core/error.hpp"
#include "hamflow/run/ensemble.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow::reproduction {

namespace {

constexpr std::int64_t steps_per_stop_check = 20000;  // steps from one check for Ctrl-C to the next
constexpr std::int64_t steps_per_sample = 10;         // steps from one sample to the next, outside of lanes

Scenario scenario_for(const TubeSet& set, const TubeStart& start) {
  Reading reading = read_scenario_text(scenario_of_start(set, start, set.block), name_of(set.run), set.sets);
  if (!reading.scenario) throw Error(reading.complaints.at(0).text());
  return *std::move(reading.scenario);
}

double energy_of(const Scenario& scenario, const std::vector<double>& q, const std::vector<double>& p) {
  return scenario.problem->energy(scenario.request.parameters, q, p);
}

/// Stores the results of a block that has ended. @param means block means of the kinetic energies
/// @return whether the run continues
bool end_block(const Scenario& scenario, const TubeSet& set, TubeWatch& watch, const std::vector<double>& means) {
  const double start = energy_of(scenario, scenario.start_q, scenario.start_p);
  const double error = std::abs(energy_of(scenario, watch.q, watch.p) - start) / std::abs(start);
  watch.blocks.push_back(means[0]);
  if (set.both_bodies) watch.heavy.push_back(means[1]);
  watch.energy_error = std::max(watch.energy_error, error);
  watch.stopped = !(watch.energy_error <= set.most_energy_error);
  return !watch.stopped;
}

std::int64_t sum_of(const std::vector<WallCount>& walls) {
  std::int64_t all = 0;
  for (const WallCount& wall : walls) all += wall.bounces;
  return all;
}

/// Runs each start in its own lane.   @return false if the method does not run in lanes
bool run_tubes_in_lanes(const Study& study, const TubeSet& set, std::span<TubeWatch> all) {
  std::vector<Scenario> scenarios;
  std::vector<MemberStart> members;
  ParameterShape shape;
  for (const TubeWatch& one : all) {
    const Scenario& scenario = scenarios.emplace_back(scenario_for(set, one.start));
    const Parameters<double> parameters(scenario.request.parameters);
    MemberStart member{scenario.start_q, scenario.start_p, {}, std::stod(set.run.dt)};
    shape.clear();
    for (const ParameterInfo& info : scenario.problem->info.parameters) {
      if (!parameters.has(info.name)) continue;
      const std::vector<double>& numbers = parameters.list(info.name);
      shape.emplace_back(info.name, numbers.size());
      member.parameters.insert(member.parameters.end(), numbers.begin(), numbers.end());
    }
    members.push_back(std::move(member));
  }
  Request request = scenarios[0].request;
  request.watch = false;
  const auto block = make_ensemble_block(request, widest_lanes());
  if (!block || !block->load(shape, std::span(members).first(1))) return false;  // lanes() needs a loaded member
  if (all.size() > block->lanes()) {
    for (std::size_t i = 0; i < all.size(); i += block->lanes()) {
      if (!run_tubes_in_lanes(study, set, all.subspan(i, std::min(block->lanes(), all.size() - i)))) return false;
    }
    return true;
  }
  const auto energy_as = [&](const char* name, const char* text) {
    return NamedExpression{name, StateExpression(text, *scenarios[0].problem, scenarios[0].request.parameters, 2)};
  };
  std::vector<NamedExpression> kinetic{energy_as("kinetic1", "p1^2/2")};
  if (set.both_bodies) kinetic.push_back(energy_as("kinetic2", "p2^2/200"));
  const std::vector sums(all.size(), std::span<const NamedExpression>(kinetic));
  if (!block->load(shape, members) || !block->expect_sums(sums)) return false;
  std::vector before(all.size(), std::vector<double>(kinetic.size()));
  std::vector<double> means(kinetic.size());
  Frame frame;
  for (std::size_t b = 0; b < set.blocks; ++b) {
    for (std::int64_t steps = 0; steps < set.block; steps += steps_per_stop_check) {
      block->advance(std::min(steps_per_stop_check, set.block - steps));
      study.breathe();
    }
    bool any = false;
    for (std::size_t lane = 0; lane < all.size(); ++lane) {
      TubeWatch& watch = all[lane];
      if (watch.stopped) continue;
      if (block->is_lost(lane)) {
        watch.stopped = true;
        continue;
      }
      block->show(lane, frame);
      watch.q = frame.q, watch.p = frame.p;
      const std::vector<StepSum> lane_sums = block->sums(lane);
      for (std::size_t i = 0; i < kinetic.size(); ++i) {
        const double sum = lane_sums[i].value();
        means[i] = (sum - std::exchange(before[lane][i], sum)) / static_cast<double>(set.block);
      }
      any = end_block(scenarios[lane], set, watch, means) || any;
      watch.bounces = sum_of(block->look(lane).walls);
    }
    if (!any) break;
  }
  return true;
}

void run_tube_alone(const Study& study, const TubeSet& set, TubeWatch& watch) {
  const Scenario scenario = scenario_for(set, watch.start);
  Request request = scenario.request;
  request.watch = false;
  const auto simulation = make_simulation(request);
  Frame frame;
  bool goes_on = true;
  for (std::size_t b = 0; b < set.blocks && goes_on; ++b) {
    std::vector<double> means(2);
    const std::int64_t looks = set.block / steps_per_sample;
    for (std::int64_t i = 0; i < looks; ++i) {
      if (simulation->advance(steps_per_sample) != Outcome::done) {  // a soft wall fails if a body passes it
        watch.stopped = true;
        return;
      }
      simulation->look(frame);
      means[0] += frame.p[0] * frame.p[0] / 2 / static_cast<double>(looks);
      means[1] += frame.p[1] * frame.p[1] / 200 / static_cast<double>(looks);
      if (i % 1000 == 0) study.breathe();
    }
    watch.q = frame.q, watch.p = frame.p;
    watch.bounces = sum_of(simulation->wall_counts());
    goes_on = end_block(scenario, set, watch, means);
  }
}

std::vector<TubeWatch> run_tube_group(const Study& study, const TubeSet& set, std::span<const TubeStart> starts) {
  std::vector<TubeWatch> all;
  for (const TubeStart& start : starts) all.push_back({.start = start});
  if (run_tubes_in_lanes(study, set, all)) return all;
  for (TubeWatch& one : all) {
    one = {.start = one.start};
    run_tube_alone(study, set, one);
  }
  return all;
}

constexpr std::size_t starts_per_file = 32;  // the widest block of lanes

std::string json_of(const std::vector<TubeWatch>& watches) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const TubeWatch& one : watches) {
    all.push_back({{"blocks", one.blocks},
                   {"heavy", one.heavy},
                   {"bounces", one.bounces},
                   {"energy_error", one.energy_error},
                   {"stopped", one.stopped},
                   {"q", one.q},
                   {"p", one.p}});
  }
  return all.dump() + "\n";
}

/// Reads stored results. Returns an empty vector if the file is missing or contains something else.
std::vector<TubeWatch> read_tube_results(const std::filesystem::path& file, std::span<const TubeStart> starts) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  const auto all = nlohmann::json::parse(text.str(), nullptr, false);
  if (!all.is_array() || all.size() != starts.size()) return {};
  std::vector<TubeWatch> watches;
  try {
    for (std::size_t i = 0; i < starts.size(); ++i) {
      const auto& one = all[i];
      watches.push_back({.start = starts[i],
                         .blocks = one.at("blocks"),
                         .heavy = one.at("heavy"),
                         .bounces = one.at("bounces"),
                         .energy_error = one.at("energy_error"),
                         .stopped = one.at("stopped"),
                         .q = one.at("q"),
                         .p = one.at("p")});
    }
  } catch (const nlohmann::json::exception&) {
    return {};
  }
  return watches;
}

bool inside(const State<double>& z) { return std::abs(z[0]) <= 1 && z[1] >= 0.1 && z[1] <= 2.1; }

}  // namespace

std::vector<TubeStart> tube_starts(int number) {
  std::vector<TubeStart> all;
  for (const double eps : {0.6, -0.6}) {
    for (int s = 0; s < number / 2; ++s) {
      const int of_32 = s % 32, turn = s / 32;
      const double near = (of_32 + 32 * turn) * 1e-9 / 64;
      if (of_32 < 14) {
        all.push_back({eps, 0.01 + near, 0});
      } else if (of_32 < 22) {
        all.push_back({eps, 0.01 + near, of_32 < 18 ? 1.0 : of_32 < 20 ? 6.0 : 10.0});
      } else {
        all.push_back({eps, -0.9 + 0.2 * (of_32 - 22) + near, 0});
      }
    }
  }
  return all;
}

std::vector<LateMotion> late_motions(Study& study) {
  std::vector<LateMotion> all{{"+0.6I", 0.6, 10, {}, {}}, {"-0.6I", -0.6, 129, {}, {}}, {"-0.6I-2", -0.6, 203, {}, {}}};
  const std::vector<TubeStart> known = tube_starts(512);
  const TubeSet set{.run = {}, .blocks = late_blocks};
  std::vector<TubeStart> starts;
  for (const LateMotion& motion : all) {
    starts.push_back(known.at(motion.start + (motion.eps > 0 ? 0 : known.size() / 2)));
  }
  const std::vector<TubeWatch> seen = watch_tubes(study, "late", set, starts);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].q = seen[i].q, all[i].p = seen[i].p;
    study.keep_scenario(fmt::format("late_{}", all[i].name),
                        scenario_of_start(set, starts[i], static_cast<std::int64_t>(late_blocks) * tube_block));
  }
  return all;
}

std::vector<TubeWatch> watch_tubes(const Study& study, const std::string& name, const TubeSet& set,
                                   std::span<const TubeStart> starts) {
  if (set.blocks == 0) return {};
  std::vector<std::vector<TubeWatch>> parts((starts.size() + starts_per_file - 1) / starts_per_file);
  study.each(parts.size(), [&](std::size_t part) {
    const std::size_t first = part * starts_per_file;
    const auto some = starts.subspan(first, std::min(starts_per_file, starts.size() - first));
    const auto file = study.folder() / fmt::format("{}_{}.json", name, first);
    parts[part] = read_tube_results(file, some);
    if (!parts[part].empty()) return;
    parts[part] = run_tube_group(study, set, some);
    write_text(file, json_of(parts[part]));
  });
  std::vector<TubeWatch> all;
  for (std::vector<TubeWatch>& part : parts) std::move(part.begin(), part.end(), std::back_inserter(all));
  return all;
}

std::size_t regular_from(const std::vector<double>& x) {
  for (std::size_t b = 2; b + tube_least_blocks <= x.size(); ++b) {
    const auto at = x.begin() + static_cast<std::ptrdiff_t>(b);
    const double before = spread_of({x.begin(), at}).deviation, after = spread_of({at, x.end()}).deviation;
    if (after < 1e-3 * before) return b;
  }
  return 0;
}

void find_two_to_one(const Study& study, const TubeSet& set, TubeWatch& watch, std::size_t blocks) {
  Request request = scenario_for(set, watch.start).request;
  request.watch = false;
  const auto simulation = make_simulation(request);
  const auto map = free_tube_step({.eps = watch.start.eps, .method = set.run.method});
  const double h = std::stod(set.run.dt);
  State<double> z(4);
  simulation->on_bounce([&](const Bounce& bounce) {
    z = {bounce.q[0], bounce.q[1], bounce.p[0], bounce.p[1]};
    if (map->advance(z, -h, 1) && inside(z)) watch.two_to_one.push_back(bounce.step);
  });
  for (std::int64_t steps = 0; steps < static_cast<std::int64_t>(blocks) * tube_block; steps += steps_per_stop_check) {
    if (simulation->advance(steps_per_stop_check) != Outcome::done)
      throw Error("a run of the T-tube ended: " + simulation->failure());
    study.breathe();
  }
}

std::string scenario_of_start(const TubeSet& set, const TubeStart& start, std::int64_t steps,
                              const std::vector<double>& q, const std::vector<double>& p) {
  const std::string state = q.empty()
                                ? fmt::format("q = [{:.17g}, 1.1], v = [{:g}, 1]", start.q1, start.v1)
                                : fmt::format("q = [{:.17g}, {:.17g}], p = [{:.17g}, {:.17g}]", q[0], q[1], p[0], p[1]);
  TubeRun run = set.run;
  run.eps = start.eps, run.steps = steps;
  return tube_scenario_from(run, state);
}

std::unique_ptr<StepMap> free_tube_step(const TubeRun& run) {
  const auto problem_entry = usual_problem("t-tube");
  const ProblemEntry& problem = *problem_entry;
  const Texts given{{"masses", "[1, 100]"}, {"eps", fmt::format("{}", run.eps)}};
  return problem.step_map({.problem = "t-tube",
                           .variant = {},
                           .parameters = complete(problem.info, given),
                           .start = {},
                           .method = parse_method(run.method)},
                          2);
}

}  // namespace hamflow::reproduction
