#include "log_columns.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>

#include "hamflow/core/complaint.hpp"
#include "hamflow/core/text.hpp"
#include "hdf5_read.hpp"

namespace hamflow {

namespace {

constexpr const char* time_key = "--time";
constexpr const char* energy_key = "--energy";

struct LogCell {
  std::string text;
  std::size_t column;  // counted from 1
};
struct LogRow {
  std::vector<LogCell> cells;
  std::size_t line = 0;
};

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

/// @param separator ',' or ';' or ' ' for any blanks
std::vector<LogCell> log_cells(const std::string& line, char separator) {
  std::vector<LogCell> cells;
  if (separator != ' ') {
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t end = std::min(line.find(separator, begin), line.size());
      std::size_t first = begin;
      std::size_t last = end;
      while (first < last && is_blank(line[first])) ++first;
      while (last > first && is_blank(line[last - 1])) --last;
      if (last - first >= 2 && line[first] == '"' && line[last - 1] == '"') {
        ++first;
        --last;
      }
      cells.push_back({line.substr(first, last - first), first + 1});
      begin = end + 1;
    }
    return cells;
  }
  for (std::size_t i = 0; i < line.size();) {
    while (i < line.size() && is_blank(line[i])) ++i;
    const std::size_t begin = i;
    while (i < line.size() && !is_blank(line[i])) ++i;
    if (i > begin) cells.push_back({line.substr(begin, i - begin), begin + 1});
  }
  return cells;
}

/// Also reads an exponent as Fortran writes it: 1.5D-3.
std::optional<double> log_number(const std::string& text) {
  std::string usual = text;
  for (char& c : usual) {
    if (c == 'D' || c == 'd') c = 'e';
  }
  char* end = nullptr;
  const double x = std::strtod(usual.c_str(), &end);
  const bool is_decimal = text.find_first_of("xX") == std::string::npos;
  return !text.empty() && is_decimal && *end == '\0' ? std::optional<double>(x) : std::nullopt;
}

bool is_comment(const LogCell& first) { return std::string_view("#%@!").find(first.text[0]) != std::string::npos; }

char separator_of(const std::string& line) {
  if (line.find(',') != std::string::npos) return ',';
  return line.find(';') != std::string::npos ? ';' : ' ';
}

[[noreturn]] void refuse_cell(const std::filesystem::path& file, std::size_t line, std::size_t column,
                              const std::string& message) {
  throw Rejection({{.file = file.string(),
                    .line = static_cast<int>(line),
                    .column = static_cast<int>(column),
                    .message = message}});
}
[[noreturn]] void refuse_file(const std::filesystem::path& file, const std::string& message) {
  throw Rejection("FILE", file.string() + ": " + message);
}

/// A table that is being read. Only time and energy of each row are kept.
class LogTable {
 public:
  LogTable(const std::filesystem::path& file, const std::string& time, const std::string& energy)
      : file_(file), time_(time), energy_(energy) {}

  /// @param names empty: the columns are only numbered   @param width number of columns
  void begin(const std::vector<LogCell>& names, std::size_t width, std::size_t line) {
    *this = LogTable(file_, time_, energy_);
    for (const LogCell& each : names) names_.push_back(each.text);
    width_ = width;
    head_ = line;
    time_place_ = place_of(time_, time_key);
    energy_place_ = place_of(energy_, energy_key);
  }
  void add(const LogRow& row) {
    if (row.cells.size() != width_) {
      const bool many = row.cells.size() > width_;
      refuse_cell(file_, row.line, many ? row.cells[width_].column : row.cells.back().column,
                  "found " + std::to_string(row.cells.size()) + (row.cells.size() == 1 ? " column" : " columns") +
                      "; allowed " + std::to_string(width_) + ", as in line " + std::to_string(head_));
    }
    columns_.time.push_back(number_in(row, time_place_));
    columns_.energy.push_back(number_in(row, energy_place_));
    columns_.lines.push_back(row.line);
  }
  std::size_t rows() const { return columns_.time.size(); }
  std::size_t width() const { return width_; }
  void leave_out(std::size_t line) { columns_.cut_line = line; }
  LogColumns take() { return std::move(columns_); }

