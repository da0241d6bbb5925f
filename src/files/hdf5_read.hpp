// Reads HDF5. A file may be damaged, and its user may have added objects. Therefore the class of the type, the rank,
// the extents and the size are checked before anything is read. Nothing else in hamflow calls H5Dread or H5Aread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hdf5_handle.hpp"

namespace hamflow {

/// Keeps HDF5 from printing its error stack; the messages of hamflow say what failed. Call it before any other function
/// of HDF5.
void silence_hdf5();

/// Opens a file that a writer has open or a crash has left. A reader may find half-written metadata and tries again,
/// doubling the waiting time. HDF5's default of 100 attempts would wait forever on a damaged file; 24 attempts take a
/// few hundredths of a second. @throws FileError
Hdf5Handle open_to_read(const std::filesystem::path& path);

/// Opens a file of any program. If nobody writes it, the library checks every address against the end of the file,
/// which is impossible beside a writer. Without this check it would try to read gigabytes that do not exist from a
/// damaged file in an older format.
/// @throws FileError
Hdf5Handle open_foreign_to_read(const std::filesystem::path& path);

/// Returns whether every link of the path exists and leads to an object.
bool has_object(hid_t file, const std::string& path);

/// Returns the names of the links in a group, whatever their length. @throws FileError
std::vector<std::string> names_in(hid_t group);
/// Returns the names of an object's attributes. @throws FileError
std::vector<std::string> attribute_names(hid_t object);

/// A dataset or an attribute, open for reading. Each function checks the stored object, and throws FileError if it does
/// not fit.
class StoredData {
 public:
  enum class Kind { numbers, texts, other };

  static StoredData dataset(hid_t file, const std::string& path);
  static StoredData attribute(hid_t object, const std::string& name);

  const std::string& name() const { return name_; }
  Kind kind() const { return kind_; }
  /// Extents. Empty: a single value, or no value if the data space is null.
  const std::vector<hsize_t>& shape() const { return shape_; }
  /// Extent of the first dimension; 1 for a single value.
  std::size_t rows() const;
  /// Number of values in a row.
  std::size_t width() const;

  std::vector<double> numbers() const;
  std::vector<double> numbers_of_row(std::size_t row) const;
  /// Returns texts of fixed length, without the zero bytes at their ends.
  std::vector<std::string> texts() const;
  std::vector<std::string> texts_of_row(std::size_t row) const;
  /// Returns one text, of fixed or variable length, with all its bytes.
  std::string text() const;
  /// Returns the bytes of `count` rows from `first` on, in the type of the file. @throws FileError
  std::vector<char> bytes_of_rows(std::size_t first, std::size_t count) const;

  hid_t object() const { return object_; }
  hid_t type() const { return type_; }
  hid_t space() const { return space_; }

 private:
  StoredData(Hdf5Handle object, Hdf5Handle type, Hdf5Handle space, std::string name, bool is_dataset);
  /// @throws FileError if the file is too small for this many bytes
  void check_size(std::size_t values, std::size_t bytes_each) const;
  void require(Kind kind) const;
  std::vector<char> read_rows(hid_t as, std::size_t first, std::size_t count) const;
  std::vector<double> numbers_of(std::size_t first, std::size_t count) const;
  std::vector<std::string> texts_of(std::size_t first, std::size_t count) const;

  std::string name_;
  Hdf5Handle object_;
  Hdf5Handle type_;
  Hdf5Handle space_;
  bool is_dataset_;
  bool is_null_ = false;
  Kind kind_ = Kind::other;
  std::vector<hsize_t> shape_;
};

/// Returns an attribute; empty if it does not exist. @throws FileError if it is not a single text
std::string text_attribute(hid_t object, const std::string& name);
/// @throws FileError if the attribute does not exist, or is not a single number
double number_attribute(hid_t object, const std::string& name);

/// Copies an attribute of any type except references, because these point into their own file. @throws FileError
void copy_attribute(hid_t from, hid_t to, const std::string& name);

}  // namespace hamflow
