// Walls: what a bounce keeps, where it is, what comes back; and what a run with walls has in common with any other.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../support/arithmetics.hpp"
#include "../support/walled_request.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/verify/certificate.hpp"

namespace hamflow::test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

std::int64_t bounces(const Simulation& simulation) {
  std::int64_t all = 0;
  for (const WallCount& wall : simulation.wall_counts()) all += wall.bounces;
  return all;
}

Frame seen(const Simulation& simulation) {
  Frame frame;
  simulation.look(frame);
  return frame;
}

Request with_problem(const std::string& problem, std::map<std::string, std::string> variant, Texts parameters,
                     std::vector<std::string> q, std::vector<std::string> p, const std::string& method,
                     const std::string& dt) {
  Request request{.problem = problem,
                  .variant = std::move(variant),
                  .parameters = std::move(parameters),
                  .start = {},
                  .method = parse_method(method)};
  request.start.q = std::move(q);
  request.start.p = std::move(p);
  request.dt = dt;
  return request;
}

/// A motion on a table between four walls, or without.
Request free_motion(const std::string& kinetic, std::vector<std::string> q, std::vector<std::string> p,
                    const std::string& method, const std::string& dt) {
  FormulaTexts texts;
  texts.coordinates = {"x", "y"};
  texts.hamiltonian = kinetic;
  return with_problem("formula", formula_choices(texts), {}, std::move(q), std::move(p), method, dt);
}

class EveryRule : public ::testing::TestWithParam<MethodAtWalls> {};

/// Whichever road a step takes: one by one, in compiled blocks with compiled searches for bounces, or never recorded;
/// what is saved has the counts of evaluations, too.
TEST_P(EveryRule, BlocksAreSteps) {
  constexpr std::int64_t steps = 4000;  // enough bounces for parts of steps to be compiled
  const auto [method, rule] = GetParam();
  const Request request = t_tube(method, rule, "0.01");
  const auto one_by_one = make_simulation(request);
  const auto in_a_block = make_simulation(request);
  for (int i = 0; i < steps; ++i) ASSERT_EQ(one_by_one->advance(1), Outcome::done);
  ASSERT_EQ(in_a_block->advance(steps), Outcome::done);
  EXPECT_EQ(one_by_one->bits(), in_a_block->bits());
  EXPECT_EQ(one_by_one->effort().force, in_a_block->effort().force);
  EXPECT_EQ(one_by_one->save(), in_a_block->save());
  EXPECT_EQ(bounces(*one_by_one), bounces(*in_a_block));
  EXPECT_GT(bounces(*in_a_block), 70);
  EXPECT_EQ(one_by_one->energy().max_error, in_a_block->energy().max_error);
  Request unrecorded = request;
  unrecorded.record = false;
  const auto ordinary = make_simulation(unrecorded);
  ASSERT_EQ(ordinary->advance(steps), Outcome::done);
  EXPECT_EQ(ordinary->bits(), in_a_block->bits());
  EXPECT_EQ(ordinary->save(), in_a_block->save());
}

TEST_P(EveryRule, GoesOnFromWhatWasSaved) {
  const auto [method, rule] = GetParam();
  const auto whole = make_simulation(t_tube(method, rule, "0.01"));
  const auto first = make_simulation(t_tube(method, rule, "0.01"));
  const auto second = make_simulation(t_tube(method, rule, "0.01"));
  ASSERT_EQ(whole->advance(700), Outcome::done);
  ASSERT_EQ(first->advance(333), Outcome::done);
  second->restore(first->save());
  ASSERT_EQ(second->advance(700 - 333), Outcome::done);
  EXPECT_EQ(second->save(), whole->save());
}

/// Copies, samples within steps and searches tell nobody of their bounces and change no bit.
TEST_P(EveryRule, OnlyTheRunTellsOfItsBounces) {
  const auto [method, rule] = GetParam();
  const auto plain = make_simulation(t_tube(method, rule, "0.01"));
  const auto watched = make_simulation(t_tube(method, rule, "0.01"));
  std::vector<Bounce> told;
  watched->on_bounce([&](const Bounce& bounce) { told.push_back(bounce); });
  for (int i = 0; i < 400; ++i) {
    ASSERT_EQ(plain->advance(1), Outcome::done);
    ASSERT_EQ(watched->advance(1), Outcome::done);
    Frame frame;
    ASSERT_EQ(watched->look_part(0.7, frame), Outcome::done);
    ASSERT_EQ(watched->look_ahead(std::to_string(0.01 * (i + 1.3)), frame), Outcome::done);
    const auto copy = watched->clone();
    ASSERT_EQ(copy->advance(3), Outcome::done);
  }
  EXPECT_EQ(plain->bits(), watched->bits());
  EXPECT_EQ(static_cast<std::int64_t>(told.size()), bounces(*watched));
  EXPECT_EQ(plain->effort().force, watched->effort().force);
  EXPECT_EQ(plain->effort().gradient, watched->effort().gradient);
  EXPECT_EQ(plain->save(), watched->save());
  for (std::size_t i = 1; i < told.size(); ++i) EXPECT_LE(told[i - 1].time, told[i].time);
}

