// [problem]: two bodies in space, whose relative motion in their plane is the problem.
#include <cmath>

#include "scenario_reader.hpp"
#include "start_keys.hpp"

namespace hamflow {

/// Two bodies in space, reduced to a planar state.
void ScenarioReader::read_bodies(TomlTable& table) {
  if (!table.has_any("bodies")) {
    table.know("bodies");
    return;
  }
  for (const char* other : {"mass", "orbit", "initial"}) {
    if (table.has(other)) table.complain(other, std::string("found ") + other + " beside bodies; allowed one of them");
  }
  auto tables = table.tables("bodies", 2);
  if (!tables) return;
  const std::size_t before = complaints_.size();
  Body bodies[2];
  std::string masses[2];
  for (std::size_t i = 0; i < 2; ++i) {
    TomlTable& body = (*tables)[i];
    if (const auto mass = body.text({.name = "mass", .range = Range::positive, .required = true})) {
      bodies[i].mass = number_value(*mass);
      masses[i] = *mass;
    }
    const auto read_vector = [&](const char* key, Vector<double, 3>& out) {
      const auto values = body.numbers(list_key(key, 3));
      for (std::size_t k = 0; values && k < 3; ++k) out[k] = number_value((*values)[k]);
    };
    read_vector("position", bodies[i].position);
    read_vector("velocity", bodies[i].velocity);
    body.finish();
  }
  if (complaints_.size() != before) return;
  if (bodies[0].position == bodies[1].position) {
    table.complain("bodies", "found both bodies at one point; allowed different positions");
    return;
  }
  scenario_.bodies = TwoBodies(bodies[0], bodies[1]);
  Request& request = scenario_.request;
  request.parameters["mass"] = "(" + masses[0] + ")*(" + masses[1] + ")/((" + masses[0] + ")+(" + masses[1] + "))";
  const Start<double, 2>& plane = scenario_.bodies->start();
  const double mu = scenario_.bodies->reduced_mass();
  const double sum = mu + plane.q[0] + plane.p[0] + plane.p[1];
  if (!std::isfinite(sum) || !(mu > 0) || !(plane.q[0] > 0)) {
    table.complain("bodies",
                   "found masses, positions or velocities whose products overflow; allowed numbers between "
                   "about 1e-100 and 1e100");
    scenario_.bodies.reset();
    return;
  }
  Frame start;
  start.q.assign(plane.q.begin(), plane.q.end());
  start.p.assign(plane.p.begin(), plane.p.end());
  if (const auto& from_plane = scenario_.problem->from_reference)
    start = from_plane(scenario_.request.parameters, start.q, start.p);
  request.start.q = {shortest(start.q[0]), shortest(start.q[1])};
  request.start.p = {shortest(start.p[0]), shortest(start.p[1])};
}

}  // namespace hamflow
