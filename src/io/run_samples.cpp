// What run.h5 holds, read again: also while it grows, and after a crash.
#include <algorithm>
#include <new>
#include <stdexcept>

#include "hdf5_text.hpp"
#include "run_column.hpp"
#include "run_file.hpp"

namespace hamflow {

namespace {
/// A dataset of rows of `width` numbers, open to be read.
struct OpenColumn {
  OpenColumn(hid_t file, const char* its_name)
      : name(its_name), dataset(H5Dopen2(file, its_name, H5P_DEFAULT), H5Dclose, "open dataset " + name) {
    const Hdf5Handle space(H5Dget_space(dataset), H5Sclose, "open the space of " + name);
    if (H5Sget_simple_extent_ndims(space) > 3) throw FileError("HDF5: dataset " + name + " has too many dimensions");
    check_hdf5(H5Sget_simple_extent_dims(space, size, nullptr), "read the size of " + name);
  }
  std::size_t rows() const { return size[0]; }
  std::size_t width() const { return size[1] * size[2]; }
  /// A chunk that its writer is writing at this moment has another checksum: a moment later it is whole.
  void read(hid_t type, void* values) const {
    for (int attempt = 1; attempt < 3; ++attempt) {
      if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0) return;
    }
    check_hdf5(H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "read " + name);
  }

  std::string name;
  Hdf5Handle dataset;
  hsize_t size[3] = {0, 1, 1};
};

/// Row by row.
std::vector<double> read_column(hid_t file, const char* name, std::size_t& width) {
  const OpenColumn column(file, name);
  width = column.width();
  std::vector<double> values(column.rows() * width);
  if (!values.empty()) column.read(H5T_NATIVE_DOUBLE, values.data());
  return values;
}

std::size_t rows_of(hid_t file, const char* name, std::size_t& width) {
  const OpenColumn column(file, name);
  width = std::max<std::size_t>(column.width(), 1);
  return column.rows();
}

std::vector<std::string> read_texts(hid_t file, const char* name, std::size_t& width) {
  const OpenColumn column(file, name);
  width = column.width();
  const Hdf5Handle type(H5Dget_type(column.dataset), H5Tclose, "read the type of " + column.name);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) {
    throw FileError("HDF5: dataset " + column.name + " holds no texts of one length");
  }
  const std::size_t length = H5Tget_size(type);
  std::string all(column.rows() * width * length, '\0');
  if (!all.empty()) column.read(type, all.data());
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < all.size(); at += length) {
    const std::string_view text = std::string_view(all).substr(at, length);
    texts.emplace_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

template <class T>
std::vector<std::vector<T>> by_coordinate(const std::vector<T>& rows, std::size_t width, std::size_t count) {
  std::vector<std::vector<T>> out(width, std::vector<T>(count));
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < width; ++i) out[i][k] = rows[k * width + i];
  }
  return out;
}
/// The names in a group; none where it is not there.
std::vector<std::string> names_in(hid_t file, const char* group_name) {
  if (H5Lexists(file, group_name, H5P_DEFAULT) <= 0) return {};
  const Hdf5Handle group(H5Gopen2(file, group_name, H5P_DEFAULT), H5Gclose, "open group " + std::string(group_name));
  H5G_info_t info{};
  check_hdf5(H5Gget_info(group, &info), "count the objects of " + std::string(group_name));
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    char name[256] = "";
    const bool read =
        H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, name, sizeof name, H5P_DEFAULT) >= 0;
    check_hdf5(read ? 0 : -1, "read a name in " + std::string(group_name));
    names.emplace_back(name);
  }
  return names;
}

bool has_particles(hid_t file) {
  return H5Lexists(file, "particles", H5P_DEFAULT) > 0 && H5Lexists(file, "particles/all", H5P_DEFAULT) > 0;
}

/// The states that reverse.h5 has, in their order.
std::vector<std::string> states_of_reversal(hid_t file) {
  std::vector<std::string> names;
  if (H5Lexists(file, "t", H5P_DEFAULT) > 0) return names;
  for (const char* name : {"start", "turn", "end"}) {
    if (H5Lexists(file, name, H5P_DEFAULT) > 0) names.emplace_back(name);
  }
  return names;
}

double read_number(hid_t object, const char* name) {
  const Hdf5Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose, "open an attribute");
  double x = 0;
  check_hdf5(H5Aread(attribute, H5T_NATIVE_DOUBLE, &x), std::string("read attribute ") + name);
  return x;
}

