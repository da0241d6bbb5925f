// Members in lanes have the bits of the members run alone, whatever the instructions: starts, parameters and step
// lengths of their own, on every problem.
#include <gtest/gtest.h>

#include <iostream>

#include "../support/member_family.hpp"

namespace hamflow {
namespace {

/// @return how many members were compared
int compare(const ProblemEntry& problem, const MethodSpec& method, const std::string& arithmetic) {
  int compared = 0;
  MemberFamily family(problem, 35);  // more than a block of any width, and no multiple of one
  family.request.method = method;
  family.request.arithmetic = arithmetic;
  for (const LaneSet set : {LaneSet::generic, LaneSet::avx2, LaneSet::avx512}) {
    if (set > widest_lanes()) continue;
    SCOPED_TRACE(method.name + " on " + problem.info.name + " in " + std::string(name(set)));
    const auto block = make_ensemble_block(family.request, set);
    EXPECT_NE(block, nullptr);
    if (block == nullptr) return compared;
    if (!block->load(family.shape, std::span(family.members).first(1))) {  // too long a step: of many bodies
      EXPECT_GT(family.members[0].q.size(), 10U);
      continue;
    }
    const std::size_t lanes = block->lanes();
    for (std::size_t first = 0; first < family.members.size(); first += lanes) {
      const auto some = std::span(family.members).subspan(first, std::min(lanes, family.members.size() - first));
      EXPECT_TRUE(block->load(family.shape, some));
      if (::testing::Test::HasFailure()) return compared;
      block->advance(100);
      block->advance(150);
      for (std::size_t lane = 0; lane < some.size(); ++lane) {
        const MemberEnd end = block->look(lane);
        const auto alone = make_simulation(family.alone(some[lane]));
        const bool regular = alone->advance(250) == Outcome::done;
        EXPECT_EQ(end.regular, regular);
        if (!end.regular || !regular) continue;
        Frame frame;
        alone->look(frame);
        EXPECT_EQ(end.q, frame.q);
        EXPECT_EQ(end.p, frame.p);
        EXPECT_EQ(end.energy.initial, alone->energy().initial);
        EXPECT_EQ(end.energy.max_error, alone->energy().max_error);
        const auto invariants = alone->invariants();
        EXPECT_EQ(end.invariants.size(), invariants.size());
        for (std::size_t k = 0; k < std::min(end.invariants.size(), invariants.size()); ++k) {
          EXPECT_EQ(end.invariants[k].max_error, invariants[k].max_error);
        }
        ++compared;
      }
    }
  }
  return compared;
}

int compare_all(const std::string& arithmetic, std::initializer_list<std::string> methods) {
  int compared = 0;
  for (const ProblemEntry& problem : problems()) {
    for (const std::string& method : methods) {
      if (!refusal({.name = method}, problem).empty()) continue;
      compared += compare(problem, {.name = method}, arithmetic);
    }
  }
  std::cout << compared << " members compared\n";
  return compared;
}

TEST(RecordedLanes, EveryLaneHasTheBitsOfTheMemberAlone) {
  EXPECT_GT(compare_all("double", {"stv4", "verlet-dkd", "rk4", "chin4a"}), 3000);
}

TEST(RecordedLanes, SoHasEveryLaneOfCompensatedSums) { EXPECT_GT(compare_all("compensated", {"verlet", "rk4"}), 1500); }

TEST(RecordedLanes, SoHaveLanesOfPlanets) {
  int compared = 0;
  for (const MethodSpec& method :
       {MethodSpec{.name = "wisdom-holman"}, MethodSpec{.name = "wisdom-holman", .options = {{"kernel", "lazy"}}},
        MethodSpec{.name = "wisdom-holman", .options = {{"coordinates", "democratic-heliocentric"}}},
        MethodSpec{.name = "saba",
        .options = {{"order_of_masses", "8"}, {"order_of_squares", "6"}, {"order_of_cubes", "4"}}}}) {
    for (const char* const arithmetic : {"double", "compensated"}) {
      compared += compare(*find_problem("solar-system", {}), method, arithmetic);
    }
  }
  EXPECT_GE(compared, 8 * 35);
}

}  // namespace
}  // namespace hamflow
