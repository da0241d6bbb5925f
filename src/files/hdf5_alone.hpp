// HDF5 as Debian builds it is for one thread at a time.
#pragma once

#include <mutex>

namespace hamflow {

/// Held by who calls HDF5 where other threads may: members of a sweep that start from a run's file are read beside each
/// other, and beside the table that is written.
[[nodiscard]] inline std::unique_lock<std::mutex> alone_with_hdf5() {
  static std::mutex mutex;
  return std::unique_lock(mutex);
}

}  // namespace hamflow
