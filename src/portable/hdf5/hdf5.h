// HDF5 in a portable build, which has none: the names that hamflow uses. Opening or making a file says that there is no
// HDF5; nothing else is ever reached. So src/files and src/io are compiled as they are.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hamflow/core/error.hpp"

using hid_t = std::int64_t;
using herr_t = int;
using hsize_t = unsigned long long;
using haddr_t = std::uint64_t;
using H5I_type_t = int;
using H5S_class_t = int;
using H5T_class_t = int;
using H5Z_filter_t = int;
struct H5A_info_t {};
struct H5L_info_t {
  int type = 0;
};
struct H5O_info_t {
  unsigned long fileno = 0;
  haddr_t addr = 0;
};

// clang-format off
#define HAMFLOW_HDF5_NUMBERS(X) X(H5D_VIRTUAL) X(H5E_DEFAULT) X(H5F_ACC_EXCL) X(H5F_ACC_RDONLY) X(H5F_ACC_SWMR_READ) \
  X(H5F_LIBVER_LATEST) X(H5F_OBJ_ALL) X(H5F_OBJ_FILE) X(H5I_BADID) X(H5I_DATASET) X(H5I_GROUP) X(H5L_TYPE_HARD) \
  X(H5O_INFO_BASIC) X(H5P_DATASET_CREATE) X(H5P_DEFAULT) X(H5P_FILE_ACCESS) X(H5P_LINK_CREATE) X(H5S_ALL) \
  X(H5S_NO_CLASS) X(H5S_NULL) X(H5S_SCALAR) X(H5S_SELECT_SET) X(H5T_CSET_UTF8) X(H5T_C_S1) X(H5T_FLOAT) \
  X(H5T_IEEE_F64LE) X(H5T_INTEGER) X(H5T_NATIVE_DOUBLE) X(H5T_NATIVE_INT) X(H5T_NATIVE_INT64) X(H5T_REFERENCE) \
  X(H5T_STD_I32LE) X(H5T_STD_I64LE) X(H5T_STRING) X(H5T_STR_NULLPAD) X(H5T_VLEN) X(H5Z_FILTER_FLETCHER32) \
  X(H5Z_FILTER_SHUFFLE) X(H5_INDEX_NAME) X(H5_ITER_INC)
#define HAMFLOW_HDF5_CLOSES(X) X(H5Aclose) X(H5Dclose) X(H5Fclose) X(H5Gclose) X(H5Oclose) X(H5Pclose) X(H5Sclose) \
  X(H5Tclose)
#define HAMFLOW_HDF5_FUNCTIONS(X) X(H5Acreate2) X(H5Aexists) X(H5Aget_space) X(H5Aget_type) X(H5Aiterate2) \
  X(H5Aopen) X(H5Aread) X(H5Awrite) X(H5Dcreate2) X(H5Dflush) X(H5Dget_create_plist) X(H5Dget_space) X(H5Dget_type) \
  X(H5Dopen2) X(H5Dread) X(H5Dset_extent) X(H5Dvlen_reclaim) X(H5Dwrite) X(H5Eset_auto2) X(H5Fget_name) \
  X(H5Fget_obj_count) X(H5Fis_hdf5) X(H5Fstart_swmr_write) X(H5Gcreate2) X(H5Gopen2) X(H5Iget_type) \
  X(H5Lcreate_hard) X(H5Ldelete) X(H5Lexists) X(H5Lget_info) X(H5Literate) X(H5Ocopy) X(H5Oexists_by_name) \
  X(H5Oget_info2) X(H5Oopen) X(H5Pcreate) X(H5Pget_external_count) X(H5Pget_filter2) X(H5Pget_layout) \
  X(H5Pget_nfilters) X(H5Pset_alignment) X(H5Pset_chunk) X(H5Pset_create_intermediate_group) X(H5Pset_fletcher32) \
  X(H5Pset_libver_bounds) X(H5Pset_metadata_read_attempts) X(H5Pset_obj_track_times) X(H5Scopy) X(H5Screate) \
  X(H5Screate_simple) X(H5Sget_simple_extent_dims) X(H5Sget_simple_extent_ndims) X(H5Sget_simple_extent_type) \
  X(H5Sselect_hyperslab) X(H5Sset_extent_simple) X(H5Tcopy) X(H5Tdetect_class) X(H5Tequal) X(H5Tget_class) \
  X(H5Tis_variable_str) X(H5Tset_cset) X(H5Tset_size) X(H5Tset_strpad) X(H5dont_atexit) X(H5free_memory)
// clang-format on

#define HAMFLOW_ABSENT(name) inline constexpr int name = 0;
HAMFLOW_HDF5_NUMBERS(HAMFLOW_ABSENT)
inline constexpr hsize_t H5S_UNLIMITED = 0;
#undef HAMFLOW_ABSENT
#define HAMFLOW_ABSENT(name) \
  inline herr_t name(hid_t) { return -1; }
HAMFLOW_HDF5_CLOSES(HAMFLOW_ABSENT)
#undef HAMFLOW_ABSENT
#define HAMFLOW_ABSENT(name)  \
  template <class... Any>     \
  int name(const Any&...) {   \
    return -1;                \
  }
HAMFLOW_HDF5_FUNCTIONS(HAMFLOW_ABSENT)
#undef HAMFLOW_ABSENT
inline std::size_t H5Tget_size(hid_t) { return 0; }
inline hsize_t H5Dget_storage_size(hid_t) { return 0; }

template <class... Any>
hid_t H5Fopen(const char* path, const Any&...) {
  throw hamflow::FileError(std::string(path) + ": a portable build of hamflow has no HDF5; allowed runs in memory");
}
template <class... Any>
hid_t H5Fcreate(const char* path, const Any&...) {
  return H5Fopen(path);
}
