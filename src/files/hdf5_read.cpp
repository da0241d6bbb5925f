#include "hdf5_read.hpp"

#include <algorithm>
#include <cstring>

#include "file_format.hpp"

namespace hamflow {

namespace {

Hdf5Handle space_of_rows(const std::vector<hsize_t>& shape) {
  return {
      shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
      H5Sclose, "make a data space"};
}

StoredData::Kind kind_of_type(hid_t type) {
  const H5T_class_t type_class = H5Tget_class(type);
  const std::size_t size = H5Tget_size(type);
  if (type_class == H5T_STRING) return StoredData::Kind::texts;
  if ((type_class == H5T_FLOAT && size <= sizeof(long double)) || (type_class == H5T_INTEGER && size <= 8)) {
    return StoredData::Kind::numbers;
  }
  return StoredData::Kind::other;
}

bool is_compressed(hid_t creation) {
  const int filters = H5Pget_nfilters(creation);
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr, 0, nullptr, nullptr);
    if (filter != H5Z_FILTER_FLETCHER32 && filter != H5Z_FILTER_SHUFFLE) return true;
  }
  return false;
}

/// Returns the current size of the file: a writer may have made it longer since it was opened.
std::uintmax_t size_of_file(hid_t object) {
  char name[4096] = "";
  if (H5Fget_name(object, name, sizeof name) <= 0) return 0;
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(name, unknown);
  return unknown ? 0 : size;
}

/// Returns an upper bound for the data of a dataset in the file; only fill values can exceed it.
std::uintmax_t most_bytes_of(hid_t dataset) {
  const Hdf5Handle creation(H5Dget_create_plist(dataset), H5Pclose, "read how a dataset is stored");
  constexpr std::uintmax_t best_ratio = 1032;  // best compression ratio of deflate
  const std::uintmax_t stored = std::min<std::uintmax_t>(H5Dget_storage_size(dataset), size_of_file(dataset));
  return stored * (is_compressed(creation) ? best_ratio : 1);
}

}  // namespace

void silence_hdf5() {
  static const bool once = [] {
    // At exit HDF5 would close files that a full disk kept open, and crash. hamflow closes every file itself.
    H5dont_atexit();
    return true;
  }();
  (void)once;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

namespace {

/// @throws OtherFormat if a later version of hamflow wrote the file in a format that this version cannot read
void check_format(hid_t file, const std::filesystem::path& path) {
  if (H5Aexists(file, "format") <= 0) return;
  const StoredData format = StoredData::attribute(file, "format");
  if (format.kind() != StoredData::Kind::texts) return;
  if (const std::string wrong = refused_format(format.text()); !wrong.empty()) {
    throw OtherFormat(path.string() + " " + wrong);
  }
}

}  // namespace

Hdf5Handle open_to_read(const std::filesystem::path& path) {
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make a property list");
  check_hdf5(H5Pset_metadata_read_attempts(access, 24), "limit the attempts to read");
  hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access);
  // If h5py has opened the file in this process, it can only be opened in the same way.
  const bool others_are_open = H5Fget_obj_count(H5F_OBJ_ALL, H5F_OBJ_FILE) > 0;
  if (file < 0 && others_are_open) file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
  Hdf5Handle opened(file, H5Fclose, "open " + path.string());
  check_format(opened, path);
  return opened;
}

Hdf5Handle open_foreign_to_read(const std::filesystem::path& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return open_to_read(path);
  Hdf5Handle opened(file, H5Fclose, "open " + path.string());
  // Another program may mean something else by an attribute of this name.
  if (H5Aexists(opened, "hamflow") > 0) check_format(opened, path);
  return opened;
}

