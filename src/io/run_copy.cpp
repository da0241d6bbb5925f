#include "run_copy.hpp"

#include <algorithm>
#include <new>
#include <set>
#include <stdexcept>

#include "hdf5_text.hpp"
#include "stored_column.hpp"
#include "whole_file.hpp"

namespace hamflow {

namespace {

/// Objects that the copy does not take from the source.
constexpr const char* written_anew[] = {"q", "p", "scenario", "digits"};
/// Tables that are left out, because their rows are states in the old coordinates at other times than the samples.
constexpr const char* left_out_tables[] = {"section", "events/wall", "events/user"};

bool is_one_of(const auto& names, const std::string& path) {
  return std::find(std::begin(names), std::end(names), path) != std::end(names);
}

/// Returns whether a path is a dataset of hamflow with a row for each sample. Damage in these is an error.
bool is_of_samples(const std::string& path) {
  constexpr std::string_view folders[] = {"invariants/", "observables/", "solver/"};
  return path == "t" || path == "step" || path == "energy" || path == "events/halved" ||
         std::any_of(std::begin(energy_range_columns), std::end(energy_range_columns),
                     [&](const NamedColumn& column) { return path == column.name; }) ||
         std::any_of(std::begin(folders), std::end(folders),
                     [&](std::string_view folder) { return path.starts_with(folder); });
}

/// The target cannot be written.
struct WriteError : FileError {
  using FileError::FileError;
};

bool holds_numbers(hid_t file, const std::string& path) {
  try {
    return StoredData::dataset(file, path).kind() == StoredData::Kind::numbers;
  } catch (const FileError&) {
    return true;
  }
}

/// Copies object by object. H5Ocopy needs only one call, but it crashes on a damaged file and on a full disk.
class Copy {
 public:
  Copy(hid_t from, hid_t to, hsize_t rows) : from_(from), to_(to), rows_(rows) {}

  void attributes_of_file() {
    for (const std::string& name : attribute_names(from_)) {
      // The names of coordinates differ in the copy, and no run can be resumed with its samples.
      if (name != "coordinates" && name != "momenta" && name != "run") copy_one(from_, to_, "", name);
    }
  }

  void group(const std::string& path) {
    const Hdf5Handle here(H5Gopen2(from_, path.empty() ? "/" : path.c_str(), H5P_DEFAULT), H5Gclose,
                          "open group " + path);
    if (!is_new(here)) return leave_out(path, "the same group was copied under another name");
    if (!path.empty()) attributes(here, make_group(to_, path), path);
    for (const std::string& name : names_in(here)) object(path.empty() ? name : path + "/" + name);
  }

  /// Copies attributes that a user has added to the objects of the copy.
  void attributes_beside(const std::string& path) {
    if (!has_object(from_, path) || !has_object(to_, path)) return;
    attributes(Hdf5Handle(H5Oopen(from_, path.c_str(), H5P_DEFAULT), H5Oclose, "open " + path),
               Hdf5Handle(H5Oopen(to_, path.c_str(), H5P_DEFAULT), H5Oclose, "open " + path), path);
  }

  OmittedFromCopy left_out() { return std::move(left_out_); }

 private:
  void leave_out(const std::string& path, const std::string& why) {
    left_out_.others.push_back("/" + path + " (" + why + ")");
  }

  /// Returns whether a group was not visited yet, because groups may contain each other.
  bool is_new(hid_t group) {
    H5O_info_t info{};
    check_hdf5(H5Oget_info2(group, &info, H5O_INFO_BASIC), "read the address of a group");
    return groups_.emplace(info.fileno, info.addr).second;
  }

  void copy_one(hid_t from, hid_t to, const std::string& path, const std::string& name) {
    try {
      copy_attribute(from, to, name);
    } catch (const FileError& error) {
      leave_out(path, error.what());
    }
  }

  void attributes(hid_t from, hid_t to, const std::string& path) {
    for (const std::string& name : attribute_names(from)) {
      if (H5Aexists(to, name.c_str()) <= 0) copy_one(from, to, path, name);
    }
  }

  void object(const std::string& path) {
    if (is_one_of(written_anew, path)) return;
    if (is_one_of(left_out_tables, path)) {
      left_out_.tables.push_back("/" + path);
      return;
    }
    H5L_info_t link{};
    check_hdf5(H5Lget_info(from_, path.c_str(), &link, H5P_DEFAULT), "look at " + path);
    if (link.type != H5L_TYPE_HARD) return leave_out(path, "a link");
    H5I_type_t kind = H5I_BADID;
    {
      const Hdf5Handle object(H5Oopen(from_, path.c_str(), H5P_DEFAULT), H5Oclose, "open " + path);
      kind = H5Iget_type(object);
    }
    if (kind == H5I_GROUP) return group(path);
    if (kind != H5I_DATASET) return leave_out(path, "neither a group nor a dataset");
    try {
      dataset(path);
    } catch (const WriteError&) {
      throw;
    } catch (const FileError& error) {
      if (is_of_samples(path) && holds_numbers(from_, path)) throw;
      (void)H5Ldelete(to_, path.c_str(), H5P_DEFAULT);  // removes the incomplete copy
      leave_out(path, error.what());
    }
  }

