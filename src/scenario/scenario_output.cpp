// Reads [output]: the folder, the formats, the figures and the observables.
#include <algorithm>

#include "column_names.hpp"
#include "figure_kinds.hpp"
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
    table.complain(key, "found figures without the format h5, which they need; allowed with formats = [\"h5\", ...]");
  }
  read_observables(table);
  read_elements(table);
  const FigureFacts facts = scenario_.figures.empty() ? FigureFacts() : figure_facts();
  for (const std::string& kind : scenario_.figures) {
    const std::string why_not = refused_figure(kind, facts);
    if (!why_not.empty()) table.complain(key, why_not);
  }
  table.finish();
}

FigureFacts ScenarioReader::figure_facts() const {
  FigureFacts facts{.degrees_of_freedom = scenario_.start_q.size(),
                    .diagnostics = has_method() && describe(scenario_.request.method).diagnostics,
                    .section = scenario_.section.has_value(),
                    .stroboscopic = scenario_.section && scenario_.section->is_stroboscopic};
  if (scenario_.problem != nullptr) {
    const auto& invariants = scenario_.problem->info.invariants;
    const std::vector<std::string> in_space{"x", "y", "z"};
    facts.bodies_in_space = scenario_.problem->info.coordinates == in_space ||
                            (scenario_.problem->dimension == 0 &&
                             std::any_of(invariants.begin(), invariants.end(), [](const InvariantInfo& invariant) {
                               return invariant.components == Components::space;
                             }));
    facts.gas = static_cast<bool>(scenario_.problem->particles);
    facts.bodies_in_space = facts.bodies_in_space || facts.gas;
    facts.particles = facts.bodies_in_space && scenario_.problem->dimension == 0;
  }
  return facts;
}

/// Reads the observables. Their names become columns of files and figures, like those of the state.
void ScenarioReader::read_observables(TomlTable& output) {
  const std::string& key = output_keys().observables.name;
  // Without a start the parameters are unknown, too.
  const bool known = scenario_.problem != nullptr && !scenario_.start_q.empty();
  const std::size_t size = scenario_.start_q.size();
  if (known) {
    for (const auto& [name, text] : scenario_.problem->info.observables) {
      scenario_.observables.push_back(
          {name, StateExpression(text, *scenario_.problem, scenario_.request.parameters, size)});
    }
  }
  if (known && !driven_hamiltonian_.empty()) {
    scenario_.hamiltonian = {
        "hamiltonian", StateExpression(driven_hamiltonian_, *scenario_.problem, scenario_.request.parameters, size)};
  }
  if (!output.has(key)) {
    output.know(key);
    return;
  }
  std::vector<std::string> taken;  // filled only if needed, because for many particles the list is long
  if (known) {
    taken = columns_of_every_run(*scenario_.problem, scenario_.request.parameters, size);
    for (const NamedExpression& own : scenario_.observables) taken.push_back(own.name);
    if (scenario_.hamiltonian) taken.push_back(scenario_.hamiltonian->name);
    for (const InvariantInfo& invariant : scenario_.problem->info.invariants) taken.push_back(invariant.name);
  }
  TomlTable table = output.table(key);
  for (const std::string& name : table.keys()) {
    if (const std::string why_not = refused_column(name, taken); !why_not.empty()) table.complain(name, why_not);
    if (auto expression = read_expression(table, {.name = name, .type = OptionType::text})) {
      scenario_.observables.push_back({name, *std::move(expression)});
    }
  }
  table.finish();
}

}  // namespace hamflow
