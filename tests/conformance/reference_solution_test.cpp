// The uncertainty that a reference states is a claim: closed forms and integrations, which share nothing, are no
// further apart than both say.
#include "hamflow/verify/reference_solution.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/core/math.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {
namespace {

ReferenceSolution finished(const Request& request, const std::string& t_end, std::int64_t steps = 100) {
  ReferenceRun run(request, t_end, steps);
  while (!run.finished()) run.advance();
  return run.solution();
}

/// Numbers that double holds exactly, so that a run in any arithmetic is of the same problem.
struct Case {
  std::string problem;
  std::map<std::string, std::string> variant;
  Texts parameters;
  std::vector<std::string> q;
  std::vector<std::string> p;
};

const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {"harmonic", {}, {{"omega", "1.5"}}, {"1"}, {"0.5"}},
      {"free-fall", {}, {}, {"1"}, {"0.5"}},
      {"pendulum", {{"coordinates", "generalised"}}, {}, {"1"}, {"0.5"}},
      {"pendulum", {{"coordinates", "generalised"}}, {}, {"0.25"}, {"3"}},
      {"duffing", {}, {{"alpha", "-1"}, {"beta", "1"}}, {"1.5"}, {"0.25"}},
      {"central-force",
       {{"potential", "kepler"}, {"coordinates", "cartesian"}},
       {{"k", "1"}},
       {"1", "0"},
       {"0", "1.25"}},
      {"central-force",
       {{"potential", "kepler"}, {"coordinates", "cartesian"}},
       {{"k", "1"}},
       {"1", "0"},
       {"0", "0.25"}},
      {"central-force",
       {{"potential", "kepler"}, {"coordinates", "polar"}},
       {{"k", "1"}},
       {"1", "0.5"},
       {"0.25", "1.25"}},
      {"central-force",
       {{"potential", "hooke"}, {"coordinates", "cartesian"}},
       {{"k", "1"}},
       {"1", "0.5"},
       {"-0.25", "1"}},
      {"magnetic", {}, {{"field", "[0.5, 0.25, 1]"}}, {"1", "0", "0"}, {"0", "1", "0.5"}}};
  return all;
}

TEST(ReferenceSolution, ClosedFormsAndIntegrationsAreNoFurtherApartThanTheySay) {
  int closed_forms = 0;
  for (const Case& c : cases()) {
    for (const char* t_end : {"1", "20.5", "-7.25"}) {
      SCOPED_TRACE(c.problem + " at " + t_end);
      Request request;
      request.problem = c.problem;
      request.variant = c.variant;
      request.parameters = c.parameters;
      request.start = {.q = c.q, .p = c.p};
      const ReferenceSolution closed = finished(request, t_end);
      request.arithmetic = "mp(24)";
      const ReferenceSolution integrated = finished(request, t_end);
      ASSERT_EQ(integrated.kind, "integration");
      EXPECT_LT(integrated.uncertainty.value, 1e-17);
      if (closed.kind != "closed form") continue;
      ++closed_forms;
      const ProblemInfo& info = find_problem(request.problem, request.variant).info;
      for (std::size_t i = 0; i < closed.end.size(); ++i) {
        double difference = std::strtod(closed.digits[i].c_str(), nullptr) - integrated.end[i];
        if (i < info.coordinates.size() && info.coordinates[i] == "phi") {
          difference = std::remainder(difference, 2 * pi_value<double>());
        }
        // The other one is rounded to double here.
        const double rounding = std::numeric_limits<double>::epsilon() * std::abs(integrated.end[i]);
        EXPECT_LE(std::abs(difference), closed.uncertainty.value + integrated.uncertainty.value + rounding) << i;
      }
    }
  }
  EXPECT_EQ(closed_forms, static_cast<int>(3 * cases().size()));
}

TEST(ReferenceSolution, EveryProblemHasOneInEveryArithmetic) {
  EXPECT_EQ(reference_arithmetic("double"), "double-double");
  EXPECT_EQ(reference_arithmetic("lattice"), "double-double");
  EXPECT_EQ(reference_arithmetic("mp(12)"), "double-double");
  for (const char* arithmetic : {"double-double", "quad", "mp(50)"}) {
    EXPECT_GE(digits_beyond_double(reference_arithmetic(arithmetic)), digits_beyond_double(arithmetic) + 10);
  }
  for (const ProblemEntry& problem : problems()) {
    Request request;
    request.problem = problem.info.name;
    for (const auto& [key, value] : problem.info.variant) request.variant[key] = value;
    request.parameters = problem.info.region.parameters;
    request.start = {.q = problem.info.default_q, .p = problem.info.default_p};
    std::vector<double> centre = problem.info.region.centre;
    if (!problem.constraint_form.empty() && problem.info.walls.empty()) {  // where it is need not meet the constraints
      centre = problem.info.example.q;
      centre.insert(centre.end(), problem.info.example.p.begin(), problem.info.example.p.end());
    }
    if (!centre.empty()) request.start = {};
    for (std::size_t i = 0; i < centre.size(); ++i) {
      (i < centre.size() / 2 ? request.start.q : request.start.p).push_back(shortest(centre[i]));
    }
    SCOPED_TRACE(problem.info.name);
    const ReferenceSolution found = finished(request, shortest(20 * problem.info.region.step), 20);
    double size = 0;
    for (const double x : found.end) size = std::max(size, std::abs(x));
    EXPECT_LT(found.uncertainty.value, 1e-13 * size) << found.description;
  }
}

TEST(ReferenceSolution, AMotionThatCannotBeFollowedHasNone) {
  Request request;
  request.problem = "henon-heiles";
  request.start = {.q = {"0", "0"}, .p = {"0", "3"}};  // over the saddle: to infinity in finite time
  EXPECT_THROW((void)finished(request, "100"), Error);
}

TEST(Magnitude, BelowTheDoublesIsAText) {
  const Magnitude small("3.25e-412");
  EXPECT_EQ(small.value, 0);
  EXPECT_NEAR(small.log10, std::log10(3.25) - 412, 1e-12);
  EXPECT_EQ(readable(small, 2), "3.25e-412");
  EXPECT_EQ(Magnitude("3.25e-300").value, 3.25e-300);
  EXPECT_TRUE(Magnitude("3.25e-300").text.empty());
  EXPECT_TRUE(small < Magnitude(1e-308));
  EXPECT_TRUE(Magnitude(0.0) < small);
}

}  // namespace
}  // namespace hamflow
