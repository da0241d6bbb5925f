// What is plainly nonsense about a run that came to its end all the same.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hamflow/detail/verify/turns.hpp"
#include "hamflow/run/simulation.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/workflow/summary.hpp"

namespace hamflow {

/// Of each kind at most one:
/// - energy_error: the largest energy error is above the scale of the energy;
/// - long_step: dt is above a tenth of the shortest period seen, or known of the orbit where none was seen;
/// - parted_copies: the two copies of the state that tao2 and tao4 carry have parted;
/// - falls_into_centre: the orbit ends in a singular centre before the run does;
/// - no_number: an invariant is not finite at the start or at the end.
/// @param summary all but its warnings   @param turns null where nobody has watched
std::vector<Warning> warnings_of(const Scenario& scenario, const Summary& summary, const Simulation& simulation,
                                 const TurnWatch* turns, std::optional<double> exchanged = {});

/// A motion that ended elsewhere than its simulation stands.
struct WatchedMotion {
  Excursion energy;
  Frame end;
  const OrbitSummary* orbit = nullptr;  // null: not known
  const TurnWatch* turns = nullptr;     // null: nobody has watched
  std::vector<WallCount> walls{};       // how often they were met
  std::int64_t steps = 0;               // in how many steps
  double mean_step = 0;                 // of steps of varying length; 0: not known
  std::optional<double> exchanged{};    // EnergyExchange::typical()
};
/// The same, but for no_number.
std::vector<Warning> warnings_of(const Scenario& scenario, const WatchedMotion& motion);
/// What is said of steps in which particles of a gas may pass through each other unseen; empty where it is nothing.
/// @param problem that of the request, whose method counts
std::string passing_in_a_step(const Request& request, const ProblemEntry& problem, double dt, const Frame& start,
                              const Frame& end);

/// Whether an energy error is more than the energy can account for: above what the motion exchanges, so that no
/// constant in H changes it. Where the exchange is zero or unknown, the error is compared with
/// the scale at the start, unless T and V vanish there by chance.   @param end the last state
/// @param exchanged EnergyExchange::typical(), which is less than Excursion::exchanged, and decides where it is known
bool is_energy_nonsense(const Scenario& scenario, const Excursion& energy, const Frame& end,
                        std::optional<double> exchanged = {});

}  // namespace hamflow
