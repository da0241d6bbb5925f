// The certificate of a method: drift class, momentum maps, reversal.
#include <algorithm>

#include "hamflow/verify/certificate.hpp"
#include "hamflow/verify/measure.hpp"

namespace hamflow {

namespace {
constexpr std::int64_t map_steps = 20000;  // of the order of 300 periods
constexpr std::int64_t return_steps = 1000;

Request request_on(const Region& region, const MethodSpec& method, const State<double>& z) {
  Request request;
  request.problem = region.problem;
  request.variant = region.variant;
  request.parameters = region.parameters;
  request.method = method;
  request.dt = shortest(region.step);
  for (std::size_t i = 0; i < z.size(); ++i)
    (2 * i < z.size() ? request.start.q : request.start.p).push_back(shortest(z[i]));
  return request;
}

/// Invariants of which rounding is known.
void measure_maps(const Region& region, const MethodSpec& method, MethodCertificate& found) {
  const ProblemEntry& problem = find_problem(region.problem, region.variant);
  if (!problem.accepts(method) || problem.info.invariants.empty()) return;
  const Request request = request_on(region, method, random_state(region, 0));
  const auto simulation = make_simulation(request);
  EnergyBlocks blocks;
  Observer* const observers[] = {&blocks};
  const bool done = run(*simulation, map_steps, observers) == Outcome::done;
  for (const MomentumMap& map : momentum_maps(*simulation, problem, blocks.state().magnitudes, request)) {
    if (!map.rounding) continue;
    found.momentum_maps.push_back({region.problem, map.name, simulation->step(), map.max_error, map.relative,
                                   *map.rounding, done && map.conserved() == true});
  }
}
}  // namespace

MethodCertificate certificate_of(const MethodSpec& method, std::span<const Region> regions,
                                 std::span<const Measurement> on) {
  MethodCertificate found;
  for (const Measurement& m : on) found.drift = std::max(found.drift, m.energy.drift.drift);
  measure_maps(region_of("central-force", {{"potential", "kepler"}, {"coordinates", "cartesian"}}), method, found);
  measure_maps(region_of("n-body"), method, found);
  for (const Region& region : regions) {
    const bool measured = std::any_of(found.momentum_maps.begin(), found.momentum_maps.end(),
                                      [&](const auto& map) { return map.problem == region.problem; });
    if (!measured) measure_maps(region, method, found);
  }
  for (const Region& region : regions) {
    const ReversalEvidence back =
        reversal_evidence(request_on(region, method, random_state(region, 0)),
                          find_problem(region.problem, region.variant), return_steps, std::nullopt);
    found.reversals.push_back({region.problem, back.steps, back.relative.value_or(0.0), back.relative.has_value(),
                               std::string(name(back.proves)), back.reason});
  }
  return found;
}

}  // namespace hamflow
