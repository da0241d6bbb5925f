// Whoever wants to stop is heard within a step in many digits, of every kind of method; the simulation is then that
// before the step, to the last bit.
#include "hamflow/core/stop_question.hpp"

#include <gtest/gtest.h>

#include <cctype>
#include <set>

#include "hamflow/run/catalog.hpp"

namespace hamflow {
namespace {

/// A step takes some seconds or more; explicit ones a part of a second.
constexpr const char* many_digits = "mp(30000)";

Request request_of(const std::string& problem, const std::string& method) {
  Request request;
  request.problem = problem;
  if (problem == "central-force") {
    request.variant = {{"potential", "kepler"}, {"coordinates", "cartesian"}};
    request.start = {.q = {"0.4", "0"}, .p = {"0", "2"}};
  } else {
    request.start = {.q = {"0.1", "0.2"}, .p = {"0.3", "0.1"}};
  }
  request.method = parse_method(method);
  request.arithmetic = many_digits;
  request.dt = "0.125";
  return request;
}

class StopWithinAStep : public ::testing::TestWithParam<std::string> {};

TEST_P(StopWithinAStep, IsAnsweredAndChangesNothing) {
  for (const char* problem : {"central-force", "henon-heiles"}) {
    const Request request = request_of(problem, GetParam());
    if (!find_problem(request)->accepts(request.method)) continue;
    const auto simulation = make_simulation(request);
    const std::function<bool()> stops = [] { return false; };
    std::vector<std::byte> before;
    Outcome outcome = Outcome::done;
    {
      const StopQuestion question(stops);
      for (int step = 0; step < 1000 && outcome == Outcome::done; ++step) {
        before = simulation->save();
        outcome = simulation->advance(1);
      }
    }
    EXPECT_EQ(outcome, Outcome::stopped) << problem;
    EXPECT_EQ(simulation->save(), before) << problem;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, StopWithinAStep,
                         ::testing::Values("verlet", "stv4", "rk4", "taylor", "implicit-midpoint", "gauss(3)",
                                           "lobatto-3a-3b", "cg", "eg", "discrete-gradient", "itoh-abe", "chin4a"),
                         [](const auto& method) {
                           std::string name;
                           for (const char c : method.param) name += std::isalnum(c) != 0 ? c : '_';
                           return name;
                         });

/// Stopped once within each step that is asked, a run has the bits of one that was not.
TEST(StopQuestion, StepsGoOnWithTheSameBits) {
  struct Case {
    const char* method;
    const char* arithmetic;
    std::int64_t steps;
  };
  for (const auto& [method, arithmetic, steps] : {Case{"stv4", many_digits, 12}, Case{"gauss(2)", "mp(2000)", 60}}) {
    Request request = request_of("central-force", method);
    request.arithmetic = arithmetic;
    const auto whole = make_simulation(request);
    const auto stopped = make_simulation(request);
    ASSERT_EQ(whole->advance(steps), Outcome::done);
    std::set<std::int64_t> asked_at;
    const std::function<bool()> stops_once = [&] { return !asked_at.insert(stopped->step()).second; };
    while (stopped->step() < steps) {
      const StopQuestion question(stops_once);
      ASSERT_FALSE(is_failure(stopped->advance(steps - stopped->step())));
    }
    EXPECT_EQ(whole->save(), stopped->save()) << method;
  }
}

}  // namespace
}  // namespace hamflow
