// The quantities that a scenario requests, for one run.
#pragma once

#include <vector>

#include "measure.hpp"

namespace hamflow {

/// An observer, with the name of its archive in the checkpoint.
struct NamedObserver {
  std::string name;
  Observer* observer;
};

class Measures {
 public:
  /// @param recorder see MeasureKind
  Measures(const Scenario& scenario, const Simulation& simulation, Recorder* recorder);
  std::vector<NamedObserver> observers() const;
  /// Call this after an early stop: observers that wait for a later step process the steps up to this one.
  void observe_end(const Frame& end);
  /// Adds the results of all measures to the summary.
  void add_to(Summary& summary) const;
  /// Adds a warning if steps were too long to be searched.
  void add_warnings(std::vector<Warning>& warnings) const;
  /// Returns whether one of them has ended the run.
  bool stopped() const;

 private:
  std::vector<std::pair<const MeasureKind*, std::unique_ptr<Measure>>> requested_;
};

/// Returns the columns in a sweep for all quantities that the scenario requests.
MemberObservables sweep_columns(const Scenario& member);

}  // namespace hamflow
