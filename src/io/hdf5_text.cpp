#include "hdf5_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "file_format.hpp"
#include "hamflow/detail/core/hash.hpp"

namespace hamflow {

namespace {
/// Chunks have checksums, but the dataset of a text is contiguous and has none. Therefore its hash is an attribute;
/// HDF5 protects attributes itself.
constexpr const char* hash_attribute = "fnv1a";
std::string hash_of(const std::string& text) { return fmt::format("{:016x}", fnv1a(std::as_bytes(std::span(text)))); }
}  // namespace

Hdf5Handle text_type(std::size_t length) {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a text type");
  check_hdf5(H5Tset_size(type, std::max<std::size_t>(length, 1)), "size a text type");
  check_hdf5(H5Tset_cset(type, H5T_CSET_UTF8), "set UTF-8");
  return type;
}

namespace {
void write_values(hid_t object, const std::string& name, hid_t type, const Hdf5Handle& space, const void* values) {
  const Hdf5Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                             "create attribute " + name);
  check_hdf5(H5Awrite(attribute, type, values), "write attribute " + name);
}
Hdf5Handle scalar() { return {H5Screate(H5S_SCALAR), H5Sclose, "make a data space"}; }
Hdf5Handle list_of(hsize_t size) { return {H5Screate_simple(1, &size, nullptr), H5Sclose, "make a data space"}; }
}  // namespace

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
  write_values(object, name, text_type(text.size()), scalar(), text.c_str());
}
void write_attribute(hid_t object, const std::string& name, double x) {
  write_values(object, name, H5T_NATIVE_DOUBLE, scalar(), &x);
}
void write_attribute(hid_t object, const std::string& name, const std::vector<double>& numbers) {
  write_values(object, name, H5T_NATIVE_DOUBLE, list_of(numbers.size()), numbers.data());
}
void write_attribute(hid_t object, const std::string& name, const std::vector<std::string>& texts) {
  std::size_t longest = 1;
  for (const std::string& text : texts) longest = std::max(longest, text.size());
  std::string all;
  for (const std::string& text : texts) all += text + std::string(longest - text.size(), '\0');
  write_values(object, name, text_type(longest), list_of(texts.size()), all.data());
}

void write_format(hid_t file) { write_attribute(file, "format", std::string(file_format)); }

void write_text_dataset(hid_t file, const std::string& name, const std::string& text) {
  const Hdf5Handle type = text_type(text.size());
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make a data space");
  const Hdf5Handle plist(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make a property list");
  check_hdf5(H5Pset_obj_track_times(plist, false), "leave out times");
  const Hdf5Handle dataset(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, plist, H5P_DEFAULT), H5Dclose,
                           "create dataset " + name);
  check_hdf5(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()), "write " + name);
  write_attribute(dataset, hash_attribute, hash_of(text.empty() ? std::string(1, 0) : text));
}

std::string read_text_dataset(hid_t file, const std::string& name) {
  const StoredData dataset = StoredData::dataset(file, name);
  std::string text = dataset.text();
  const std::string hash = text_attribute(dataset.object(), hash_attribute);
  if (!hash.empty() && hash != hash_of(text))
    throw FileError("HDF5: dataset " + name + " is damaged: its hash is wrong");
  return text;
}

Hdf5Handle make_group(hid_t file, const std::string& name) {
  return {H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "create group " + name};
}

namespace {
/// Creates a new file. HDF5 does not follow a link here.
Hdf5Handle create_new(const std::filesystem::path& path, hid_t access) {
  std::error_code none;
  std::filesystem::remove(path, none);
  return {H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access), H5Fclose, "create " + path.string()};
}
}  // namespace

Hdf5Handle create_hdf5(const std::filesystem::path& path) {
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make a property list");
  check_hdf5(H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), "choose the file format");
  constexpr hsize_t page = 4096;
  check_hdf5(H5Pset_alignment(access, 3400, page), "put chunks on pages");
  return create_new(path, access);
}

Hdf5Handle create_hdf5_in_usual_format(const std::filesystem::path& path) { return create_new(path, H5P_DEFAULT); }

}  // namespace hamflow
