// The names of orbital elements: those by which an orbit is given, and those that are computed from a state.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "hamflow/orbits/elements.hpp"
#include "hamflow/orbits/orbit.hpp"

namespace hamflow {

/// An element that is computed.
struct ElementColumn {
  enum class Quantity { number, length, time, angle };
  const char* name;
  double OrbitalElements<double>::*value;
  const char* meaning;
  Quantity quantity;
};
/// a, e, inclination, ..., in the order of columns.
std::span<const ElementColumn> element_columns();

/// Calls action(key, member) for each key by which an orbit is given.
template <class OrbitOfSome, class Action>
void for_each_key(OrbitOfSome& orbit, const Action& action) {
  action("a", orbit.a);
  action("period", orbit.period);
  action("pericentre_distance", orbit.pericentre_distance);
  action("e", orbit.e);
  action("inclination", orbit.inclination);
  action("node", orbit.node);
  action("pericentre", orbit.pericentre);
  action("longitude_of_pericentre", orbit.longitude_of_pericentre);
  action("mean_anomaly", orbit.mean_anomaly);
  action("true_anomaly", orbit.true_anomaly);
  action("eccentric_anomaly", orbit.eccentric_anomaly);
  action("mean_longitude", orbit.mean_longitude);
  action("time_of_pericentre", orbit.time_of_pericentre);
}

/// The keys of for_each_key.
std::vector<std::string> orbit_keys();

}  // namespace hamflow
