// [output]: where results go, in which formats, with which figures.
#include <algorithm>

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
    table.complain(key,
                   "found figures without the format h5, from which they are drawn; allowed formats = [\"h5\", ...]");
  }
  FigureFacts facts{.degrees_of_freedom = scenario_.start_q.size(),
                    .diagnostics = has_method() && describe(scenario_.request.method).diagnostics,
                    .section = scenario_.section.has_value()};
  if (scenario_.problem != nullptr) {
    const auto& invariants = scenario_.problem->info.invariants;
    const std::vector<std::string> in_space{"x", "y", "z"};
    facts.bodies_in_space = scenario_.problem->info.coordinates == in_space ||
                            (scenario_.problem->dimension == 0 &&
                             std::any_of(invariants.begin(), invariants.end(), [](const InvariantInfo& invariant) {
                               return invariant.components == Components::space;
                             }));
  }
  for (const std::string& kind : scenario_.figures) {
    const std::string why_not = refused_figure(kind, facts);
    if (!why_not.empty()) table.complain(key, why_not);
  }
  table.finish();
}

}  // namespace hamflow
