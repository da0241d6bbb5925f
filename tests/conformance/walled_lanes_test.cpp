// Walls within recorded steps and in lanes: bits, counts and rows are those of the ordinary road and of single runs.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/walled_request.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/ensemble.hpp"

namespace hamflow::test {
namespace {

std::vector<std::int64_t> counts(const std::vector<WallCount>& walls) {
  std::vector<std::int64_t> all;
  for (const WallCount& wall : walls) all.push_back(wall.bounces);
  return all;
}
std::int64_t bounces(const Simulation& simulation) {
  std::int64_t all = 0;
  for (const std::int64_t count : counts(simulation.wall_counts())) all += count;
  return all;
}

const std::vector<WallRule> hard_rules{WallRule::event, WallRule::mirror, WallRule::reject};
std::string named(WallRule rule) { return wall_rules()[static_cast<std::size_t>(rule)]; }

/// The same with and without recorded steps. @param steps also without, where some have to meet walls
void expect_same_as_ordinary(Request request, std::int64_t steps, std::int64_t least_bounces) {
  const auto recorded = make_simulation(request);
  request.record = false;
  const auto ordinary = make_simulation(request);
  for (const std::int64_t part : {std::int64_t{7}, steps / 3, steps - steps / 3 - 7}) {
    ASSERT_EQ(recorded->advance(part), Outcome::done);
    ASSERT_EQ(ordinary->advance(part), Outcome::done);
    EXPECT_EQ(recorded->bits(), ordinary->bits());
    EXPECT_EQ(counts(recorded->wall_counts()), counts(ordinary->wall_counts()));
    EXPECT_EQ(recorded->energy().max_error, ordinary->energy().max_error);
  }
  EXPECT_TRUE(recorded->is_recorded());
  EXPECT_GE(bounces(*recorded), least_bounces);
}

TEST(WalledSteps, BounceAsOnTheOrdinaryRoad) {
  for (const WallRule rule : hard_rules) {
    for (const char* method : {"stv4", "verlet-dkd", "rkn8-s19", "chin4a"}) {
      for (const char* arithmetic : {"double", "compensated"}) {
        SCOPED_TRACE(named(rule) + ", " + method + ", " + arithmetic);
        Request request = t_tube(method, rule, "0.01");
        request.arithmetic = arithmetic;
        expect_same_as_ordinary(request, 4000, 80);  // enough for parts of steps to be compiled, too
      }
    }
  }
}

TEST(WalledSteps, OfMethodsWithoutDriftsToo) {
  for (const WallRule rule : {WallRule::event, WallRule::reject}) {
    for (const char* method : {"rk4", "tao2"}) {
      SCOPED_TRACE(named(rule) + ", " + method);
      expect_same_as_ordinary(t_tube(method, rule, "0.01"), 1500, 30);
    }
  }
}

/// More sides than a word counts, corners (two and three walls at once), and coordinates without walls.
TEST(WalledSteps, InCornersAndBetweenManyWalls) {
  FormulaTexts texts;
  texts.coordinates = {"x", "y", "z", "u"};
  texts.hamiltonian = "(p_x^2 + p_y^2 + p_z^2 + p_u^2)/2 + u^2/2";
  Request request{.problem = "formula", .variant = formula_choices(texts), .parameters = {}, .start = {}, .method = {}};
  request.start.q = {"0", "0", "0.25", "1"};
  request.start.p = {"1", "1", "-0.7", "0"};
  request.method = parse_method("stv4");
  request.dt = "0.03";
  for (const WallRule rule : hard_rules) {
    SCOPED_TRACE(named(rule));
    expect_same_as_ordinary(
        behind_walls(request, {{"x", 0, "-1", "1"}, {"y", 1, "-1", "1"}, {"z", 2, "-0.5", "2"}}, rule), 1500, 50);
  }
}

/// A full mass matrix turns no single momentum: such bounces are left to the ordinary road.
TEST(WalledSteps, OfAFullMassMatrix) {
  FormulaTexts texts;
  texts.coordinates = {"x", "y"};
  texts.hamiltonian = "p_x^2/2 + p_x*p_y/4 + p_y^2/2 + (x^2 + y^2)/2";
  Request request{.problem = "formula", .variant = formula_choices(texts), .parameters = {}, .start = {}, .method = {}};
  request.start.q = {"0", "0.2"};
  request.start.p = {"1", "-0.5"};
  request.method = parse_method("stv4");
  request.dt = "0.03";
  for (const WallRule rule : {WallRule::event, WallRule::reject}) {
    SCOPED_TRACE(named(rule));
    expect_same_as_ordinary(behind_walls(request, {{"x", 0, "-0.5", "0.5"}}, rule), 1500, 20);
  }
}

TEST(WalledSteps, WhoIsToldOfBouncesHearsOfAll) {
  for (const WallRule rule : hard_rules) {
    SCOPED_TRACE(named(rule));
    std::vector<Bounce> told[2];
    std::vector<std::byte> bits[2];
    for (const bool in_a_block : {false, true}) {
      const auto simulation = make_simulation(t_tube("stv4", rule, "0.01"));
      simulation->on_bounce([&](const Bounce& bounce) { told[in_a_block].push_back(bounce); });
      constexpr int steps = 4000;
      for (int i = 0; i < (in_a_block ? 1 : steps); ++i) {
        ASSERT_EQ(simulation->advance(in_a_block ? steps : 1), Outcome::done);
      }
      EXPECT_EQ(static_cast<std::int64_t>(told[in_a_block].size()), bounces(*simulation));
      bits[in_a_block] = simulation->bits();
    }
    EXPECT_EQ(bits[0], bits[1]);
    ASSERT_EQ(told[0].size(), told[1].size());
    ASSERT_GT(told[0].size(), 30U);
    for (std::size_t i = 0; i < told[0].size(); ++i) {
      EXPECT_EQ(told[0][i].step, told[1][i].step);
      EXPECT_EQ(told[0][i].time, told[1][i].time);
      EXPECT_EQ(told[0][i].side, told[1][i].side);
      EXPECT_EQ(told[0][i].q, told[1][i].q);
      EXPECT_EQ(told[0][i].p, told[1][i].p);
    }
  }
}

/// A partial step is four forces, since nothing is kept. The goal is twelve of them.
TEST(WalledSteps, ALocatedBounceTakesFewPartialSteps) {
  for (const char* dt : {"0.01", "0.001"}) {
    const auto simulation = make_simulation(t_tube("stv4", WallRule::event, dt));
    constexpr std::int64_t steps = 10000;
    ASSERT_EQ(simulation->advance(steps), Outcome::done);
    const double more = static_cast<double>(simulation->effort().force) - 3.0 * steps;
    EXPECT_GT(bounces(*simulation), 30);
    EXPECT_LE(more / 4, 12.0 * static_cast<double>(bounces(*simulation))) << "dt = " << dt;
  }
}

// Lanes.

struct Tube {
  MemberStart start;
  Request alone;
};

/// T-tubes with starts, masses, forces and steps of their own: more than a block, and no multiple of one.
std::vector<Tube> tubes(WallRule rule, const std::string& method) {
  std::vector<Tube> all;
  for (int i = 0; i < 35; ++i) {
    const double nudge = 1 + 1e-3 * i;
    Tube tube{
        {{0.01 * nudge, 1.1}, {6 * nudge, 100 / nudge}, {1, 100 * nudge, -0.6 * nudge}, i % 3 == 0 ? 0.01 : 0.005},
        t_tube(method, rule, i % 3 == 0 ? "0.01" : "0.005", shortest(-0.6 * nudge))};
    tube.alone.parameters["masses"] = "[1, " + shortest(100 * nudge) + "]";
    tube.alone.start.q = {shortest(tube.start.q[0]), "1.1"};
    tube.alone.start.p = {shortest(tube.start.p[0]), shortest(tube.start.p[1])};
    all.push_back(std::move(tube));
  }
  return all;
}

int compare_lanes(WallRule rule, LaneSet set, const std::string& method) {
  const std::vector<Tube> all = tubes(rule, method);
  const auto block = make_ensemble_block(all[0].alone, set);
  if (block == nullptr) return 0;
  int compared = 0;
  std::vector<MemberStart> starts;
  for (const Tube& tube : all) starts.push_back(tube.start);
  EXPECT_TRUE(block->load({{"masses", 2}, {"eps", 1}}, std::span(starts).first(1)));
  const auto problem_entry = find_problem("t-tube", all[0].alone.variant);
  const ProblemEntry& problem = *problem_entry;
  const std::vector<NamedExpression> kinetic{
      {"kinetic1", StateExpression("p1^2/2", problem, complete(problem.info, all[0].alone.parameters), 2)},
      {"kinetic2", StateExpression("p2^2/200", problem, complete(problem.info, all[0].alone.parameters), 2)}};
  for (std::size_t first = 0; first < starts.size(); first += block->lanes()) {
    const auto some = std::span(starts).subspan(first, std::min(block->lanes(), starts.size() - first));
    EXPECT_TRUE(block->load({{"masses", 2}, {"eps", 1}}, some));
    EXPECT_TRUE(block->expect_sums(std::vector(some.size(), std::span<const NamedExpression>(kinetic))));
    for (const std::int64_t part : {1, 299, 500}) block->advance(part);
    for (std::size_t lane = 0; lane < some.size(); ++lane) {
      const std::vector<StepSum> sums = block->sums(lane);
      const MemberEnd end = block->look(lane);
      EXPECT_TRUE(end.regular);
      const auto alone = make_simulation(all[first + lane].alone);
      std::vector<StepSum> expected(2);
      Frame frame;
      for (int i = 0; i < 800; ++i) {
        EXPECT_EQ(alone->advance(1), Outcome::done);
        alone->look(frame);
        for (std::size_t k = 0; k < 2; ++k) expected[k].add(kinetic[k].expression(frame));
      }
      EXPECT_EQ(end.q, frame.q);
      EXPECT_EQ(end.p, frame.p);
      EXPECT_EQ(end.energy.max_error, alone->energy().max_error);
      EXPECT_EQ(counts(end.walls), counts(alone->wall_counts()));
      EXPECT_GT(bounces(*alone), 5);
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_EQ(sums[k].sum, expected[k].sum);
        EXPECT_EQ(sums[k].lost, expected[k].lost);
      }
      ++compared;
    }
    if (::testing::Test::HasFailure()) break;
  }
  return compared;
}

TEST(WalledLanes, EveryLaneHasBitsCountsAndSumsOfTheMemberAlone) {
  int compared = 0;
  for (const WallRule rule : hard_rules) {
    for (const LaneSet set : {LaneSet::generic, LaneSet::avx2, LaneSet::avx512}) {
      if (set > widest_lanes()) continue;
      SCOPED_TRACE(named(rule) + " in " + std::string(name(set)));
      compared += compare_lanes(rule, set, "stv4");
      if (::testing::Test::HasFailure()) return;
    }
    compared += compare_lanes(rule, widest_lanes(), "verlet-dkd");
  }
  EXPECT_GE(compared, 3 * 3 * 35);
}

/// The rule of the listing by hand. @tparam rolls_back the kick with which the next step begins is that of the position
/// that was kept; else the one of the step that was rejected
template <bool rolls_back>
Vector<double, 4> by_hand(double h, int steps) {
  const double g1 = 1.3512071919596576340476878089714608269219993762171;
  const double weights[] = {g1, 1 - 2 * g1, g1};
  const double kicks[] = {h * (g1 / 2), h * ((g1 + weights[1]) / 2), h * ((g1 + weights[1]) / 2), h * (g1 / 2)};
  double x = 0.01, y = 1.1, px = 6, py = 100, kick_x = 0, kick_y = 0;
  const auto find_kick = [&](double c) {
    const double u = x * x + y * y;
    const double pull = (-c * -0.6) / (u * std::sqrt(u));
    kick_x = pull * x;
    kick_y = pull * y;
  };
  find_kick(kicks[0]);
  for (int i = 0; i < steps; ++i) {
    const double old[] = {x, y, px, py, kick_x, kick_y};
    px += kick_x;
    py += kick_y;
    for (int j = 0; j < 3; ++j) {
      x += (h * weights[j]) / 1.0 * px;
      y += (h * weights[j]) / 100.0 * py;
      find_kick(kicks[j + 1]);
      px += kick_x;
      py += kick_y;
    }
    const bool first = x < -1 || 1 < x;
    const bool second = y < 0.1 || 2.1 < y;
    if (!first && !second) continue;
    x = old[0];
    y = old[1];
    px = second ? old[2] : -old[2];
    py = second ? -old[3] : old[3];
    if (rolls_back) {
      kick_x = old[4];
      kick_y = old[5];
    }
  }
  return {x, y, px, py};
}

TEST(WalledSteps, ARejectionKeepsTheKickOfTheOldPosition) {
  const auto simulation = make_simulation(t_tube("stv4", WallRule::reject, "0.01"));
  ASSERT_EQ(simulation->advance(2000), Outcome::done);
  Frame frame;
  simulation->look(frame);
  const Vector<double, 4> found{frame.q[0], frame.q[1], frame.p[0], frame.p[1]};
  EXPECT_EQ(found, (by_hand<true>(0.01, 2000)));
  EXPECT_NE(found, (by_hand<false>(0.01, 2000))) << "mutant: kick not rolled back at a rejection";
}

}  // namespace
}  // namespace hamflow::test
