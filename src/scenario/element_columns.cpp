#include "element_columns.hpp"

namespace hamflow {

std::string body_name(const Scenario& scenario, std::size_t body) {
  return body < scenario.body_names.size() ? scenario.body_names[body] : "body" + std::to_string(body + 1);
}

std::vector<std::size_t> bodies_with_elements(const Scenario& scenario) {
  const RecordedElements& elements = scenario.elements.value();
  std::vector<std::size_t> all;
  bool has_mass = elements.primary != Primary::jacobi;  // before the body
  for (std::size_t i = 0; i < elements.masses.size(); ++i) {
    const bool has_orbit = elements.primary == Primary::body ? i != elements.of : i > 0;
    if (has_orbit && has_mass) all.push_back(i);
    has_mass = has_mass || elements.masses[i] > 0;
  }
  return all;
}

std::vector<std::optional<OrbitalElements<double>>> elements_at(const Scenario& scenario, const Frame& frame) {
  const RecordedElements& elements = scenario.elements.value();
  const std::size_t space = frame.q.size() / elements.masses.size();
  std::vector<OrbitState<double>> states(elements.masses.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double inertia = elements.masses[i] > 0 ? elements.masses[i] : 1;
    for (std::size_t k = 0; k < 3; ++k) {
      states[i].position[k] = k < space ? frame.q[i * space + k] : 0;
      states[i].velocity[k] = k < space ? frame.p[i * space + k] / inertia : 0;
    }
  }
  return elements_of_bodies(elements.masses, states, elements.gravitational_constant, elements.primary, elements.of);
}

}  // namespace hamflow
