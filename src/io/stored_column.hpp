// Stores a column of a table as a dataset that grows by rows.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "hamflow/core/table.hpp"
#include "hdf5_handle.hpp"

namespace hamflow {

class StoredColumn {
 public:
  /// @param path path of the dataset; its attributes describe the column
  /// @param rows expected number, so that a short run has a small file
  /// @param of_each numbers of one particle; the dataset has rank 3 and width/of_each particles in a row; 0: rank 1 or
  /// 2
  StoredColumn(hid_t file, std::string path, const ColumnInfo& info, std::size_t rows, std::size_t of_each = 0);

  std::size_t bytes_of_row() const { return bytes_of_row_; }
  /// Copies the first `rows` rows from the dataset of the same name in another file. @throws FileError
  void copy_from(hid_t other, std::uint64_t rows, std::size_t at_once);
  /// Writes rows in the representation of a Column, and flushes them. @throws FileError
  void write(const void* bytes, std::size_t rows);
  /// Writes all rows of a column.
  void write(const Column& column) { write(column.bytes().data(), column.rows()); }

 private:
  using Shape = std::array<hsize_t, 3>;
  Shape shape(hsize_t rows) const { return {rows, width_ / of_each_, of_each_}; }

  std::string path_;
  int rank_;
  hsize_t width_;
  hsize_t of_each_;
  Hdf5Handle type_;  // type in the file and in memory
  std::size_t bytes_of_row_;
  Hdf5Handle dataset_;
  hsize_t written_ = 0;
};

/// The type of decimal texts with `length` characters; zero bytes may fill the end.
Hdf5Handle digits_type(std::size_t length);

}  // namespace hamflow
