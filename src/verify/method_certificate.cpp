// Makes the certificate of a method: drift class, momentum maps, reversal.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hamflow/verify/certificate.hpp"
#include "hamflow/verify/measure.hpp"
#include "measuring_stopped.hpp"

namespace hamflow {

namespace {
constexpr std::int64_t map_steps = 20000;  // about 300 periods
constexpr std::int64_t reversal_steps = 1000;

Request request_on(const Region& region, const MethodSpec& method, const State<double>& z) {
  Request request;
  request.problem = region.problem;
  request.variant = region.variant;
  request.walls = region.walls;
  request.parameters = region.parameters;
  request.method = method;
  request.dt = shortest(region.step);
  for (std::size_t i = 0; i < z.size(); ++i)
    (2 * i < z.size() ? request.start.q : request.start.p).push_back(shortest(z[i]));
  return request;
}

/// Half of the digits of a double. If the motion grows by more, rounding explains errors as large as the invariants.
constexpr double largest_growth = 0x1p26;

double largest_coordinate(const Frame& frame) {
  double most = 0;
  for (const auto* all : {&frame.q, &frame.p}) {
    for (const double x : *all) most = std::max(most, std::abs(x));
  }
  return most;
}

/// Explains why a run shows nothing about conservation; empty if it does show something.
std::string why_nothing_concluded(const Simulation& simulation, Outcome outcome, double size_at_start, double size) {
  if (outcome == Outcome::non_finite) {
    return fmt::format("the state was no longer finite after step {} of {}", simulation.step(), map_steps);
  }
  if (outcome != Outcome::done) {
    return fmt::format("the run stopped at step {} of {}: {}", simulation.step(), map_steps,
                       cause_of(simulation.failure()));
  }
  if (!(size <= largest_growth * size_at_start)) {
    return fmt::format("the motion grew too much: coordinates grew from {:.2g} to {:.2g}", size_at_start, size);
  }
  return {};
}

/// Measures the invariants whose rounding error is known.
void measure_maps(const Region& region, const MethodSpec& method, MethodCertificate& found) {
  const auto problem_entry = find_problem(region);
  const ProblemEntry& problem = *problem_entry;
  if (!problem.accepts(method) || problem.info.invariants.empty()) return;
  throw_if_stopped();
  const Request request = request_on(region, method, random_state(region, 0));
  const auto simulation = make_simulation(request);
  Frame start;
  simulation->look(start);
  EnergyBlocks blocks;
  Observer* const observers[] = {&blocks};
  const Outcome outcome = run(*simulation, map_steps, observers);
  const std::vector<double>& sizes = blocks.state().magnitudes;
  const std::string nothing =
      why_nothing_concluded(*simulation, outcome, largest_coordinate(start), std::max(sizes[0], sizes[1]));
  const std::vector<MomentumMap> maps = momentum_maps(*simulation, problem, sizes, request);
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const MomentumMap& map = maps[i];
    if (map.rounding) {
      const bool is_undecided = nothing.empty() && !map.conserved();
      found.momentum_maps.push_back({region.problem, map.name, simulation->step(), map.max_error, map.relative,
                                     *map.rounding, nothing.empty() ? map.conserved() : std::nullopt,
                                     is_undecided ? "the error may come from rounding or from the method" : nothing});
    } else if (simulation->step() == 0 && problem.info.invariants[i].terms != Terms::other) {
      constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
      found.momentum_maps.push_back({region.problem, map.name, 0, unknown, unknown, unknown, std::nullopt, nothing});
    }
  }
}
}  // namespace

MethodCertificate certificate_of(const MethodSpec& method, std::span<const Region> regions,
                                 std::span<const Measurement> on) {
  MethodCertificate found;
  for (const Measurement& m : on) {
    const std::optional<DriftClass>& here = m.energy.drift.drift;
    if (found.drift == DriftClass::linear) break;  // no class is worse
    if (here == DriftClass::linear || !here || !found.drift) {
      found.drift = here == DriftClass::linear ? here : std::nullopt;
    } else {
      found.drift = std::max(found.drift, here);
    }
  }
  measure_maps(region_of("central-force", {{"potential", "kepler"}, {"coordinates", "cartesian"}}), method, found);
  measure_maps(region_of("n-body"), method, found);
  for (const Region& region : regions) {
    const bool measured = std::any_of(found.momentum_maps.begin(), found.momentum_maps.end(),
                                      [&](const auto& map) { return map.problem == region.problem; });
    if (!measured) measure_maps(region, method, found);
  }
  for (const Region& region : regions) {
    const ReversalEvidence back = reversal_evidence(request_on(region, method, random_state(region, 0)),
                                                    *find_problem(region), reversal_steps, std::nullopt);
    found.reversals.push_back({region.problem, back.steps, back.relative.value_or(0.0), back.relative.has_value(),
                               std::string(name(back.proves)), back.reason});
  }
  return found;
}

}  // namespace hamflow
