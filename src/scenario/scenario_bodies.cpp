// Reads [problem].bodies: two bodies in space. The problem is their relative motion in its plane.
#include <cmath>

#include "scenario_reader.hpp"
#include "start_keys.hpp"

namespace hamflow {

namespace {

/// Numbers of a body as texts.
struct BodyTexts {
  std::string mass, position[3], velocity[3];
};

/// Returns the planar start of TwoBodies as expressions of the given numbers, which have more digits than double in
/// some arithmetics. With the relative position r and velocity v it is (|r|, 0), mu (r.v, |r x v|)/|r|; in polar
/// coordinates the second momentum is the angular momentum mu |r x v|.   [Gross1999, (2.1)-(2.20)]
StartSpec in_any_digits(const BodyTexts& first, const BodyTexts& second, const std::string& mu, bool polar) {
  std::string r[3], v[3], rr, rv, cc;
  for (std::size_t k = 0; k < 3; ++k) {
    r[k] = "((" + second.position[k] + ")-(" + first.position[k] + "))";
    v[k] = "((" + second.velocity[k] + ")-(" + first.velocity[k] + "))";
    rr += (k > 0 ? "+" : "") + r[k] + "*" + r[k];
    rv += (k > 0 ? "+" : "") + r[k] + "*" + v[k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const std::string c = "(" + r[i] + "*" + v[j] + "-" + r[j] + "*" + v[i] + ")";
    cc += (k > 0 ? "+" : "") + c + "*" + c;
  }
  const std::string length = "sqrt(" + rr + ")";
  StartSpec start;
  start.q = {length, "0"};
  start.p = {mu + "*(" + rv + ")/" + length, mu + "*sqrt(" + cc + ")" + (polar ? "" : "/" + length)};
  return start;
}

}  // namespace

/// Reads two bodies in space and reduces them to a planar state.
void ScenarioReader::read_bodies(TomlTable& table) {
  if (!table.has_any("bodies")) {
    table.know("bodies");
    return;
  }
  for (const char* other : {"mass", "orbit", "initial"}) {
    if (table.has(other))
      table.complain(other, std::string("found ") + other + " together with bodies; allowed one of them");
  }
  auto tables = table.tables("bodies", 2);
  if (!tables) return;
  const std::size_t before = complaints_.size();
  Body bodies[2];
  BodyTexts texts[2];
  for (std::size_t i = 0; i < 2; ++i) {
    TomlTable& body = (*tables)[i];
    if (const auto mass = body.text({.name = "mass", .range = Range::positive, .required = true})) {
      bodies[i].mass = number_value(*mass);
      texts[i].mass = *mass;
    }
    const auto read_vector = [&](const char* key, Vector<double, 3>& out, std::string* given) {
      const auto values = body.numbers(list_key(key, 3));
      for (std::size_t k = 0; values && k < 3; ++k) out[k] = number_value(given[k] = (*values)[k]);
    };
    read_vector("position", bodies[i].position, texts[i].position);
    read_vector("velocity", bodies[i].velocity, texts[i].velocity);
    body.finish();
  }
  if (complaints_.size() != before) return;
  if (bodies[0].position == bodies[1].position) {
    table.complain("bodies", "found both bodies at the same point; allowed different positions");
    return;
  }
  scenario_.bodies = TwoBodies(bodies[0], bodies[1]);
  Request& request = scenario_.request;
  const std::string &m1 = texts[0].mass, &m2 = texts[1].mass;
  request.parameters["mass"] = "(" + m1 + ")*(" + m2 + ")/((" + m1 + ")+(" + m2 + "))";
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
  const bool polar = static_cast<bool>(scenario_.problem->from_reference);
  start_of_bodies_ = in_any_digits(texts[0], texts[1], "(" + request.parameters["mass"] + ")", polar);
  Frame start;
  start.q.assign(plane.q.begin(), plane.q.end());
  start.p.assign(plane.p.begin(), plane.p.end());
  if (const auto& from_plane = scenario_.problem->from_reference)
    start = from_plane(scenario_.request.parameters, start.q, start.p);
  request.start.q = {shortest(start.q[0]), shortest(start.q[1])};
  request.start.p = {shortest(start.p[0]), shortest(start.p[1])};
}

}  // namespace hamflow
