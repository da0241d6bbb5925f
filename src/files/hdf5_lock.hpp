// Debian builds HDF5 without support for threads, so only one thread may call it at a time.
#pragma once

#include <mutex>

namespace hamflow {

/// Returns a lock. Hold it around calls of HDF5 if other threads may call HDF5, too: members of a sweep that start from
/// a run's file are read at the same time, and while the table is written.
[[nodiscard]] inline std::unique_lock<std::mutex> lock_hdf5() {
  static std::mutex mutex;
  return std::unique_lock(mutex);
}

}  // namespace hamflow
