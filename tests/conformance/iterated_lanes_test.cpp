// Members whose steps are solved by iteration, in lanes: all that a simulation is, its work and what it remembers
// included, is that of the member alone, on every problem that has such lanes.
#include <gtest/gtest.h>

#include <iostream>

#include "../support/member_family.hpp"

namespace hamflow {
namespace {

struct Compared {
  int members = 0;
  std::int64_t together = 0;  // steps taken in lanes
};

/// After many steps and one more, before which a simulation is asked for.
void compare(MemberFamily& family, LaneSet set, Compared& compared) {
  const auto block = make_ensemble_block(family.request, set);
  ASSERT_NE(block, nullptr);
  if (!block->load(family.shape, family.members)) return;
  block->advance(100);
  block->advance(50);
  block->take_step();
  for (std::size_t lane = 0; lane < family.members.size(); ++lane) {
    const auto alone = make_simulation(family.alone(family.members[lane]));
    const bool regular = alone->advance(150) == Outcome::done;
    const auto before = alone->save();
    Frame frame;
    const bool last = regular && alone->advance(1) == Outcome::done;
    ASSERT_EQ(block->is_lost(lane), !last);
    if (!last) continue;
    EXPECT_TRUE(block->before_step(lane).save() == before) << "lane " << lane;
    alone->look(frame);
    const MemberEnd end = block->look(lane);
    EXPECT_TRUE(end.regular);
    EXPECT_EQ(end.q, frame.q);
    EXPECT_EQ(end.p, frame.p);
    EXPECT_EQ(end.energy.max_error, alone->energy().max_error);
    ++compared.members;
  }
  compared.together += block->steps_in_lanes();
}

TEST(IteratedLanes, EveryLaneIsTheMemberAlone) {
  Compared compared;
  for (const ProblemEntry& problem : problems()) {
    for (const std::string method : {"cg(2,4)", "cg(2,auto)", "cg(3,auto)", "gauss(2)", "gauss(4)"}) {
      const MethodSpec spec = parse_method(method);
      if (!refusal(spec, problem).empty()) continue;
      MemberFamily family(problem, 21);
      family.request.method = spec;
      for (const LaneSet set : {LaneSet::avx2, LaneSet::avx512}) {
        if (set > widest_lanes()) continue;
        SCOPED_TRACE(method + " on " + problem.info.name + " in " + std::string(name(set)));
        compare(family, set, compared);
        if (::testing::Test::HasFailure()) return;
      }
    }
  }
  std::cout << compared.members << " members, " << compared.together << " steps in lanes\n";
}

/// Rods that turn over: entries of Newton's tangent then grow and shrink by tens, and with a pivot that is always the
/// largest one the programs of a step, which are good for one order of rows, served a fifth of the steps.
TEST(IteratedLanes, WildMembersStayInThem) {
  constexpr std::size_t count = 16;
  constexpr std::int64_t steps = 1500;
  MemberFamily family(*find_problem("double-pendulum", {{"model", "nonlinear"}, {"angles", "absolute"}}), count);
  for (std::size_t i = 0; i < count; ++i) {
    MemberStart& member = family.members[i];
    const MemberStart& first = family.members[0];
    member = {.q = {1.5 + 0.05 * static_cast<double>(i), 2.4}, .p = {0, 0}, .parameters = first.parameters, .h = 0.01};
  }
  for (const std::string method : {"cg(2,auto)", "cg(2,6)", "gauss(3)"}) {
    family.request.method = parse_method(method);
    for (const LaneSet set : {LaneSet::avx2, LaneSet::avx512}) {
      if (set > widest_lanes()) continue;
      SCOPED_TRACE(method + " in " + std::string(name(set)));
      const auto block = make_ensemble_block(family.request, set);
      ASSERT_TRUE(block->load(family.shape, family.members));
      block->advance(steps);
      for (std::size_t lane = 0; lane < count; ++lane) {
        const auto alone = make_simulation(family.alone(family.members[lane]));
        ASSERT_EQ(alone->advance(steps), Outcome::done);
        Frame frame;
        alone->look(frame);
        const MemberEnd end = block->look(lane);
        EXPECT_EQ(end.q, frame.q);
        EXPECT_EQ(end.p, frame.p);
        EXPECT_EQ(end.energy.max_error, alone->energy().max_error);
      }
      EXPECT_GT(block->steps_in_lanes(), 4 * steps * static_cast<std::int64_t>(count) / 5);
    }
  }
}

}  // namespace
}  // namespace hamflow
