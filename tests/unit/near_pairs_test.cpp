// Loops over the pairs of lists against those over all pairs: the same bits.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "gas/gas_system.hpp"
#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/detail/core/thread_team.hpp"
#include "hamflow/detail/methods/pair_sums.hpp"
#include "hamflow/problems/pairs/lennard_jones.hpp"

namespace hamflow::test {
namespace {

template <class R>
using SystemIn = GasSystem<R, std::variant<pairs::LennardJones<R>>>;

constexpr double spacing = 0.5;
constexpr double radius = 1;  // twice the spacing: pairs stand on the jump

struct Arena {
  std::size_t space;
  std::size_t side;
  bool periodic;
  std::size_t particles() const { return space == 2 ? side * side : side * side * side; }
  double edge() const { return spacing * static_cast<double>(side); }
};
constexpr std::array arenas{Arena{2, 12, false}, Arena{2, 12, true}, Arena{3, 7, false}, Arena{3, 7, true}};

template <class R>
SystemIn<R> system_of(const Arena& arena, const std::shared_ptr<NearPairs>& near) {
  auto model = std::make_shared<typename SystemIn<R>::Model>(pairs::LennardJones<R>(Parameters<R>{}));
  model->space = arena.space;
  model->set_masses(std::vector<R>(arena.particles(), R(1)));
  model->scale = model->scale_squared = R(1);
  model->cutoff =
      std::visit([](const auto& law) { return Cutoff<R>(CutoffKind::shifted, R(radius), R(0), law); }, model->law);
  model->container = arena.periodic ? ContainerKind::periodic : ContainerKind::none;
  if (arena.periodic) {
    model->edges.assign(arena.space, R(arena.edge()));
  }
  model->near = near;
  return SystemIn<R>(model);
}
std::shared_ptr<NearPairs> lists_of(const Arena& arena, double skin, bool every_time = false) {
  NearPairs::Reach reach;
  reach.space = arena.space;
  reach.particles = arena.particles();
  reach.radius = radius;
  reach.skin = skin;
  for (std::size_t k = 0; arena.periodic && k < arena.space; ++k) reach.edges.at(k) = arena.edge();
  reach.rebuild_every_time = every_time;
  return std::make_shared<NearPairs>(reach);
}
/// On a lattice whose numbers are shuffled, and after some random steps of it, the way back too; the box is left by
/// many.
std::vector<double> places(const Arena& arena, int time) {
  const std::size_t n = arena.particles();
  std::vector<double> q(n * arena.space);
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t rest = i * 5 % n;  // 5 divides neither 12^2 nor 7^3
    for (std::size_t k = 0; k < arena.space; ++k, rest /= arena.side) {
      const double drift = std::ldexp(std::round((counter_uniform(3, i * 3 + k) - 0.5) * 4096), -12);
      const double images = arena.periodic ? std::floor(5 * counter_uniform(4, i)) - 2 : 0;
      q[i * arena.space + k] = spacing * static_cast<double>(rest % arena.side) + images * arena.edge() +
                               0x1p-6 * drift * static_cast<double>(time < 12 ? time : 24 - time);
    }
  }
  return q;
}
template <class R>
Vector<R, dynamic> vector_of(const std::vector<double>& x) {
  Vector<R, dynamic> v(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) v[i] = R(x[i]);
  return v;
}
std::size_t pairs_in(NearPairs& near, const std::vector<double>& q, std::size_t particles) {
  const auto turn = near.at([&](std::size_t k) { return q[k]; });
  std::size_t count = 0;
  for (std::size_t i = 0; i < particles; ++i) count += turn[i].size();
  return count;
}

/// @param stride of the times that are looked at
template <class R>
void compare_forces(std::span<const Arena> where, int stride) {
  for (const Arena& arena : where) {
    const auto all = system_of<R>(arena, nullptr);
    const std::size_t n = arena.particles();
    std::vector<std::shared_ptr<NearPairs>> lists{lists_of(arena, 0.2, true)};
    for (const double skin : {0.01, 0.1, 0.3, 1.0}) lists.push_back(lists_of(arena, skin));
    for (int time = 0; time <= 24; time += stride) {
      const auto q = vector_of<R>(places(arena, time));
      Vector<R, dynamic> f(q.size());
      Vector<R, dynamic> again(q.size());
      all.force(q, f);
      const R potential = all.potential(q);
      for (const auto& near : lists) {
        const auto system = system_of<R>(arena, near);
        system.force(q, again);
        EXPECT_EQ(f, again) << n << ", " << time;
        EXPECT_EQ(potential, system.potential(q));
      }
    }
    EXPECT_EQ(lists[0]->lists(), 2u * static_cast<unsigned>(24 / stride + 1));  // force and potential
    EXPECT_GT(lists[1]->lists(), lists[3]->lists());
    EXPECT_LT(lists[4]->lists(), 5u);
    EXPECT_LT(pairs_in(*lists[1], places(arena, 0), n), n * (n - 1) / 4);
  }
}
TEST(NearPairs, ForcesAndEnergiesHaveTheBitsOfAllPairs) { compare_forces<double>(arenas, 2); }
TEST(NearPairs, ForcesAndEnergiesInDoubleDoubleToo) { compare_forces<DoubleDouble>(std::span(arenas).first(2), 2); }

TEST(NearPairs, KicksOfTheLatticeAreThoseOfAllPairs) {
  using System = SystemIn<double>;
  for (const Arena& arena : arenas) {
    const System all = system_of<double>(arena, nullptr);
    Lattice lattice;
    lattice.position.set_unit(0x1p-44);
    lattice.momentum.set_unit(0x1p-20);
    const auto zero = vector_of<double>(std::vector<double>(arena.particles() * arena.space));
    for (const double skin : {0.01, 0.3}) {
      const System system = system_of<double>(arena, lists_of(arena, skin));
      for (const std::size_t threads : {1u, 2u, 4u}) {
        PairSums<System, Lattice> sums;
        PairSums<System, Lattice> by_list;
        by_list.use_threads(threads);
        for (int time = 0; time <= 24; time += 3) {
          auto q = vector_of<double>(places(arena, time));
          q[static_cast<std::size_t>(time)] += 0x1p-44;  // off the jump, or onto it, by one unit
          PhasePoint<Lattice, dynamic> z{.arithmetic = lattice};
          z.store(q, zero);
          Vector<std::int64_t, dynamic> kick(q.size());
          Vector<std::int64_t, dynamic> again(q.size());
          EXPECT_TRUE(sums.evaluate(all, 0.001, z, kick));
          EXPECT_TRUE(by_list.evaluate(system, 0.001, z, again));
          EXPECT_EQ(kick, again) << threads << ", " << skin << ", " << time;
        }
      }
    }
  }
}

/// Where positions have lost what lists allow for, and where they are none.
TEST(NearPairs, LeaveNoPairOutFarAwayOrWithoutNumbers) {
  const Arena& arena = arenas[0];
  const auto near = lists_of(arena, 0.1);
  const std::size_t n = arena.particles();
  auto q = places(arena, 0);
  EXPECT_LT(pairs_in(*near, q, n), n * (n - 1) / 4);
  for (const double x : {2e5, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    q[7] = x;
    EXPECT_EQ(pairs_in(*near, q, n), n * (n - 1) / 2);
  }
}

TEST(ThreadTeam, RefusesMoreBlocksThanItCounts) {
  ThreadTeam team(2);
  auto nothing = [](std::size_t, std::uint64_t, std::size_t) {};
  EXPECT_THROW((void)team.share(ThreadTeam::most_blocks + 1, nothing), Error);
  EXPECT_EQ(team.share(3, nothing), 1U);
}

}  // namespace
}  // namespace hamflow::test
