// The orbital elements that are recorded of bodies: names, meanings, values.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hamflow/orbits/elements.hpp"
#include "hamflow/run/simulation.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

struct ElementColumn {
  enum class Quantity { number, length, time, angle };
  const char* name;
  double OrbitalElements<double>::*value;
  const char* meaning;
  Quantity quantity;
};
std::span<const ElementColumn> element_columns();

/// "Jupiter", or "body2" where bodies have no names.
std::string body_name(const Scenario& scenario, std::size_t body);

/// The bodies with elements, by index.
std::vector<std::size_t> bodies_with_elements(const Scenario& scenario);

/// The elements of bodies in a state; nothing for those without.
std::vector<std::optional<OrbitalElements<double>>> elements_at(const Scenario& scenario, const Frame& frame);

}  // namespace hamflow
