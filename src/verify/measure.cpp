#include "hamflow/verify/measure.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/run/walls.hpp"
#include "structure.hpp"

namespace hamflow {

namespace {
constexpr std::uint64_t seed = 20100617;  // arbitrary but fixed, so that a measurement can be repeated

/// Moves bodies so that their centre of mass is at rest at the origin. Otherwise they move away, their coordinates
/// round by more and more, and the energy of any method walks like t^1.5.
State<double> in_barycentre(const Region& region, const State<double>& z) {
  const auto found_entry = find_problem(region);
  const ProblemEntry& entry = *found_entry;
  Request request;
  request.parameters = complete(entry.info, region.parameters);
  request.start.barycentric = true;
  for (std::size_t i = 0; i < z.size(); ++i) {
    (2 * i < z.size() ? request.start.q : request.start.p).push_back(shortest(z[i]));
  }
  const Frame start = entry.start(request);
  State<double> moved = start.q;
  moved.insert(moved.end(), start.p.begin(), start.p.end());
  return moved;
}
}  // namespace

/// Moves a state onto the constraints, if there are any.
static State<double> onto_constraints(const Region& region, const State<double>& z) {
  const auto found_entry = find_problem(region);
  const ProblemEntry& entry = *found_entry;
  if (!entry.onto_constraints) return z;
  const auto half = z.begin() + static_cast<std::ptrdiff_t>(z.size() / 2);
  const Frame there =
      entry.onto_constraints(complete(entry.info, region.parameters), {z.begin(), half}, {half, z.end()});
  State<double> moved = there.q;
  moved.insert(moved.end(), there.p.begin(), there.p.end());
  return moved;
}

State<double> random_state(const Region& region, std::uint64_t k) {
  State<double> z = region.centre;
  for (std::size_t i = 0; i < z.size(); ++i) z[i] += region.spread * counter_uniform(seed, k * z.size() + i);
  if (region.constrained) return onto_constraints(region, z);
  return region.of_bodies ? in_barycentre(region, z) : z;
}

Region region_of(const std::string& problem, const std::map<std::string, std::string>& variant) {
  const auto found_entry = usual_problem(problem, variant);
  const ProblemEntry& entry = *found_entry;
  Region region{entry.info.region, problem, {entry.info.variant.begin(), entry.info.variant.end()}};
  region.of_bodies = static_cast<bool>(entry.total_mass);
  region.constrained = static_cast<bool>(entry.onto_constraints);
  if (!region.centre.empty()) {
    if (region.constrained) region.centre = onto_constraints(region, region.centre);
    return region;
  }
  // The centre is the default start, or any state if there is none, moved a little so that no coordinate is at rest.
  const std::size_t dimension = entry.dimension > 0 ? entry.dimension : entry.info.default_q.size();
  if (dimension == 0) throw Error(problem + " has no fixed size, and declares neither a region nor a default start");
  for (std::size_t i = 0; i < 2 * dimension; ++i) {
    const auto& texts = i < dimension ? entry.info.default_q : entry.info.default_p;
    const std::size_t at = i % dimension;
    region.centre.push_back((texts.empty() ? 0.5 : evaluate_number<double>(texts[at])) +
                            0.1 * counter_uniform(seed + 1, i));
  }
  return region;
}

std::optional<Region> region_at_walls(const std::string& problem) {
  const auto found_entry = usual_problem(problem);
  const ProblemEntry& entry = *found_entry;
  if (entry.info.region_at_walls.centre.empty()) return std::nullopt;
  Region region{entry.info.region_at_walls, problem, {entry.info.variant.begin(), entry.info.variant.end()}};
  Walls walls;
  for (const FixedWall& wall : entry.info.walls) {
    walls.intervals.push_back({entry.info.coordinates.at(wall.coordinate), wall.coordinate, wall.min, wall.max});
  }
  region.walls = walls;
  return region;
}

namespace {
/// Replaces options with which the step has no order, such as a tolerance for sub-steps.
MethodSpec measurable(const MethodSpec& method) {
  const MethodFamily& family = *find_method(method.name).family;
  return {method.name, family.measurable ? family.measurable(method.options) : method.options};
}
}  // namespace

std::unique_ptr<StepMap> step_map_on(const Region& region, const MethodSpec& method) {
  if (describe(method).varies_steps) {
    throw Error("found " + describe(method).name +
                "; allowed step_control=fixed, because with steps of varying size a step is not a map of (q, p) alone");
  }
  const auto found_entry = find_problem(region);
  const ProblemEntry& entry = *found_entry;
  const Request request{.problem = region.problem,
                        .variant = region.variant,
                        .walls = region.walls,
                        .parameters = complete(entry.info, region.parameters),
                        .start = {},
                        .method = measurable(method)};
  auto map = entry.step_map(request, region.centre.size() / 2);
  if (!map) throw Error(refusal(method, entry));
  return map;
}

std::vector<Region> default_regions(const MethodSpec& method) {
  const auto refused = [&](const Region& r) { return !find_problem(r)->accepts(method); };
  std::vector<Region> usual{region_of("pendulum"), region_of("henon-heiles")};
  std::erase_if(usual, refused);
  if (!usual.empty()) return usual;
  // The Kepler ellipse has forces like those between bodies, and takes a tenth of the time.
  const Region ellipse = region_of("central-force", {{"potential", "kepler"}, {"coordinates", "cartesian"}});
  if (!refused(ellipse)) return {ellipse};
  // With constraints two problems are used, because a property that is not claimed has to be missing on one of several.
  std::vector<Region> found;
  for (const ProblemEntry& entry : problems()) {
    if (!entry.accepts(method)) continue;
    if (!found.empty() && (entry.constraint_form.empty() || found.back().problem == entry.info.name)) continue;
    found.push_back(region_of(entry.info.name, {entry.info.variant.begin(), entry.info.variant.end()}));
  }
  if (!found.empty()) return found;
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
  const std::string as = describe(measurable(method)).name;
  if (as != describe(method).name) row.measured_as = as;
  return row;
}

PropertyRow measure_at_walls(const MethodSpec& method, const Region& region) {
  const auto map = step_map_on(region, method);
  Measurement found;
  found.problem = region.problem + ", at a wall";
  found.order = measure_order(*map, region);
  measure_structure(*map, region, found);
  PropertyRow row = judge(map->claims(), {found});
  std::erase_if(row.cells, [](const PropertyCell& cell) {
    const std::vector<std::string> others{"explicit", "energy conserving", "forces per step", "Newton corrections"};
    return std::find(others.begin(), others.end(), cell.property) != others.end();
  });
  return row;
}

}  // namespace hamflow
