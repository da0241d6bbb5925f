// A run.h5 as the data of a figure, and what tells runs apart.
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

/// The run.h5, or reverse.h5, of a folder or file.
/// @throws FileError if the folder is that of a sweep, a comparison or an unfinished reversal, or the file is sweep.h5
std::filesystem::path stored_run_in(const std::filesystem::path& run);
/// The scenario that a run.h5 carries.   @throws FileError
Scenario scenario_of(const StoredRun& run, const std::filesystem::path& file);

/// What a title calls the problem: one that is typed by what was typed.
std::string problem_text(const Scenario& scenario);

struct RunForFigure {
  FigureData data;   // without title and label
  std::string name;  // of its folder or file
  /// What it is a run of, e.g. {"method", "stv4"}, {"dt", "0.1"}: keys and values in the order in which titles have
  /// them.
  std::vector<std::pair<std::string, std::string>> facts;
  std::vector<std::string> notes;  // on what the file has among its samples and is left out
  Scenario scenario;
};

/// All positions of particles at a sample.
using Positions = std::function<std::vector<double>(std::size_t sample)>;

/// @param run the folder of the run, by which it is named   @param kinds of the figures; none: not chosen yet
/// @param positions none: those of the table
RunForFigure for_figure(const Scenario& scenario, const RunTables& tables, const std::filesystem::path& run,
                        const std::vector<std::string>& kinds, Positions positions = {});
/// @param run a folder or run.h5   @throws FileError
RunForFigure read_for_figure(const std::filesystem::path& run, const std::vector<std::string>& kinds = {});

/// Where samples begin later than the run, and a time before them is asked for, the start becomes one of them; what
/// else a sample has is not known there.
void add_start(RunForFigure& run, const std::vector<double>& times);

/// The first steps of the run once more, every one of them; nothing where they do not meet its samples to the bit.
FigureSamples opening_of(const RunForFigure& run);

/// Gives the runs their titles, of what they have in common, and their labels, of what differs; where nothing does,
/// their names.
void tell_apart(std::vector<RunForFigure>& runs);

}  // namespace hamflow
