// Facts from the effective potential, as entries of a summary.
#include <limits>

#include "hamflow/problems/support/central_force.hpp"

namespace hamflow {

OrbitFacts facts_of(const CentralOrbit& orbit) {
  OrbitFacts facts{{"type", std::string(name_of(orbit.type))}};
  constexpr double none = std::numeric_limits<double>::quiet_NaN();  // null in the summary
  if (!orbit.conic.empty()) facts.emplace_back("conic", orbit.conic);
  const auto number = [&](const char* name, long double x) { facts.emplace_back(name, static_cast<double>(x)); };
  number("r_min", orbit.r_min);
  number("r_max", orbit.r_max);
  const bool has_circle = orbit.type == OrbitType::circle || orbit.circular_radius > 0;
  number("circular_radius", has_circle ? orbit.circular_radius : none);
  if (has_circle) {
    facts.emplace_back("circular_stable", orbit.circular_stable);
  } else {
    number("circular_stable", none);
  }
  number("apsidal_angle", orbit.apsidal_angle);
  number("radial_period", orbit.radial_period);
  facts.emplace_back("closed", orbit.closed);
  number("revolutions", orbit.closed ? orbit.revolutions : none);
  number("radial_periods", orbit.closed && orbit.radial_periods > 0 ? orbit.radial_periods : none);
  facts.emplace_back("falls_into_centre", orbit.falls_into_centre);
  return facts;
}

}  // namespace hamflow
