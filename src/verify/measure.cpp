#include "hamflow/verify/measure.hpp"

#include <cmath>

#include "hamflow/verify/counter_random.hpp"
#include "structure.hpp"

namespace hamflow {

namespace {
constexpr std::uint64_t seed = 20100617;  // any number: fixed, so that a measurement can be repeated

/// Regions by hand, where the dynamics is nonlinear, bounded and regular; libration, no turning point, no apsis.
const std::vector<Region>& known_regions() {
  static const std::vector<Region> all{
      {.problem = "pendulum", .centre = {2.0, 0.5}, .spread = 0.15, .time = 2.5},
      {.problem = "henon-heiles", .centre = {0.3, -0.15, 0.2, 0.25}, .spread = 0.08, .time = 3.25},
      {.problem = "lennard-jones-oscillator", .centre = {1.25, 0.25}, .spread = 0.05, .step = 0.025, .time = 0.7},
      {.problem = "harmonic", .centre = {1.0, 0.5}, .spread = 0.2},
  };
  return all;
}

/// The ellipse from r = 1 to r = 3 of mass 1 and k = 1, at its pericentre where the defects are largest; the time is
/// about a seventh of its period, 2 pi sqrt(8).
Region kepler_region() { return {.problem = "central-force", .centre = {1, 0, 0, std::sqrt(1.5)}, .spread = 0.1}; }
}  // namespace

State<double> random_state(const Region& region, std::uint64_t k) {
  State<double> z = region.centre;
  for (std::size_t i = 0; i < z.size(); ++i) z[i] += region.spread * counter_uniform(seed, k * z.size() + i);
  return z;
}

Region region_of(const std::string& problem) {
  for (const Region& region : known_regions()) {
    if (region.problem == problem) return region;
  }
  if (problem == "central-force") return kepler_region();
  // The start of the catalogue, or any state when there is none, moved a little: no coordinate at rest.
  const ProblemEntry& entry = find_problem(problem, {});
  Region region{.problem = problem};
  for (std::size_t i = 0; i < 2 * entry.dimension; ++i) {
    const auto& texts = i < entry.dimension ? entry.info.default_q : entry.info.default_p;
    const std::size_t at = i % entry.dimension;
    region.centre.push_back((texts.empty() ? 0.5 : evaluate_number<double>(texts[at])) +
                            0.1 * counter_uniform(seed + 1, i));
  }
  return region;
}

std::vector<Region> default_regions() { return {region_of("pendulum"), region_of("henon-heiles")}; }

Measurement measure(const StepMap& map, const Region& region) {
  Measurement found;
  found.problem = region.problem;
  found.order = measure_order(map, region);
  measure_structure(map, region, found);
  found.energy = measure_energy(map, region);
  found.cost = measure_cost(map, region);
  return found;
}

PropertyRow measure_method(const MethodSpec& method, std::span<const Region> regions) {
  std::vector<Measurement> on;
  MethodInfo claims = describe(method);
  for (const Region& region : regions) {
    const ProblemEntry& entry = find_problem(region.problem, {});
    const auto map = entry.step_map(complete(entry.info, {}), method);
    claims = map->claims();
    on.push_back(measure(*map, region));
  }
  return judge(claims, std::move(on));
}

}  // namespace hamflow
