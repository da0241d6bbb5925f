// Warnings about a run that ended normally but whose results are meaningless or doubtful.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hamflow/detail/verify/turning_points.hpp"
#include "hamflow/run/simulation.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/workflow/summary.hpp"

namespace hamflow {

/// Returns at most one warning of each kind:
/// - energy_error: the largest energy error is above the scale of the energy;
/// - long_step: dt is above a tenth of the shortest period seen, or of the known period of the orbit if none was seen;
/// - parted_copies: the two copies of the state that tao2 and tao4 carry have separated;
/// - falls_into_centre: the orbit reaches a singular centre before the run ends;
/// - left_orbit: the distance from the centre at the end is not near the orbit of the start;
/// - close_encounter: two bodies came so close that a splitting into Kepler motions is inaccurate;
/// - no_number: an invariant is not finite at the start or at the end.
/// @param summary complete except for its warnings   @param turns null: nothing watched for steps that are too long
std::vector<Warning> warnings_of(const Scenario& scenario, const Summary& summary, const Simulation& simulation,
                                 const TurningPointObserver* turns, std::optional<double> exchanged = {});

/// A motion to be judged, whose end may differ from the current state of the simulation.
struct WatchedMotion {
  Excursion energy;
  Frame end;
  const OrbitSummary* orbit = nullptr;          // null: unknown
  const TurningPointObserver* turns = nullptr;  // null: nothing watched for steps that are too long
  std::vector<WallCount> walls{};               // number of bounces off each wall
  std::int64_t steps = 0;
  double mean_step = 0;               // mean of steps of varying size; 0: unknown
  std::optional<double> exchanged{};  // EnergyExchange::typical()
};
/// Returns the same warnings without close_encounter and no_number.
std::vector<Warning> warnings_of(const Scenario& scenario, const WatchedMotion& motion);
/// Returns a warning if particles of a gas may pass through each other within a step; else empty.
/// @param problem problem of the request
std::string passing_in_a_step(const Request& request, const ProblemEntry& problem, double dt, const Frame& start,
                              const Frame& end);

/// Returns whether the energy error is so large that the result is meaningless: larger than the energy that the motion
/// exchanges, which does not depend on a constant in H. If the exchange is zero or unknown, the error is compared with
/// the scale at the start, unless T and V vanish there by chance.   @param end last state
/// @param exchanged EnergyExchange::typical(), used if it is known; it is less than Excursion::exchanged
bool is_energy_meaningless(const Scenario& scenario, const Excursion& energy, const Frame& end,
                           std::optional<double> exchanged = {});

}  // namespace hamflow