/// A reversal as a run of three samples.
RunSamples read_reversal(hid_t file, const std::vector<std::string>& names, std::size_t most_coordinates) {
  RunSamples run;
  run.description.scenario = read_text_dataset(file, "scenario");
  std::vector<double> q;
  std::vector<double> p;
  for (const std::string& name : names) {
    const Hdf5Handle group(H5Gopen2(file, name.c_str(), H5P_DEFAULT), H5Gclose, "open group " + name);
    run.t.push_back(read_number(group, "t"));
    std::size_t one = 0;
    for (const auto& [numbers, letter] : {std::pair{&q, "/q"}, std::pair{&p, "/p"}}) {
      const std::vector<double> row = read_column(file, (name + letter).c_str(), one);
      numbers->insert(numbers->end(), row.begin(), row.end());
    }
  }
  const std::size_t width = q.size() / names.size();
  run.description.dimension = width;
  if (width * names.size() != q.size() || p.size() != q.size()) throw FileError("HDF5: states differ in length");
  if (width > most_coordinates) return run;
  run.q = by_coordinate(q, width, names.size());
  run.p = by_coordinate(p, width, names.size());
  return run;
}

RunSamples read_samples(const std::filesystem::path& path, std::size_t most_coordinates) {
  silence_hdf5();
  const Hdf5Handle file = open_to_read(path);
  if (const auto states = states_of_reversal(file); !states.empty()) {
    return read_reversal(file, states, most_coordinates);
  }
  RunSamples run;
  run.description.scenario = read_text_dataset(file, "scenario");
  run.description.version = read_attribute(file, "hamflow");
  run.description.host = read_attribute(file, "host");
  run.description.problem = read_attribute(file, "problem");
  run.description.method = read_attribute(file, "method");
  run.description.arithmetic = read_attribute(file, "arithmetic");
  std::size_t width = 0;
  run.t = read_column(file, "t", width);
  run.energy = read_column(file, "energy", width);
  std::size_t q_width = 0;
  std::size_t p_width = 0;
  const bool particles = has_particles(file);
  const char* const q_name = particles ? H5mdNames::position : "q";
  const char* const p_name = particles ? H5mdNames::momentum : "p";
  const std::size_t q_rows = rows_of(file, q_name, q_width);
  const std::size_t p_rows = rows_of(file, p_name, p_width);
  const bool with_states = q_width <= most_coordinates;
  const std::vector<double> q = with_states ? read_column(file, q_name, q_width) : std::vector<double>();
  const std::vector<double> p = with_states ? read_column(file, p_name, p_width) : std::vector<double>();
  std::size_t one = 0;
  for (const auto& [name, meaning] : diagnostic_columns) {
    if (H5Lexists(file, name, H5P_DEFAULT) <= 0) continue;
    run.diagnostics.emplace_back(name + std::string("solver/").size(), read_column(file, name, one));
  }
  for (const std::string& name : names_in(file, "observables")) {
    if (particles && (name == "energy" || H5Lexists(file, ("invariants/" + name).c_str(), H5P_DEFAULT) > 0)) continue;
    const std::string dataset = "observables/" + name + (particles ? "/value" : "");
    run.observables.emplace_back(name, read_column(file, dataset.c_str(), one));
  }
  for (const std::string& name : names_in(file, "invariants")) {
    std::size_t numbers = 0;
    const std::vector<double> rows = read_column(file, ("invariants/" + name).c_str(), numbers);
    numbers = std::max<std::size_t>(numbers, 1);
    const auto columns = by_coordinate(rows, numbers, rows.size() / numbers);
    for (std::size_t k = 0; k < numbers; ++k) {
      run.invariants.emplace_back(numbers == 1 ? name : name + "_" + std::to_string(k + 1), columns[k]);
    }
  }
  // After a crash between two flushes the columns may differ in length: what all of them have is complete.
  std::size_t count = std::min({run.t.size(), run.energy.size(), q_rows, p_rows});
  if (with_states) count = std::min({count, q.size() / q_width, p.size() / p_width});
  for (const auto& column : run.diagnostics) count = std::min(count, column.second.size());
  for (const auto& column : run.observables) count = std::min(count, column.second.size());
  for (const auto& column : run.invariants) count = std::min(count, column.second.size());
  for (auto* columns : {&run.diagnostics, &run.observables, &run.invariants}) {
    for (auto& column : *columns) column.second.resize(count);
  }
  run.t.resize(count);
  run.energy.resize(count);
  if (with_states) {
    run.q = by_coordinate(q, q_width, count);
    run.p = by_coordinate(p, p_width, count);
  }
  run.description.dimension = q_width;
  if (H5Lexists(file, "section", H5P_DEFAULT) > 0) {
    run.section_t = read_column(file, "section/t", one);
    const std::vector<double> section_q = read_column(file, "section/q", one);
    const std::vector<double> section_p = read_column(file, "section/p", one);
    const std::size_t points = std::min({run.section_t.size(), section_q.size() / q_width, section_p.size() / p_width});
    run.section_t.resize(points);
    run.section_q = by_coordinate(section_q, q_width, points);
    run.section_p = by_coordinate(section_p, p_width, points);
    run.description.section = true;
  }
  if (H5Lexists(file, "events", H5P_DEFAULT) > 0 && H5Lexists(file, "events/wall", H5P_DEFAULT) > 0) {
    run.wall_t = read_column(file, "events/wall/t", one);
    const std::vector<double> wall_q = read_column(file, "events/wall/q", one);
    const std::size_t bounces = std::min(run.wall_t.size(), wall_q.size() / q_width);
    run.wall_t.resize(bounces);
    run.wall_q = by_coordinate(wall_q, q_width, bounces);
  }
  return run;
}