INSTANTIATE_TEST_SUITE_P(
    Walls, EveryRule,
    ::testing::Values(MethodAtWalls{"stv4", WallRule::event}, MethodAtWalls{"cg(2,auto)", WallRule::event},
                      MethodAtWalls{"stv4", WallRule::mirror}, MethodAtWalls{"chin4a", WallRule::mirror},
                      MethodAtWalls{"stv4", WallRule::reject}, MethodAtWalls{"cg(1,3)", WallRule::reject},
                      MethodAtWalls{"euler", WallRule::event}, MethodAtWalls{"stv4-dkd", WallRule::event},
                      MethodAtWalls{"chin4a", WallRule::reject}),
    [](const auto& each) { return name_of(each.param); });

/// Both copies of tao2's state are thrown back: bound to one that flies on, a bounce would be none.
TEST(Walls, BothCopiesBounce) {
  const auto simulation = make_simulation(t_tube("tao2", WallRule::event, "0.001", "0.6"));
  ASSERT_EQ(simulation->advance(4000), Outcome::done);
  EXPECT_GT(bounces(*simulation), 8);
  EXPECT_LT(bounces(*simulation), 30);  // thousands where one copy drags the other through the wall again and again
}

/// Every bounce stands on its wall to rounding: a tau that is good to 1e-8 only is 1e-7 off.
TEST(Walls, ABounceStandsOnItsWall) {
  for (const char* method : {"stv4", "cg(2,auto)", "gauss(3)", "rk4", "dop853"}) {
    const auto simulation = make_simulation(t_tube(method, WallRule::event, "0.01"));
    double furthest = 0;
    simulation->on_bounce([&](const Bounce& bounce) {
      const double at[2][2] = {{-1, 1}, {0.1, 2.1}};
      furthest =
          std::max(furthest, std::abs(bounce.q[bounce.coordinate] - at[bounce.coordinate][bounce.side < 0 ? 0 : 1]));
    });
    ASSERT_EQ(simulation->advance(2000), Outcome::done);
    EXPECT_GT(bounces(*simulation), 50);
    EXPECT_LE(furthest, 8 * epsilon) << method;
  }
}

/// Iterations are those of whole steps, with all that the search for a bounce took, so that no mean is above the
/// largest.
TEST(Walls, IterationsAreCountedByStep) {
  for (const auto& [method, rule] : {MethodAtWalls{"cg(2,auto)", WallRule::event}, {"cg(1,3)", WallRule::reject}}) {
    const auto simulation = make_simulation(t_tube(method, rule, "0.01"));
    ASSERT_EQ(simulation->advance(1000), Outcome::done);
    EXPECT_GT(bounces(*simulation), 20);
    const Effort effort = simulation->effort();
    EXPECT_EQ(effort.steps, 1000);
    EXPECT_LE(effort.linear_solves, effort.steps * effort.solves_max);
    EXPECT_GE(effort.linear_solves, effort.steps * effort.solves_min);
    const auto again = make_simulation(t_tube(method, rule, "0.01"));
    again->restore(simulation->save());
    EXPECT_EQ(again->effort().steps, 1000);
    EXPECT_EQ(again->effort().solves_max, effort.solves_max);
  }
}

/// An empty text among the choices says that there are no walls.
TEST(Walls, WithoutThemNothingBounces) {
  const Request behind = t_tube("stv4", WallRule::event, "0.01");
  Request free = behind;
  free.walls.reset();
  const auto at_end = [](const Request& request) {
    const auto simulation = make_simulation(request);
    EXPECT_EQ(simulation->advance(300), Outcome::done);
    return simulation->bits();
  };
  EXPECT_NE(at_end(free), at_end(behind));
  EXPECT_TRUE(make_simulation(free)->wall_counts().empty());
}

