// A **measured quantity**: what watches a run beside its trajectory, and what the summary and a sweep hold of it. One
// quantity is one file of this folder: measures/lyapunov.cpp defines measure_lyapunov(), and the build finds it. The
// run, its checkpoints, the summary and the sweep walk the list and know none by name.
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
  /// Woken with the other observers; its archive() stands in the checkpoints.
  virtual Observer& observer() = 0;
  /// The same where it follows tangent vectors, which many members carry together.
  virtual TangentWatch* tangents() { return nullptr; }
  /// The same where it needs sums over the steps alone, which lanes keep by themselves.
  virtual SummedSteps* summing() { return nullptr; }
  /// Sets its member of the summary to what was seen so far, and adds the events that it counts.
  virtual void add_to(Summary& summary) const = 0;
  /// What there is to say of those counts.
  virtual std::vector<std::string> event_notes() const { return {}; }
  /// Whether the run ends here by its own will.
  virtual bool stops() const { return false; }
  /// Long steps into which it could not look closely enough.
  virtual std::int64_t unseen_steps() const { return 0; }
  /// How often each event of the scenario was met, and which has ended the run; of events alone.
  virtual std::vector<std::int64_t> event_counts() const { return {}; }
  virtual std::optional<MemberStop> stopped_by() const { return {}; }
  /// Its numbers in a sweep, from what was seen of a member that is done, one for each of the columns.
  virtual std::vector<double> row() const { return {}; }
};

struct MeasureKind {
  std::string key;    // of [run], of the checkpoint
  std::string label;  // of its line in the summary for people
  bool (*requested)(const Scenario&);
  /// Of anything that shows step, time, q and p: a run, a lane. The scenario outlives it.
  std::unique_ptr<Measure> (*make)(const Scenario&) = nullptr;
  /// In its place, of what needs more of a run.   @param recorder takes what is recorded beside the samples; may be
  /// null
  std::unique_ptr<Measure> (*make_of_run)(const Scenario&, const Simulation&, Recorder* recorder) = nullptr;
  /// Its key in the summary, and its line for people. Nothing where the summary does not have it.
  void (*write)(JsonWriter&, Summary&);
  void (*read)(JsonReader&, Summary&);
  std::string (*text)(const Summary&);
  /// The names of the columns that it gives a member of a sweep; null: a sweep records it for each member in a table of
  /// its own.
  std::vector<std::string> (*columns)(const Scenario&) = nullptr;
  /// Whether it gives a sweep the counts of events, made by make_of_run: members then run one by one.
  bool counts_events = false;
};

/// Every kind, in the alphabetical order of its files.
std::span<const MeasureKind> measure_kinds();

/// The map of one step that the scenario's method takes.
StepMapSource step_map_of(const Scenario& scenario);

}  // namespace hamflow
