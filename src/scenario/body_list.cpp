#include "body_list.hpp"

#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/orbits/element_table.hpp"

namespace hamflow {

namespace {

template <class R>
Orbit<R> orbit_in(const Texts& texts) {
  Orbit<R> orbit;
  for_each_key(orbit, [&](const char* key, auto& to) {
    if (const auto given = texts.find(key); given != texts.end()) to = evaluate_number<R>(given->second);
  });
  return orbit;
}

template <class R>
StartSpec start_in(const BodyList& list) {
  std::vector<BodyStart<R>> starts;
  for (const ListedBody& body : list.bodies) {
    BodyStart<R> start{.mass = evaluate_number<R>(body.mass), .primary = body.primary, .of = body.of};
    if (!body.orbit.empty()) start.orbit = orbit_in<R>(body.orbit);
    for (std::size_t k = 0; k < body.position.size(); ++k) {
      start.state.position[k] = evaluate_number<R>(body.position[k]);
      start.state.velocity[k] = evaluate_number<R>(body.velocity[k]);
    }
    starts.push_back(start);
  }
  const BodyStates<R> placed = states_of(starts, evaluate_number<R>(list.gravitational_constant));
  if (placed.not_finite) throw Error(list.bodies[*placed.not_finite].name);
  StartSpec spec;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const R inertia = R(0) < starts[i].mass ? starts[i].mass : R(1);
    const R most(std::numeric_limits<double>::max());
    for (std::size_t k = 0; k < list.space; ++k) {
      if (most < abs(placed.states[i].position[k]) || most < abs(placed.states[i].velocity[k])) {
        throw Error(list.bodies[i].name);
      }
      spec.q.push_back(written_digits(placed.states[i].position[k]));
      spec.p.push_back(written_digits(R(inertia * placed.states[i].velocity[k])));
    }
  }
  return spec;
}

}  // namespace

std::optional<std::string> angle_in_radians(const std::string& text) {
  std::string number = text;
  std::string factor;
  for (const auto& [unit, in_radians] : {std::pair{"deg", "pi/180"}, std::pair{"rad", ""}}) {
    if (!text.ends_with(unit)) continue;
    number = text.substr(0, text.size() - 3);
    factor = in_radians;
  }
  try {
    (void)evaluate_number<double>(number);
  } catch (const Error&) {
    return std::nullopt;
  }
  return factor.empty() ? number : "(" + number + ")*" + factor;
}

Orbit<double> orbit_of(const Texts& orbit) { return orbit_in<double>(orbit); }

StartSpec start_of(const BodyList& list, const std::string& arithmetic) {
  const int digits = digits_beyond_double(arithmetic);
  if (digits == 0) return start_in<Quad>(list);
  const MpDigits scope(std::min(digits + 16, MpDigits::most));  // more than the conversion loses
  return start_in<Mp>(list);
}

}  // namespace hamflow
