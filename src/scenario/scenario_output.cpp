// [output]: where results go, in which formats, with which figures.
#include <algorithm>

#include "run_keys.hpp"
#include "scenario_reader.hpp"

namespace hamflow {

void ScenarioReader::read_output(TomlTable& table) {
  const OutputKeys& keys = output_keys();
  const std::string& key = keys.figures.name;
  if (const auto folder = table.text(keys.folder)) scenario_.folder = *folder;
  if (const auto formats = table.words(keys.formats)) scenario_.formats = *formats;
  if (const auto figures = table.words(keys.figures)) scenario_.figures = *figures;
  const auto wants = [&](const std::vector<std::string>& list, const char* word) {
    return std::find(list.begin(), list.end(), word) != list.end();
  };
  if (!scenario_.figures.empty() && !wants(scenario_.formats, "h5")) {
    table.complain(key,
                   "found figures without the format h5, from which they are drawn; allowed formats = [\"h5\", ...]");
  }
  const std::size_t dimension = scenario_.start_q.size();
  if (scenario_.problem != nullptr && dimension > 0) {
    const auto& invariants = scenario_.problem->info.invariants;
    const bool in_space = scenario_.problem->dimension == 0 &&
                          std::any_of(invariants.begin(), invariants.end(), [](const InvariantInfo& invariant) {
                            return invariant.components == Components::space;
                          });
    const std::string degrees = std::to_string(dimension) + (dimension == 1 ? " degree" : " degrees") + " of freedom";
    if (wants(scenario_.figures, "orbit") && dimension != 2 && !in_space) {
      table.complain(key, "found \"orbit\" for a problem with " + degrees + "; allowed energy, energy-error" +
                                    (dimension <= 12 ? ", phase" : ""));
    }
    if (wants(scenario_.figures, "phase") && dimension > 12) {
      table.complain(key, "found \"phase\" for a problem with " + degrees + "; allowed at most 12, or energy, " +
                                    "energy-error" + (in_space ? ", orbit" : ""));
    }
  }
  if (wants(scenario_.figures, "condition") && has_method() && !describe(scenario_.request.method).diagnostics) {
    table.complain(key, "found \"condition\", which needs method.diagnostics = true of an implicit method");
  }
  if (wants(scenario_.figures, "section") && dimension == 1) {
    table.complain(key, "found \"section\" for a problem with 1 degree of freedom; allowed with 2 and more");
  } else if (wants(scenario_.figures, "section") && !scenario_.section) {
    table.complain(key, "found \"section\", which needs run.section, e.g. { coordinate = \"q1\" }");
  }
  table.finish();
}

}  // namespace hamflow
