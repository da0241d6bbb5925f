// Where a run goes on: what of its folder fits the scenario, and how checkpoints are written on the way.
#pragma once

#include <chrono>
#include <optional>

#include "measures/measures.hpp"
#include "recorder.hpp"

namespace hamflow {

/// What differs between the scenario and the run that left the checkpoint. More steps may be asked for, fewer not; the
/// folder, threads, figures and spacing of checkpoints change nothing in the run.
std::vector<Complaint> differences(const Scenario& scenario, const Checkpoint& checkpoint);

/// Puts what the observers had seen back into them, each by its name. The simulation has to be restored before.
/// @throws FileError when the checkpoint is of other observers, or damaged
void restore_observers(const Checkpoint& checkpoint, const std::vector<NamedObserver>& observers);

/// The summary that the run left, if it was carried through to the last step of the scenario.
std::optional<std::string> finished_summary(const Scenario& scenario, const Checkpoint& checkpoint,
                                            const std::filesystem::path& folder);

/// Writes checkpoints: every so many steps, or every ten seconds of the clock; and when asked to.
class CheckpointWriter final : public Observer {
 public:
  /// @param observers whose archives belong to the checkpoint   @param seconds_before of the run's earlier parts
  CheckpointWriter(const Scenario& scenario, const Simulation& simulation, Recorder& recorder,
                   std::vector<NamedObserver> observers, const std::filesystem::path& folder, double seconds_before);
  std::int64_t next_due(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;
  void write_if_due();
  /// @throws FileError
  void write();

 private:
  void archive_observers();

  using Clock = std::chrono::steady_clock;
  const Simulation& simulation_;
  Recorder& recorder_;
  std::vector<NamedObserver> observers_;
  std::filesystem::path file_;
  std::int64_t every_;
  Checkpoint checkpoint_;
  double seconds_before_;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

}  // namespace hamflow
