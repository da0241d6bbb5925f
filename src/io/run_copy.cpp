#include "run_copy.hpp"

#include <algorithm>
#include <new>
#include <stdexcept>

#include "hdf5_text.hpp"
#include "run_column.hpp"
#include "whole_file.hpp"

namespace hamflow {

namespace {

/// The names of an object's attributes, or of the objects in a group.
std::vector<std::string> names_in(hid_t file, bool attributes) {
  std::vector<std::string> names;
  if (attributes) {
    const auto note = [](hid_t, const char* name, const H5A_info_t*, void* all) -> herr_t {
      static_cast<std::vector<std::string>*>(all)->emplace_back(name);
      return 0;
    };
    check_hdf5(H5Aiterate2(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, note, &names), "list the attributes");
  } else {
    const auto note = [](hid_t, const char* name, const H5L_info_t*, void* all) -> herr_t {
      static_cast<std::vector<std::string>*>(all)->emplace_back(name);
      return 0;
    };
    check_hdf5(H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, note, &names), "list the datasets");
  }
  return names;
}

void copy_attribute(hid_t from, hid_t to, const char* name) {
  const Hdf5Handle source(H5Aopen(from, name, H5P_DEFAULT), H5Aclose, "open an attribute");
  const Hdf5Handle type(H5Aget_type(source), H5Tclose, "read a type");
  const Hdf5Handle space(H5Aget_space(source), H5Sclose, "open a data space");
  const auto points = static_cast<std::size_t>(std::max<hssize_t>(H5Sget_simple_extent_npoints(space), 0));
  if (H5Tis_variable_str(type) != 0)
    throw FileError(std::string("HDF5: attribute ") + name + " has a type that no run has");
  std::vector<char> bytes(points * H5Tget_size(type));
  check_hdf5(H5Aread(source, type, bytes.data()), std::string("read attribute ") + name);
  const Hdf5Handle target(H5Acreate2(to, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "create an attribute");
  check_hdf5(H5Awrite(target, type, bytes.data()), std::string("write attribute ") + name);
}

/// What the copy has of its own.
constexpr const char* written_anew[] = {"q", "p", "scenario", "digits"};
/// Tables whose rows are no samples, of states in the coordinates that are left behind.
constexpr const char* left_out[] = {"section", "events/wall", "events/user"};

bool is_one_of(const auto& names, const std::string& path) {
  return std::find(std::begin(names), std::end(names), path) != std::end(names);
}

/// One dataset of the source. H5Ocopy would be one call, but crashes on a damaged file, and on a disk that is full.
struct Source {
  std::string name;
  Hdf5Handle dataset;
  int rank = 0;
  hsize_t size[2] = {0, 1};

  Source(hid_t file, std::string path)
      : name(std::move(path)), dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "open dataset " + name) {
    const Hdf5Handle space(H5Dget_space(dataset), H5Sclose, "open the space of " + name);
    rank = H5Sget_simple_extent_ndims(space);
    if (rank < 0 || rank > 2) throw FileError("HDF5: dataset " + name + " has too many dimensions");
    check_hdf5(H5Sget_simple_extent_dims(space, size, nullptr), "read the size of " + name);
  }
};

struct Objects {
  std::vector<std::string> groups;
  std::vector<Source> datasets;
  std::vector<std::string> tables_left_out;
};

void collect(hid_t file, const std::string& group, Objects& objects) {
  constexpr std::size_t most_objects = 10000;  // of a damaged file that goes in circles
  const Hdf5Handle here(H5Gopen2(file, group.empty() ? "/" : group.c_str(), H5P_DEFAULT), H5Gclose,
                        "open group " + group);
  for (const std::string& name : names_in(here, false)) {
    const std::string path = group.empty() ? name : group + "/" + name;
    if (is_one_of(written_anew, path)) continue;
    if (is_one_of(left_out, path)) {
      objects.tables_left_out.push_back("/" + path);
      continue;
    }
    const Hdf5Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, "open " + path);
    const H5I_type_t kind = H5Iget_type(object);
    if (objects.groups.size() + objects.datasets.size() > most_objects)
      throw FileError("HDF5: found no end of objects");
    if (kind == H5I_DATASET) objects.datasets.emplace_back(file, path);
    if (kind != H5I_GROUP) continue;
    objects.groups.push_back(path);
    collect(file, path, objects);
  }
}

