#include "hamflow/workflow/convert.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "converted_text.hpp"
#include "scenario_edit.hpp"
#include "summary.hpp"

namespace hamflow {

namespace {

using Json = nlohmann::ordered_json;

std::string row(const std::vector<double>& numbers) {
  std::string text;
  for (const double x : numbers) text += fmt::format("{}{:.17g}", text.empty() ? "" : ", ", x);
  return "[" + text + "]";
}

/// Why the scenario's method cannot run in the new coordinates; empty if it can.
std::string refused_method(const Scenario& scenario, const std::string& to) {
  auto variant = scenario.request.variant;
  variant[coordinate_key(to)] = to;
  return refusal(scenario.request.method, find_problem(scenario.request.problem, variant));
}

}  // namespace

std::string state_text(const CanonicalState& state) { return "q = " + row(state.q) + "\np = " + row(state.p) + "\n"; }

std::string state_json(const std::string& system, const CanonicalState& state) {
  return json_text(Json{{"coordinates", system}, {"q", state.q}, {"p", state.p}});
}

std::string converted_text(const Scenario& scenario, const std::string& to, const CanonicalState& start) {
  const std::string key = coordinate_key(to);
  std::vector<ScenarioEdit> edits{{"problem." + key, "\"" + to + "\""}};
  if (!scenario.request.start.geometric() && !scenario.bodies) {
    edits.push_back({"problem.initial", "{ q = " + toml_list(start.q) + ", p = " + toml_list(start.p) + " }"});
  }
  if (scenario.section) {  // of a coordinate that is there no more
    edits.push_back({"run.section", {}});
    std::string others;
    for (const std::string& figure : scenario.figures) {
      if (figure != "section") others += (others.empty() ? "\"" : ", \"") + figure + "\"";
    }
    if (!scenario.figures.empty()) edits.push_back({"output.figures", "[" + others + "]"});
  }
  return edited_scenario(scenario.text, edits);
}

CanonicalState converted_start(const Scenario& scenario, const std::string& to) {
  const std::string from = present_system(scenario.request.problem, scenario.request.variant, to);
  return StateConverter(from, to)({scenario.start_q, scenario.start_p});
}

std::string converted_scenario(const Scenario& scenario, const std::string& to) {
  const std::string from = present_system(scenario.request.problem, scenario.request.variant, to);
  const CanonicalState start = converted_start(scenario, to);
  const std::string why_not = refused_method(scenario, to);
  if (!why_not.empty()) {
    throw Error("in " + to + " coordinates " + why_not + "; give one of them with --set method.name=...");
  }
  const std::string text = converted_text(scenario, to, start);
  (void)accepted(read_scenario_text(text, "the converted scenario", {}));
  return "# Converted by hamflow convert from " + from + " to " + to + " coordinates.\n" + text;
}

bool is_run(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) return true;
  std::ifstream in(path, std::ios::binary);
  char mark[4] = {};
  in.read(mark, sizeof mark);
  return std::string(mark, sizeof mark) == "\x89HDF";
}

}  // namespace hamflow
