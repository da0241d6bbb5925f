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

/// What a checkpoint says of a run before its first step: whose folder it is. `Checkpoint::simulation` is empty.
Checkpoint beginning_of(const Scenario& scenario, const std::string& identity);
/// Whether a run was killed before it saved a step: it begins anew, in its own folder.
inline bool has_only_begun(const Checkpoint& checkpoint) { return checkpoint.simulation.empty(); }

/// Compares run.h5 and trajectory.csv with the checkpoint: nothing is mixed with another run's samples, and none are
/// missing. @throws FileError
void check_samples(const Scenario& scenario, const Checkpoint& checkpoint, const std::filesystem::path& folder);

/// summary.json of a folder, and what it says.
struct KeptSummary {
  std::string json;
  Summary summary;
};
/// That of the folder if it is, to the last byte, the one that the run left.
std::optional<KeptSummary> own_summary(const Checkpoint& checkpoint, const std::filesystem::path& folder);

/// Whether the run was carried through to the last step of the scenario, by its own summary.
bool is_complete(const Scenario& scenario, const Checkpoint& checkpoint, const Summary& own);

/// A summary that is another run's is not replaced. One of the same run that was changed, or is older, may be.
/// @param own a summary of this run, as JSON   @throws FileError
void check_summary(const std::string& own, const std::filesystem::path& folder);

/// Writes checkpoints: every so many steps, or every ten seconds of the clock; and when asked to.
class CheckpointWriter final : public Observer {
 public:
  /// @param observers whose archives belong to the checkpoint   @param last where the run begins or goes on
  CheckpointWriter(const Scenario& scenario, const Simulation& simulation, Recorder& recorder,
                   std::vector<NamedObserver> observers, const std::filesystem::path& folder, Checkpoint last);
  std::int64_t next_due(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;
  void write_if_due();
  /// @throws FileError
  void write();
  /// Notes in the last checkpoint which summary is written next. @throws FileError
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
