#include "warnings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "hamflow/numerics/inverse_cube.hpp"

namespace hamflow {

namespace {

using Json = nlohmann::ordered_json;
constexpr double steps_per_period = 10;

Json warning(const char* kind, const std::string& message) { return {{"kind", kind}, {"message", message}}; }

/// |q dH/dq| + |p dH/dp|: for homogeneous T and V about T and V without their constants.
double virial(const ProblemEntry& problem, const Texts& parameters, const Frame& at) {
  constexpr double part = 0x1p-20;
  const auto slope = [&](double of_q, double of_p) {
    const auto energy = [&](double sign) {
      std::vector<double> q = at.q;
      std::vector<double> p = at.p;
      for (double& x : q) x *= 1 + sign * of_q;
      for (double& x : p) x *= 1 + sign * of_p;
      return problem.energy(parameters, q, p);
    };
    return std::abs(energy(1) - energy(-1)) / (2 * part);
  };
  return slope(part, 0) + slope(0, part);
}

std::string name_of(const Scenario& scenario, std::uint64_t coordinate) {
  const std::vector<std::string>& names = scenario.problem->info.coordinates;
  if (scenario.problem->dimension > 0 && coordinate < names.size()) return names[coordinate];
  return "coordinate " + std::to_string(coordinate + 1);
}

/// The time from one turn of a Cartesian coordinate to the next but one, or of the radius where that is longer; 0 where
/// it is not known.
double period_of_orbit(const Json& orbit) {
  if (orbit["falls_into_centre"].get<bool>()) return 0;
  const double radial = orbit["radial_period"].get<double>();
  const double angle = orbit["apsidal_angle"].get<double>();
  const double round = angle > 0 ? radial * pi_value<double>() / angle : radial;
  return std::isfinite(round) && std::isfinite(radial) ? std::max(radial, round) : 0;
}

void add_long_step(const Scenario& scenario, const Json& summary, const TurnWatch& turns, Json& all) {
  const auto seen = turns.fastest();
  double dt = std::abs(scenario.dt);
  double period = 0;
  std::string whose;
  if (seen) {
    dt = std::abs(seen->dt);
    period = seen->period;
    whose = fmt::format("shortest period seen, {:.3g} (of {})", period, name_of(scenario, seen->coordinate));
  } else if (summary.contains("orbit")) {
    period = period_of_orbit(summary["orbit"]);
    whose = fmt::format("period of the orbit, {:.3g}", period);
  }
  if (period == 0 || steps_per_period * dt <= period) return;
  all.push_back(warning("long_step", fmt::format("dt = {:g} is more than a tenth of the {}; try dt = {:.2g} or less",
                                                 dt, whose, period / (2 * steps_per_period))));
}

}  // namespace

bool is_energy_nonsense(const ProblemEntry& problem, const Texts& parameters, const Excursion& energy, double scale,
                        const Frame& start, const Frame& end) {
  if (!(energy.max_error > scale)) return false;
  // A start at which T and V vanish by chance (a pendulum held level) has a scale of rounding: there the virial at the
  // start says what is large, and an error that is small beside the virial at the end is none.
  return !(energy.max_error <= virial(problem, parameters, start) / 4 ||
           energy.max_error <= 0.01 * virial(problem, parameters, end));
}

Json warnings_of(const Scenario& scenario, const Json& summary, const Simulation& simulation, const TurnWatch* turns) {
  Json all = Json::array();
  const Excursion energy = simulation.energy();
  const double scale = simulation.energy_scale();
  Frame end;
  simulation.look(end);
  Frame start;
  start.q = scenario.start_q;
  start.p = scenario.start_p;
  const Texts& parameters = scenario.request.parameters;
  if (is_energy_nonsense(*scenario.problem, parameters, energy, scale, start, end)) {
    all.push_back(
        warning("energy_error", fmt::format("the energy was off by {:.3g}, more than its scale, {:.3g}: this is "
                                            "no motion of {}; try a smaller dt",
                                            energy.max_error, scale, scenario.request.problem)));
  }
  if (turns != nullptr && turns->is_active()) add_long_step(scenario, summary, *turns, all);
  if (summary.contains("orbit") && summary["orbit"]["falls_into_centre"].get<bool>() && !summary.contains("exact")) {
    // Known at the start, and at the end no more. Where it is not known at the start, nobody can say.
    if (scenario.problem->exact(parameters, scenario.start_q, scenario.start_p, 0)) {
      all.push_back(
          warning("falls_into_centre",
                  "the orbit ends in the centre, where H has no finite value, before the run does: what comes "
                  "after is no motion; stop earlier, or give the start some angular momentum"));
    }
  }
  return all;
}

std::vector<std::string> warning_lines(const Json& summary) {
  std::vector<std::string> lines;
  if (!summary.contains("warnings")) return lines;
  for (const Json& each : summary["warnings"]) {
    lines.push_back(each["kind"].get<std::string>() + ": " + each["message"].get<std::string>());
  }
  return lines;
}

}  // namespace hamflow
