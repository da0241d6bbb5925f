// Records a run: its samples, which are the start, every n-th step and the last one, or the states at given times; and
// points of sections, events and bounces. With a folder they go to its files, without one they stay in memory.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "checkpoint.hpp"
#include "csv_file.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "run_file.hpp"

namespace hamflow {

class Recorder final : public Observer {
 public:
  /// @param folder empty: nothing is written
  /// @param identity of the run   @param from where the run goes on; null: at its start
  /// @param restart_range Simulation::restart_energy_range(): a sample has the range since the one before
  /// @throws FileError
  Recorder(const Scenario& scenario, const std::filesystem::path& folder, const std::string& identity,
           const Checkpoint* from, std::function<void()> restart_range);

  std::int64_t next_due(std::int64_t step) const override;
  std::span<const std::string> times(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;
  void append(const SectionPoint& point);
  /// As long as the scenario wants more rows.
  void append(const Bounce& bounce);
  /// Whether there is room for more of them.
  bool wants_bounces() const;
  void append(std::size_t event, std::int64_t step, const SectionPoint& point);

  /// The state in which a run by steps ended early is a sample too.
  void finish(const Simulation& simulation);
  void flush();
  void flush_if_due();
  /// The lengths that the files would have if the run had no end yet go into the checkpoint; the files are written and
  /// forced to the disk. This is the recorder's archive(): it is read before the files are opened.
  void mark(Checkpoint& checkpoint);
  /// All that was recorded; null where it is not all in memory.
  const RunTables* tables() const { return rows_ && rows_->complete() ? &rows_->tables() : nullptr; }
  /// Ends the files. What is in memory stays.
  void close() {
    h5_.reset();
    csv_.reset();
  }
  RunTables take_tables() { return rows_ ? rows_->take() : RunTables{}; }
  /// The time of the sample at which a run stopped for want of a partial step; else nothing.
  std::optional<std::string> failed_at(std::int64_t step) const;

 private:
  struct Sizes {
    std::uint64_t rows = 0;
    std::uint64_t csv_bytes = 0;
    std::uint64_t csv_hash = 0;
  };
  bool by_times() const { return !scenario_.record.empty(); }
  Sizes sizes() const;

  const Scenario& scenario_;
  std::filesystem::path folder_;
  std::function<void()> restart_range_;
  std::optional<RunRows> rows_;  // none where only trajectory.csv is written
  std::unique_ptr<RunFile> h5_;
  std::unique_ptr<CsvFile> csv_;
  std::int64_t first_ = 0;               // step from which samples are still to be written
  std::int64_t last_ = -1;               // step of the last sample
  std::size_t written_ = 0;              // of the given times
  std::optional<Sizes> before_the_end_;  // where the last sample is there only because the run ended
};

}  // namespace hamflow
