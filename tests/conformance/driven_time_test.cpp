// H(q, p, t): the time of a stage is that of its step, n h, and what has passed within the step, whatever the number of
// steps. x'' = cos t from rest at 0 has p = sin t, which a clock of the method's own would miss by its roundings.
#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow::test {
namespace {

Request driven(const std::string& method, const std::string& dt, const std::string& arithmetic = "double") {
  Request r;
  r.problem = FormulaKeys::problem;
  r.variant = formula_choices(FormulaTexts{.coordinates = {"x"}, .hamiltonian = "p_x^2/2 - x*cos(t)"});
  r.start.q = {"0"};
  r.start.p = {"0"};
  r.dt = dt;
  r.method = parse_method(method);
  r.arithmetic = arithmetic;
  return r;
}

/// sin(n h) of the double h; the product has to keep what long double has beyond double.
double sine(double h, std::int64_t n) {
  return static_cast<double>(std::sin(static_cast<long double>(h) * static_cast<long double>(n)));
}

double miss(const std::string& method, const std::string& dt, double h, std::int64_t steps) {
  const auto run = make_simulation(driven(method, dt));
  EXPECT_EQ(run->advance(steps), Outcome::done) << method << " " << dt;
  Frame end;
  run->look(end);
  return std::abs(end.p.at(0) - sine(h, steps));
}

/// One method of each family whose steps are cheap.
TEST(DrivenTime, IsThatOfTheStepAfterTenMillionSteps) {
  EXPECT_LT(miss("stv4", "1/128", 0x1p-7, 10'000'000), 1e-11);
  for (const char* method : {"pefrl", "chin4a", "rk4"}) {
    EXPECT_LT(miss(method, "0.01", 0.01, 10'000'000), 1e-11) << method;
  }
}

TEST(DrivenTime, IsThatOfTheStepForEveryFamily) {
  for (const char* method : {"kahan-li8", "rkn8-s19", "chin4a", "rk4", "gauss(4)"}) {
    EXPECT_LT(miss(method, "0.01", 0.01, 100'000), 1e-11) << method;
  }
  for (const char* method : {"cg(3)", "lobatto-3a-3b(4)", "dop853", "taylor"}) {
    EXPECT_LT(miss(method, "0.01", 0.01, 20'000), 1e-12) << method;
  }
}

TEST(DrivenTime, IsThatOfTheStepForEveryLength) {
  EXPECT_LT(miss("kahan-li8", "0.1", 0.1, 1'000'000), 1e-11);
  EXPECT_LT(miss("kahan-li8", "1/128", 0x1p-7, 1'000'000), 1e-11);
  EXPECT_LT(miss("rkn8-s19", "1/3", 1.0 / 3, 100'000), 1e-11);
  EXPECT_LT(miss("kahan-li8", "-0.01", -0.01, 1'000'000), 1e-11);
}

/// Recorded or not, at once or with a save between.
TEST(DrivenTime, HasTheSameBitsEveryWay) {
  for (const char* method : {"kahan-li8", "rk4", "gauss(4)", "cg(3)", "tao4", "dop853"}) {
    Request request = driven(method, "0.01");
    const auto recorded = make_simulation(request);
    EXPECT_EQ(recorded->advance(2000), Outcome::done);
    const auto first = make_simulation(request);
    EXPECT_EQ(first->advance(700), Outcome::done);
    const auto second = make_simulation(request);
    second->restore(first->save());
    EXPECT_EQ(second->advance(1300), Outcome::done);
    request.record = false;
    const auto ordinary = make_simulation(request);
    EXPECT_EQ(ordinary->advance(2000), Outcome::done);
    EXPECT_EQ(recorded->bits(), second->bits()) << method;
    EXPECT_EQ(recorded->bits(), ordinary->bits()) << method;
  }
}

/// Also where time runs the other way from the middle of a run on.
TEST(DrivenTime, IsThatOfTheStepOnTheWayBack) {
  for (const char* method : {"kahan-li8", "rkn8-s19", "rk4", "gauss(4)", "cg(3)", "dop853"}) {
    const std::int64_t steps = std::string(method) == "kahan-li8" ? 200'000 : 20'000;
    for (const auto& [dt, h] : {std::pair{"0.01", 0.01}, {"-1/128", -0x1p-7}}) {
      const auto run = make_simulation(driven(method, dt));
      EXPECT_EQ(run->advance(steps), Outcome::done);
      run->reverse_time();
      EXPECT_EQ(run->advance(steps / 4 * 3), Outcome::done);
      Frame end;
      run->look(end);
      EXPECT_LT(std::abs(end.p.at(0) - sine(h, steps / 4)), 1e-11) << method << " " << dt;
    }
  }
}

/// The way back meets the same times: on the lattice every bit returns.
TEST(DrivenTime, ComesBack) {
  for (const char* method : {"verlet", "stv4", "kahan-li8"}) {
    for (const char* dt : {"0.01", "0.013", "1/3"}) {
      const auto run = make_simulation(driven(method, dt, "lattice"));
      Frame start;
      run->look(start);
      EXPECT_EQ(run->advance(1000), Outcome::done);
      run->reverse_time();
      EXPECT_EQ(run->advance(1000), Outcome::done);
      Frame end;
      run->look(end);
      EXPECT_EQ(start.q, end.q) << method << " " << dt;
      EXPECT_EQ(start.p, end.p) << method << " " << dt;
    }
  }
}

/// The roundings of an element's bounces have no sign: it had walked half of 1e-12 by here, one way.
TEST(WallsOfElements, DoNotLetTheEnergyWalkOneWay) {
  for (const char* dt : {"0.01", "0.013", "0.02"}) {
    Request r;
    r.problem = FormulaKeys::problem;
    r.variant = formula_choices(FormulaTexts{.coordinates = {"q"}, .hamiltonian = "p^2/2 + 9.81*q"});
    Walls walls;
    walls.intervals.push_back({"q", 0, "-1", ""});
    r.walls = walls;
    r.start.q = {"0"};
    r.start.p = {"0"};
    r.dt = dt;
    r.method = parse_method("cg(1)");
    const auto run = make_simulation(r);
    EXPECT_EQ(run->advance(100'000), Outcome::done);
    EXPECT_LT(run->energy().max_error, 2e-13) << dt;
  }
}

}  // namespace
}  // namespace hamflow::test
