// hamflow new: prints a scenario to start from, written from the declarations of the catalogue.
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/verify/measure.hpp"
#include "scenario_template.hpp"
#include "suggested_names.hpp"

namespace hamflow::app {

namespace {

void add_once(std::vector<std::string>& list, const std::string& word) {
  if (std::find(list.begin(), list.end(), word) == list.end()) list.push_back(word);
}

/// The catalogue entry of a problem for the given choices; choices not given have their default. @throws Error
std::shared_ptr<const ProblemEntry> chosen(const NewOptions& options) {
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::string>> choices;
  for (const ProblemEntry& entry : problems()) {
    add_once(names, entry.info.name);
    if (entry.info.name != options.problem) continue;
    for (const auto& [key, value] : entry.info.variant) {
      if (!entry.structure) add_once(choices[key], value);
    }
  }
  for (const ProblemEntry& entry : typed_examples()) {
    const std::string& key = entry.info.typed_choice;
    if (entry.info.name == options.problem) add_once(choices[key], choice_of(entry.info, key));
  }
  if (std::find(names.begin(), names.end(), options.problem) == names.end()) {
    throw Error("found the problem '" + options.problem + "'; allowed " + joined(names) +
                suggested_problem(options.problem));
  }
  std::map<std::string, std::string> variant;
  for (const auto& [key, value] : options.variant) {
    if (value.empty()) continue;
    if (!choices.contains(key)) {
      std::string allowed;
      for (const auto& choice : choices) allowed += (allowed.empty() ? "--" : ", --") + choice.first;
      throw Rejection("--" + key, fmt::format("{} has no choice of {}; allowed {}", options.problem, key,
                                              allowed.empty() ? "no such option" : allowed));
    }
    const std::vector<std::string>& all = choices[key];
    if (std::find(all.begin(), all.end(), value) == all.end()) {
      throw Rejection("--" + key, fmt::format("found {}; allowed {}{}", value, joined(all), suggestion(value, all)));
    }
    variant[key] = value;
  }
  const auto lacking = [&](const ProblemEntry& entry) {
    return std::find_if(variant.begin(), variant.end(), [&](const auto& choice) {
      return std::find(entry.info.variant.begin(), entry.info.variant.end(), std::pair(choice.first, choice.second)) ==
             entry.info.variant.end();
    });
  };
  for (const ProblemEntry& entry : typed_examples()) {
    const auto typed = variant.find(entry.info.typed_choice);
    if (entry.info.name != options.problem || typed == variant.end()) continue;
    if (lacking(entry) == variant.end()) return std::make_shared<const ProblemEntry>(entry);
  }
  // A choice may exist only together with another: a pendulum has a dimension only in Cartesian coordinates.
  const std::shared_ptr<const ProblemEntry> usual = usual_problem(options.problem, variant);
  const auto lacks = lacking(*usual);
  if (lacks == variant.end()) return usual;
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name == options.problem && lacking(entry) == variant.end())
      return find_problem(options.problem, {entry.info.variant.begin(), entry.info.variant.end()});
  }
  throw Rejection(
      "--" + lacks->first,
      fmt::format("found {}, which cannot be combined with the other choices; leave it out", lacks->second));
}

/// The example that the problem declares; else a start in the region where `hamflow verify` measures, since runs are
/// bounded and regular there.
ExampleInfo example_for(const ProblemEntry& problem) {
  ExampleInfo example = problem.info.example;
  const Region region = region_of(problem.info.name, {problem.info.variant.begin(), problem.info.variant.end()});
  if (example.parameters.empty()) example.parameters = region.parameters;
  if (example.dt == 0) example.dt = region.step;
  if (example.q.empty() && problem.info.default_q.empty()) {
    const auto half = static_cast<std::ptrdiff_t>(region.centre.size() / 2);
    example.q.assign(region.centre.begin(), region.centre.begin() + half);
    example.p.assign(region.centre.begin() + half, region.centre.end());
  }
  return example;
}

}  // namespace

int new_command(const NewOptions& options) {
  return guarded(false, [&] {
    const std::shared_ptr<const ProblemEntry> problem = chosen(options);
    MethodSpec method{.name = ""};
    if (!options.method.empty()) {
      method = parse_method(options.method);
      if (const std::string why_not = refusal(method, *problem); !why_not.empty()) throw Rejection("--method", why_not);
    }
    std::cout << scenario_template(*problem, example_for(*problem), method, options.all);
    return exit_done;
  });
}

}  // namespace hamflow::app
