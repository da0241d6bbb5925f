// A **measured quantity** observes a run and adds its result to the summary and to a sweep. Each quantity is one file
// of this folder: measures/lyapunov.cpp defines measure_lyapunov(), and the build finds it. The code for runs,
// checkpoints, summaries and sweeps iterates over the list and does not name any quantity.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hamflow/detail/run/step_sums.hpp"
#include "hamflow/detail/verify/lyapunov.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/workflow/summary.hpp"
#include "sweep.hpp"

namespace hamflow {

class JsonReader;
class JsonWriter;
class Recorder;

/// A quantity during one run.
class Measure {
 public:
  virtual ~Measure() = default;
  /// Called with the other observers of the run; its archive() is part of the checkpoints.
  virtual Observer& observer() = 0;
  /// Returns the observer if it carries tangent vectors, which many members of a sweep compute together; otherwise
  /// null.
  virtual TangentObserver* tangents() { return nullptr; }
  /// Returns the observer if it only needs sums over the steps, which SIMD lanes compute themselves; otherwise null.
  virtual SummedSteps* summing() { return nullptr; }
  /// Writes the results so far into its member of the summary, and adds the events that it counts.
  virtual void add_to(Summary& summary) const = 0;
  /// Returns remarks on these counts.
  virtual std::vector<std::string> event_notes() const { return {}; }
  /// Returns whether it ends the run at this step.
  virtual bool stops() const { return false; }
  /// Returns the number of steps that were too long to be searched.
  virtual std::int64_t unseen_steps() const { return 0; }
  /// Return the number of occurrences of each event, and the event that ended the run; only for events.
  virtual std::vector<std::int64_t> event_counts() const { return {}; }
  virtual std::optional<MemberStop> stopped_by() const { return {}; }
  /// Returns the numbers of a finished member of a sweep, one for each column.
  virtual std::vector<double> row() const { return {}; }
};

struct MeasureKind {
  std::string key;    // its key in [run] and in the checkpoint
  std::string label;  // label of its line in the text of the summary
  bool (*requested)(const Scenario&);
  /// Makes a measure that only needs step, time, q and p, for a run or a SIMD lane. The scenario outlives it.
  std::unique_ptr<Measure> (*make)(const Scenario&) = nullptr;
  /// Used in place of `make` if the measure needs the simulation.
  /// @param recorder receives the records other than samples; may be null
  std::unique_ptr<Measure> (*make_of_run)(const Scenario&, const Simulation&, Recorder* recorder) = nullptr;
  /// Write and read its key in the JSON summary, and return its line of text; empty if the summary does not have it.
  void (*write)(JsonWriter&, Summary&);
  void (*read)(JsonReader&, Summary&);
  std::string (*text)(const Summary&);
  /// Returns the names of its columns in a sweep; null: a sweep records it in a separate table for each member.
  std::vector<std::string> (*columns)(const Scenario&) = nullptr;
  /// Whether it counts events in a sweep. If so, make_of_run is used, and members run one by one.
  bool counts_events = false;
};

/// Returns every kind, in the alphabetical order of its files.
std::span<const MeasureKind> measure_kinds();

/// Returns the map of one step of the scenario's method.
StepMapSource step_map_of(const Scenario& scenario);

}  // namespace hamflow
