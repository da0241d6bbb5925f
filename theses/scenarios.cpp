#include "scenarios.hpp"

#include <fmt/format.h>

#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "scenario_texts.hpp"

namespace hamflow::reproduction {

std::string scenario_of(const std::string& name, const std::vector<std::string>& sets) {
  const auto found = scenario_texts().find(name);
  if (found == scenario_texts().end()) throw Error("found no scenario " + name);
  const Reading reading = read_scenario_text(found->second, name + ".toml", sets);
  if (!reading.scenario) {
    throw Error(joined(
        reading.complaints, [](const Complaint& complaint) { return complaint.text(); }, "; "));
  }
  return reading.scenario->text;
}

std::vector<std::string> in_steps(const std::string& dt, long steps, long every, const std::string& method) {
  std::vector<std::string> sets{fmt::format("run.dt=\"{}\"", dt), fmt::format("run.steps={}", steps),
                                fmt::format("run.record_every={}", every)};
  if (!method.empty()) sets.push_back(method);
  return sets;
}

}  // namespace hamflow::reproduction
