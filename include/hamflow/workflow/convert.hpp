// Converts states, scenarios and runs to other coordinates of their problem.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "hamflow/core/table.hpp"
#include "hamflow/run/state_names.hpp"
#include "hamflow/scenario/coordinates.hpp"
#include "hamflow/scenario/rejection.hpp"

namespace hamflow {

/// Return a state as text ("q = [...]\np = [...]\n") and as JSON, {"coordinates", "q", "p"}.
std::string state_text(const CanonicalState& state);
std::string state_json(const std::string& system, const CanonicalState& state);

/// Returns the start of a scenario in the coordinates `to`.   @throws Error if its problem has no such coordinates
CanonicalState converted_start(const Scenario& scenario, const std::string& to);
/// The same as JSON; in arithmetic with more digits than double the numbers are texts with all digits.
std::string converted_start_json(const Scenario& scenario, const std::string& to);
struct ConvertedScenario {
  std::string text;
  std::vector<std::string> notes;  // notes on keys that are not used
};
/// Returns the scenario in the coordinates `to`, without its comments.
/// @param sets PATH=VALUE texts for the converted scenario, for example a method that only the new coordinates allow
/// @throws Error if the problem has no such coordinates or the method cannot be used in them   @throws Rejection
ConvertedScenario converted_scenario(const Scenario& scenario, const std::string& to,
                                     const std::vector<std::string>& sets = {});
/// Returns the keys of the scenario that refer to its old coordinates and are therefore left out of the converted one.
std::string left_out_of_converted(const Scenario& scenario, const std::string& to);

/// Returns whether a path is a folder or an HDF5 file. The name does not matter.
bool is_run(const std::filesystem::path& path);

struct ConvertedSamples {
  Table table;  // q and p; with more digits than double also digits/q, digits/p, digits/energy, digits/t
  StateNames names;
  /// A warning if an angle changes so much between two samples that whole turns may be missing; else empty.
  std::string note;
};
/// Returns the samples of a run in the coordinates `to`.   @throws Error if a state cannot be converted
ConvertedSamples converted_samples(const Scenario& scenario, const Table& samples, const std::string& to);

/// A stored run in the coordinates `to`.
class ConvertedRun {
 public:
  /// @param run folder of the run, or its run.h5   @throws Error if a state cannot be converted   @throws FileError
  ConvertedRun(const std::filesystem::path& run, const std::string& to);
  ~ConvertedRun();
  ConvertedRun(const ConvertedRun&) = delete;
  ConvertedRun& operator=(const ConvertedRun&) = delete;

  std::string csv() const;
  std::string json() const;
  /// Writes a run.h5 with everything of the run except Poincare sections and tables of events.
  /// @return a note for the user; empty: none   @throws FileError
  std::string write_h5(const std::filesystem::path& target) const;
  /// See ConvertedSamples.
  const std::string& note() const;
  /// Returns the keys of the scenario that the converted scenario does not have.
  std::string left_out() const;
  /// Returns the columns of the run that csv() and json() do not have.
  std::vector<std::string> columns_left_out() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hamflow
