#include "stored_column.hpp"

#include <algorithm>
#include <bit>

#include "hdf5_text.hpp"

namespace hamflow {

static_assert(std::endian::native == std::endian::little, "numbers are written in the byte order of memory");

namespace {

/// Every chunk has a Fletcher32 checksum, so that damage is an error instead of wrong data. A chunk that is not full
/// yet is written again by each flush, at the same place. Therefore it fills at most one memory page, and create_hdf5()
/// aligns it to a page: a kill interrupts a write only between pages, so a chunk is never half old and half new, which
/// its checksum would report as damage of all its rows.
constexpr std::size_t page = 4096;
constexpr std::size_t checksum = 4;

std::size_t rows_of_chunk(std::size_t bytes_of_row, std::size_t rows) {
  const std::size_t on_a_page = std::max<std::size_t>((page - checksum) / bytes_of_row, 1);
  return std::min(on_a_page, std::max<std::size_t>(rows, 16));
}

Hdf5Handle chunks(int rank, const hsize_t* chunk) {
  Hdf5Handle plist(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make a property list");
  check_hdf5(H5Pset_chunk(plist, rank, chunk), "choose the chunks");
  check_hdf5(H5Pset_fletcher32(plist), "choose a checksum");
  return plist;
}

}  // namespace

Hdf5Handle digits_type(std::size_t length) {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a text type");
  check_hdf5(H5Tset_size(type, length), "size a text type");
  check_hdf5(H5Tset_strpad(type, H5T_STR_NULLPAD), "fill up a text type");
  return type;
}

namespace {

Hdf5Handle stored_type(const ColumnInfo& info) {
  if (info.type == ValueType::text) return digits_type(info.text_size);
  return {H5Tcopy(info.type == ValueType::number ? H5T_IEEE_F64LE : H5T_STD_I64LE), H5Tclose, "copy a type"};
}

}  // namespace

StoredColumn::StoredColumn(hid_t file, std::string path, const ColumnInfo& info, std::size_t rows, std::size_t of_each)
    : path_(std::move(path)),
      rank_(of_each > 0   ? 3
            : info.scalar ? 1
                          : 2),
      width_(std::max<std::size_t>(info.width, 1)),
      of_each_(std::max<std::size_t>(of_each, 1)),
      type_(stored_type(info)),
      bytes_of_row_(H5Tget_size(type_) * width_) {
  const Shape size = shape(0);
  const Shape most = shape(H5S_UNLIMITED);
  const Hdf5Handle space(H5Screate_simple(rank_, size.data(), most.data()), H5Sclose, "make a data space");
  const Hdf5Handle plist = chunks(rank_, shape(rows_of_chunk(bytes_of_row_, rows)).data());
  dataset_ = Hdf5Handle(H5Dcreate2(file, path_.c_str(), type_, space, H5P_DEFAULT, plist, H5P_DEFAULT), H5Dclose,
                        "create dataset " + path_);
  if (!info.parts.empty()) write_attribute(dataset_, "columns", info.parts);
  if (!info.meaning.empty()) write_attribute(dataset_, "meaning", info.meaning);
  if (!info.unit.empty()) write_attribute(dataset_, "unit", info.unit);
}

void StoredColumn::copy_from(hid_t other, std::uint64_t rows, std::size_t at_once) {
  const StoredData source = StoredData::dataset(other, path_);
  const std::size_t found = source.rows();
  if (H5Tequal(source.type(), type_) <= 0 || source.shape().size() != static_cast<std::size_t>(rank_)) {
    throw FileError("HDF5: " + source.name() + " has another shape");
  }
  const Shape size = shape(found);
  if (!std::equal(source.shape().begin(), source.shape().end(), size.begin())) {
    throw FileError("HDF5: " + source.name() + " has another width");
  }
  if (found < rows) {
    throw FileError("HDF5: dataset " + path_ + " has " + std::to_string(found) + " rows, but the checkpoint needs " +
                    std::to_string(rows));
  }
  while (written_ < rows) {
    const std::size_t count = std::min<std::size_t>(rows - written_, at_once);
    const std::vector<char> bytes = source.bytes_of_rows(written_, count);
    write(bytes.data(), count);
  }
}

void StoredColumn::write(const void* bytes, std::size_t rows) {
  if (rows == 0) return;
  const Shape size = shape(written_ + rows);
  const Shape offset{written_, 0, 0};
  const Shape count = shape(rows);
  check_hdf5(H5Dset_extent(dataset_, size.data()), "extend dataset " + path_);
  const Hdf5Handle space(H5Dget_space(dataset_), H5Sclose, "open the space of " + path_);
  check_hdf5(H5Sselect_hyperslab(space, H5S_SELECT_SET, offset.data(), nullptr, count.data(), nullptr),
             "select rows of " + path_);
  const Hdf5Handle memory(H5Screate_simple(rank_, count.data(), nullptr), H5Sclose, "make a data space");
  check_hdf5(H5Dwrite(dataset_, type_, memory, space, H5P_DEFAULT, bytes), "write " + path_);
  check_hdf5(H5Dflush(dataset_), "flush " + path_);
  written_ += rows;
}

}  // namespace hamflow