  /// Copies some rows at a time, so that a long run does not fill the memory.
  void dataset(const std::string& path) {
    const StoredData source = StoredData::dataset(from_, path);
    const std::string& name = source.name();
    const bool cut = is_of_samples(path) && !source.shape().empty() && source.rows() > rows_;
    if (H5Tdetect_class(source.type(), H5T_REFERENCE) != 0) throw FileError("it refers to objects of its file");
    const Hdf5Handle type(H5Tcopy(source.type()), H5Tclose, "copy a type");  // a named type belongs to its file
    const Hdf5Handle creation(H5Dget_create_plist(source.object()), H5Pclose, "read the chunks of " + name);
    const Hdf5Handle space(H5Scopy(source.space()), H5Sclose, "copy the space of " + name);
    const std::size_t rows = cut ? static_cast<std::size_t>(rows_) : source.rows();
    std::vector<hsize_t> size = source.shape();
    if (cut) {
      std::vector<hsize_t> most(size.size());
      check_hdf5(H5Sget_simple_extent_dims(space, nullptr, most.data()), "read the size of " + name);
      size[0] = rows;
      check_hdf5(H5Sset_extent_simple(space, static_cast<int>(size.size()), size.data(), most.data()),
                 "choose the rows of " + name);
    }
    const Hdf5Handle target(H5Dcreate2(to_, path.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose,
                            "create " + name);
    attributes(source.object(), target, path);
    constexpr std::size_t bytes_at_once = std::size_t{1} << 23;
    const std::size_t row_bytes = std::max<std::size_t>(H5Tget_size(type) * source.width(), 1);
    const std::size_t at_once = std::max<std::size_t>(bytes_at_once / row_bytes, 1);
    for (std::size_t row = 0; row < rows; row += at_once) {
      const std::size_t count = std::min(at_once, rows - row);
      write_part(source, target, space, size, row, count);
    }
  }

  static void write_part(const StoredData& source, hid_t target, hid_t space, std::vector<hsize_t> size,
                         std::size_t row, std::size_t count) {
    std::vector<char> bytes = source.bytes_of_rows(row, count);
    if (bytes.empty()) return;
    std::vector<hsize_t> first(size.size(), 0);
    if (!size.empty()) {
      first[0] = row;
      size[0] = count;
      check_hdf5(H5Sselect_hyperslab(space, H5S_SELECT_SET, first.data(), nullptr, size.data(), nullptr),
                 "select rows of " + source.name());
    }
    const Hdf5Handle memory(
        size.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr),
        H5Sclose, "make a data space");
    const herr_t written = H5Dwrite(target, source.type(), memory, space, H5P_DEFAULT, bytes.data());
    if (H5Tdetect_class(source.type(), H5T_VLEN) != 0 || H5Tdetect_class(source.type(), H5T_STRING) != 0) {
      (void)H5Dvlen_reclaim(source.type(), memory, H5P_DEFAULT,
                            bytes.data());  // does nothing for texts of fixed length
    }
    if (written < 0) throw WriteError("HDF5: cannot write " + source.name());
  }

  hid_t from_;
  hid_t to_;
  hsize_t rows_;
  std::set<std::pair<unsigned long, haddr_t>> groups_;
  OmittedFromCopy left_out_;
};

void write_states(hid_t file, const Table& states) {
  if (states.find("digits/t") != nullptr) (void)make_group(file, "digits");
  for (const Column& column : states.columns()) {
    StoredColumn(file, column.name(), column.info(), states.rows()).write(column);
  }
}

OmittedFromCopy copy(const std::filesystem::path& source, const std::filesystem::path& target,
                     const ConvertedStates& states) {
  const Hdf5Handle from = open_to_read(source);
  if (has_object(from, "particles/all")) {
    throw FileError(source.string() + " contains particles, which have no other coordinates");
  }
  WholeFile whole(target);
  Hdf5Handle to = create_hdf5(whole.part());
  Copy copy(from, to, states.table.rows());
  copy.attributes_of_file();
  if (!states.coordinates.empty()) write_attribute(to, "coordinates", states.coordinates);
  if (!states.momenta.empty()) write_attribute(to, "momenta", states.momenta);
  copy.group("");
  write_text_dataset(to, "scenario", states.scenario);
  write_states(to, states.table);
  for (const char* name : {"q", "p", "digits", "digits/q", "digits/p", "digits/t", "digits/energy"}) {
    copy.attributes_beside(name);
  }
  to.close_now("write " + target.string() + " (is the disk full?)");
  whole.put_in_place();
  return copy.left_out();
}

}  // namespace

OmittedFromCopy copy_run_file(const std::filesystem::path& source, const std::filesystem::path& target,
                              const ConvertedStates& states) {
  silence_hdf5();
  try {
    return copy(source, target, states);
  } catch (const std::bad_alloc&) {
    throw FileError(source.string() + " cannot be copied: it states an impossible size");
  } catch (const std::length_error&) {
    throw FileError(source.string() + " cannot be copied: it states an impossible size");
  }
}

}  // namespace hamflow