/// What nobody has: an element that keeps the energy, through every bounce.
TEST(Walls, AnElementKeepsTheEnergyThroughBounces) {
  const auto element = make_simulation(t_tube("cg(2,auto)", WallRule::event, "0.01"));
  const auto splitting = make_simulation(t_tube("stv4", WallRule::event, "0.01"));
  constexpr std::int64_t steps = 5000;
  ASSERT_EQ(element->advance(steps), Outcome::done);
  ASSERT_EQ(splitting->advance(steps), Outcome::done);
  EXPECT_GT(bounces(*element), 150);
  // A walk of some epsilon a step, four standard deviations of it.
  EXPECT_LE(element->energy().max_error / element->energy_scale(), 4 * epsilon * std::sqrt(5000.0));
  EXPECT_GT(splitting->energy().max_error / splitting->energy_scale(), 1e-10);
}

/// p_i -> -p_i would change the energy of the double pendulum, whose mass matrix is full and depends on q.
TEST(Walls, ReflectionByAFullMassMatrix) {
  Request request = with_problem("double-pendulum", {{"model", "nonlinear"}, {"angles", "absolute"}},
                                 {{"masses", "[1, 1]"}, {"half_lengths", "[1, 1]"}}, {"0.5", "0.8"}, {"1", "-2"},
                                 "cg(1,auto)", "0.01");
  request = behind_walls(request, {{"q1", 0, "-0.6", "0.6"}, {"q2", 1, "-1", ""}}, WallRule::event);
  for (const char* method : {"cg(1,auto)", "cg(2,auto)"}) {
    request.method = parse_method(method);
    const auto simulation = make_simulation(request);
    ASSERT_EQ(simulation->advance(2000), Outcome::done);
    EXPECT_GT(bounces(*simulation), 10);
    EXPECT_LE(simulation->energy().max_error / simulation->energy_scale(), 4 * epsilon * std::sqrt(2000.0)) << method;
  }
  for (auto& [key, text] : request.variant) {  // rejection reflects likewise
    if (key == wall_keys().wall_rule.name) text = "reject";
  }
  const auto rejecting = make_simulation(request);
  ASSERT_EQ(rejecting->advance(2000), Outcome::done);
  EXPECT_GT(bounces(*rejecting), 10);
  EXPECT_LE(rejecting->energy().max_error / rejecting->energy_scale(), 4 * epsilon * std::sqrt(2000.0));
}

/// The other root of H(q, p + lambda e_i) = H(q, p) where T is not quadratic, and not even in the momentum.
TEST(Walls, ReflectionOfAnyKineticEnergy) {
  Request request = free_motion("exp(p_x) - p_x + p_x*p_y/5 + p_y^2/2", {"0", "0"}, {"1", "0.3"}, "rk4", "0.01");
  request = behind_walls(request, {{"x", 0, "-0.5", "0.5"}, {"y", 1, "-0.4", "0.4"}}, WallRule::event);
  const auto simulation = make_simulation(request);
  ASSERT_EQ(simulation->advance(3000), Outcome::done);
  EXPECT_GT(bounces(*simulation), 10);
  // Nothing but reflections changes the momenta; each keeps H to some roundings.
  EXPECT_LE(simulation->energy().max_error, 64 * epsilon * static_cast<double>(bounces(*simulation)));
}

class ComesBack : public ::testing::TestWithParam<MethodAtWalls> {};

/// S Psi S Psi = id through bounces. Roundings are carried by a motion that is not chaotic over so short a time.
TEST_P(ComesBack, ToRounding) {
  const auto [method, rule] = GetParam();
  const auto simulation = make_simulation(t_tube(method, rule, "0.01"));
  const Reversal there_and_back = reverse(*simulation, 150);
  ASSERT_EQ(there_and_back.outcome, Outcome::done);
  EXPECT_GT(bounces(*simulation), 6);
  EXPECT_LE(there_and_back.relative_distance.value, 1e-12);
}
INSTANTIATE_TEST_SUITE_P(Walls, ComesBack,
                         ::testing::Values(MethodAtWalls{"stv4", WallRule::event},
                                           MethodAtWalls{"cg(2,auto)", WallRule::event},
                                           MethodAtWalls{"stv4", WallRule::mirror}),
                         [](const auto& each) { return name_of(each.param); });

/// Every bit, on the lattice.
TEST(Walls, MirrorsOnTheLatticeReturnEveryBit) {
  Request request = t_tube("stv4", WallRule::mirror, "0.01");
  request.arithmetic = "lattice";
  request.position_unit = 0x1p-50;
  request.momentum_unit = 0x1p-46;
  const auto simulation = make_simulation(request);
  const Reversal there_and_back = reverse(*simulation, 3000);
  ASSERT_EQ(there_and_back.outcome, Outcome::done);
  EXPECT_GT(bounces(*simulation), 100);
  EXPECT_TRUE(there_and_back.bit_exact);
}

