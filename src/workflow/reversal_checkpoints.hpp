// A reversal that was stopped goes on from either half: what its folder keeps on the way, reversal.bin.
#pragma once

#include <chrono>
#include <optional>

#include "checkpoint.hpp"
#include "hamflow/detail/verify/turns.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "verify/reversal_progress.hpp"

namespace hamflow {

/// What the folder keeps of this scenario's reversal; nothing where it keeps none.
/// @throws Rejection when the scenario is another   @throws FileError
std::optional<Checkpoint> kept_reversal(const Scenario& scenario, const std::filesystem::path& folder);
/// reverse.json of a reversal that came to its end, if it is to the last byte the one that it left.
std::optional<std::string> complete_reversal(const Checkpoint& checkpoint, const std::filesystem::path& folder);

/// Writes checkpoints: every so many steps of the scenario, or every ten seconds of the clock.
class ReversalCheckpoints final : public Observer {
 public:
  /// @param from where the reversal goes on, which is put into the simulation; null: at its beginning
  /// @throws FileError
  ReversalCheckpoints(const Scenario& scenario, Simulation& simulation, const std::filesystem::path& folder,
                      const Checkpoint* from);
  ReversalProgress& progress() { return progress_; }
  /// What the coordinates did on the way there.
  TurnWatch& turns() { return turns_; }

  std::int64_t next_due(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;
  void write_if_due();
  /// @throws FileError
  void write();
  /// The reversal is done: nothing is left to go on with. @throws FileError
  void complete(const std::string& json);

 private:
  using Clock = std::chrono::steady_clock;
  const Simulation& simulation_;
  std::filesystem::path file_;
  std::int64_t every_;
  Checkpoint checkpoint_;
  ReversalProgress progress_;
  TurnWatch turns_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace hamflow
