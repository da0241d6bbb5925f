// The Sun with the inner planets' mass, and Jupiter to Pluto: astronomical units, days, solar masses.
// [HLW2006, Sect. I.2.4; data of September 5, 1994, from Ahnerts Kalender fuer Sternfreunde]
#pragma once

#include "hamflow/detail/problems/gravity.hpp"

namespace hamflow {

template <class R = double>
class SolarSystem : public Gravity<R> {
 public:
  SolarSystem(const Parameters<R>& /*none*/, std::size_t /*18*/) : SolarSystem() {}
  SolarSystem() : Gravity<R>(masses(), evaluate_number<R>(gravitational_constant), R(0), 3) {}

  static constexpr const char* name = "solar-system";

  static ProblemInfo info() {
    ProblemInfo all{.name = name,
                    .formula =
                        "H = sum |p_i|^2/(2 m_i) - G sum_{i<j} m_i m_j/r_ij: Sun, Jupiter, Saturn, Uranus, "
                        "Neptune, Pluto; AU, days, solar masses",
                    .reference = "HLW2006, Sect. I.2.4",
                    .coordinates = {"x1", "y1", "z1", "...", "z6"},
                    .invariants = Gravity<R>::gravity_invariants(),
                    // The data are heliocentric: without the shift the system would drift by 2250 AU in 10^6 years.
                    .frame = Gravity<R>::frame_key(StartFrames::barycentric),
                    // Days. Momenta are as small as 1e-11; a larger spread would eject the planets.
                    .region = {.spread = 1e-13, .step = 50, .time = 1000},
                    .example = {.dt = 20, .steps = 80000}};  // 17 revolutions of Pluto
    for (const Body& body : bodies) {
      for (const char* x : body.position) all.default_q.push_back(x);
      for (const char* v : body.velocity) all.default_p.push_back(std::string(body.mass) + "*(" + v + ")");
    }
    for (const auto* texts : {&all.default_q, &all.default_p}) {
      for (const std::string& text : *texts) all.region.centre.push_back(evaluate_number<double>(text));
    }
    return all;
  }
  /// The masses of the Sun with the inner planets, Jupiter, Saturn, Uranus, Neptune, Pluto, in solar masses.
  static std::vector<R> masses() {
    std::vector<R> all;
    for (const Body& body : bodies) all.push_back(evaluate_number<R>(body.mass));
    return all;
  }
  static std::string refused_size(const Parameters<R>&, std::size_t size) {
    return size == 18 ? std::string() : "18 numbers, three for each of Sun, Jupiter, Saturn, Uranus, Neptune, Pluto";
  }

 private:
  struct Body {
    const char* mass;
    const char* position[3];
    const char* velocity[3];
  };
  static constexpr const char* gravitational_constant = "2.95912208286e-4";
  static constexpr Body bodies[6] = {
      {"1.00000597682", {"0", "0", "0"}, {"0", "0", "0"}},
      {"0.000954786104043", {"-3.5023653", "-3.8169847", "-1.5507963"}, {"0.00565429", "-0.00412490", "-0.00190589"}},
      {"0.000285583733151", {"9.0755314", "-3.0458353", "-1.6483708"}, {"0.00168318", "0.00483525", "0.00192462"}},
      {"0.0000437273164546", {"8.3101420", "-16.2901086", "-7.2521278"}, {"0.00354178", "0.00137102", "0.00055029"}},
      {"0.0000517759138449", {"11.4707666", "-25.7294829", "-10.8169456"}, {"0.00288930", "0.00114527", "0.00039677"}},
      {"1/1.3e8", {"-15.5387357", "-25.2225594", "-3.1902382"}, {"0.00276725", "-0.00170702", "-0.00136504"}}};
};

}  // namespace hamflow
