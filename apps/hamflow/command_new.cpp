// hamflow new: a scenario to begin with, written from what the catalogue says of the problem.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <set>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/scenario/coordinates.hpp"
#include "hamflow/verify/measure.hpp"
#include "scenario_template.hpp"

namespace hamflow::app {

namespace {

/// What a selecting key is when it is not given.
const std::set<std::string> usual_choices{"kepler", "cartesian", "nonlinear", "absolute"};

std::string list_of(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}
std::string meant(const std::string& name, const std::vector<std::string>& candidates) {
  const std::string near = nearest(name, candidates);
  return near.empty() ? "" : "; did you mean " + near + "?";
}

void add_once(std::vector<std::string>& list, const std::string& word) {
  if (std::find(list.begin(), list.end(), word) == list.end()) list.push_back(word);
}

/// The entry of a problem with the choices given, the usual ones for those not given. @throws Error
const ProblemEntry& chosen(const NewOptions& options) {
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::string>> choices;
  for (const ProblemEntry& entry : problems()) {
    add_once(names, entry.info.name);
    if (entry.info.name != options.problem) continue;
    for (const auto& [key, value] : entry.info.variant) add_once(choices[key], value);
  }
  if (std::find(names.begin(), names.end(), options.problem) == names.end()) {
    throw Error("there is no problem '" + options.problem + "'; allowed " + list_of(names) +
                meant(options.problem, names));
  }
  std::map<std::string, std::string> variant;
  for (const auto& [key, value] : options.variant) {
    if (value.empty()) continue;
    if (!choices.contains(key)) {
      std::string allowed;
      for (const auto& choice : choices) allowed += (allowed.empty() ? "--" : ", --") + choice.first;
      throw Error(fmt::format("--{}: {} has no choice of {}; allowed {}", key, options.problem, key,
                              allowed.empty() ? "no choice here" : allowed));
    }
    const std::vector<std::string>& all = choices[key];
    if (std::find(all.begin(), all.end(), value) == all.end()) {
      throw Error(fmt::format("--{}: found {}; allowed {}{}", key, value, list_of(all), meant(value, all)));
    }
    variant[key] = value;
  }
  for (const auto& [key, all] : choices) {
    if (variant.contains(key)) continue;
    const auto usual =
        std::find_if(all.begin(), all.end(), [](const auto& word) { return usual_choices.contains(word); });
    variant[key] = usual != all.end() ? *usual : all.front();
  }
  return find_problem(options.problem, variant);
}

/// Where `hamflow verify` measures is where a run is bounded and regular.
ScenarioExample example_for(const ProblemEntry& problem) {
  std::map<std::string, std::string> variant(problem.info.variant.begin(), problem.info.variant.end());
  const bool polar = variant.contains("coordinates") && variant["coordinates"] == "polar";
  if (polar) variant["coordinates"] = "cartesian";
  const Region region = region_of(problem.info.name, variant);
  ScenarioExample example;
  example.parameters = region.parameters;
  example.dt = region.step;
  const auto half = static_cast<std::ptrdiff_t>(region.centre.size() / 2);
  example.q.assign(region.centre.begin(), region.centre.begin() + half);
  example.p.assign(region.centre.begin() + half, region.centre.end());
  if (polar) {
    const CanonicalState state = StateConverter("cartesian", "polar")({example.q, example.p});
    example.q = state.q;
    example.p = state.p;
  }
  // A start of the catalogue's own is better than a region about it.
  if (!problem.info.default_q.empty()) example.q.clear();
  if (problem.info.name == "double-pendulum") example.dt = 0.01;
  if (problem.info.name == "n-body") {  // a sun with two planets: the region's bodies would meet after a while
    example = {.parameters = {{"masses", "[1, 0.001, 0.0005]"}},
               .q = {0, 0, 1, 0, 0, -1.7},
               .p = {-0.00038, -0.001, 0, 0.001, 0.00038, 0},
               .dt = 0.05,
               .steps = 2000};
  }
  if (problem.info.name == "solar-system") {  // days; Jupiter takes 4333 for one round
    example.dt = 20;
    example.steps = 10000;
  }
  return example;
}

}  // namespace

int new_command(const NewOptions& options) {
  return guarded(false, [&] {
    const ProblemEntry& problem = chosen(options);
    std::cout << scenario_template(problem, example_for(problem));
    return exit_done;
  });
}

}  // namespace hamflow::app
