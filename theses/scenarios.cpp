#include "scenarios.hpp"

#include <fmt/format.h>

#include "embedded.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow::reproduction {

std::string scenario_of(const std::string& name, const std::vector<std::string>& sets) {
  const std::string file = "scenarios/" + name + ".toml";
  const Reading reading = read_scenario_text(embedded_text(file), file, sets);
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