/// Both walls of a corner within rounding: both components.
TEST(Walls, Corner) {
  Request request = free_motion("(p_x^2 + p_y^2)/2", {"0", "0"}, {"1", "1"}, "verlet", "0.3");
  request = behind_walls(request, {{"x", 0, "-1", "1"}, {"y", 1, "-1", "1"}}, WallRule::event);
  const auto simulation = make_simulation(request);
  ASSERT_EQ(simulation->advance(4), Outcome::done);
  const Frame frame = seen(*simulation);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(frame.q[i], 0.8, 4 * epsilon);
    EXPECT_EQ(frame.p[i], -1);
  }
  EXPECT_EQ(bounces(*simulation), 2);
}

/// Out and back within one step, as close to the wall as it may be.
TEST(Walls, OutAndBackWithinAStep) {
  for (const double beyond : {0.05, 1e-3, 1e-6, 1e-10}) {
    Request request =
        with_problem("harmonic", {}, {{"mass", "1"}, {"omega", "1"}}, {"0"}, {"1"}, "taylor", "pi/5 - 0.01");
    request = behind_walls(request, {{"q", 0, "", shortest(1 - beyond)}}, WallRule::event);
    const auto simulation = make_simulation(request);
    ASSERT_EQ(simulation->advance(30), Outcome::done);
    // Thrown back at q = w, the motion comes again after 2 pi - 2 acos(w) (3 roundings of a long way: 18 to 3 turns).
    const double between = 2 * std::acos(-1.0) - 2 * std::acos(1 - beyond);
    const double first = std::asin(1 - beyond);
    const double t = seen(*simulation).time;
    EXPECT_EQ(bounces(*simulation), 1 + static_cast<std::int64_t>((t - first) / between)) << beyond;
    EXPECT_LE(seen(*simulation).q[0], 1 - beyond + 4 * epsilon);
    EXPECT_LE(simulation->energy().max_error, 1e-11);
  }
}

/// Where the motion turns before the wall there is no bounce, and not one bit is another than without a wall.
TEST(Walls, ATurnBeforeTheWallIsNoBounce) {
  const Request plain =
      with_problem("harmonic", {}, {{"mass", "1"}, {"omega", "1"}}, {"0"}, {"1"}, "cg(2,auto)", "0.2");
  const auto free = make_simulation(plain);
  const auto walled = make_simulation(behind_walls(plain, {{"q", 0, "", "1.0001"}}, WallRule::event));
  ASSERT_EQ(free->advance(500), Outcome::done);
  ASSERT_EQ(walled->advance(500), Outcome::done);
  EXPECT_EQ(bounces(*walled), 0);
  EXPECT_EQ(seen(*free).q, seen(*walled).q);
  EXPECT_EQ(seen(*free).p, seen(*walled).p);
}

/// A thousand bounces in a step are followed, more are an error that leaves the last good state.
TEST(Walls, TooManyBounces) {
  const auto between = [](const char* width) {
    return behind_walls(free_motion("(p_x^2 + p_y^2)/2", {"0", "0"}, {"1", "0.5"}, "verlet", "0.25"),
                        {{"x", 0, "0", width}}, WallRule::event);
  };
  const auto many = make_simulation(between("0.0005"));
  ASSERT_EQ(many->advance(4), Outcome::done);
  EXPECT_NEAR(static_cast<double>(bounces(*many)), 2000, 1);
  const auto too_many = make_simulation(between("0.0002"));
  EXPECT_EQ(too_many->advance(4), Outcome::wall);
  EXPECT_EQ(too_many->step(), 0);
  EXPECT_EQ(bounces(*too_many), 0);
  EXPECT_NE(too_many->failure().find("1000"), std::string::npos);
}

/// The force of a soft wall is the derivative of its potential, and it ends where the wall is.
TEST(Walls, SoftWalls) {
  for (const char* exponent : {"1", "2", "3", "6", "7", "2.5"}) {
    Request request =
        with_problem("harmonic", {}, {{"mass", "1"}, {"omega", "1"}}, {"0.1"}, {"0.5"}, "cg(2,auto)", "0.01");
    Walls walls;
    walls.intervals = {{"q", 0, "-0.5", "1"}};
    walls.rule = WallRule::soft;
    walls.strength = "1";
    walls.exponent = exponent;
    request.walls = walls;
    // An element keeps H only if force and energy are those of one function.
    const auto element = make_simulation(request);
    ASSERT_EQ(element->advance(2000), Outcome::done);
    EXPECT_LE(element->energy().max_error / element->energy_scale(), 4 * epsilon * std::sqrt(2000.0)) << exponent;
    Frame frame = seen(*element);
    EXPECT_GT(frame.q[0], -0.5);
    EXPECT_LT(frame.q[0], 1);
    request.method = parse_method("stv4");
    const auto splitting = make_simulation(request);
    ASSERT_EQ(splitting->advance(2000), Outcome::done);
    EXPECT_LE(splitting->energy().max_error, 1e-3);
    request.start.p = {"5"};  // a drift through the wall
    request.dt = "0.7";
    const auto through = make_simulation(request);
    EXPECT_EQ(through->advance(10), Outcome::outside) << exponent;
    EXPECT_NE(through->failure().find("q"), std::string::npos);
  }
}

