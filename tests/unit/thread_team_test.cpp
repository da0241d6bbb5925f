// Every block of every call is done once, by more threads than there are processors. HAMFLOW_TEAM_CALLS asks for more
// calls; `./dev sanitize --threads` makes 10^6 of them under the thread sanitizer.
#include "hamflow/detail/core/thread_team.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace {

TEST(ThreadTeam, DoesEveryBlockOnceWhenOversubscribed) {
  const char* const wanted = std::getenv("HAMFLOW_TEAM_CALLS");
  const long calls = wanted == nullptr ? 20000 : std::atol(wanted);
  hamflow::ThreadTeam team(8);
  std::uint32_t random = 12345;
  std::uint64_t before = 0;
  for (long i = 0; i < calls; ++i) {
    random = random * 1664525u + 1013904223u;
    const std::size_t blocks = (random >> 16) % 9;
    std::atomic<unsigned> done{0};
    std::atomic<bool> of_another_call{false};
    auto work = [&](std::size_t worker, std::uint64_t call, std::size_t block) {
      if (call != before + 1 || worker >= 8) of_another_call = true;
      done.fetch_add(1u << (3 * block), std::memory_order_relaxed);  // 3 bits count each block
    };
    ASSERT_EQ(team.share(blocks, work), before + 1) << "call " << i;
    ++before;
    ASSERT_EQ(done.load(), 0111111111u & ((1u << (3 * blocks)) - 1)) << "call " << i;
    ASSERT_FALSE(of_another_call.load()) << "call " << i;
    // Now and then the workers fall asleep between two calls.
    if ((random >> 8) % 1000 == 0) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

TEST(ThreadTeam, RefusesMoreBlocksThanItCanCount) {
  hamflow::ThreadTeam team(2);
  auto work = [](std::size_t, std::uint64_t, std::size_t) {};
  EXPECT_THROW(team.share(hamflow::ThreadTeam::most_blocks + 1, work), hamflow::Error);
}

}  // namespace
