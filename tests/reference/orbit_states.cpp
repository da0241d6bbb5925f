// Answers questions about orbits, a line each, for tools/orbit_reference.py. Numbers are hexadecimal floating-point
// numbers, or "-" for what is not given. The name of a number type comes first:
//     double drift   x y z vx vy vz mu t                 -> the state after t
//     double state   mu t a period q e i node w varpi M f E lambda T   -> the state
//     double elements x y z vx vy vz mu                  -> a e q i node w varpi f M lambda period time
// Numbers beyond double are answered as two doubles: the value and the rest.
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/orbits/elements.hpp"
#include "hamflow/orbits/kepler_drift.hpp"
#include "hamflow/orbits/orbit.hpp"

namespace {

using hamflow::Vector;

template <class R>
void print(const R& x) {
  const double value = static_cast<double>(x);
  std::printf("%a", value);
  if constexpr (!std::is_same_v<R, double>) std::printf(":%a", static_cast<double>(x - R(value)));
  std::printf(" ");
}

template <class R>
void print(const Vector<R, 3>& x) {
  for (const R& part : x) print(part);
}

template <class R>
void answer(const std::string& question, std::istringstream& in) {
  std::vector<std::optional<R>> all;
  for (std::string word; in >> word;) {
    all.push_back(word == "-" ? std::nullopt : std::optional<R>(R(std::strtod(word.c_str(), nullptr))));
  }
  const auto number = [&](std::size_t k) { return all.at(k).value(); };
  if (question == "state") {
    hamflow::Orbit<R> orbit{all.at(2), all.at(3),  all.at(4),  number(5),  number(6),  number(7), all.at(8),
                            all.at(9), all.at(10), all.at(11), all.at(12), all.at(13), all.at(14)};
    const auto state = state_on(orbit, number(0), number(1));
    if (state) {
      print(state->position);
      print(state->velocity);
    } else {
      std::printf("none");
    }
  } else {
    Vector<R, 3> r{number(0), number(1), number(2)};
    Vector<R, 3> v{number(3), number(4), number(5)};
    if (question == "drift") {
      const hamflow::Outcome outcome = hamflow::advance_on_conic(r, v, number(6), number(7));
      if (outcome == hamflow::Outcome::done) {
        print(r);
        print(v);
      } else {
        std::printf("none");
      }
    } else {
      const auto o = hamflow::elements_of(r, v, number(6));
      for (const R& x :
           {o.a, o.e, o.pericentre_distance, o.inclination, o.node, o.pericentre, o.longitude_of_pericentre,
            o.true_anomaly, o.mean_anomaly, o.mean_longitude, o.period, o.time_since_pericentre}) {
        print(x);
      }
    }
  }
  std::printf("\n");
}

}  // namespace

int main() {
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream in(line);
    std::string type;
    std::string question;
    in >> type >> question;
    if (type == "double") answer<double>(question, in);
    if (type == "double-double") answer<hamflow::DoubleDouble>(question, in);
    if (type == "quad") answer<hamflow::Quad>(question, in);
  }
}
