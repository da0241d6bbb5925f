// Runs the same work on several threads.
#pragma once

#include <exception>
#include <mutex>
#include <system_error>
#include <vector>

#include "hamflow/detail/core/thread.hpp"

namespace hamflow {

/// Passes an exception of a thread on to the caller. If the system starts fewer threads, these do all the work, with
/// the same bits.   @return number of threads, including the caller's
template <class Work>
int on_threads(int threads, const Work& work) {
  std::exception_ptr trouble;
  std::mutex mutex;
  const auto guarded = [&] {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!trouble) trouble = std::current_exception();
    }
  };
  int started = 1;
  {
    std::vector<Thread> others;
    try {
      for (; started < threads; ++started) others.emplace_back(guarded);
    } catch (const std::system_error&) {  // NOLINT: told by the number
    }
    guarded();
  }
  if (trouble) std::rethrow_exception(trouble);
  return started;
}

}  // namespace hamflow
