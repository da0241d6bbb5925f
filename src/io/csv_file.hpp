// trajectory.csv: the samples as text, 17 digits, a header line, one line a sample.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/run/simulation.hpp"
#include "run_file.hpp"

namespace hamflow {

class CsvFile {
 public:
  /// Columns step, t, q1.., p1.., energy and the invariants, each with its number of components. @throws FileError
  CsvFile(const std::filesystem::path& file, std::size_t dimension, const std::vector<InvariantColumn>& invariants);
  /// Goes on after the first `bytes` bytes of a file that is there. @throws FileError
  CsvFile(const std::filesystem::path& file, std::uint64_t bytes);
  /// Appended so far, written or not.
  std::uint64_t bytes();
  void append(const Frame& frame);
  /// @throws FileError when the disk is full
  void flush();

 private:
  std::filesystem::path path_;
  std::ofstream out_;
};

}  // namespace hamflow
