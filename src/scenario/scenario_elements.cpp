// Reads [output].elements.
#include <algorithm>

#include "element_columns.hpp"
#include "hamflow/detail/problems/body_keys.hpp"
#include "hamflow/detail/problems/solar_bodies.hpp"
#include "run_keys.hpp"
#include "scenario_reader.hpp"

namespace hamflow {

void ScenarioReader::read_elements(TomlTable& table) {
  const OptionInfo& key = output_keys().elements;
  const bool is_known = scenario_.problem != nullptr;
  const bool is_solar = is_known && scenario_.request.problem == SolarBodies::problem;
  const SolarBodies* const solar =
      is_solar ? &solar_bodies(choice_of(scenario_.problem->info, SolarBodies::key)) : nullptr;
  if (solar != nullptr) scenario_.body_names = solar->names();
  const auto about = table.text(key);
  if (!about || !is_known) return;
  if (solar == nullptr && !takes_body_list(scenario_.problem->info)) {
    table.complain(key.name, table.found(key.name) + " with " + scenario_.request.problem +
                                 "; allowed with n-body and solar-system, whose bodies have orbits");
    return;
  }
  RecordedElements elements;
  if (solar != nullptr) {
    elements.masses = solar->masses<double>();
    elements.gravitational_constant = number_value(solar->gravitational_constant);
  } else {
    if (scenario_.start_q.empty()) return;  // complained about elsewhere
    const Parameters<double> parameters(scenario_.request.parameters);
    elements.masses = parameters.list(BodyKeys::masses);
    elements.gravitational_constant = parameters[BodyKeys::constant];
    const double softening = parameters["softening"];
    if (softening > 0 || !(elements.gravitational_constant > 0)) {
      table.complain(key.name,
                     table.found(key.name) + " with " +
                         (softening > 0 ? "softening = " + shortest(softening)
                                        : "gravitational_constant = " + shortest(elements.gravitational_constant)) +
                         "; allowed where two bodies move on conics: without softening, with a positive G");
      return;
    }
  }
  scenario_.elements = elements;
  if (*about == BodyKeys::jacobi) return;
  if (*about == BodyKeys::barycentre) {
    scenario_.elements->primary = Primary::barycentre;
    return;
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < elements.masses.size(); ++i) names.push_back(body_name(scenario_, i));
  const auto found = std::find(names.begin(), names.end(), *about);
  std::vector<std::string> allowed{BodyKeys::jacobi, BodyKeys::barycentre};
  allowed.insert(allowed.end(), names.begin(), names.end());
  if (found == names.end()) {
    table.complain(key.name, table.found(key.name) + "; allowed " + joined(allowed) + suggestion(*about, allowed));
    return;
  }
  const auto of = static_cast<std::size_t>(found - names.begin());
  if (!(elements.masses[of] > 0)) {
    table.complain(key.name, table.found(key.name) + ", whose mass is 0; allowed a body with a mass");
    return;
  }
  scenario_.elements->primary = Primary::body;
  scenario_.elements->of = of;
}

}  // namespace hamflow
