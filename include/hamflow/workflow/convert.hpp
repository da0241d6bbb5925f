// States, scenarios and runs in the other coordinates of their problem.
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

/// A state for people ("q = [...]\np = [...]\n") and as JSON, {"coordinates", "q", "p"}.
std::string state_text(const CanonicalState& state);
std::string state_json(const std::string& system, const CanonicalState& state);

/// The start of a scenario in the coordinates `to`.   @throws Error when its problem has no such coordinates
CanonicalState converted_start(const Scenario& scenario, const std::string& to);
/// The same as JSON, in arithmetic beyond double as texts with all digits.
std::string converted_start_json(const Scenario& scenario, const std::string& to);
struct ConvertedScenario {
  std::string text;
  std::vector<std::string> notes;  // what of it is not used
};
/// The scenario in the coordinates `to`; comments are lost.
/// @param sets PATH=VALUE texts for the converted one: its method, say, which may not be allowed in both coordinates
/// @throws Error when its problem or its method cannot be used in them   @throws Rejection
ConvertedScenario converted_scenario(const Scenario& scenario, const std::string& to,
                                     const std::vector<std::string>& sets = {});
/// The keys of the scenario that are said in its old coordinates, and are not in the converted one.
std::string left_out_of_converted(const Scenario& scenario, const std::string& to);

/// Whether a path names the folder of a run or an HDF5 file, whatever it is called.
bool is_run(const std::filesystem::path& path);

struct ConvertedSamples {
  Table table;  // q, p; of a run beyond double also digits/q, digits/p, digits/energy, digits/t
  StateNames names;
  /// Says where an angle, whose whole turns the samples do not show, changes so much from one sample to the next that
  /// turns may be missing; else empty.
  std::string note;
};
/// The samples of a run in the coordinates `to`.   @throws Error when a state cannot be converted
ConvertedSamples converted_samples(const Scenario& scenario, const Table& samples, const std::string& to);

/// Every sample of a run in the coordinates `to`.
class ConvertedRun {
 public:
  /// @param run its folder or run.h5   @throws Error when a state cannot be converted   @throws FileError
  ConvertedRun(const std::filesystem::path& run, const std::string& to);
  ~ConvertedRun();
  ConvertedRun(const ConvertedRun&) = delete;
  ConvertedRun& operator=(const ConvertedRun&) = delete;

  std::string csv() const;
  std::string json() const;
  /// Writes a run.h5 that has all of the run but its sections and tables of events.   @return what is worth a note, or
  /// nothing
  /// @throws FileError
  std::string write_h5(const std::filesystem::path& target) const;
  /// See ConvertedSamples.
  const std::string& note() const;
  /// Keys of its scenario that the converted one has not.
  std::string left_out() const;
  /// Columns of the run that csv() and json() have not.
  std::vector<std::string> columns_left_out() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hamflow
