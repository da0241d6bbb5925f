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

}  // namespace
}  // namespace hamflow