 private:
  double number_in(const LogRow& row, std::size_t place) const {
    const LogCell& cell = row.cells[place];
    const std::optional<double> x = log_number(cell.text);
    if (!x || !std::isfinite(*x)) {
      const std::string name = names_.empty() ? "column " + std::to_string(place + 1) : names_[place];
      refuse_cell(file_, row.line, cell.column, "found '" + cell.text + "' for " + name + "; allowed finite numbers");
    }
    return *x;
  }
  std::size_t place_of(const std::string& wanted, const char* key) const {
    const auto named = std::count(names_.begin(), names_.end(), wanted);
    if (named > 1) {
      throw Rejection(key, "found '" + wanted + "', which is the name of " + std::to_string(named) +
                               " columns; allowed a number of a column, from 1 to " + std::to_string(width_));
    }
    if (named == 1) {
      return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), wanted) - names_.begin());
    }
    const bool is_number =
        !wanted.empty() && wanted.size() < 10 && wanted.find_first_not_of("0123456789") == std::string::npos;
    if (is_number) {
      const std::size_t number = std::stoul(wanted);
      if (number >= 1 && number <= width_) return number - 1;
    }
    const std::string numbers = "numbers from 1 to " + std::to_string(width_);
    if (names_.empty()) {
      throw Rejection(
          key, "found '" + wanted + "'; allowed " + numbers + ", because " + file_.string() + " has no column names");
    }
    throw Rejection(
        key, "found '" + wanted + "'; allowed " + joined(names_) + ", or " + numbers + suggestion(wanted, names_));
  }

  std::filesystem::path file_;
  std::string time_;
  std::string energy_;
  std::vector<std::string> names_;
  std::size_t width_ = 0;
  std::size_t head_ = 0;
  std::size_t time_place_ = 0;
  std::size_t energy_place_ = 0;
  LogColumns columns_;
};

std::ifstream opened(const std::filesystem::path& file) {
  std::error_code none;
  if (std::filesystem::is_directory(file, none)) throw FileError(file.string() + " is a folder; allowed a file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw FileError("cannot read " + file.string() + ": " + std::strerror(errno));
  return in;
}

/// Calls take(line, number, is_whole) for each line, without a UTF-8 byte order mark. is_whole is false for a last line
/// without line end.
template <class Take>
void each_log_line(const std::filesystem::path& file, const Take& take) {
  std::ifstream in = opened(file);
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (constexpr std::string_view mark = "\xef\xbb\xbf"; number == 1 && line.starts_with(mark)) {
      line.erase(0, mark.size());
    }
    take(line, number, !in.eof());
  }
  if (in.bad()) throw FileError("cannot read " + file.string() + " to its end");
}

bool begins_with(const std::vector<LogCell>& cells, const std::string& first, const std::string& second = {}) {
  return !cells.empty() && cells[0].text == first && (second.empty() || (cells.size() > 1 && cells[1].text == second));
}

bool is_log_of_lammps(const std::filesystem::path& file) {
  std::ifstream in = opened(file);
  std::string line;
  bool has_table = false;
  while (std::getline(in, line)) {
    if (line.starts_with("LAMMPS (")) return true;
    const std::vector<LogCell> cells = log_cells(line, ' ');
    has_table = has_table || begins_with(cells, "Step");
    if (has_table && begins_with(cells, "Loop", "time")) return true;
  }
  return false;
}

LogColumns read_log_of_lammps(const std::filesystem::path& file, const std::string& time, const std::string& energy) {
  LogTable table(file, time, energy);
  std::optional<LogTable> last;
  std::size_t tables = 0;
  bool in_table = false;
  const auto end = [&] {
    in_table = false;
    if (!last || table.rows() >= 2) last = table;
  };
  each_log_line(file, [&](const std::string& line, std::size_t number, bool is_whole) {
    const std::vector<LogCell> cells = log_cells(line, ' ');
    if (begins_with(cells, "Step")) {
      if (in_table) end();
      table.begin(cells, cells.size(), number);
      in_table = true;
      ++tables;
    } else if (in_table && (begins_with(cells, "Loop", "time") || begins_with(cells, "ERROR:"))) {
      end();
    } else if (in_table && !cells.empty() && !begins_with(cells, "WARNING:")) {
      if (!is_whole) return table.leave_out(number);
      table.add({cells, number});
    }
  });
  if (in_table) end();  // the run is still running, or was killed
  if (!last) refuse_file(file, "no thermo output; allowed a table below a line that starts with Step");
  LogColumns columns = last->take();
  columns.tables = tables;
  return columns;
}

LogColumns read_text_columns(const std::filesystem::path& file, const std::string& time, const std::string& energy) {
  LogTable table(file, time, energy);
  LogRow comment;
  std::string comment_line;
  bool begun = false;
  char separator = ' ';
  each_log_line(file, [&](const std::string& line, std::size_t number, bool is_whole) {
    const std::vector<LogCell> words = log_cells(line, ' ');
    if (words.empty()) return;
    if (is_comment(words[0])) {
      if (!begun) {
        comment = {{}, number};
        comment_line = line;
      }
      return;
    }
    if (begun) {
      LogRow row{log_cells(line, separator), number};
      if (!is_whole && row.cells.size() < table.width()) return table.leave_out(number);
      return table.add(row);
    }
    begun = true;
    separator = separator_of(line);
    const std::vector<LogCell> cells = log_cells(line, separator);
    const bool is_head =
        std::none_of(cells.begin(), cells.end(), [](const LogCell& cell) { return log_number(cell.text).has_value(); });
    if (is_head) return table.begin(cells, cells.size(), number);
    if (!comment_line.empty()) {
      comment_line.erase(0, comment_line.find_first_of("#%@!") + 1);
      comment.cells = log_cells(comment_line, separator);
      if (comment.cells.size() != cells.size()) comment.cells = log_cells(comment_line, ' ');
    }
    const bool has_names = comment.cells.size() == cells.size();
    table.begin(has_names ? comment.cells : std::vector<LogCell>{}, cells.size(), number);
    table.add({cells, number});
  });
  if (!begun) refuse_file(file, "the file is empty; allowed columns of numbers");
  if (table.rows() == 0) refuse_file(file, "found column names but no numbers; allowed a row for each sample");
  return table.take();
}

