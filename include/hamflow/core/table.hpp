// Tables: named columns of values in contiguous memory. Runs, sections, events and sweeps return tables; files, figures
// and other languages view or copy them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hamflow {

enum class ValueType { number, integer, text };

/// The description of a column.
struct ColumnInfo {
  std::string name;  // "q", "invariants/angular_momentum"
  ValueType type = ValueType::number;
  std::size_t width = 1;             // values per row
  bool scalar = true;                // a row is a single value; false for a list, even with one entry
  std::vector<std::string> parts{};  // a name for each value of a row, such as "x", "y"; may be empty
  std::string meaning{};
  std::string unit{};         // empty: the unit of the input
  std::size_t text_size = 0;  // bytes of each text; 0: those of the longest text
};

/// A column of rows, contiguous in memory; a row is one value or a list of `width` values. Moving a column does not
/// move its values.
class Column {
 public:
  explicit Column(ColumnInfo info);
  Column(const Column& other);
  Column& operator=(const Column& other);
  Column(Column&&) noexcept = default;
  Column& operator=(Column&&) noexcept = default;
  ~Column() = default;

  const ColumnInfo& info() const { return info_; }
  const std::string& name() const { return info_.name; }
  std::size_t rows() const { return size_ / (bytes_of_value_ * info_.width); }
  std::size_t bytes_of_row() const { return bytes_of_value_ * info_.width; }

  // Each adds one value to the last row. @throws Error if the column has another type or a text does not fit
  void add(double x);
  void add(std::int64_t x);
  void add(std::string_view text);
  /// Adds rows as they are stored. @param bytes of whole rows
  void add_bytes(std::span<const std::byte> bytes);

  /// rows() times width values, row by row. Valid until a value is added. @throws Error if the column is not of numbers
  std::span<const double> numbers() const;
  std::span<double> numbers();
  /// @throws Error if the column is not of integers
  std::span<const std::int64_t> integers() const;
  /// @throws Error if the column is not of texts
  std::string_view text(std::size_t row, std::size_t part = 0) const;
  std::vector<std::string> texts() const;
  /// The i-th value of each row. @throws Error if the column is not of numbers or has no i-th value
  std::vector<double> part(std::size_t i) const;
  /// All values of a row.
  std::vector<double> row(std::size_t k) const;
  std::vector<std::string> row_of_texts(std::size_t k) const;
  /// The stored values: doubles, 64-bit integers, or texts padded with zero bytes.
  std::span<const std::byte> bytes() const { return {bytes_.get(), size_}; }

  void reserve(std::size_t rows);
  /// Keeps the first `rows` rows and removes the others.
  void cut(std::size_t rows);

 private:
  struct Free {
    void operator()(std::byte* bytes) const { std::free(bytes); }
  };
  void require(ValueType type) const;
  std::byte* grow(std::size_t bytes);
  void widen(std::size_t text_size);

  ColumnInfo info_;
  std::size_t bytes_of_value_;
  // Allocated by realloc, which remaps the pages of large blocks instead of copying them.
  std::unique_ptr<std::byte, Free> bytes_;
  std::size_t size_ = 0;
  std::size_t capacity_ = 0;
};

/// Columns with common rows.
class Table {
 public:
  /// @throws Error if there is already a column of that name
  Column& add(ColumnInfo info);
  Column& add(Column column);

  const std::string& name() const { return name_; }
  void rename(std::string name) { name_ = std::move(name); }
  const std::vector<Column>& columns() const { return columns_; }
  std::vector<Column>& columns() { return columns_; }
  bool empty() const { return columns_.empty(); }
  /// The number of complete rows, that is, of the last column, which is filled last.
  std::size_t rows() const { return columns_.empty() ? 0 : columns_.back().rows(); }
  std::size_t bytes() const;

  /// Null if there is no such column.
  const Column* find(std::string_view name) const;
  /// @throws Error if no column has that name; the message proposes the nearest one
  const Column& operator[](std::string_view name) const;

  void cut(std::size_t rows);

 private:
  std::string name_;
  std::vector<Column> columns_;
};

}  // namespace hamflow
