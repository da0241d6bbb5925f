// Threads for pieces of work that take microseconds, such as the forces of one step. An idle thread spins for a while
// before it sleeps, and no piece of work allocates. Any free thread takes the next piece, so the result must not depend
// on which thread computes it, as for sums of integers.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "hamflow/core/error.hpp"
#include "hamflow/detail/core/thread.hpp"

namespace hamflow {

class ThreadTeam {
 public:
  /// @param size the number of workers, the caller of share() included
  /// Without threads (a portable build) the caller does all the work.
  /// @throws Error if the system cannot start so many threads
  explicit ThreadTeam(std::size_t size) : size_(size) {
    threads_.reserve(size);
    try {
      for (std::size_t worker = 1; has_threads && worker < size; ++worker)
        threads_.emplace_back([this, worker] { serve(worker); });
    } catch (const std::system_error& error) {
      const std::size_t started = threads_.size();
      dismiss();  // started threads sleep; without this the destructor would wait for ever
      throw Error("threads: found " + std::to_string(size) + "; allowed at most " + std::to_string(started + 1) +
                  ", the system starts no more (" + error.code().message() + ")");
    }
  }
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;
  ~ThreadTeam() { dismiss(); }

  std::size_t size() const { return size_; }
  static constexpr std::size_t most_blocks = 0xffffffff;

  /// Calls work(worker, call, block) for each block, on any worker, in any order, and returns when all are done. It
  /// does not wait for workers that wake up late and find no work. Only one thread may call it at a time; `work` must
  /// not throw.
  /// @param blocks at most most_blocks @return the number of this call, which `work` receives, too
  /// @throws Error for more blocks
  template <class Work>
  std::uint64_t share(std::size_t blocks, Work& work) {
    if (blocks > most_blocks) {
      throw Error("threads: " + std::to_string(blocks) + " blocks of work; allowed at most " +
                  std::to_string(most_blocks));
    }
    job_ = &work;
    run_ = [](void* job, std::size_t worker, std::uint64_t call, std::size_t block) {
      (*static_cast<Work*>(job))(worker, call, block);
    };
    done_.store(0, std::memory_order_relaxed);
    ++call_;
    tickets_.store((call_ << ticket_bits) | blocks, std::memory_order_release);
    wake_workers();
    help(0);
    for (int looks = 0; done_.load(std::memory_order_acquire) < blocks; ++looks) {
      if (looks < patience) {
        pause();
      } else {
        std::this_thread::yield();  // the worker with the last block may need this processor
      }
    }
    return call_;
  }

 private:
  static constexpr int ticket_bits = 32;
  static constexpr int patience = 2000;

  static void pause() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#endif
  }
  void wake_workers() {
    // A worker first announces that it sleeps and then reads calls_; here calls_ is written first and sleepers are read
    // afterwards. Neither pair may be reordered.
    calls_.fetch_add(1, std::memory_order_seq_cst);
    calls_.notify_all();
  }
  void dismiss() {
    leaving_.store(true, std::memory_order_relaxed);
    wake_workers();
    threads_.clear();
  }
  void serve(std::size_t worker) {
    std::uint32_t seen = 0;
    while (true) {
      for (int looks = 0; calls_.load(std::memory_order_acquire) == seen; ++looks) {
        if (looks < patience) {
          pause();
        } else {
          calls_.wait(seen, std::memory_order_acquire);
        }
      }
      seen = calls_.load(std::memory_order_acquire);
      if (leaving_.load(std::memory_order_relaxed)) return;
      help(worker);
    }
  }
  /// Takes blocks while there are any. A ticket holds the low half of the call's number, so that a ticket read before
  /// the call ended cannot be taken afterwards. The data of a call (job_, run_, call_) are read only while holding one
  /// of its blocks, for which the caller waits.
  void help(std::size_t worker) {
    std::uint64_t ticket = tickets_.load(std::memory_order_acquire);
    while ((ticket & most_blocks) != 0) {
      if (!tickets_.compare_exchange_weak(ticket, ticket - 1, std::memory_order_acquire)) continue;
      run_(job_, worker, call_, (ticket & most_blocks) - 1);
      done_.fetch_add(1, std::memory_order_release);
      ticket = tickets_.load(std::memory_order_acquire);
    }
  }

  std::size_t size_;
  void* job_ = nullptr;
  void (*run_)(void*, std::size_t, std::uint64_t, std::size_t) = nullptr;
  std::uint64_t call_ = 0;
  alignas(64) std::atomic<std::uint64_t> tickets_{0};  // the number of the call and of its remaining blocks
  alignas(64) std::atomic<std::size_t> done_{0};
  alignas(64) std::atomic<std::uint32_t> calls_{0};  // sleeping workers wait for a change
  std::atomic<bool> leaving_{false};
  std::vector<Thread> threads_;
};

}  // namespace hamflow
