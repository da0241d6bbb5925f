// Checks that the folder of a run fits the scenario that resumes it, and writes checkpoints during the run.
#pragma once

#include <chrono>
#include <optional>

#include "measures/measures.hpp"
#include "recorder.hpp"

namespace hamflow {

/// Returns the differences between the scenario and the run of the checkpoint that forbid resuming. More steps are
/// allowed, fewer are not. Folder, threads, figures and spacing of checkpoints may differ, because they do not change
/// the run.
std::vector<Complaint> differences(const Scenario& scenario, const Checkpoint& checkpoint);

/// Restores the state of the observers, each by its name. The simulation must be restored first.
/// @throws FileError if the checkpoint has other observers or is damaged
void restore_observers(const Checkpoint& checkpoint, const std::vector<NamedObserver>& observers);

/// Returns the checkpoint before the first step, which marks the folder as that of this run. `Checkpoint::simulation`
/// is empty.
Checkpoint first_checkpoint(const Scenario& scenario, const std::string& identity);
/// Returns whether a run was killed before it saved a step. If so, it starts from the beginning in its folder.
inline bool has_no_step(const Checkpoint& checkpoint) { return checkpoint.simulation.empty(); }

/// Compares run.h5 and trajectory.csv with the checkpoint.
/// @throws FileError if samples are missing or belong to another run
void check_samples(const Scenario& scenario, const Checkpoint& checkpoint, const std::filesystem::path& folder);

/// Text of summary.json of a folder, and its contents.
struct KeptSummary {
  std::string json;
  Summary summary;
};
/// Returns the summary in the folder if it is byte for byte the one that the run wrote; else nullopt.
std::optional<KeptSummary> own_summary(const Checkpoint& checkpoint, const std::filesystem::path& folder);

/// Returns whether the run reached the last step of the scenario, according to its own summary.
bool is_complete(const Scenario& scenario, const Checkpoint& checkpoint, const Summary& own);

/// Checks that summary.json in the folder belongs to this run, so that it may be replaced. It may be older or edited.
/// @param own a summary of this run, as JSON   @throws FileError if it belongs to another run
void check_summary(const std::string& own, const std::filesystem::path& folder);

/// Writes checkpoints every given number of steps, or every ten seconds of wall time, and on request.
class CheckpointWriter final : public Observer {
 public:
  /// @param observers observers whose archives are part of the checkpoint   @param last checkpoint from which the run
  /// starts
  CheckpointWriter(const Scenario& scenario, const Simulation& simulation, Recorder& recorder,
                   std::vector<NamedObserver> observers, const std::filesystem::path& folder, Checkpoint last);
  std::int64_t next_due(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;
  void write_if_due();
  /// @throws FileError
  void write();
  /// Stores in the last checkpoint the hash of the summary that is written next. @throws FileError
  void expect_summary(const std::string& text);

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
