// [output]: where results go, in which formats, with which figures.
#include <algorithm>

#include "figure_kinds.hpp"
#include "hamflow/run/gas.hpp"
#include "hamflow/run/state_names.hpp"
#include "run_keys.hpp"
#include "scenario_reader.hpp"

namespace hamflow {

void ScenarioReader::read_output(TomlTable& table) {
  const OutputKeys& keys = output_keys();
  const std::string& key = keys.figures.name;
  if (const auto folder = table.text(keys.folder)) scenario_.folder = *folder;
  if (const auto formats = table.words(keys.formats)) scenario_.formats = *formats;
  if (const auto figures = table.words(keys.figures)) scenario_.figures = *figures;
  const bool has_h5 = std::find(scenario_.formats.begin(), scenario_.formats.end(), "h5") != scenario_.formats.end();
  if (!scenario_.figures.empty() && !has_h5) {
    table.complain(key,
                   "found figures without the format h5, from which they are drawn; allowed formats = [\"h5\", ...]");
  }
  read_observables(table);
  FigureFacts facts{.degrees_of_freedom = scenario_.start_q.size(),
                    .diagnostics = has_method() && describe(scenario_.request.method).diagnostics,
                    .section = scenario_.section.has_value(),
                    .stroboscopic = scenario_.section && scenario_.section->by_time_alone};
  if (scenario_.problem != nullptr) {
    const auto& invariants = scenario_.problem->info.invariants;
    const std::vector<std::string> in_space{"x", "y", "z"};
    facts.bodies_in_space = scenario_.problem->info.coordinates == in_space ||
                            (scenario_.problem->dimension == 0 &&
                             std::any_of(invariants.begin(), invariants.end(), [](const InvariantInfo& invariant) {
                               return invariant.components == Components::space;
                             }));
    facts.gas = scenario_.request.problem == GasKeys::problem;
    facts.bodies_in_space = facts.bodies_in_space || facts.gas;
    facts.particles = facts.bodies_in_space && scenario_.problem->dimension == 0;
  }
  for (const std::string& kind : scenario_.figures) {
    const std::string why_not = refused_figure(kind, facts);
    if (!why_not.empty()) table.complain(key, why_not);
  }
  table.finish();
}

/// A name that may stand in files and figures beside those of the state.
void ScenarioReader::read_observables(TomlTable& output) {
  const std::string& key = output_keys().observables.name;
  std::vector<std::string> taken{"t", "step", "energy", "energy-error"};
  if (scenario_.problem != nullptr && !scenario_.start_q.empty()) {
    for (const auto& [name, text] : scenario_.problem->info.observables) {
      taken.push_back(name);
      scenario_.observables.push_back(
          {name, StateExpression(text, *scenario_.problem, scenario_.request.parameters, scenario_.start_q.size())});
    }
  }
  if (!output.has(key)) {
    output.know(key);
    return;
  }
  TomlTable table = output.table(key);
  if (scenario_.problem != nullptr && !scenario_.start_q.empty()) {  // without a start there are no parameters either
    const StateNames names = state_names(*scenario_.problem, scenario_.request.parameters, scenario_.start_q.size());
    taken.insert(taken.end(), names.q.begin(), names.q.end());
    taken.insert(taken.end(), names.p.begin(), names.p.end());
    for (const InvariantInfo& invariant : scenario_.problem->info.invariants) taken.push_back(invariant.name);
    for (std::size_t i = 1; i <= scenario_.start_q.size(); ++i) {  // of trajectory.csv
      taken.push_back("q" + std::to_string(i));
      taken.push_back("p" + std::to_string(i));
    }
  }
  for (const std::string& name : table.keys()) {
    constexpr const char* letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";
    const bool is_word = name.find_first_not_of(letters) == std::string::npos && !(name[0] >= '0' && name[0] <= '9');
    if (!is_word || name.empty()) {
      table.complain(name, "found the name \"" + name + "\"; allowed letters, digits and _");
    } else if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
      table.complain(name, "found the name " + name + ", which a column of every run has; allowed another");
    }
    if (auto expression = read_expression(table, {.name = name, .type = OptionType::text})) {
      scenario_.observables.push_back({name, *std::move(expression)});
    }
  }
  table.finish();
}

}  // namespace hamflow
