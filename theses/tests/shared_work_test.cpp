// Pieces of work on several threads: each once, and nothing is lost where one fails.
#include "shared_work.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace hamflow::reproduction {
namespace {

/// An experiment that shares `count` pieces on each of two threads, with two that have none.
void on_four_threads(std::size_t count, const std::function<void(std::size_t thread, std::size_t piece)>& piece) {
  SharedWork work(4);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      if (t < 2) work.each(count, [&](std::size_t i) { piece(t, i); });
      work.help();
    });
  }
  for (std::thread& thread : threads) thread.join();
}

TEST(SharedWork, CallsEveryPieceOnce) {
  for (const std::size_t count : {0u, 1u, 2u, 100u}) {
    std::vector<std::vector<std::atomic<int>>> calls(2);
    for (auto& of_thread : calls) of_thread = std::vector<std::atomic<int>>(count);
    on_four_threads(count, [&](std::size_t t, std::size_t i) { ++calls[t][i]; });
    for (const auto& of_thread : calls) {
      for (const std::atomic<int>& one : of_thread) EXPECT_EQ(one, 1);
    }
  }
}

TEST(SharedWork, IsDoneByThreadsWithoutWorkOfTheirOwn) {
  SharedWork work(2);
  std::atomic<int> at_once = 0;
  std::thread other([&] { work.help(); });
  work.each(2, [&](std::size_t) {  // neither returns before the other has begun: it takes two threads
    ++at_once;
    while (at_once < 2) std::this_thread::yield();
  });
  work.help();
  other.join();
  EXPECT_EQ(at_once, 2);
}

TEST(SharedWork, APieceThatFailsIsToldToItsOwnerAlone) {
  SharedWork work(2);
  std::atomic<int> done = 0;
  std::thread other([&] {
    work.each(50, [&](std::size_t) { ++done; });
    work.help();
  });
  std::atomic<int> begun = 0;
  EXPECT_THROW(work.each(1000,
                         [&](std::size_t i) {
                           ++begun;
                           if (i == 3) throw std::runtime_error("one failed");
                         }),
               std::runtime_error);
  work.help();
  other.join();
  EXPECT_EQ(done, 50);
  EXPECT_GE(begun, 4);
}

TEST(SharedWork, WaitsForNoThreadThatWasNeverStarted) {
  SharedWork work(3);
  work.reduce_threads(2);
  work.help();
}

}  // namespace
}  // namespace hamflow::reproduction
