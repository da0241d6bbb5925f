// Checkpoints of a reversal, reversal.bin. A stopped reversal can be resumed in both of its halves.
#pragma once

#include <chrono>
#include <optional>

#include "checkpoint.hpp"
#include "hamflow/detail/verify/turning_points.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "verify/reversal_progress.hpp"

namespace hamflow {

/// Returns the checkpoint of this scenario's reversal in the folder; nullopt if there is none.
/// @throws Rejection if it belongs to another scenario   @throws FileError
std::optional<Checkpoint> kept_reversal(const Scenario& scenario, const std::filesystem::path& folder);
/// Returns the text of reverse.json if the reversal is complete and the file is byte for byte the one that it wrote.
std::optional<std::string> complete_reversal(const Checkpoint& checkpoint, const std::filesystem::path& folder);

/// Writes checkpoints every given number of steps, or every ten seconds of wall time.
class ReversalCheckpoints final : public Observer {
 public:
  /// @param from checkpoint of a resumed reversal, from which the simulation is restored; null: the reversal starts
  /// @throws FileError
  ReversalCheckpoints(const Scenario& scenario, Simulation& simulation, const std::filesystem::path& folder,
                      const Checkpoint* from);
  ReversalProgress& progress() { return progress_; }
  /// Returns the observer of the coordinates during the first half.
  TurningPointObserver& turns() { return turns_; }

  std::int64_t next_due(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;
  void write_if_due();
  /// @throws FileError
  void write();
  /// Marks the reversal as complete, so that it is not resumed. @throws FileError
  void complete(const std::string& json);

 private:
  using Clock = std::chrono::steady_clock;
  const Simulation& simulation_;
  std::filesystem::path file_;
  std::int64_t every_;
  Checkpoint checkpoint_;
  ReversalProgress progress_;
  TurningPointObserver turns_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace hamflow
