// Folder of a sweep: the checkpoint members.bin, and the table, which is rewritten while the sweep runs.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/workflow/sweep.hpp"
#include "sweep_journal.hpp"
#include "sweep_table.hpp"

namespace hamflow {

/// Returns the header that identifies a sweep.
SweepIdentity head_of(const Sweep& sweep, const SweepRequest& request);

class SweepFolder {
 public:
  /// Makes the folder; a shard has a folder of its own in it. With Existing::resume it restores the members that are
  /// finished in any journal of the sweep; if wrong() is not empty, the sweep cannot be resumed and no file was
  /// touched.   @throws FileError
  SweepFolder(Sweep& sweep, const SweepRequest& request, std::filesystem::path folder, Existing existing);
  const std::vector<Complaint>& wrong() const { return wrong_; }
  const std::vector<std::string>& notes() const { return notes_; }
  const std::filesystem::path& path() const { return folder_.path(); }

  /// Returns the wall time of all parts of the sweep together.
  double seconds() const;
  /// Starts the clock of this part.
  void begin() { begin_ = last_ = Clock::now(); }
  /// Saves a finished member.   @throws FileError
  void keep(std::size_t member);
  /// Rewrites the table at most four times a second, and so rarely that writing takes at most a twentieth of the time.
  /// Errors are ignored here, because save() tries again.
  void save_if_due();
  /// Writes the final table and the summary.   @throws FileError
  void save(const std::string& summary);

 private:
  using Clock = std::chrono::steady_clock;
  void restore(StoredSweep& past);
  void take_others(const SweepIdentity& head, const std::filesystem::path& whole);
  void note_progress();
  void write_table(const SweepTables& tables) const;

  Sweep& sweep_;
  WorkFolder folder_;
  std::vector<Complaint> wrong_;
  std::vector<std::string> notes_;
  std::optional<SweepJournal> journal_;
  double seconds_before_ = 0;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
  Clock::duration pause_ = std::chrono::milliseconds(250);
  std::atomic<bool> table_is_outdated_{
      true};  // a member has finished since the table was written, or no table exists yet
  bool failed_ = false;
};

}  // namespace hamflow
