// A column of a table as a dataset that grows by rows.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "hamflow/core/table.hpp"
#include "hdf5_handle.hpp"

namespace hamflow {

class StoredColumn {
 public:
  /// @param path of the dataset; its attributes say what the column says of itself
  /// @param rows expected, so that a short run leaves a small file
  /// @param of_each numbers of a particle, of which a row has width/of_each: the dataset has rank 3; 0: of rank 1 or 2
  StoredColumn(hid_t file, std::string path, const ColumnInfo& info, std::size_t rows, std::size_t of_each = 0);

  std::size_t bytes_of_row() const { return bytes_of_row_; }
  /// Writes the first `rows` rows of the dataset of the same name in another file. @throws FileError
  void copy_from(hid_t other, std::uint64_t rows, std::size_t at_once);
  /// Writes rows as they are stored in a Column, and flushes them. @throws FileError
  void write(const void* bytes, std::size_t rows);
  /// All rows of a column.
  void write(const Column& column) { write(column.bytes().data(), column.rows()); }

 private:
  using Shape = std::array<hsize_t, 3>;
  /// Of so many rows.
  Shape shape(hsize_t rows) const { return {rows, width_ / of_each_, of_each_}; }

  std::string path_;
  int rank_;
  hsize_t width_;
  hsize_t of_each_;
  Hdf5Handle type_;  // in the file and in memory
  std::size_t bytes_of_row_;
  Hdf5Handle dataset_;
  hsize_t written_ = 0;
};

/// Decimal texts of `length` characters, of which the last ones may be zero bytes.
Hdf5Handle digits_type(std::size_t length);

}  // namespace hamflow
