// The one place that reads HDF5. A file may be damaged, and its user may have added objects to it: the class of a type,
// the rank, the extent and the size are checked before anything is read. Nothing else in hamflow calls H5Dread or
// H5Aread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hdf5_handle.hpp"

namespace hamflow {

/// HDF5 prints its error stack by default; our messages say what failed. To be called before anything else of HDF5.
void silence_hdf5();

/// Opens what a writer has open or a crash has left. A reader beside a writer may meet metadata half written and tries
/// again, each time twice as long after. HDF5's own 100 attempts would wait for ever on a damaged file; 24 are over in
/// a few hundredths of a second each. @throws FileError
Hdf5Handle open_to_read(const std::filesystem::path& path);

/// Opens a file of any program. Where nobody writes it the library checks every address against the end of the file,
/// which it cannot do beside a writer: in a damaged file of the older formats it would read gigabytes that are not
/// there.
/// @throws FileError
Hdf5Handle open_foreign_to_read(const std::filesystem::path& path);

/// Whether every link of the path is there and leads to an object.
bool has_object(hid_t file, const std::string& path);

/// The names of the links in a group, without a limit to their length. @throws FileError
std::vector<std::string> names_in(hid_t group);
/// The names of the attributes of an object. @throws FileError
std::vector<std::string> attribute_names(hid_t object);

/// A dataset or an attribute, open to be read. Each function checks what it reads and throws FileError otherwise.
class StoredData {
 public:
  enum class Kind { numbers, texts, other };

  static StoredData dataset(hid_t file, const std::string& path);
  static StoredData attribute(hid_t object, const std::string& name);

  const std::string& name() const { return name_; }
  Kind kind() const { return kind_; }
  /// Empty: one value, or nothing at all, as of a null data space.
  const std::vector<hsize_t>& shape() const { return shape_; }
  /// Of the first dimension; 1 of one value.
  std::size_t rows() const;
  /// Values a row.
  std::size_t width() const;

  std::vector<double> numbers() const;
  std::vector<double> numbers_of_row(std::size_t row) const;
  /// Texts of one length, without the zero bytes that fill them.
  std::vector<std::string> texts() const;
  std::vector<std::string> texts_of_row(std::size_t row) const;
  /// One text, of fixed or of variable length, with all its bytes.
  std::string text() const;
  /// `count` rows from `first` on as they are stored: bytes of the type of the file, some at a time. @throws FileError
  std::vector<char> bytes_of_rows(std::size_t first, std::size_t count) const;

  hid_t object() const { return object_; }
  hid_t type() const { return type_; }
  hid_t space() const { return space_; }

 private:
  StoredData(Hdf5Handle object, Hdf5Handle type, Hdf5Handle space, std::string name, bool is_dataset);
  /// @throws FileError where so many bytes cannot be in the file
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

/// Empty where there is no such attribute. @throws FileError where it is not one text
std::string text_attribute(hid_t object, const std::string& name);
/// @throws FileError where there is no such attribute, or it is not one number
double number_attribute(hid_t object, const std::string& name);

/// Copies an attribute of any type but references, which lead into their own file. @throws FileError
void copy_attribute(hid_t from, hid_t to, const std::string& name);

}  // namespace hamflow
