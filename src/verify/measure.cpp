#include "hamflow/verify/measure.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/verify/counter_random.hpp"
#include "structure.hpp"

namespace hamflow {

namespace {
constexpr std::uint64_t seed = 20100617;  // any number: fixed, so that a measurement can be repeated

/// Regions chosen by hand, where the dynamics is bounded and regular, and, where the problem is, nonlinear: no turning
/// point, no apsis but that of the ellipses, where the defects are largest.
const std::vector<Region>& known_regions() {
  static const std::vector<Region> all{
      {.problem = "pendulum", .centre = {2.0, 0.5}, .spread = 0.15, .time = 2.5},
      {.problem = "henon-heiles", .centre = {0.3, -0.15, 0.2, 0.25}, .spread = 0.08, .time = 3.25},
      {.problem = "lennard-jones-oscillator", .centre = {1.25, 0.25}, .spread = 0.05, .step = 0.025, .time = 0.7},
      {.problem = "harmonic", .centre = {1.0, 0.5}, .spread = 0.2},
      // From r = 1 to r = 3 for mass 1 and k = 1; the time is a seventh of the period, 2 pi sqrt(8).
      {.problem = "central-force", .variant = {{"potential", "kepler"}}, .centre = {1, 0, 0, std::sqrt(1.5)}},
      {.problem = "central-force",
       .variant = {{"potential", "hooke"}},
       .parameters = {{"k", "-1"}},
       .centre = {1, 0.3, -0.2, 0.6}},
      {.problem = "central-force", .variant = {{"potential", "linear"}}, .centre = {1, 0.3, -0.2, 0.9}},
      {.problem = "central-force",
       .variant = {{"potential", "binomial"}},
       .centre = {1.2, 0.3, -0.2, 0.9},
       .step = 0.04},
      {.problem = "central-force",
       .variant = {{"potential", "power"}},
       .parameters = {{"a", "[0.5, -0.5]"}, {"n", "[2, -2.5]"}},
       .centre = {1.2, 0.3, -0.2, 0.9},
       .step = 0.04},
      {.problem = "central-force",
       .variant = {{"potential", "hooke"}, {"coordinates", "polar"}},
       .parameters = {{"k", "-1"}},
       .centre = {1.2, 0.3, -0.2, 0.7},
       .step = 0.07},
      {.problem = "central-force",
       .variant = {{"potential", "binomial"}, {"coordinates", "polar"}},
       .centre = {1.2, 0.3, -0.2, 0.9},
       .step = 0.03},
      {.problem = "central-force",
       .variant = {{"potential", "power"}, {"coordinates", "polar"}},
       .parameters = {{"a", "[0.5, -0.5]"}, {"n", "[2, -2.5]"}},
       .centre = {1.2, 0.3, -0.2, 0.9},
       .step = 0.03},
      {.problem = "central-force",
       .variant = {{"potential", "linear"}, {"coordinates", "polar"}},
       .centre = {1.2, 0.3, -0.2, 0.9},
       .step = 0.07},
      {.problem = "central-force",
       .variant = {{"potential", "kepler"}, {"coordinates", "polar"}},
       .centre = {1.2, 0.3, -0.2, 1.1},
       .step = 0.07},
      // A period of the faster mode is 2 pi/sqrt(5.65 g/l) = 0.84 for unit rods.
      {.problem = "double-pendulum",
       .variant = {{"model", "linear"}, {"angles", "absolute"}},
       .centre = {0.4, -0.3, 0.5, 0.2},
       .step = 0.013,
       .time = 0.7},
      {.problem = "double-pendulum",
       .variant = {{"model", "linear"}, {"angles", "relative"}},
       .centre = {0.4, -0.7, 0.7, 0.2},
       .step = 0.013,
       .time = 0.7},
      {.problem = "double-pendulum",
       .variant = {{"model", "nonlinear"}, {"angles", "absolute"}},
       .centre = {0.4, -0.3, 0.5, 0.2},
       .spread = 0.05,
       .step = 0.008,
       .time = 0.7},
      {.problem = "double-pendulum",
       .variant = {{"model", "nonlinear"}, {"angles", "relative"}},
       .centre = {0.4, -0.7, 0.7, 0.2},
       .spread = 0.05,
       .step = 0.008,
       .time = 0.7},
      {.problem = "sextic", .centre = {0.6, 0.9}, .spread = 0.2, .step = 0.023},
      {.problem = "duffing", .parameters = {{"alpha", "-1"}, {"beta", "1"}}, .centre = {1.3, 0.4}},
      {.problem = "magnetic", .centre = {0.4, -0.3, 0.2, 0.5, 0.3, 0.4}},
      // Softened, so that close encounters, to which the elements come in time, do no harm.
      {.problem = "n-body",
       .parameters = {{"masses", "[1, 0.3, 0.2]"}, {"softening", "0.2"}},
       .centre = {0, 0, 1, 0, 0, -1.5, 0, -0.1, 0, 0.3, 0.16, 0},
       .spread = 0.05,
       .step = 0.02},
      // A fall for ever: over a short time, in which H does not become a difference of large numbers.
      {.problem = "free-fall", .centre = {0.5, 0.5}, .step = 0.0002, .time = 1},
      {.problem = "fput",
       .parameters = {{"n", "4"}, {"alpha", "0.25"}, {"beta", "0.5"}},
       .centre = {0.3, 0.4, -0.2, 0.2, 0.1, -0.2, 0.2, 0.1},
       .spread = 0.05,
       .step = 0.05},
  };
  return all;
}
}  // namespace

State<double> random_state(const Region& region, std::uint64_t k) {
  State<double> z = region.centre;
  for (std::size_t i = 0; i < z.size(); ++i) z[i] += region.spread * counter_uniform(seed, k * z.size() + i);
  return z;
}

Region region_of(const std::string& problem, const std::map<std::string, std::string>& variant) {
  const auto polar = variant.find("coordinates");
  for (const Region& region : known_regions()) {
    if (region.problem != problem) continue;
    if (polar != variant.end() && polar->second == "polar" && !region.variant.contains("coordinates")) continue;
    const bool matches = std::all_of(region.variant.begin(), region.variant.end(), [&](const auto& choice) {
      const auto given = variant.find(choice.first);
      return given == variant.end() || given->second == choice.second;
    });
    if (matches) {
      Region found = region;
      for (const auto& [key, value] : variant) found.variant[key] = value;
      return found;
    }
  }
  // The start of the catalogue, or any state when there is none, moved a little: no coordinate at rest.
  const ProblemEntry& entry = find_problem(problem, variant);
  Region region{.problem = problem, .variant = variant};
  if (problem == "solar-system") {  // days; momenta down to 1e-11: any move would throw the planets out
    for (const auto* texts : {&entry.info.default_q, &entry.info.default_p}) {
      for (const std::string& text : *texts) region.centre.push_back(evaluate_number<double>(text));
    }
    region.spread = 1e-13;
    region.step = 50;
    region.time = 1000;
    return region;
  }
  const std::size_t dimension = entry.dimension > 0 ? entry.dimension : entry.info.default_q.size();
  for (std::size_t i = 0; i < 2 * dimension; ++i) {
    const auto& texts = i < dimension ? entry.info.default_q : entry.info.default_p;
    const std::size_t at = i % dimension;
    region.centre.push_back((texts.empty() ? 0.5 : evaluate_number<double>(texts[at])) +
                            0.1 * counter_uniform(seed + 1, i));
  }
  return region;
}

namespace {
/// With sub-steps of its own a step has no order.
MethodSpec measurable(const MethodSpec& method) {
  const MethodFamily& family = *find_method(method.name).family;
  return {method.name, family.measurable ? family.measurable(method.options) : method.options};
}
}  // namespace

std::unique_ptr<StepMap> step_map_on(const Region& region, const MethodSpec& method) {
  const ProblemEntry& entry = find_problem(region.problem, region.variant);
  const MethodSpec fixed = measurable(method);
  auto map = entry.step_map(complete(entry.info, region.parameters), fixed, region.centre.size() / 2);
  if (!map) throw Error(refusal(method, entry));
  return map;
}

std::vector<Region> default_regions(const MethodSpec& method) {
  std::vector<Region> usual{region_of("pendulum"), region_of("henon-heiles")};
  std::erase_if(usual, [&](const Region& r) { return !find_problem(r.problem, r.variant).accepts(method); });
  if (!usual.empty()) return usual;
  for (const ProblemEntry& entry : problems()) {
    if (!entry.accepts(method)) continue;
    return {region_of(entry.info.name, {entry.info.variant.begin(), entry.info.variant.end()})};
  }
  throw Error("no problem of the catalogue has what " + method.name + " needs");
}

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
    const auto map = step_map_on(region, method);
    claims = map->claims();
    on.push_back(measure(*map, region));
  }
  MethodCertificate certificate = certificate_of(method, regions, on);
  PropertyRow row = judge(claims, std::move(on));
  row.certificate = std::move(certificate);
  return row;
}

}  // namespace hamflow
