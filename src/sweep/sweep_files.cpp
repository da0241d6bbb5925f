#include <fmt/format.h>

#include <algorithm>

#include "csv_file.hpp"
#include "hamflow/core/text.hpp"
#include "hdf5_lock.hpp"
#include "hdf5_text.hpp"
#include "sweep_table.hpp"
#include "whole_file.hpp"

namespace hamflow {

namespace {

/// Makes datasets with a checksum for each chunk. A chunk has at most 64 kilobytes, or one row.
Hdf5Handle protected_chunks(int rank, const hsize_t* size, std::size_t bytes) {
  constexpr hsize_t most_bytes = 1 << 16;
  const hsize_t width = rank > 1 ? size[1] : 1;
  const hsize_t chunk[2] = {std::clamp<hsize_t>(most_bytes / (bytes * width), 1, std::max<hsize_t>(size[0], 1)), width};
  Hdf5Handle plist(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make a property list");
  check_hdf5(H5Pset_chunk(plist, rank, chunk), "choose the chunks");
  check_hdf5(H5Pset_fletcher32(plist), "choose a checksum");
  check_hdf5(H5Pset_obj_track_times(plist, false), "leave out times");  // so that equal sweeps write equal files
  return plist;
}

void write_dataset(hid_t file, const std::string& name, hid_t stored, hid_t memory, int rank, const hsize_t* size,
                   const void* values) {
  const Hdf5Handle space(H5Screate_simple(rank, size, nullptr), H5Sclose, "make a data space");
  const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "make a property list");
  check_hdf5(H5Pset_create_intermediate_group(links, 1), "request intermediate groups");
  const Hdf5Handle plist = protected_chunks(rank, size, H5Tget_size(stored));
  const Hdf5Handle dataset(H5Dcreate2(file, name.c_str(), stored, space, links, plist, H5P_DEFAULT), H5Dclose,
                           "create dataset " + name);
  check_hdf5(H5Dwrite(dataset, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "write " + name);
}

void write_column(hid_t file, const Column& column) {
  const ColumnInfo& info = column.info();
  const hsize_t size[2] = {column.rows(), info.width};
  const int rank = info.scalar ? 1 : 2;
  if (info.type == ValueType::text) {
    const std::vector<std::string> texts = column.texts();
    std::size_t longest = 1;
    for (const std::string& text : texts) longest = std::max(longest, text.size());
    std::string all;
    for (const std::string& text : texts) all += text + std::string(longest - text.size(), '\0');
    const Hdf5Handle type = text_type(longest);
    write_dataset(file, info.name, type, type, rank, size, all.data());
  } else if (info.type == ValueType::integer) {
    write_dataset(file, info.name, H5T_STD_I64LE, H5T_NATIVE_INT64, rank, size, column.integers().data());
  } else {
    write_dataset(file, info.name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, rank, size, column.numbers().data());
  }
}

}  // namespace

void write_sweep_h5(const std::filesystem::path& file, const Sweep& sweep, const SweepTables& tables,
                    const SweepDescription& description) {
  const auto alone = lock_hdf5();
  silence_hdf5();
  WholeFile whole(file, next_name(file));
  Hdf5Handle id = create_hdf5_in_usual_format(whole.part());
  const Request& request = sweep.common().request;
  write_format(id);
  write_attribute(id, "hamflow", description.version);
  write_attribute(id, "host", description.host);
  write_attribute(id, "problem", request.problem);
  // Settings that differ between members are in the columns of the varied keys.
  if (sweep.arithmetics().size() <= 1) write_attribute(id, "arithmetic", request.arithmetic);
  write_text_dataset(id, "scenario", sweep.text());
  for (const Column& column : tables.members.columns()) write_column(id, column);
  for (const Column& column : tables.section.columns()) write_column(id, column);
  id.close_now("write " + file.string() + " (is the disk full?)");
  whole.put_in_place();
}

namespace {

/// Quotes a text for CSV if it contains commas, quotes or line ends.
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string all = "\"";
  for (const char c : text) all += c == '"' ? std::string("\"\"") : std::string(1, c);
  return all + "\"";
}

/// Returns component i of row k as text.
std::string cell(const Column& column, std::size_t k, std::size_t i) {
  const std::size_t at = k * column.info().width + i;
  switch (column.info().type) {
    case ValueType::text:
      return quoted(std::string(column.text(k, i)));
    case ValueType::integer:
      return std::to_string(column.integers()[at]);
    default:
      return fmt::format("{:.17g}", without_sign_of_nan(column.numbers()[at]));
  }
}

/// Returns the columns, with all digits if they have more than a double. Columns of varied keys stay numbers.
std::vector<const Column*> columns_of_csv(const Table& table) {
  const std::string beyond_double = "digits/";
  std::vector<const Column*> all;
  for (const Column& column : table.columns()) {
    if (column.name().starts_with(beyond_double)) continue;
    const Column* const digits =
        column.name().starts_with("varied/") ? nullptr : table.find(beyond_double + column.name());
    all.push_back(digits != nullptr ? digits : &column);
  }
  return all;
}

/// @throws FileError
void write_csv(const std::filesystem::path& file, const Table& table) {
  constexpr std::size_t bytes_at_once = 1 << 16;
  WholeFile whole(file, next_name(file));
  const std::vector<const Column*> columns = columns_of_csv(table);
  std::vector<std::string> labels;
  for (const Column* column : columns) {
    for (std::size_t i = 0; i < column->info().width; ++i) labels.push_back(quoted(csv_name(*column, i)));
  }
  std::string text = joined(labels, ",") + '\n';
  for (std::size_t row = 0; row < columns[0]->rows(); ++row) {
    std::vector<std::string> cells;
    for (const Column* column : columns) {
      for (std::size_t i = 0; i < column->info().width; ++i) cells.push_back(cell(*column, row, i));
    }
    text += joined(cells, ",") + '\n';
    if (text.size() < bytes_at_once) continue;
    whole.write(text);
    text.clear();
  }
  write_whole(whole, text);
}

}  // namespace

std::string csv_name(const Column& column, std::size_t i) {
  std::string name = column.name();
  for (const std::string table : {"digits/", "varied/", "section/"}) {
    if (name.starts_with(table)) name = name.substr(table.size());
  }
  return name + (column.info().scalar ? "" : std::to_string(i + 1));
}

void write_sweep_csv(const std::filesystem::path& folder, const SweepTables& tables) {
  write_csv(folder / "sweep.csv", tables.members);
  if (!tables.section.empty()) write_csv(folder / "section.csv", tables.section);
}

}  // namespace hamflow
