// Makes the data of a figure from a run.h5, and finds the settings in which runs differ.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "figure.hpp"
#include "hamflow/detail/run/run_tables.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "run_file.hpp"

namespace hamflow {

/// Returns the path of run.h5 or reverse.h5 in a folder, or the file itself.
/// @throws FileError for the folder of a sweep, a comparison or an unfinished reversal, and for sweep.h5
std::filesystem::path stored_run_in(const std::filesystem::path& run);
/// Returns the scenario stored in a run.h5.   @throws FileError
Scenario scenario_of(const StoredRun& run, const std::filesystem::path& file);

/// Returns the name of the problem in titles; for a typed problem the formula.
std::string problem_text(const Scenario& scenario);

struct RunForFigure {
  FigureData data;   // without title and label
  std::string name;  // name of the folder or file of the run
  /// Settings of the run, for example {"method", "stv4"}, {"dt", "0.1"}: keys and values in the order of titles.
  std::vector<std::pair<std::string, std::string>> facts;
  std::vector<std::string> notes;  // notes on data of the file that are left out
  Scenario scenario;
};

/// Returns all positions of particles at a sample.
using Positions = std::function<std::vector<double>(std::size_t sample)>;

/// @param run folder of the run, which gives its name   @param kinds kinds of the figures; empty: not chosen yet
/// @param positions empty: the positions are in the table
RunForFigure for_figure(const Scenario& scenario, const RunTables& tables, const std::filesystem::path& run,
                        const std::vector<std::string>& kinds, Positions positions = {});
/// @param run a folder or run.h5   @throws FileError
RunForFigure read_for_figure(const std::filesystem::path& run, const std::vector<std::string>& kinds = {});

/// Adds the start as a sample if a requested time is before the first sample. The other columns are NaN there.
void add_start(RunForFigure& run, const std::vector<double>& times);

/// Repeats the first steps of the run and returns all of them; empty if they do not agree with the samples bit for bit.
FigureSamples first_steps_of(const RunForFigure& run);

/// Sets the titles of the runs from their common settings, and the labels from the settings in which they differ. If
/// labels are equal, the names of the runs are added.
void set_titles_and_labels(std::vector<RunForFigure>& runs);

}  // namespace hamflow
