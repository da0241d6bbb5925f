#include "run_copy.hpp"

#include <algorithm>

#include "hdf5_text.hpp"

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

/// Rows of a sample each, chunked like those of a run.
void write_states(hid_t file, const char* name, const std::vector<std::vector<double>>& by_coordinate) {
  const std::size_t width = by_coordinate.size();
  const std::size_t rows = by_coordinate.at(0).size();
  std::vector<double> all(width * rows);
  for (std::size_t i = 0; i < width; ++i) {
    for (std::size_t k = 0; k < rows; ++k) all[k * width + i] = by_coordinate[i][k];
  }
  const hsize_t size[2] = {rows, width};
  const hsize_t most[2] = {H5S_UNLIMITED, width};
  const hsize_t chunk[2] = {std::max<hsize_t>(std::min<hsize_t>(rows, 8192), 16), width};
  const Hdf5Handle space(H5Screate_simple(2, size, most), H5Sclose, "make a data space");
  const Hdf5Handle plist(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make a property list");
  check_hdf5(H5Pset_chunk(plist, 2, chunk), std::string("chunk ") + name);
  const Hdf5Handle dataset(H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, plist, H5P_DEFAULT), H5Dclose,
                           std::string("create dataset ") + name);
  check_hdf5(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()),
             std::string("write ") + name);
}

}  // namespace

void copy_run_file(const std::filesystem::path& source, const std::filesystem::path& target,
                   const std::string& scenario, const std::vector<std::vector<double>>& q,
                   const std::vector<std::vector<double>>& p) {
  silence_hdf5();
  const Hdf5Handle from = open_to_read(source);
  const Hdf5Handle to = create_hdf5(target);
  for (const std::string& name : names_in(from, true)) copy_attribute(from, to, name.c_str());
  for (const std::string& name : names_in(from, false)) {
    if (name == "q" || name == "p" || name == "scenario") continue;
    if (name == "section") continue;  // that of another coordinate
    check_hdf5(H5Ocopy(from, name.c_str(), to, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), "copy " + name);
  }
  write_text_dataset(to, "scenario", scenario);
  write_states(to, "q", q);
  write_states(to, "p", p);
  check_hdf5(H5Fflush(to, H5F_SCOPE_GLOBAL), "write " + target.string() + " (is the disk full?)");
}

}  // namespace hamflow
