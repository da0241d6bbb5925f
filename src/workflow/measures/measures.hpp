// The quantities that a scenario requests, during one run.
#pragma once

#include <vector>

#include "measure.hpp"

namespace hamflow {

/// An observer whose archive stands in the checkpoint under its name.
struct NamedObserver {
  std::string name;
  Observer* observer;
};

class Measures {
 public:
  /// @param recorder see MeasureKind
  Measures(const Scenario& scenario, const Simulation& simulation, Recorder* recorder);
  std::vector<NamedObserver> observers() const;
  /// The run has ended, where nobody could know before: what waits for a later step is brought up to this one.
  void reach_the_end(const Frame& end);
  /// Adds what each has found to the summary.
  void add_to(Summary& summary) const;
  /// What is to be said of steps that were too long for them.
  void add_warnings(std::vector<Warning>& warnings) const;
  /// Whether one of them has ended the run.
  bool stopped() const;

 private:
  std::vector<std::pair<const MeasureKind*, std::unique_ptr<Measure>>> requested_;
};

/// The columns that a member of a sweep has, of all quantities that it requests.
MemberObservables sweep_columns(const Scenario& member);

}  // namespace hamflow
