#include "hamflow/core/table.hpp"

#include <algorithm>
#include <cstring>
#include <new>

#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"

namespace hamflow {

namespace {

constexpr const char* type_name(ValueType type) {
  return type == ValueType::number ? "numbers" : type == ValueType::integer ? "integers" : "texts";
}
std::size_t bytes_of(const ColumnInfo& info) {
  return info.type == ValueType::text ? std::max<std::size_t>(info.text_size, 1) : sizeof(double);
}

}  // namespace

Column::Column(ColumnInfo info) : info_(std::move(info)), bytes_of_value_(bytes_of(info_)) {
  info_.width = std::max<std::size_t>(info_.width, 1);
}
Column::Column(const Column& other) : info_(other.info_), bytes_of_value_(other.bytes_of_value_) {
  if (other.size_ > 0) std::memcpy(grow(other.size_), other.bytes_.get(), other.size_);
}
Column& Column::operator=(const Column& other) {
  if (this != &other) *this = Column(other);
  return *this;
}

void Column::require(ValueType type) const {
  if (info_.type == type) return;
  throw Error("column " + info_.name + " has " + type_name(info_.type) + ", not " + type_name(type));
}

std::byte* Column::grow(std::size_t bytes) {
  if (size_ + bytes > capacity_) {
    const std::size_t capacity = std::max({size_ + bytes, capacity_ + capacity_ / 2, std::size_t{64}});
    auto* const larger = static_cast<std::byte*>(std::realloc(bytes_.get(), capacity));
    if (larger == nullptr) throw std::bad_alloc();
    (void)bytes_.release();  // realloc has freed it
    bytes_.reset(larger);
    capacity_ = capacity;
  }
  size_ += bytes;
  return bytes_.get() + (size_ - bytes);
}

void Column::reserve(std::size_t rows) {
  const std::size_t size = size_;
  if (rows > this->rows()) (void)grow((rows - this->rows()) * bytes_of_row());
  size_ = size;
}

void Column::cut(std::size_t rows) { size_ = std::min(size_, rows * bytes_of_row()); }

void Column::add(double x) {
  require(ValueType::number);
  std::memcpy(grow(sizeof x), &x, sizeof x);
}
void Column::add(std::int64_t x) {
  require(ValueType::integer);
  std::memcpy(grow(sizeof x), &x, sizeof x);
}
void Column::add(std::string_view text) {
  require(ValueType::text);
  if (text.size() > bytes_of_value_) {
    if (info_.text_size > 0) {
      throw Error("a text of column " + info_.name + " has " + std::to_string(text.size()) +
                  " characters; allowed at most " + std::to_string(info_.text_size));
    }
    widen(std::max(text.size(), bytes_of_value_ + bytes_of_value_ / 2));
  }
  std::byte* const to = grow(bytes_of_value_);
  std::memset(to, 0, bytes_of_value_);
  std::memcpy(to, text.data(), text.size());
}
void Column::add_bytes(std::span<const std::byte> bytes) {
  if (!bytes.empty()) std::memcpy(grow(bytes.size()), bytes.data(), bytes.size());
}

void Column::widen(std::size_t text_size) {
  Column wider(info_);
  wider.bytes_of_value_ = text_size;
  const std::size_t values = size_ / bytes_of_value_;
  for (std::size_t k = 0; k < values; ++k) {
    std::byte* const to = wider.grow(text_size);
    std::memset(to, 0, text_size);
    std::memcpy(to, bytes_.get() + k * bytes_of_value_, bytes_of_value_);
  }
  *this = std::move(wider);
}

std::span<const double> Column::numbers() const {
  require(ValueType::number);
  return {reinterpret_cast<const double*>(bytes_.get()), size_ / sizeof(double)};
}
std::span<double> Column::numbers() {
  require(ValueType::number);
  return {reinterpret_cast<double*>(bytes_.get()), size_ / sizeof(double)};
}
std::span<const std::int64_t> Column::integers() const {
  require(ValueType::integer);
  return {reinterpret_cast<const std::int64_t*>(bytes_.get()), size_ / sizeof(std::int64_t)};
}
std::string_view Column::text(std::size_t row, std::size_t part) const {
  require(ValueType::text);
  const char* const begin = reinterpret_cast<const char*>(bytes_.get()) + row * bytes_of_row() + part * bytes_of_value_;
  return {begin, strnlen(begin, bytes_of_value_)};
}
std::vector<std::string> Column::texts() const {
  std::vector<std::string> all;
  all.reserve(rows() * info_.width);
  for (std::size_t k = 0; k < rows(); ++k) {
    for (std::size_t i = 0; i < info_.width; ++i) all.emplace_back(text(k, i));
  }
  return all;
}
std::vector<double> Column::part(std::size_t i) const {
  const std::span<const double> all = numbers();
  if (i >= info_.width) {
    throw Error("column " + info_.name + " has " + std::to_string(info_.width) + " values in a row; found index " +
                std::to_string(i));
  }
  std::vector<double> values(rows());
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = all[k * info_.width + i];
  return values;
}
std::vector<double> Column::row(std::size_t k) const {
  const std::span<const double> all = numbers().subspan(k * info_.width, info_.width);
  return {all.begin(), all.end()};
}
std::vector<std::string> Column::row_of_texts(std::size_t k) const {
  std::vector<std::string> all;
  for (std::size_t i = 0; i < info_.width; ++i) all.emplace_back(text(k, i));
  return all;
}

Column& Table::add(ColumnInfo info) { return add(Column(std::move(info))); }
Column& Table::add(Column column) {
  if (find(column.name()) != nullptr) throw Error("the table already has a column " + column.name());
  return columns_.emplace_back(std::move(column));
}

std::size_t Table::bytes() const {
  std::size_t all = 0;
  for (const Column& column : columns_) all += column.bytes().size();
  return all;
}

const Column* Table::find(std::string_view name) const {
  const auto found =
      std::find_if(columns_.begin(), columns_.end(), [&](const Column& column) { return column.name() == name; });
  return found == columns_.end() ? nullptr : &*found;
}
const Column& Table::operator[](std::string_view name) const {
  if (const Column* const found = find(name)) return *found;
  std::vector<std::string> names;
  for (const Column& column : columns_) names.push_back(column.name());
  throw Error("no column " + std::string(name) + suggestion(std::string(name), names));
}

void Table::cut(std::size_t rows) {
  for (Column& column : columns_) column.cut(rows);
}

}  // namespace hamflow
