// What a scenario asks to be measured beside the trajectory: Lyapunov exponents, eigenvalues, a Poincare section.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "hamflow/verify/monodromy.hpp"
#include "recorder.hpp"

namespace hamflow {

class Measures {
 public:
  /// @param recorder takes the points of the section; may be null
  Measures(const Scenario& scenario, const Simulation& simulation, Recorder* recorder);
  /// Those asked for, to be woken with the others.
  std::vector<Observer*> observers();
  /// Their entries in the summary.
  nlohmann::ordered_json summary() const;

 private:
  std::optional<LyapunovWatch> lyapunov_;
  std::optional<MonodromyWatch> product_;
  std::optional<SectionFinder> section_;
};

/// Why a scenario cannot go on from a checkpoint: what these measures have seen is not in it. Empty if it can.
std::vector<Complaint> refused_resumption(const Scenario& scenario);
/// The Lyapunov exponents of a scenario without a run of its own, for the members of a sweep; NaN when a step fails.
std::vector<double> exponents_of(const Scenario& scenario);

}  // namespace hamflow
