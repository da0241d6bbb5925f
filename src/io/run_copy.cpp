#include "run_copy.hpp"

#include <algorithm>

#include "hdf5_text.hpp"
#include "run_column.hpp"

namespace hamflow {

namespace {

/// The names of a file's attributes, or of the objects in its root.
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
  std::vector<char> bytes(static_cast<std::size_t>(H5Aget_storage_size(source)));
  check_hdf5(H5Aread(source, type, bytes.data()), std::string("read attribute ") + name);
  const Hdf5Handle target(H5Acreate2(to, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "create an attribute");
  check_hdf5(H5Awrite(target, type, bytes.data()), std::string("write attribute ") + name);
}

template <class T>
void write_rows(hid_t file, const char* name, hid_t type, const std::vector<std::vector<T>>& by_coordinate,
                const ColumnText& text) {
  const std::size_t rows = by_coordinate.at(0).size();
  Column column(file, name, type, by_coordinate.size(), rows, text);
  for (std::size_t k = 0; k < rows; ++k) {
    for (const auto& coordinate : by_coordinate) column.add(coordinate[k]);
  }
  column.write(rows);
}

template <class T>
void write_row_numbers(hid_t file, const char* name, hid_t type, const std::vector<T>& values, const ColumnText& text) {
  Column column(file, name, type, 0, values.size(), text);
  for (const T& x : values) column.add(x);
  column.write(values.size());
}

void write_states(hid_t file, const ConvertedStates& states) {
  const ColumnText of_q{states.coordinates, "coordinates, converted"};
  const ColumnText of_p{states.momenta, "canonical momenta, converted"};
  write_rows(file, "q", H5T_IEEE_F64LE, states.q, of_q);
  write_rows(file, "p", H5T_IEEE_F64LE, states.p, of_p);
  const RunDigits& digits = states.digits;
  if (digits.t.empty()) return;
  (void)make_group(file, "digits");
  const Hdf5Handle type = digits_type(states.digits_length);
  write_rows(file, "digits/q", type, digits.q, of_q);
  write_rows(file, "digits/p", type, digits.p, of_p);
  write_row_numbers(file, "digits/energy", type, digits.energy, {{"energy"}, "H(q, p)"});
  write_row_numbers(file, "digits/t", type, digits.t, {{"t"}, "time"});
}

}  // namespace

void copy_run_file(const std::filesystem::path& source, const std::filesystem::path& target,
                   const ConvertedStates& states) {
  silence_hdf5();
  const Hdf5Handle from = open_to_read(source);
  const Hdf5Handle to = create_hdf5(target);
  for (const std::string& name : names_in(from, true)) {
    if (name != "coordinates" && name != "momenta") copy_attribute(from, to, name.c_str());
  }
  if (!states.coordinates.empty()) write_attribute(to, "coordinates", states.coordinates);
  if (!states.momenta.empty()) write_attribute(to, "momenta", states.momenta);
  for (const std::string& name : names_in(from, false)) {
    if (name == "q" || name == "p" || name == "scenario" || name == "digits") continue;
    if (name == "section") continue;  // that of another coordinate
    check_hdf5(H5Ocopy(from, name.c_str(), to, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), "copy " + name);
  }
  write_text_dataset(to, "scenario", states.scenario);
  write_states(to, states);
  check_hdf5(H5Fflush(to, H5F_SCOPE_GLOBAL), "write " + target.string() + " (is the disk full?)");
}

}  // namespace hamflow
