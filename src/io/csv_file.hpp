// trajectory.csv: the samples as text with 17 digits, a header line, then one line for each sample.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hamflow/detail/core/hash.hpp"
#include "hamflow/run/simulation.hpp"
#include "run_header.hpp"

namespace hamflow {

/// Returns x, or NaN without a sign, so that equal columns are equal as text.
inline double without_sign_of_nan(double x) { return std::isnan(x) ? std::numeric_limits<double>::quiet_NaN() : x; }

class CsvFile {
 public:
  /// Writes the header: step, t, q1.., p1.., energy, the invariants with their components, and observables.
  /// @throws FileError
  CsvFile(const std::filesystem::path& file, std::size_t dimension, const std::vector<InvariantColumn>& more);
  /// Continues an existing file after its first `bytes` bytes, whose hash is `hash`. @throws FileError
  CsvFile(const std::filesystem::path& file, std::uint64_t bytes, std::uint64_t hash);
  /// Number of bytes appended so far, whether flushed or not.
  std::uint64_t bytes() const { return bytes_; }
  /// Hash of these bytes. It shows whether another program changed the file.
  std::uint64_t hash() const { return hash_; }
  void append(const Frame& frame, std::span<const double> observables = {});
  /// @throws FileError, for example if the disk is full
  void flush();

 private:
  void put(std::string_view text);
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> out_;
  std::uint64_t bytes_ = 0;
  std::uint64_t hash_ = fnv1a_of_nothing;
};

/// Returns an empty text if the file begins with `bytes` bytes whose hash is `hash`; otherwise a phrase that says what
/// is wrong.
std::string refused_csv(const std::filesystem::path& file, std::uint64_t bytes, std::uint64_t hash);

}  // namespace hamflow
