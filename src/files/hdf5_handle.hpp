// Owning handles for the C API of HDF5. The C++ API of HDF5 1.10 has no SWMR calls.
#pragma once

#include <hdf5.h>

#include <string>
#include <utility>

#include "hamflow/core/error.hpp"

namespace hamflow {

/// Closes its identifier with the function that belongs to its kind.
class Hdf5Handle {
 public:
  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
    if (id < 0) throw FileError("HDF5: cannot " + what);
  }
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  /// Closes now, so that data that cannot be written cause an error. @throws FileError
  void close_now(const std::string& what) {
    const hid_t id = std::exchange(id_, -1);
    if (id >= 0 && close_(id) < 0) throw FileError("HDF5: cannot " + what);
  }
  operator hid_t() const { return id_; }  // NOLINT: so that it goes where the C API wants an identifier

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

inline void check_hdf5(herr_t status, const std::string& what) {
  if (status < 0) throw FileError("HDF5: cannot " + what);
}

}  // namespace hamflow
