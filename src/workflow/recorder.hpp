// Records a run: samples (the start, every n-th step and the last one, or the states at given times), section points,
// events and bounces. With a folder they are written to its files, without one they stay in memory.
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
  /// @param identity identity of the run   @param from checkpoint of a resumed run; null: the run starts
  /// @param restart_range Simulation::restart_energy_range(); a sample has the range since the previous sample
  /// @throws FileError
  Recorder(const Scenario& scenario, const std::filesystem::path& folder, const std::string& identity,
           const Checkpoint* from, std::function<void()> restart_range);

  std::int64_t next_due(std::int64_t step) const override;
  std::span<const std::string> times(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;
  void append(const SectionPoint& point);
  /// Records a bounce, up to the number that the scenario allows.
  void append(const Bounce& bounce);
  /// Returns whether more bounces shall be recorded.
  bool records_more_bounces() const;
  void append(std::size_t event, std::int64_t step, const SectionPoint& point);

  /// If a run with samples by steps ended early, adds the last state as a sample.
  void finish(const Simulation& simulation);
  void flush();
  void flush_if_due();
  /// Forces the files to the disk and writes their lengths into the checkpoint, without a sample that exists only
  /// because the run ended. The recorder has no archive(), because the lengths are read before the files are opened.
  void mark(Checkpoint& checkpoint);
  /// Returns all records; null if not all of them are in memory.
  const RunTables* tables() const { return rows_ && rows_->complete() ? &rows_->tables() : nullptr; }
  /// Closes the files. The tables in memory are kept.
  void close() {
    h5_.reset();
    csv_.reset();
  }
  RunTables take_tables() { return rows_ ? rows_->take() : RunTables{}; }
  /// Returns the time of the sample whose partial step failed and ended the run; else nullopt.
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
  std::optional<RunRows> rows_;  // nullopt if only trajectory.csv is written
  std::unique_ptr<RunFile> h5_;
  std::unique_ptr<CsvFile> csv_;
  std::int64_t first_ = 0;               // first step whose samples have not been written
  std::int64_t last_ = -1;               // step of the last sample
  std::size_t written_ = 0;              // number of given times that were written
  std::optional<Sizes> before_the_end_;  // sizes without the last sample, if that exists only because the run ended
};

}  // namespace hamflow