bool has_object(hid_t file, const std::string& path) {
  for (std::size_t end = path.find('/'); end != std::string::npos; end = path.find('/', end + 1)) {
    if (H5Lexists(file, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Lexists(file, path.c_str(), H5P_DEFAULT) > 0 && H5Oexists_by_name(file, path.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> names_in(hid_t group) {
  std::vector<std::string> names;
  const auto note = [](hid_t, const char* name, const H5L_info_t*, void* all) -> herr_t {
    static_cast<std::vector<std::string>*>(all)->emplace_back(name);
    return 0;
  };
  check_hdf5(H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, note, &names), "list the objects of a group");
  return names;
}

std::vector<std::string> attribute_names(hid_t object) {
  std::vector<std::string> names;
  const auto note = [](hid_t, const char* name, const H5A_info_t*, void* all) -> herr_t {
    static_cast<std::vector<std::string>*>(all)->emplace_back(name);
    return 0;
  };
  check_hdf5(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, note, &names), "list the attributes");
  return names;
}

StoredData::StoredData(Hdf5Handle object, Hdf5Handle type, Hdf5Handle space, std::string name, bool is_dataset)
    : name_(std::move(name)),
      object_(std::move(object)),
      type_(std::move(type)),
      space_(std::move(space)),
      is_dataset_(is_dataset),
      kind_(kind_of_type(type_)) {
  const H5S_class_t extent = H5Sget_simple_extent_type(space_);
  is_null_ = extent == H5S_NULL;
  if (extent == H5S_NO_CLASS) throw FileError("HDF5: the data space of " + name_ + " cannot be read");
  const int rank = H5Sget_simple_extent_ndims(space_);
  if (rank < 0) throw FileError("HDF5: the rank of " + name_ + " cannot be read");
  shape_.resize(static_cast<std::size_t>(rank));
  if (rank > 0) check_hdf5(H5Sget_simple_extent_dims(space_, shape_.data(), nullptr), "read the size of " + name_);
  // more than any disk holds, and multiplied by the size of a value it does not overflow
  constexpr hsize_t most_values = hsize_t{1} << 42;
  hsize_t values = 1;
  for (const hsize_t size : shape_) {
    if (size > most_values / values) throw FileError("HDF5: " + name_ + " states an impossible size");
    values *= std::max<hsize_t>(size, 1);
  }
}

StoredData StoredData::dataset(hid_t file, const std::string& path) {
  const std::string name = "dataset " + path;
  if (!has_object(file, path)) throw FileError("HDF5: " + name + " does not exist");
  Hdf5Handle object(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose, "open " + name);
  Hdf5Handle type(H5Dget_type(object), H5Tclose, "read the type of " + name);
  Hdf5Handle space(H5Dget_space(object), H5Sclose, "open the space of " + name);
  const Hdf5Handle creation(H5Dget_create_plist(object), H5Pclose, "read how " + name + " is stored");
  if (H5Pget_layout(creation) == H5D_VIRTUAL || H5Pget_external_count(creation) != 0) {
    throw FileError("HDF5: the values of " + name + " are in other files");
  }
  return {std::move(object), std::move(type), std::move(space), name, true};
}

StoredData StoredData::attribute(hid_t object, const std::string& name) {
  const std::string what = "attribute " + name;
  Hdf5Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "open " + what);
  Hdf5Handle type(H5Aget_type(attribute), H5Tclose, "read the type of " + what);
  Hdf5Handle space(H5Aget_space(attribute), H5Sclose, "open the space of " + what);
  return {std::move(attribute), std::move(type), std::move(space), what, false};
}

std::size_t StoredData::rows() const {
  if (is_null_) return 0;
  return shape_.empty() ? 1 : static_cast<std::size_t>(shape_[0]);
}

std::size_t StoredData::width() const {
  std::size_t width = 1;
  for (std::size_t k = 1; k < shape_.size(); ++k) width *= static_cast<std::size_t>(shape_[k]);
  return width;
}

void StoredData::check_size(std::size_t values, std::size_t bytes_each) const {
  // twice the data that a writer may not have written yet
  constexpr std::uintmax_t never_too_much = std::uintmax_t{1} << 24;
  const bool overflows = bytes_each > (std::size_t{1} << 20) && values > (std::size_t{1} << 20);
  const std::uintmax_t bytes = overflows ? 0 : std::uintmax_t{values} * bytes_each;
  if (!overflows && bytes <= never_too_much) return;
  if (overflows || !is_dataset_ || bytes - never_too_much > most_bytes_of(object_)) {
    throw FileError("HDF5: " + name_ + " states an impossible size");
  }
}

void StoredData::require(Kind kind) const {
  if (kind_ == kind && !is_null_) return;
  throw FileError("HDF5: " + name_ + " holds " + (is_null_ ? "nothing" : "values of another type") + ", not " +
                  (kind == Kind::numbers ? "numbers" : "texts"));
}

std::vector<char> StoredData::read_rows(hid_t as, std::size_t first, std::size_t count) const {
  if (first > rows() || count > rows() - first) {
    throw FileError("HDF5: " + name_ + " has " + std::to_string(rows()) + " rows, not " +
                    std::to_string(first + count));
  }
  const std::size_t size = H5Tget_size(as);
  check_size(count * width(), std::max(size, H5Tget_size(type_)));
  std::vector<char> bytes(count * width() * size);
  if (bytes.empty()) return bytes;
  if (!is_dataset_) {  // attributes are only read as a whole
    if (first != 0 || count != rows()) throw FileError("HDF5: a part of " + name_ + " cannot be read");
    check_hdf5(H5Aread(object_, as, bytes.data()), "read " + name_);
    return bytes;
  }
  std::vector<hsize_t> counts = shape_;
  std::vector<hsize_t> offset(shape_.size(), 0);
  const Hdf5Handle part(H5Scopy(space_), H5Sclose, "copy a data space");
  if (!shape_.empty()) {
    counts[0] = count;
    offset[0] = first;
    check_hdf5(H5Sselect_hyperslab(part, H5S_SELECT_SET, offset.data(), nullptr, counts.data(), nullptr),
               "select rows of " + name_);
  }
  const Hdf5Handle memory = space_of_rows(counts);
  const auto read = [&] { return H5Dread(object_, as, memory, part, H5P_DEFAULT, bytes.data()); };
  // If a writer is just writing a chunk, its checksum is wrong; a moment later the chunk is complete.
  for (int attempt = 1; attempt < 3; ++attempt) {
    if (read() >= 0) return bytes;
  }
  check_hdf5(read(), "read " + name_);
  return bytes;
}

std::vector<char> StoredData::bytes_of_rows(std::size_t first, std::size_t count) const {
  return read_rows(type_, first, count);
}

std::vector<double> StoredData::numbers_of(std::size_t first, std::size_t count) const {
  require(Kind::numbers);
  const std::vector<char> bytes = read_rows(H5T_NATIVE_DOUBLE, first, count);
  std::vector<double> numbers(bytes.size() / sizeof(double));
  if (!bytes.empty()) std::memcpy(numbers.data(), bytes.data(), bytes.size());
  return numbers;
}

std::vector<std::string> StoredData::texts_of(std::size_t first, std::size_t count) const {
  require(Kind::texts);
  const std::size_t length = H5Tget_size(type_);
  if (H5Tis_variable_str(type_) != 0 || length == 0) {
    throw FileError("HDF5: " + name_ + " does not contain texts of one length");
  }
  const std::vector<char> bytes = read_rows(type_, first, count);
  std::vector<std::string> texts;
  texts.reserve(bytes.size() / length);
  for (std::size_t at = 0; at < bytes.size(); at += length) {
    const std::string_view text(bytes.data() + at, length);
    texts.emplace_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

std::vector<double> StoredData::numbers() const { return numbers_of(0, rows()); }
std::vector<double> StoredData::numbers_of_row(std::size_t row) const { return numbers_of(row, 1); }
std::vector<std::string> StoredData::texts() const { return texts_of(0, rows()); }
std::vector<std::string> StoredData::texts_of_row(std::size_t row) const { return texts_of(row, 1); }

std::string StoredData::text() const {
  require(Kind::texts);
  if (rows() != 1 || width() != 1) throw FileError("HDF5: " + name_ + " contains several texts, not one");
  const std::vector<char> bytes = read_rows(type_, 0, 1);
  if (H5Tis_variable_str(type_) == 0) return {bytes.data(), bytes.size()};
  char* text = nullptr;
  std::memcpy(&text, bytes.data(), sizeof text);
  std::string copy = text != nullptr ? text : "";
  (void)H5free_memory(text);
  return copy;
}

std::string text_attribute(hid_t object, const std::string& name) {
  if (H5Aexists(object, name.c_str()) <= 0) return {};
  const std::string text = StoredData::attribute(object, name).text();
  return text.substr(0, text.find('\0'));
}

double number_attribute(hid_t object, const std::string& name) {
  const StoredData attribute = StoredData::attribute(object, name);
  const std::vector<double> numbers = attribute.numbers();
  if (numbers.size() != 1) throw FileError("HDF5: " + attribute.name() + " is not one number");
  return numbers[0];
}

void copy_attribute(hid_t from, hid_t to, const std::string& name) {
  const StoredData source = StoredData::attribute(from, name);
  if (H5Tdetect_class(source.type(), H5T_REFERENCE) != 0) {
    throw FileError("HDF5: " + source.name() + " refers to objects of its file");
  }
  const Hdf5Handle type(H5Tcopy(source.type()), H5Tclose, "copy a type");  // a named type belongs to its file
  const Hdf5Handle target(H5Acreate2(to, name.c_str(), type, source.space(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                          "create " + source.name());
  std::vector<char> bytes = source.bytes_of_rows(0, source.rows());
  if (bytes.empty()) return;
  const herr_t written = H5Awrite(target, type, bytes.data());
  (void)H5Dvlen_reclaim(type, source.space(), H5P_DEFAULT, bytes.data());
  check_hdf5(written, "write " + source.name());
}

}  // namespace hamflow
