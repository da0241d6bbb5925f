#include "hamflow/orbits/element_table.hpp"

namespace hamflow {

std::span<const ElementColumn> element_columns() {
  using E = OrbitalElements<double>;
  using Q = ElementColumn::Quantity;
  static constexpr ElementColumn all[] = {
      {"a", &E::a, "semi-major axis, negative on a hyperbola", Q::length},
      {"e", &E::e, "eccentricity", Q::number},
      {"inclination", &E::inclination, "from 0 to pi", Q::angle},
      {"node", &E::node, "longitude of the ascending node; 0 in the plane", Q::angle},
      {"pericentre", &E::pericentre, "argument of the pericentre, from the node; 0 on a circle", Q::angle},
      {"longitude_of_pericentre", &E::longitude_of_pericentre, "node + pericentre", Q::angle},
      {"mean_anomaly", &E::mean_anomaly, "on a hyperbola e sinh F - F", Q::angle},
      {"true_anomaly", &E::true_anomaly, "from the pericentre", Q::angle},
      {"mean_longitude", &E::mean_longitude, "longitude of the pericentre + mean anomaly; NaN on a hyperbola",
       Q::angle},
      {"period", &E::period, "NaN on a hyperbola", Q::time}};
  return all;
}

std::vector<std::string> orbit_keys() {
  std::vector<std::string> all;
  Orbit<double> orbit;
  for_each_key(orbit, [&](const char* key, const auto&) { all.emplace_back(key); });
  return all;
}

}  // namespace hamflow
