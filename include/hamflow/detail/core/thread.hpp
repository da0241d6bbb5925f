// A thread that is joined when it is destroyed. In a portable build there is none: as on a system that starts no more.
#pragma once

#include <system_error>
#ifndef HAMFLOW_PORTABLE
#include <thread>
#endif

namespace hamflow {

#ifdef HAMFLOW_PORTABLE
inline constexpr bool has_threads = false;
class Thread {
 public:
  /// @throws std::system_error
  template <class Work>
  explicit Thread(const Work&) {
    throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
  }
};
inline unsigned processors() { return 1; }
#else
inline constexpr bool has_threads = true;
using Thread = std::jthread;
inline unsigned processors() { return std::thread::hardware_concurrency(); }
#endif

}  // namespace hamflow
