// run.h5: the tables of a run. The file is written in single-writer-multiple-readers mode and flushed several times a
// second. So it can be read while it grows, and after a crash up to the last flush. docs/reference/files.md lists its
// contents. A resumed run copies the remaining rows to a new file that replaces the old one, because only readers can
// open a file that a crash left. Open a file that was not closed with H5F_ACC_RDONLY | H5F_ACC_SWMR_READ.
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

/// Writes the rows of a run. When there are many rows, written ones are removed from memory.
class RunFile {
 public:
  /// @param rows rows of the run; they have to outlive this object. Rows that the run had before they were in memory
  /// are the first ones of the existing file, whatever state it was left in, and are kept.
  /// @throws FileError; an existing file is unchanged in this case
  RunFile(const std::filesystem::path& file, const RunDescription& description, RunRows& rows);
  ~RunFile();
  /// Writes and flushes all waiting rows. @throws FileError, for example if the disk is full
  void flush();
  /// Flushes if enough rows wait that a write call pays.
  void flush_if_many();
  /// Flushes if enough time has passed since the last flush, so that a crash loses little.
  void flush_if_due();

 private:
  struct Impl;
  static std::unique_ptr<Impl> create(const std::filesystem::path& file, const RunDescription& description,
                                      RunRows& rows);
  std::unique_ptr<Impl> impl_;
};

/// The tables of a run.h5. The file may have been cut short by a crash; then the tables end with the last complete row.
struct StoredRun {
  RunDescription description;
  RunTables tables;                   // a reversal has three samples with only q, p and t
  std::vector<std::string> left_out;  // sentences about objects among the samples that are not columns
};

struct StoredRunOptions {
  /// For larger systems q and p of the samples are not read, and only description.dimension tells their number.
  std::size_t most_coordinates = std::numeric_limits<std::size_t>::max();
  bool digits = false;  // also read the columns digits/... of the samples, if the run has them
  bool counts = false;  // also read step and the numbers of evaluations
  bool events = false;  // also read the tables of events, and all columns of the bounces
};

/// @throws FileError that names the file and what is wrong with it
StoredRun read_run_file(const std::filesystem::path& file, const StoredRunOptions& options = {});

/// Reads q at one sample.   @throws FileError
std::vector<double> read_run_positions(const std::filesystem::path& file, std::size_t sample);

}  // namespace hamflow
