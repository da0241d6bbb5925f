// Members in lanes have the bits of the members run alone, whatever the instructions: starts, parameters and step
// lengths of their own, on every problem.
#include <gtest/gtest.h>

#include <iostream>

#include "hamflow/run/catalog.hpp"
#include "hamflow/run/ensemble.hpp"
#include "hamflow/verify/measure.hpp"

namespace hamflow {
namespace {

/// Members of one problem around the point where it is measured.
struct Family {
  Request request;
  ParameterShape shape;
  std::vector<MemberStart> members;

  Family(const ProblemEntry& problem, std::size_t count) {
    request.problem = problem.info.name;
    request.variant = {problem.info.variant.begin(), problem.info.variant.end()};
    const Region region = region_of(request.problem, request.variant);
    request.parameters = complete(problem.info, region.parameters);
    const Parameters<double> parameters(request.parameters);
    for (const ParameterInfo& info : problem.info.parameters) {
      if (parameters.has(info.name)) shape.emplace_back(info.name, parameters.list(info.name).size());
    }
    const std::size_t n = region.centre.size() / 2;
    for (std::size_t i = 0; i < count; ++i) {
      MemberStart member;
      const double nudge = 1 + 1e-3 * static_cast<double>(i);
      for (std::size_t k = 0; k < n; ++k) {
        member.q.push_back(region.centre[k] * nudge);
        member.p.push_back(region.centre[n + k] / nudge);
      }
      for (const auto& [name, size] : shape) {
        const bool is_whole = name == "n";  // of fput
        for (const double x : parameters.list(name)) {
          member.parameters.push_back(i % 2 == 0 || is_whole ? x : x * nudge);
        }
      }
      member.h = region.step / (i % 3 == 0 ? 10 : 20);
      members.push_back(member);
    }
  }

  std::unique_ptr<Simulation> alone(const MemberStart& member) const {
    Request one = request;
    std::size_t at = 0;
    for (const auto& [name, size] : shape) {
      std::string text;
      for (std::size_t k = 0; k < size; ++k) text += (k == 0 ? "" : ", ") + shortest(member.parameters[at++]);
      one.parameters[name] = size == 1 ? text : "[" + text + "]";
    }
    for (const double x : member.q) one.start.q.push_back(shortest(x));
    for (const double x : member.p) one.start.p.push_back(shortest(x));
    one.dt = shortest(member.h);
    return make_simulation(one);
  }
};

TEST(RecordedLanes, EveryLaneHasTheBitsOfTheMemberAlone) {
  int compared = 0;
  for (const ProblemEntry& problem : problems()) {
    for (const std::string method : {"stv4", "verlet-dkd", "rk4", "chin4a"}) {
      if (!refusal({.name = method}, problem).empty()) continue;
      Family family(problem, 35);  // more than a block of any width, and no multiple of one
      family.request.method = {.name = method};
      const std::pair<LaneSet, const char*> choices[] = {{LaneSet::generic, "exact"}, {LaneSet::avx2, "exact"},
                                                         {LaneSet::avx512, "exact"},  {LaneSet::generic, "fast"},
                                                         {LaneSet::avx2, "fast"},     {LaneSet::avx512, "fast"}};
      for (const auto& [set, kernel] : choices) {
        if (set > widest_lanes()) continue;
        family.request.kernel = kernel;
        SCOPED_TRACE(method + " on " + problem.info.name + " in " + std::string(name(set)) + ", " + kernel);
        const auto block = make_ensemble_block(family.request, set);
        ASSERT_NE(block, nullptr);
        if (!block->load(family.shape, std::span(family.members).first(1))) {  // too long a step: of many bodies
          EXPECT_GT(family.members[0].q.size(), 10U);
          continue;
        }
        const std::size_t lanes = block->lanes();
        for (std::size_t first = 0; first < family.members.size(); first += lanes) {
          const auto some = std::span(family.members).subspan(first, std::min(lanes, family.members.size() - first));
          ASSERT_TRUE(block->load(family.shape, some));
          block->advance(100);
          block->advance(150);
          for (std::size_t lane = 0; lane < some.size(); ++lane) {
            const MemberEnd end = block->look(lane);
            const auto alone = family.alone(some[lane]);
            const bool regular = alone->advance(250) == Outcome::done;
            ASSERT_EQ(end.regular, regular);
            if (!regular) continue;
            Frame frame;
            alone->look(frame);
            EXPECT_EQ(end.q, frame.q);
            EXPECT_EQ(end.p, frame.p);
            EXPECT_EQ(end.energy.initial, alone->energy().initial);
            EXPECT_EQ(end.energy.max_error, alone->energy().max_error);
            const auto invariants = alone->invariants();
            ASSERT_EQ(end.invariants.size(), invariants.size());
            for (std::size_t k = 0; k < invariants.size(); ++k) {
              EXPECT_EQ(end.invariants[k].max_error, invariants[k].max_error);
            }
            ++compared;
          }
        }
      }
    }
  }
  std::cout << compared << " members compared\n";
  EXPECT_GT(compared, 3000);
}

}  // namespace
}  // namespace hamflow
