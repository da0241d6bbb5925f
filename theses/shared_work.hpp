// Shares the work of one experiment with threads that have no experiment left. Without it, the longest experiment would
// run on a single thread at the end.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <list>
#include <mutex>

namespace hamflow::reproduction {

class SharedWork {
 public:
  /// @param threads the number of threads; each calls help() once, when it has no experiment left
  explicit SharedWork(std::size_t threads) : busy_(threads) {}

  /// Calls piece(0) to piece(count - 1) once each, in any order, on this thread and on threads in help(). Returns when
  /// all calls have returned.   @throws the exception of the first piece that failed; it skips pieces that have not
  /// started
  void each(std::size_t count, const std::function<void(std::size_t)>& piece);

  /// Reports that `threads` threads could not be started.
  void reduce_threads(std::size_t threads);

  /// Works on pieces until every thread has called help().
  void help();

 private:
  struct Job {
    std::size_t count = 0;
    const std::function<void(std::size_t)>* piece = nullptr;
    std::size_t next = 0;
    std::size_t running = 0;
    std::exception_ptr error{};
  };
  void take_one(Job& job, std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::list<Job*> jobs_;  // jobs with pieces that have not finished
  std::size_t busy_;
};

}  // namespace hamflow::reproduction
