// trajectory.csv: the samples as text, 17 digits, a header line, one line a sample.
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

/// What stands in a column: that of a nan has no sign, which nobody has given it.
inline double without_sign_of_nan(double x) { return std::isnan(x) ? std::numeric_limits<double>::quiet_NaN() : x; }

class CsvFile {
 public:
  /// Columns step, t, q1.., p1.., energy, the invariants, each with its number of components, and observables.
  /// @throws FileError
  CsvFile(const std::filesystem::path& file, std::size_t dimension, const std::vector<InvariantColumn>& more);
  /// Goes on after the first `bytes` bytes of a file that is there, whose hash is `hash`. @throws FileError
  CsvFile(const std::filesystem::path& file, std::uint64_t bytes, std::uint64_t hash);
  /// Appended so far, written or not.
  std::uint64_t bytes() const { return bytes_; }
  /// Of these bytes: what somebody else wrote has another one.
  std::uint64_t hash() const { return hash_; }
  void append(const Frame& frame, std::span<const double> observables = {});
  /// @throws FileError when the disk is full
  void flush();

 private:
  void put(std::string_view text);
  [[noreturn]] void fail() const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> out_;
  std::uint64_t bytes_ = 0;
  std::uint64_t hash_ = fnv1a_of_nothing;
};

/// Nothing, if a file begins with `bytes` bytes whose hash is `hash`; else what is wrong with it, a phrase.
std::string refused_csv(const std::filesystem::path& file, std::uint64_t bytes, std::uint64_t hash);

}  // namespace hamflow
