#include "hamflow/workflow/convert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "converted_text.hpp"
#include "figure_kinds.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/detail/run/digits.hpp"
#include "json_text.hpp"
#include "method_keys.hpp"
#include "run_keys.hpp"
#include "scenario_edit.hpp"

namespace hamflow {

namespace {

using Json = nlohmann::ordered_json;

std::string row(const std::vector<double>& numbers) {
  return "[" + joined(numbers, [](double x) { return fmt::format("{:.17g}", x); }) + "]";
}

/// Explains why the scenario's method cannot run in the new coordinates; empty if it can.
std::string refused_method(const Scenario& scenario, const std::string& to) {
  return refusal(scenario.request.method, *in_coordinates(scenario.problem, to));
}

/// Returns the start of a run with all digits, in arithmetic with more digits than double.
DigitState start_digits(const Scenario& scenario, const std::string& to) {
  Frame frame;
  make_simulation(scenario.request)->look(frame);
  const std::shared_ptr<const ProblemEntry> problem = without_own_walls(scenario.problem);
  return in_chart_of(*in_coordinates(problem, to), *problem, scenario.request.parameters, scenario.request.arithmetic,
                     {frame.digits.q, frame.digits.p});
}

/// Returns the start as a TOML table for `initial`, with all digits of the arithmetic.
std::string start_table(const Scenario& scenario, const std::string& to, const CanonicalState& start) {
  const auto table = [](const std::string& q, const std::string& p) { return "{ q = " + q + ", p = " + p + " }"; };
  if (longest_digits(scenario.request.arithmetic) == 0) return table(toml_list(start.q), toml_list(start.p));
  const DigitState state = start_digits(scenario, to);
  const auto list = [](const std::vector<std::string>& texts) {
    return "[" + joined(texts, [](const std::string& text) { return "\"" + text + "\""; }) + "]";
  };
  return table(list(state.q), list(state.p));
}

/// Returns whether output.observables has entries. The observables of the problem come first and exist in all its
/// charts.
bool has_own_observables(const Scenario& scenario) {
  return scenario.observables.size() > scenario.problem->info.observables.size();
}

}  // namespace

std::string state_text(const CanonicalState& state) { return "q = " + row(state.q) + "\np = " + row(state.p) + "\n"; }

std::string state_json(const std::string& system, const CanonicalState& state) {
  return json_text(Json{{"coordinates", system}, {"q", state.q}, {"p", state.p}});
}

std::string converted_text(const Scenario& scenario, const std::string& to, const CanonicalState& start) {
  std::vector<ScenarioEdit> edits;
  if (coordinates_of(*scenario.problem) == to) return edited_scenario(scenario.text, edits);
  const ProblemInfo before = without_own_walls(scenario.problem)->info;
  const ProblemInfo behind = in_coordinates(scenario.problem, to)->info;
  const auto is_given = [&](const std::string& key) { return scenario.settings.contains("problem." + key); };
  for (const auto& [key, value] : behind.variant) {
    const bool usual =
        std::find(behind.default_choices.begin(), behind.default_choices.end(), key) != behind.default_choices.end();
    const bool is_chart = key == behind.chart_key;
    if (choice_of(before, key) != value && (is_chart || is_given(key) || !usual)) {
      edits.push_back({"problem." + key, "\"" + value + "\""});
    }
  }
  for (const auto& [key, value] : before.variant) {
    if (choice_of(behind, key).empty() && is_given(key)) edits.push_back({"problem." + key, {}});
  }
  if (!scenario.request.start.geometric() && !scenario.bodies) {
    edits.push_back({"problem.initial", start_table(scenario, to, start)});
    const std::string& velocities = before.velocities.name;  // belongs to the start that is replaced
    if (!velocities.empty() && is_given(velocities)) edits.push_back({"problem." + velocities, {}});
  }
  // Removes the keys whose texts name coordinates that no longer exist (left_out_of_converted).
  if (!scenario.events.empty()) edits.push_back({run_path(run_keys().events), {}});
  if (scenario.section) {
    edits.push_back({run_path(run_keys().section), {}});
    std::vector<std::string> others = scenario.figures;
    const FigureFacts without_section{.diagnostics = true, .section = false};
    std::erase_if(others, [&](const std::string& kind) { return !refused_figure(kind, without_section).empty(); });
    const std::string list = joined(others, [](const std::string& kind) { return "\"" + kind + "\""; });
    if (!scenario.figures.empty()) edits.push_back({output_path(output_keys().figures), "[" + list + "]"});
  }
  if (has_own_observables(scenario)) edits.push_back({output_path(output_keys().observables), {}});
  return edited_scenario(scenario.text, edits);
}

std::string left_out_of_converted(const Scenario& scenario, const std::string& to) {
  std::vector<std::string> keys;
  if (coordinates_of(*scenario.problem) == to) return "";
  if (!scenario.events.empty()) keys.push_back(run_path(run_keys().events));
  if (scenario.section) keys.push_back(run_path(run_keys().section));
  if (has_own_observables(scenario)) keys.push_back(output_path(output_keys().observables));
  return joined(keys);
}

CanonicalState converted_start(const Scenario& scenario, const std::string& to) {
  return StateConverter(scenario.problem, in_coordinates(scenario.problem, to),
                        scenario.request.parameters)({scenario.start_q, scenario.start_p});
}

std::string converted_start_json(const Scenario& scenario, const std::string& to) {
  const CanonicalState start = converted_start(scenario, to);
  if (longest_digits(scenario.request.arithmetic) == 0) return state_json(to, start);
  const DigitState state = start_digits(scenario, to);
  return json_text(Json{{"coordinates", to}, {"q", state.q}, {"p", state.p}});
}

ConvertedScenario converted_scenario(const Scenario& scenario, const std::string& to,
                                     const std::vector<std::string>& sets) {
  const std::string from = coordinates_of(*scenario.problem);
  const CanonicalState start = converted_start(scenario, to);
  const std::string why_not = refused_method(scenario, to);
  if (!why_not.empty() && sets.empty()) {
    throw Error("in " + to + " coordinates " + why_not + "; choose one with " +
                set_option("method." + method_name_key().name, "..."));
  }
  const Scenario converted =
      accepted(read_scenario_text(converted_text(scenario, to, start), "the converted scenario", sets));
  return {"# Converted by hamflow convert from " + from + " to " + to + " coordinates.\n" + converted.text,
          converted.notes};
}

bool is_run(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) return true;
  std::ifstream in(path, std::ios::binary);
  char mark[4] = {};
  in.read(mark, sizeof mark);
  return std::string(mark, sizeof mark) == "\x89HDF";
}

}  // namespace hamflow
