// What run.h5 holds beside its samples, from the scenario.
#pragma once

#include <filesystem>

#include "hamflow/scenario/scenario.hpp"
#include "run_header.hpp"

namespace hamflow {

/// Above it a gas has no list of names, and its last state is said by its place in run.h5.
constexpr std::size_t most_named_coordinates = 10000;

/// The invariants in the order of the problem, with the number of components that each has here.
std::vector<InvariantColumn> invariant_columns(const Scenario& scenario);

/// The observables of [output], with their expressions.
std::vector<InvariantColumn> observable_columns(const Scenario& scenario);
/// Their values in a state.
std::vector<double> observable_values(const Scenario& scenario, const Frame& frame);
/// What trajectory.csv has beside the state: invariants, then observables.
std::vector<InvariantColumn> csv_columns(const Scenario& scenario);

/// Of the problem that brings numbers along; empty where units are those of the input.
ColumnUnits column_units(const Scenario& scenario);

/// Above the scenario that a session leaves, whose course was changed on the way; the changes follow, a line each.
inline constexpr std::string_view steered_heading =
    "# Steered by hamflow shell; the settings below are the last ones, the start is the first.\n";
inline constexpr std::string_view change_heading = "# after step ";
inline constexpr std::string_view momenta_negated = "momenta negated";
/// What was changed on the way, such as "dt = 0.05", from the text of that scenario.
std::vector<std::string> changes_on_the_way(std::string_view scenario);

/// @param samples expected
RunDescription description_of(const Scenario& scenario, std::size_t samples);

/// @throws FileError where states of a file have another length than those of the scenario in it
void check_states(const Scenario& scenario, const RunDescription& found, const std::filesystem::path& file);

/// The name of this machine.
std::string host_name();

}  // namespace hamflow