/// The force is -k x/(1 - x^2)^e with x from -1 to 1.
TEST(Walls, TheForceOfASoftWall) {
  Request request = free_motion("(p_x^2 + p_y^2)/2", {"0.25", "0"}, {"0", "0"}, "euler", "1e-6");
  Walls walls;
  walls.intervals = {{"x", 0, "-1", "2"}};
  walls.rule = WallRule::soft;
  walls.strength = "0.7";
  walls.exponent = "3";
  request.walls = walls;
  const auto simulation = make_simulation(request);
  ASSERT_EQ(simulation->advance(1), Outcome::done);
  const double x = (0.25 - 0.5) / 1.5;
  EXPECT_NEAR(seen(*simulation).p[0] / 1e-6, -0.7 * x / std::pow(1 - x * x, 3), 1e-14);
  EXPECT_NEAR(simulation->energy().initial, 0.7 * 1.5 / 4 / std::pow(1 - x * x, 2), 1e-15);
}

/// The motion itself, by Taylor series between walls, thrown back where halving finds them: written for this test.
Frame exact_motion(double end) {
  Request plain = t_tube("taylor", WallRule::event, "0.05", "-0.6", {"1", "100"});
  plain.variant.clear();
  plain.arithmetic = test::present({"double-double", "quad"}).back();
  const double at[2][2] = {{-1, 1}, {0.1, 2.1}};
  double t = 0;
  while (true) {
    const auto simulation = make_simulation(plain);
    const auto inside = [&](const Frame& frame) {
      return frame.q[0] >= at[0][0] && frame.q[0] <= at[0][1] && frame.q[1] >= at[1][0] && frame.q[1] <= at[1][1];
    };
    Frame frame;
    double from = 0;
    while (true) {  // to the step that leaves
      if (simulation->look_ahead(shortest(from + 0.05), frame) != Outcome::done) return {};
      if (!inside(frame) || t + from + 0.05 >= end) break;
      (void)simulation->advance(1);
      from += 0.05;
    }
    const auto look = [&](double s) { (void)simulation->look_ahead(shortest(s), frame); };
    double low = from;
    double high = std::min(from + 0.05, end - t);
    look(high);
    if (inside(frame)) return frame;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      look(middle);
      (inside(frame) ? low : high) = middle;
    }
    look(high);
    const std::size_t i = frame.q[0] < at[0][0] || frame.q[0] > at[0][1] ? 0 : 1;
    look(low);
    t += low;
    plain.start.q = frame.digits.q;
    plain.start.p = frame.digits.p;
    std::string& p = plain.start.p[i];
    p = p.front() == '-' ? p.substr(1) : "-" + p;
  }
}

/// Located bounces keep the order of the method.
TEST(Walls, LocatedBouncesKeepTheOrder) {
  const Frame exact = exact_motion(2.5);
  const auto error = [&](const char* method, const char* dt, int steps) {
    const auto simulation = make_simulation(t_tube(method, WallRule::event, dt, "-0.6", {"1", "100"}));
    EXPECT_EQ(simulation->advance(steps), Outcome::done);
    const Frame frame = seen(*simulation);
    double most = 0;
    for (std::size_t i = 0; i < 2; ++i) most = std::max(most, std::abs(frame.q[i] - exact.q[i]));
    return most;
  };
  for (const auto& [method, order] :
       {std::pair{"verlet", 2.0}, std::pair{"stv4", 4.0}, std::pair{"cg(1,auto)", 2.0}, std::pair{"cg(2,auto)", 4.0}}) {
    const double slope = std::log2(error(method, "0.02", 125) / error(method, "0.01", 250));
    EXPECT_NEAR(slope, order, 0.6) << method;
  }
  // The motion is found by a reference good to its own rounding.
  EXPECT_LE(error("gauss(5)", "0.01", 250), 1e-11);
}

}  // namespace
}  // namespace hamflow::test