/// The first `rows` rows; some at a time, so that a long run does not fill the memory.
void copy_rows(const Source& source, hid_t to, hsize_t rows) {
  const std::string& name = source.name;
  const Hdf5Handle type(H5Dget_type(source.dataset), H5Tclose, "read the type of " + name);
  const H5T_class_t kind = H5Tget_class(type);
  if ((kind != H5T_FLOAT && kind != H5T_INTEGER && kind != H5T_STRING) || H5Tis_variable_str(type) != 0) {
    throw FileError("HDF5: dataset " + name + " has a type that no run has");
  }
  const Hdf5Handle plist(H5Dget_create_plist(source.dataset), H5Pclose, "read the chunks of " + name);
  const hsize_t size[2] = {source.rank > 0 ? rows : 1, source.size[1]};
  const hsize_t most[2] = {H5S_UNLIMITED, source.size[1]};
  const bool grows = H5Pget_layout(plist) == H5D_CHUNKED;
  const Hdf5Handle space(H5Screate_simple(source.rank, size, grows ? most : nullptr), H5Sclose, "make a data space");
  const Hdf5Handle target(H5Dcreate2(to, name.c_str(), type, space, H5P_DEFAULT, plist, H5P_DEFAULT), H5Dclose,
                          "create dataset " + name);
  for (const std::string& attribute : names_in(source.dataset, true)) {
    copy_attribute(source.dataset, target, attribute.c_str());
  }
  constexpr std::size_t bytes_at_once = std::size_t{1} << 23;
  const std::size_t row_bytes = H5Tget_size(type) * static_cast<std::size_t>(size[1]);
  const hsize_t at_once = std::max<hsize_t>(bytes_at_once / std::max<std::size_t>(row_bytes, 1), 1);
  std::vector<char> bytes;
  for (hsize_t row = 0; row < size[0]; row += at_once) {
    const hsize_t offset[2] = {row, 0};
    const hsize_t count[2] = {std::min(at_once, size[0] - row), size[1]};
    bytes.resize(static_cast<std::size_t>(count[0]) * row_bytes);
    const Hdf5Handle part(H5Dget_space(source.dataset), H5Sclose, "open the space of " + name);
    const Hdf5Handle memory(H5Screate_simple(source.rank, count, nullptr), H5Sclose, "make a data space");
    if (source.rank > 0) {
      for (const hid_t both : {hid_t(part), hid_t(space)}) {
        check_hdf5(H5Sselect_hyperslab(both, H5S_SELECT_SET, offset, nullptr, count, nullptr),
                   "select rows of " + name);
      }
    }
    check_hdf5(H5Dread(source.dataset, type, memory, part, H5P_DEFAULT, bytes.data()), "read " + name);
    check_hdf5(H5Dwrite(target, type, memory, space, H5P_DEFAULT, bytes.data()), "write " + name);
  }
}

template <class T>
void write_rows(hid_t file, const char* name, hid_t type, const std::vector<std::vector<T>>& by_coordinate,
                std::size_t rows, const ColumnText& text) {
  Column column(file, name, type, by_coordinate.size(), rows, text);
  for (std::size_t k = 0; k < rows; ++k) {
    for (const auto& coordinate : by_coordinate) column.add(coordinate[k]);
  }
  column.write(rows);
}

template <class T>
void write_row_numbers(hid_t file, const char* name, hid_t type, const std::vector<T>& values, std::size_t rows,
                       const ColumnText& text) {
  Column column(file, name, type, 0, rows, text);
  for (std::size_t k = 0; k < rows; ++k) column.add(values[k]);
  column.write(rows);
}

void write_states(hid_t file, const ConvertedStates& states, std::size_t rows) {
  const ColumnText of_q{states.coordinates, "coordinates, converted"};
  const ColumnText of_p{states.momenta, "canonical momenta, converted"};
  write_rows(file, "q", H5T_IEEE_F64LE, states.q, rows, of_q);
  write_rows(file, "p", H5T_IEEE_F64LE, states.p, rows, of_p);
  const RunDigits& digits = states.digits;
  if (digits.t.empty()) return;
  (void)make_group(file, "digits");
  const Hdf5Handle type = digits_type(states.digits_length);
  write_rows(file, "digits/q", type, digits.q, rows, of_q);
  write_rows(file, "digits/p", type, digits.p, rows, of_p);
  write_row_numbers(file, "digits/energy", type, digits.energy, rows, {{"energy"}, "H(q, p)"});
  write_row_numbers(file, "digits/t", type, digits.t, rows, {{"t"}, "time"});
}

std::vector<std::string> copy(const std::filesystem::path& source, const std::filesystem::path& target,
                              const ConvertedStates& states) {
  const Hdf5Handle from = open_to_read(source);
  Objects objects;
  collect(from, "", objects);
  hsize_t rows = states.q.at(0).size();  // a run that goes on, or was killed, has columns of different lengths
  for (const Source& each : objects.datasets) {
    if (each.rank > 0) rows = std::min(rows, each.size[0]);
  }
  WholeFile whole(target);
  Hdf5Handle to = create_hdf5(whole.part());
  for (const std::string& name : names_in(from, true)) {
    // Names are others, and no run goes on with these samples.
    if (name != "coordinates" && name != "momenta" && name != "run") copy_attribute(from, to, name.c_str());
  }
  if (!states.coordinates.empty()) write_attribute(to, "coordinates", states.coordinates);
  if (!states.momenta.empty()) write_attribute(to, "momenta", states.momenta);
  for (const std::string& group : objects.groups) (void)make_group(to, group);
  for (const Source& each : objects.datasets) copy_rows(each, to, rows);
  write_text_dataset(to, "scenario", states.scenario);
  write_states(to, states, rows);
  to.close_now("write " + target.string() + " (is the disk full?)");
  whole.put_in_place();
  return objects.tables_left_out;
}

}  // namespace

std::vector<std::string> copy_run_file(const std::filesystem::path& source, const std::filesystem::path& target,
                                       const ConvertedStates& states) {
  silence_hdf5();
  try {
    return copy(source, target, states);
  } catch (const std::bad_alloc&) {
    throw FileError(source.string() + " cannot be copied: it claims a size that cannot be");
  } catch (const std::length_error&) {
    throw FileError(source.string() + " cannot be copied: it claims a size that cannot be");
  }
}

}  // namespace hamflow
