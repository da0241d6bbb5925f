// The folder of a sweep: members.bin, from which it goes on, and its table, written while it runs.
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

/// Which sweep it is.
SweepHead head_of(const Sweep& sweep, const SweepRequest& request);

class SweepFolder {
 public:
  /// Makes the folder; with Existing::resume reads what is there and restores the members that are finished, unless
  /// wrong() says why the sweep cannot go on: then nothing was touched.   @throws FileError
  SweepFolder(Sweep& sweep, const SweepRequest& request, std::filesystem::path folder, Existing existing);
  const std::vector<Complaint>& wrong() const { return wrong_; }
  const std::vector<std::string>& notes() const { return notes_; }

  /// Of the sweep, all its parts together.
  double seconds() const;
  /// The clock of this part begins.
  void begin() { begin_ = last_ = Clock::now(); }
  /// A member is finished.   @throws FileError
  void keep(std::size_t member);
  /// Writes the table again, four times a second or, where that takes long, as often as takes a twentieth of the time.
  /// Trouble is left to save(), which tries again.
  void save_if_due();
  /// The table as it is in the end, and the summary.   @throws FileError
  void save(const std::string& summary);

 private:
  using Clock = std::chrono::steady_clock;
  void restore(SweepPast& past);
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
  std::atomic<bool> is_behind_{true};  // a member was finished since the table was written, or there is none yet
  bool failed_ = false;
};

}  // namespace hamflow