std::vector<double> read_positions(const std::filesystem::path& path, std::size_t sample) {
  silence_hdf5();
  const Hdf5Handle file = open_to_read(path);
  if (const auto states = states_of_reversal(file); !states.empty()) {
    std::size_t one = 0;
    return read_column(file, (states.at(sample) + "/q").c_str(), one);
  }
  const OpenColumn column(file, has_particles(file) ? H5mdNames::position : "q");
  const hsize_t first[3] = {sample, 0, 0};
  const hsize_t count[3] = {1, column.size[1], column.size[2]};
  const hsize_t width = column.width();
  const Hdf5Handle space(H5Dget_space(column.dataset), H5Sclose, "open the space of " + column.name);
  const Hdf5Handle memory(H5Screate_simple(1, &width, nullptr), H5Sclose, "make a data space");
  check_hdf5(H5Sselect_hyperslab(space, H5S_SELECT_SET, first, nullptr, count, nullptr), "select a row");
  std::vector<double> q(width);
  check_hdf5(H5Dread(column.dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, q.data()), "read " + column.name);
  return q;
}

RunDigits read_digits(const std::filesystem::path& path) {
  silence_hdf5();
  const Hdf5Handle file = open_to_read(path);
  RunDigits run;
  if (H5Lexists(file, "digits", H5P_DEFAULT) <= 0) return run;
  std::size_t one = 0;
  std::size_t width = 0;
  run.t = read_texts(file, "digits/t", one);
  run.energy = read_texts(file, "digits/energy", one);
  const std::vector<std::string> q = read_texts(file, "digits/q", width);
  const std::vector<std::string> p = read_texts(file, "digits/p", width);
  const std::size_t count = std::min({run.t.size(), run.energy.size(), q.size() / width, p.size() / width});
  run.t.resize(count);
  run.energy.resize(count);
  run.q = by_coordinate(q, width, count);
  run.p = by_coordinate(p, width, count);
  return run;
}

/// What goes wrong while a file is read names the file.
template <class Read>
auto naming(const std::filesystem::path& path, const Read& read) {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown)) {
    const bool of_sweep = std::filesystem::exists(path.parent_path() / "sweep.h5", unknown) && path.has_parent_path();
    throw FileError(path.string() + " cannot be read: there is no such file" +
                    (of_sweep ? "; this is the folder of a sweep: hamflow sweep --figure draws it" : ""));
  }
  try {
    return read(path);
  } catch (const FileError& error) {
    throw FileError(path.string() + " cannot be read, damaged or no run of hamflow: " + error.what());
  } catch (const std::bad_alloc&) {
    throw FileError(path.string() + " cannot be read: it claims a size that cannot be");
  } catch (const std::length_error&) {
    throw FileError(path.string() + " cannot be read: it claims a size that cannot be");
  }
}

}  // namespace

RunSamples read_run_file(const std::filesystem::path& path, std::size_t most_coordinates) {
  return naming(path, [&](const std::filesystem::path& file) { return read_samples(file, most_coordinates); });
}
std::vector<double> read_run_positions(const std::filesystem::path& path, std::size_t sample) {
  return naming(path, [&](const std::filesystem::path& file) { return read_positions(file, sample); });
}
RunDigits read_run_digits(const std::filesystem::path& path) { return naming(path, read_digits); }

}  // namespace hamflow
