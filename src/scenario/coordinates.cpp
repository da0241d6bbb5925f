#include "hamflow/scenario/coordinates.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/core/error.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/problems/support/pendulum_angles.hpp"
#include "hamflow/problems/support/polar.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

namespace {

/// One set of coordinates that a problem may have, as its selecting key and its two values.
struct Family {
  const char* problem;
  const char* key;
  std::vector<std::string> systems;
};
const std::vector<Family>& families() {
  static const std::vector<Family> all{{"central-force", "coordinates", {"cartesian", "polar"}},
                                       {"double-pendulum", "angles", {"absolute", "relative"}}};
  return all;
}

const Family* family_of(const std::string& system) {
  for (const Family& family : families()) {
    if (std::find(family.systems.begin(), family.systems.end(), system) != family.systems.end()) return &family;
  }
  return nullptr;
}

std::string what_there_is() {
  std::string text;
  for (const Family& family : families()) {
    text += (text.empty() ? "" : "; ") + std::string(family.problem) + " has " + family.systems[0] + " and " +
            family.systems[1];
  }
  return text;
}

CanonicalState as_state(const Vector<double, 2>& q, const Vector<double, 2>& p) { return {{q[0], q[1]}, {p[0], p[1]}}; }

}  // namespace

const std::vector<std::string>& coordinate_systems() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names;
    for (const Family& family : families()) names.insert(names.end(), family.systems.begin(), family.systems.end());
    return names;
  }();
  return all;
}

std::string coordinate_key(const std::string& system) {
  if (const Family* family = family_of(system)) return family->key;
  const std::string near = nearest(system, coordinate_systems());
  throw Error("found coordinates '" + system + "'; allowed cartesian, polar, absolute, relative" +
              (near.empty() ? "" : "; did you mean " + near + "?"));
}

std::string present_system(const std::string& problem, const std::map<std::string, std::string>& variant,
                           const std::string& to) {
  const std::string key = coordinate_key(to);
  if (problem == family_of(to)->problem && variant.contains(key)) return variant.at(key);
  throw Error(problem + " has no " + to + " coordinates; allowed: " + what_there_is());
}

StateConverter::StateConverter(std::string from, std::string to) : from_(std::move(from)), to_(std::move(to)) {
  if (coordinate_key(from_) != coordinate_key(to_)) {
    throw Error("found no way from " + from_ + " to " + to_ + "; allowed: " + what_there_is());
  }
}

CanonicalState StateConverter::operator()(const CanonicalState& state) {
  if (state.q.size() != 2 || state.p.size() != 2) {
    throw Error("found " + std::to_string(state.q.size()) + " coordinates and " + std::to_string(state.p.size()) +
                " momenta; allowed 2 of each");
  }
  if (from_ == to_) return state;
  const Vector<double, 2> q{state.q[0], state.q[1]};
  const Vector<double, 2> p{state.p[0], state.p[1]};
  if (to_ == "polar") return to_polar_continuously(state);
  if (to_ == "cartesian") {
    if (q[0] == 0 && p[1] != 0) throw Error("found r = 0 with p_phi = " + shortest(p[1]) + "; allowed r other than 0");
    const Start<double, 2> s = to_cartesian(Start<double, 2>{q, p});
    return as_state(s.q, s.p);
  }
  if (to_ == "relative") return as_state(relative_angles(q), relative_momenta(p));
  return as_state(absolute_angles(q), absolute_momenta(p));
}

CanonicalState StateConverter::to_polar_continuously(const CanonicalState& state) {
  if (state.q[0] == 0 && state.q[1] == 0) {
    throw Error("found the centre, r = 0, where there are no polar coordinates; allowed any other point");
  }
  Start<double, 2> s = to_polar(Start<double, 2>{{state.q[0], state.q[1]}, {state.p[0], state.p[1]}});
  if (begun_) {
    const double turn = 2 * pi_value<double>();
    s.q[1] += turn * std::round((phi_ - s.q[1]) / turn);
    largest_turn_ = std::max(largest_turn_, std::abs(s.q[1] - phi_));
  }
  begun_ = true;
  phi_ = s.q[1];
  return as_state(s.q, s.p);
}

}  // namespace hamflow