bool is_hdf5(const std::filesystem::path& file) {
  std::ifstream in = opened(file);
  std::array<char, 8> begin{};
  in.read(begin.data(), begin.size());
  return in.gcount() == 8 && std::string_view(begin.data(), 8) == "\x89HDF\r\n\x1a\n";
}

/// Lists the paths of all datasets in a group and its subgroups, without links to other files.
void list_datasets(hid_t group, const std::string& path, std::vector<std::string>& all) {
  constexpr std::size_t most_listed = 100;
  constexpr std::ptrdiff_t deepest = 8;  // a group may contain itself
  if (std::count(path.begin(), path.end(), '/') > deepest) return;
  for (const std::string& name : names_in(group)) {
    if (all.size() == most_listed) return;
    H5L_info_t link;
    const bool is_own = H5Lget_info(group, name.c_str(), &link, H5P_DEFAULT) >= 0 && link.type == H5L_TYPE_HARD;
    if (!is_own || !has_object(group, name)) continue;
    const Hdf5Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose, "open " + path + name);
    if (H5Iget_type(object) == H5I_DATASET) all.push_back(path + name);
    if (H5Iget_type(object) == H5I_GROUP) list_datasets(object, path + name + "/", all);
  }
}

std::vector<double> stored_log_column(hid_t file, const std::string& wanted, const char* key) {
  std::string path = wanted;
  path.erase(0, std::min(path.find_first_not_of('/'), path.size()));
  std::optional<std::size_t> column;
  if (const std::size_t colon = path.rfind(':');
      colon != std::string::npos && (path.empty() || !has_object(file, path))) {
    const std::string number = path.substr(colon + 1);
    if (!number.empty() && number.size() < 10 && number.find_first_not_of("0123456789") == std::string::npos) {
      column = std::stoul(number);
      path.erase(colon);
    }
  }
  std::vector<std::string> datasets;
  const auto refuse_path = [&](const std::string& what) {
    list_datasets(file, "", datasets);
    throw Rejection(key, "found '" + wanted + "'" + what + "; allowed " +
                             (datasets.empty() ? "a dataset, but the file has none" : joined(datasets)) +
                             suggestion(path, datasets));
  };
  if (path.empty() || !has_object(file, path)) refuse_path("");
  {
    const Hdf5Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, "open " + path);
    if (H5Iget_type(object) != H5I_DATASET) refuse_path(", a group");
  }
  const StoredData data = StoredData::dataset(file, path);
  if (data.kind() != StoredData::Kind::numbers)
    throw Rejection(key, "found '" + wanted + "', which does not contain numbers; allowed a dataset of numbers");
  const std::size_t width = data.width();
  if (width == 0) throw Rejection(key, "found '" + wanted + "', which has no columns; allowed a dataset of numbers");
  if (!column && width != 1) {
    throw Rejection(key, "found '" + wanted + "', which has " + std::to_string(width) + " columns; allowed " + path +
                             ":1 to " + path + ":" + std::to_string(width));
  }
  if (column && (*column < 1 || *column > width)) {
    throw Rejection(key, "found '" + wanted + "'; allowed columns from 1 to " + std::to_string(width));
  }
  const std::vector<double> all = data.numbers();
  std::vector<double> numbers;
  for (std::size_t i = column.value_or(1) - 1; i < all.size(); i += width) numbers.push_back(all[i]);
  return numbers;
}

LogColumns read_hdf5_columns(const std::filesystem::path& file, const std::string& time, const std::string& energy) {
  silence_hdf5();
  const Hdf5Handle id = open_foreign_to_read(file);
  LogColumns columns{stored_log_column(id, time, time_key), stored_log_column(id, energy, energy_key)};
  if (columns.time.size() != columns.energy.size()) {
    throw Rejection(energy_key, "found " + std::to_string(columns.energy.size()) +
                                    (columns.energy.size() == 1 ? " energy" : " energies") + "; allowed " +
                                    std::to_string(columns.time.size()) + ", the number of times");
  }
  return columns;
}

}  // namespace

LogColumns read_log_columns(const std::filesystem::path& file, const std::string& time, const std::string& energy) {
  if (is_hdf5(file)) return read_hdf5_columns(file, time, energy);
  return is_log_of_lammps(file) ? read_log_of_lammps(file, time, energy) : read_text_columns(file, time, energy);
}

}  // namespace hamflow
