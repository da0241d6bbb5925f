// One dataset of a run that grows by a row a sample, with the rows that wait to be written.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hdf5_handle.hpp"

namespace hamflow {

/// What a dataset says of itself, in attributes; empty ones are left out.
struct ColumnText {
  std::vector<std::string> columns{};  // a name for each number of a row
  std::string meaning{};
  std::string unit{};
};

/// A dataset of numbers, and what it means.
struct NamedColumn {
  const char* name;
  const char* meaning;
};

/// Those of /solver that `method.diagnostics` adds.
inline constexpr NamedColumn diagnostic_columns[] = {
    {"solver/iterations", "of the last step; NaN at the start"},
    {"solver/residual", "of the last step"},
    {"solver/condition_tangent", "of the tangent matrix of the last step"},
    {"solver/determinant_tangent", "of the tangent matrix of the last step"},
    {"solver/condition_inverse_mass", "of the inverse mass matrix at the last step"}};

/// H - H0 over the steps from one sample to the next, both included.
inline constexpr NamedColumn energy_range_columns[] = {
    {"energy_error_min", "least H - H0 at the end of a step since the sample before, both samples included"},
    {"energy_error_max", "largest H - H0 at the end of a step since the sample before, both samples included"}};

class Column {
 public:
  /// @param type of a number: H5T_IEEE_F64LE, H5T_STD_I64LE or digits_type()
  /// @param width of a row; 0: a row is one number, and the dataset has rank 1
  /// @param rows expected, so that a short run leaves a small file
  /// @param of_each numbers of a particle, of which a row has width/of_each: the dataset has rank 3; 0: of rank 2
  Column(hid_t file, std::string name, hid_t type, std::size_t width, std::size_t rows, const ColumnText& text,
         std::size_t of_each = 0);

  // The next number of a row, of the column's own type. A text is filled up with zero bytes.
  void add(double x) { put(&x, sizeof x); }
  void add(std::int64_t x) { put(&x, sizeof x); }
  /// @throws FileError when it is longer than the column is wide
  void add(const std::string& digits);

  std::size_t bytes_a_row() const { return bytes_a_row_; }
  /// Writes the first `rows` rows of the dataset of the same name in another file. @throws FileError
  void copy_from(hid_t other, std::uint64_t rows, std::size_t at_once);
  /// Writes what waits, `rows` rows, and flushes it. @throws FileError
  void write(std::size_t rows);

 private:
  using Shape = std::array<hsize_t, 3>;
  /// Of so many rows.
  Shape shape(hsize_t rows) const { return {rows, width_ / of_each_, of_each_}; }

  void put(const void* bytes, std::size_t count) {
    const auto* const begin = static_cast<const char*>(bytes);
    waiting_.insert(waiting_.end(), begin, begin + count);
  }

  std::string name_;
  int rank_;
  hsize_t width_;
  hsize_t of_each_;
  Hdf5Handle type_;  // in the file and in memory
  std::size_t bytes_a_row_;
  Hdf5Handle dataset_;
  std::vector<char> waiting_;
  hsize_t written_ = 0;
};

/// Decimal texts of `length` characters, of which the last ones may be zero bytes.
Hdf5Handle digits_type(std::size_t length);

}  // namespace hamflow
