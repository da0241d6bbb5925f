// What is plainly nonsense about a run that came to its end all the same.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hamflow/run/simulation.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/verify/turns.hpp"

namespace hamflow {

/// [{kind, message}, ...] of
/// - energy_error: the largest energy error is above the scale of the energy;
/// - long_step: dt is above a tenth of the shortest period seen, or known of the orbit where none was seen;
/// - parted_copies: the two copies of the state that tao2 and tao4 carry have parted;
/// - falls_into_centre: the orbit ends in a singular centre before the run does;
/// - no_number: an invariant is not finite at the start or at the end.
/// @param summary its energy, orbit, exact and final   @param turns null where nobody has watched
nlohmann::ordered_json warnings_of(const Scenario& scenario, const nlohmann::ordered_json& summary,
                                   const Simulation& simulation, const TurnWatch* turns,
                                   std::optional<double> exchanged = {});
/// The same of a motion that ended elsewhere than the simulation stands.
/// @param summary its orbit   @param end where it ended
/// @param walls how often they were met   @param steps in how many steps
nlohmann::ordered_json warnings_of(const Scenario& scenario, const nlohmann::ordered_json& summary,
                                   const Excursion& energy, const Frame& end, const TurnWatch* turns,
                                   std::span<const WallCount> walls = {}, std::int64_t steps = 0,
                                   std::optional<double> exchanged = {});
/// What is said of steps in which particles of a gas may pass through each other unseen; empty where it is nothing.
/// @param problem that of the request, whose method counts
std::string passing_in_a_step(const Request& request, const ProblemEntry& problem, double dt, const Frame& start,
                              const Frame& end);
/// "kind: message" of each, for the terminal; none of a summary without the key.
std::vector<std::string> warning_lines(const nlohmann::ordered_json& summary);

/// Whether an energy error is more than the energy can account for: above what the motion exchanges, so that no
/// constant in H changes it. Where the exchange is zero or unknown, the error is compared with
/// the scale at the start, unless T and V vanish there by chance.   @param end the last state
/// @param exchanged EnergyExchange::typical(), which is less than Excursion::exchanged, and decides where it is known
bool is_energy_nonsense(const Scenario& scenario, const Excursion& energy, const Frame& end,
                        std::optional<double> exchanged = {});

}  // namespace hamflow
