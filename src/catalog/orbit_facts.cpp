// What the effective potential tells, as entries of a summary.
#include <limits>

#include "hamflow/problems/support/central_force.hpp"

namespace hamflow {

OrbitFacts facts_of(const CentralOrbit& orbit) {
  OrbitFacts facts{{"type", std::string(name_of(orbit.type))}};
  if (!orbit.conic.empty()) facts.emplace_back("conic", orbit.conic);
  const auto number = [&](const char* name, long double x) { facts.emplace_back(name, static_cast<double>(x)); };
  number("r_min", orbit.r_min);
  number("r_max", orbit.r_max);
  number("circular_radius", orbit.circular_radius);
  facts.emplace_back("circular_stable", orbit.circular_stable);
  number("apsidal_angle", orbit.apsidal_angle);
  number("radial_period", orbit.radial_period);
  facts.emplace_back("closed", orbit.closed);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();  // null in the summary
  number("revolutions", orbit.closed ? orbit.revolutions : none);
  number("radial_periods", orbit.closed ? orbit.radial_periods : none);
  facts.emplace_back("falls_into_centre", orbit.falls_into_centre);
  return facts;
}

}  // namespace hamflow
