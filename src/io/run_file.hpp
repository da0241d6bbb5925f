// run.h5: the tables of a run. Written in single-writer-multiple-readers mode and flushed several times a second, so
// that it can be read while it grows, and after a crash at any moment, up to the last flush. docs/reference/files.md
// lists what is in it. A run that goes on copies the rows that stay into a fresh file, which then takes the place of
// the old one: only a reader can open what a crash leaves. Open a file that was not closed with H5F_ACC_RDONLY |
// H5F_ACC_SWMR_READ.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "hamflow/detail/run/run_tables.hpp"
#include "run_header.hpp"
#include "run_rows.hpp"

namespace hamflow {

/// Writes the rows of a run, which leave the memory once they are written and many.
class RunFile {
 public:
  /// @param rows of the run, as long as the file is written. Those that it had before it was in memory are the first
  /// ones of the file that is there, however it was left, and stay.
  /// @throws FileError; a file that was there is then as it was
  RunFile(const std::filesystem::path& file, const RunDescription& description, RunRows& rows);
  ~RunFile();
  /// Writes and flushes what has gathered. @throws FileError, e.g. when the disk is full
  void flush();
  /// Flushes where so much has gathered that one write is worth it.
  void flush_if_many();
  /// Flushes if some time has passed since the last flush: bounds what a crash can lose.
  void flush_if_due();

 private:
  struct Impl;
  static std::unique_ptr<Impl> create(const std::filesystem::path& file, const RunDescription& description,
                                      RunRows& rows);
  std::unique_ptr<Impl> impl_;
};

/// A run.h5, whole or cut short by a crash (then up to the last complete row), as tables.
struct StoredRun {
  RunDescription description;
  RunTables tables;                   // of a reversal: three samples with q, p and t alone
  std::vector<std::string> left_out;  // sentences: what stands among the samples and is no column of them
};

struct StoredRunOptions {
  /// Above it q and p are left out of samples, and description.dimension says how many there are.
  std::size_t most_coordinates = std::numeric_limits<std::size_t>::max();
  bool digits = false;  // also the columns digits/... of samples, where the run has them
  bool counts = false;  // also step and the numbers of evaluations
  bool events = false;  // also the tables of events, and of bounces more than q and t
};

/// @throws FileError naming the file and what is wrong with it
StoredRun read_run_file(const std::filesystem::path& file, const StoredRunOptions& options = {});

/// q at one sample.   @throws FileError
std::vector<double> read_run_positions(const std::filesystem::path& file, std::size_t sample);

}  // namespace hamflow
