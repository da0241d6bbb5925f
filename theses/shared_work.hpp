// Pieces of one experiment's work, for the threads that have no experiment left to take: the longest experiment would
// else end alone.
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
  /// @param threads that each call help() once, when they have no experiment left
  explicit SharedWork(std::size_t threads) : busy_(threads) {}

  /// Calls piece(0) to piece(count - 1), each once, on this thread and on those that help, in any order, and returns
  /// when all have returned.   @throws what the first piece that failed threw; pieces not begun are left out
  void each(std::size_t count, const std::function<void(std::size_t)>& piece);

  /// So many of the threads were never started.
  void go_without(std::size_t threads);

  /// Takes pieces until every thread has come here.
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
  std::list<Job*> jobs_;  // with pieces that are not begun, or are not done
  std::size_t busy_;
};

}  // namespace hamflow::reproduction
