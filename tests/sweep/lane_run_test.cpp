// What is measured of members in lanes has the bits of what is measured of the members alone: Lyapunov exponents,
// derivatives of all steps, points of sections, on every problem.
#include "lane_run.hpp"

#include <gtest/gtest.h>

#include <iostream>

#include "../support/member_family.hpp"
#include "verify/monodromy.hpp"

namespace hamflow {
namespace {

constexpr std::int64_t steps = 400;

/// Everything that can be measured of one member.
struct Measured {
  LyapunovObserver exponents;
  LyapunovObserver largest;
  MonodromyObserver derivative;
  std::vector<SectionPoint> points{};

  Measured(const StepMapSource& map, double h)
      : exponents(map, h, steps), largest(map, h, steps, 1), derivative(map, h, steps) {}
  std::vector<Observer*> observers() { return {&exponents, &largest, &derivative}; }
  std::vector<TangentObserver*> tangents() { return {&exponents, &largest, &derivative}; }
  auto take() {
    return [this](const SectionPoint& point) { points.push_back(point); };
  }
};

/// How many lanes had what.
struct Tally {
  int members = 0;
  int points = 0;
  int out_of_step = 0;  // blocks whose lanes orthonormalise at different steps
  int on_their_own = 0;
};

void compare(const Measured& lane, const Measured& alone) {
  for (const auto& [a, b] : {std::pair{&lane.exponents, &alone.exponents}, std::pair{&lane.largest, &alone.largest}}) {
    EXPECT_EQ(a->followed(), b->followed());
    EXPECT_EQ(a->spectrum().exponents, b->spectrum().exponents);
    EXPECT_EQ(a->spectrum().renormalisations, b->spectrum().renormalisations);
    EXPECT_EQ(a->spectrum().pair_sums, b->spectrum().pair_sums);
  }
  EXPECT_EQ(lane.derivative.rows(), alone.derivative.rows());
  ASSERT_EQ(lane.points.size(), alone.points.size());
  for (std::size_t i = 0; i < lane.points.size(); ++i) {
    EXPECT_EQ(lane.points[i].time, alone.points[i].time);
    EXPECT_EQ(lane.points[i].q, alone.points[i].q);
    EXPECT_EQ(lane.points[i].p, alone.points[i].p);
  }
}

/// Members of one block, which has to hold them.
void compare_block(const MemberFamily& family, std::span<const MemberStart> members, EnsembleBlock& block,
                   const Section& section, Tally& tally) {
  const auto problem_entry = find_problem(family.request);
  const ProblemEntry& problem = *problem_entry;
  const std::size_t n = members[0].q.size();
  std::vector<Request> requests;
  std::vector<std::unique_ptr<Measured>> in_lanes;
  std::vector<std::unique_ptr<SectionSearch>> searches;
  std::vector<LaneObservers> observers;
  for (const MemberStart& member : members) {
    requests.push_back(family.alone(member));
    const StepMapSource map{n, [&problem, &tally, n, request = requests.back()] {
                              ++tally.on_their_own;
                              return problem.step_map(request, n);
                            }};
    in_lanes.push_back(std::make_unique<Measured>(map, member.h));
    searches.push_back(std::make_unique<SectionSearch>(section, in_lanes.back()->take()));
    observers.push_back({in_lanes.back()->observers(), in_lanes.back()->tangents(), searches.back().get()});
  }
  ASSERT_TRUE(block.load(family.shape, members));
  LaneRun run(block, observers);
  for (const std::int64_t part : {1, 99, 250, 50}) run.advance(part);
  bool out_of_step = false;
  for (std::size_t lane = 0; lane < members.size(); ++lane) {
    const std::shared_ptr<const StepMap> map = problem.step_map(requests[lane], n);
    Measured alone({n, [map] { return map; }}, members[lane].h);
    const auto simulation = make_simulation(requests[lane]);
    SectionFinder finder(*simulation, section, alone.take());
    std::vector<Observer*> watches = alone.observers();
    watches.push_back(&finder);
    const bool regular = hamflow::run(*simulation, steps, watches) == Outcome::done;
    EXPECT_EQ(block.look(lane).regular, regular);
    if (!regular) continue;
    compare(*in_lanes[lane], alone);
    ++tally.members;
    tally.points += static_cast<int>(alone.points.size());
    out_of_step =
        out_of_step || alone.largest.spectrum().renormalisations != in_lanes[0]->largest.spectrum().renormalisations;
  }
  tally.out_of_step += out_of_step ? 1 : 0;
}

void compare_all(LaneSet set, std::initializer_list<std::string> methods, std::size_t members, Tally& tally) {
  if (set > widest_lanes()) return;
  for (const ProblemEntry& problem : problems()) {
    for (const std::string& method : methods) {
      if (!refusal({.name = method}, problem).empty()) continue;
      SCOPED_TRACE(method + " on " + problem.info.name + " in " + std::string(name(set)));
      MemberFamily family(problem, members);
      if (family.members[0].q.size() > 4) continue;  // 2n exponents of many bodies take their time
      // Long steps let vectors grow so fast that lanes orthonormalise at steps of their own.
      for (std::size_t i = 0; i < members; ++i) family.members[i].h *= i % 3 == 0 ? 10.0 : i % 3 == 1 ? 1.0 : 5.0;
      family.request.method = {.name = method};
      const auto block = make_ensemble_block(family.request, set);
      ASSERT_NE(block, nullptr);
      Section section{.coordinate = 0, .momentum = family.members[0].q.size() == 1, .direction = 0};
      section.value = section.momentum ? 0 : family.members[0].q[0];
      for (std::size_t first = 0; first < members; first += 32) {
        ASSERT_TRUE(block->load(family.shape, std::span(family.members).first(1)));
        const std::size_t count = std::min(block->lanes(), members - first);
        compare_block(family, std::span(family.members).subspan(first, count), *block, section, tally);
        if (::testing::Test::HasFailure()) return;
      }
    }
  }
}

TEST(LaneRun, WhatIsMeasuredHasTheBitsOfMembersAlone) {
  Tally tally;
  compare_all(widest_lanes(), {"stv4", "rk4"}, 40, tally);
  compare_all(LaneSet::avx2, {"verlet-dkd", "chin4a"}, 16, tally);
  compare_all(LaneSet::generic, {"stv4"}, 5, tally);
  EXPECT_EQ(tally.on_their_own, 0);
  std::cout << tally.members << " members, " << tally.points << " points, " << tally.out_of_step
            << " blocks out of step, " << tally.on_their_own << " vectors on their own\n";
  EXPECT_GT(tally.members, 500);
  EXPECT_GT(tally.points, 1000);
  EXPECT_GT(tally.out_of_step, 3);
}

}  // namespace
}  // namespace hamflow
