// Describes a scenario for run.h5: everything except the samples.
#pragma once

#include <filesystem>

#include "hamflow/scenario/scenario.hpp"
#include "run_header.hpp"

namespace hamflow {

/// With more coordinates a gas has no list of names, and the summary refers to run.h5 for the final state.
constexpr std::size_t most_named_coordinates = 10000;

/// Returns the invariants in the order of the problem, with their numbers of components.
std::vector<InvariantColumn> invariant_columns(const Scenario& scenario);

/// Returns the observables of [output], with their expressions.
std::vector<InvariantColumn> observable_columns(const Scenario& scenario);
/// Returns the values of the observables in a state.
std::vector<double> observable_values(const Scenario& scenario, const Frame& frame);
/// Returns the columns of trajectory.csv after the state: invariants, then observables.
std::vector<InvariantColumn> csv_columns(const Scenario& scenario);

/// Returns the units of a problem with built-in numbers; empty if the units are those of the input.
ColumnUnits column_units(const Scenario& scenario);

/// First line of the scenario that a session with changed settings writes; a line for each change follows.
inline constexpr std::string_view session_heading =
    "# Steered by hamflow shell; the settings below are the last ones, the start is the first.\n";
inline constexpr std::string_view change_heading = "# after step ";
inline constexpr std::string_view momenta_negated = "momenta negated";
/// Returns the changes of settings during a session, such as "dt = 0.05", from the text of its scenario.
std::vector<std::string> changes_during_run(std::string_view scenario);

/// @param samples expected number of samples
RunDescription description_of(const Scenario& scenario, std::size_t samples);

/// @throws FileError if the states of a file have another length than the scenario in it says
void check_states(const Scenario& scenario, const RunDescription& found, const std::filesystem::path& file);

/// Returns the name of this machine.
std::string host_name();

}  // namespace hamflow
