// The Sun and planets with built-in masses and starts: astronomical units, days, solar masses.
#pragma once

#include <span>
#include <string>

#include "hamflow/detail/problems/gravity.hpp"

namespace hamflow {

/// Numbers as texts, which every arithmetic reads with all digits.
struct SolarBody {
  const char* name;
  const char* mass;
  const char* position[3];  // from the Sun
  const char* velocity[3];
};

struct SolarBodies {
  static constexpr const char* problem = "solar-system";
  static constexpr const char* key = "planets";  // selects the set of bodies
  const char* choice;
  const char* gravitational_constant;
  std::span<const SolarBody> bodies;

  template <class R>
  std::vector<R> masses() const {
    std::vector<R> all;
    for (const SolarBody& body : bodies) all.push_back(evaluate_number<R>(body.mass));
    return all;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const SolarBody& body : bodies) all.emplace_back(body.name);
    return all;
  }
};

namespace detail {
// [HLW2006, Sect. I.2.4; data of September 5, 1994, from Ahnerts Kalender fuer Sternfreunde]
inline constexpr SolarBody outer_bodies[] = {
    {"Sun", "1.00000597682", {"0", "0", "0"}, {"0", "0", "0"}},
    {"Jupiter",
     "0.000954786104043",
     {"-3.5023653", "-3.8169847", "-1.5507963"},
     {"0.00565429", "-0.00412490", "-0.00190589"}},
    {"Saturn",
     "0.000285583733151",
     {"9.0755314", "-3.0458353", "-1.6483708"},
     {"0.00168318", "0.00483525", "0.00192462"}},
    {"Uranus",
     "0.0000437273164546",
     {"8.3101420", "-16.2901086", "-7.2521278"},
     {"0.00354178", "0.00137102", "0.00055029"}},
    {"Neptune",
     "0.0000517759138449",
     {"11.4707666", "-25.7294829", "-10.8169456"},
     {"0.00288930", "0.00114527", "0.00039677"}},
    {"Pluto", "1/1.3e8", {"-15.5387357", "-25.2225594", "-3.1902382"}, {"0.00276725", "-0.00170702", "-0.00136504"}}};

// The sample input of the integrator Mercury: ecliptic and equinox J2000, JD 2451000.5 (July 6, 1998). Earth is the
// Earth and the Moon together.   [Chambers1999]
inline constexpr SolarBody all_bodies[] = {
    {"Sun", "1", {"0", "0", "0"}, {"0", "0", "0"}},
    {"Mercury",
     "1.66013679527193009e-7",
     {"-3.83966017419175965e-1", "-1.76865300855700736e-1", "2.07959213998758705e-2"},
     {"5.96286238644834141e-3", "-2.43281292146216750e-2", "-2.53463209848734695e-3"}},
    {"Venus",
     "2.44783833966454430e-6",
     {"6.33469157915745540e-1", "3.49855234102151691e-1", "-3.17853172088953667e-2"},
     {"-9.84258038001823571e-3", "1.76183746921837227e-2", "8.08822351013463794e-4"}},
    {"Earth",
     "3.04043264264672381e-6",
     {"2.42093942183383037e-1", "-9.87467766698604366e-1", "-4.54276292555233496e-6"},
     {"1.64294055023289365e-2", "4.03200725816140870e-3", "1.13609607260006795e-8"}},
    {"Mars",
     "3.22715144505386530e-7",
     {"2.51831018120174499e-1", "1.52598983115984788", "2.57781137811807781e-2"},
     {"-1.32744166042475433e-2", "3.46582959610421387e-3", "3.98930013246952611e-4"}},
    {"Jupiter",
     "9.54791938424326609e-4",
     {"4.84143144246472090", "-1.16032004402742839", "-1.03622044471123109e-1"},
     {"1.66007664274403694e-3", "7.69901118419740425e-3", "-6.90460016972063023e-5"}},
    {"Saturn",
     "2.85885980666130812e-4",
     {"8.34336671824457987", "4.12479856412430479", "-4.03523417114321381e-1"},
     {"-2.76742510726862411e-3", "4.99852801234917238e-3", "2.30417297573763929e-5"}},
    {"Uranus",
     "4.36624404335156298e-5",
     {"1.28943695621391310e1", "-1.51111514016986312e1", "-2.23307578892655734e-1"},
     {"2.96460137564761618e-3", "2.37847173959480950e-3", "-2.96589568540237556e-5"}},
    {"Neptune",
     "5.15138902046611451e-5",
     {"1.53796971148509165e1", "-2.59193146099879641e1", "1.79258772950371181e-1"},
     {"2.68067772490389322e-3", "1.62824170038242295e-3", "-9.51592254519715870e-5"}},
    {"Pluto",
     "7.39644970414201173e-9",
     {"-1.15095623952731607e1", "-2.70779438829451422e1", "6.22871533567077229"},
     {"2.97220056963797431e-3", "-1.69820233395912967e-3", "-6.76798264809371094e-4"}}};
}  // namespace detail

/// The Sun with the inner planets' mass, and Jupiter to Pluto.
inline constexpr SolarBodies outer_solar_bodies{"outer", "2.95912208286e-4", detail::outer_bodies};
/// The Sun, the eight planets and Pluto. G is the square of Gauss' constant.
inline constexpr SolarBodies all_solar_bodies{"all", "0.01720209895^2", detail::all_bodies};
inline const SolarBodies& solar_bodies(const std::string& choice) {
  return choice == all_solar_bodies.choice ? all_solar_bodies : outer_solar_bodies;
}

template <class R, const SolarBodies& set>
class SolarSystemOf : public Gravity<R> {
 public:
  SolarSystemOf(const Parameters<R>& /*none*/, std::size_t /*of q*/) : SolarSystemOf() {}
  SolarSystemOf() : Gravity<R>(set.template masses<R>(), evaluate_number<R>(set.gravitational_constant), R(0), 3) {}

  static std::string refused_size(const Parameters<R>&, std::size_t size) {
    const std::size_t needed = 3 * set.bodies.size();
    return size == needed ? std::string()
                          : std::to_string(needed) + " numbers, three for each of " + joined(set.names());
  }

 protected:
  static ProblemInfo info_of_set(const char* reference, double step, double time, double dt) {
    ProblemInfo all{.name = SolarBodies::problem,
                    .variant = {{SolarBodies::key, set.choice}},
                    .formula = "H = sum |p_i|^2/(2 m_i) - G sum_{i<j} m_i m_j/r_ij: " + joined(set.names()) +
                               "; AU, days, solar masses",
                    .reference = reference,
                    .coordinates = {"x1", "y1", "z1", "...", "z" + std::to_string(set.bodies.size())},
                    .invariants = Gravity<R>::gravity_invariants(),
                    // The data are heliocentric: without the shift the system would drift by 2250 AU in 10^6 years.
                    .frame = Gravity<R>::frame_key(StartFrames::barycentric),
                    // Days. Momenta are as small as 1e-11; a larger spread would eject the planets.
                    .region = {.spread = 1e-13, .step = step, .time = time},
                    .example = {.dt = dt, .steps = 10000}};
    for (const SolarBody& body : set.bodies) {
      for (const char* x : body.position) all.default_q.push_back(x);
      for (const char* v : body.velocity) all.default_p.push_back(std::string(body.mass) + "*(" + v + ")");
    }
    for (const auto* texts : {&all.default_q, &all.default_p}) {
      for (const std::string& text : *texts) all.region.centre.push_back(evaluate_number<double>(text));
    }
    return all;
  }
};

}  // namespace hamflow
