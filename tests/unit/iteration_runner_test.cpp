// Steps that are solved by iteration, taken by their programs and with stages in lanes: the bits of the ordinary road.
#include <gtest/gtest.h>

#include "../support/measured_request.hpp"
#include "engine/stages_in_lanes.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/simulation.hpp"

namespace hamflow {
namespace {

struct Case {
  std::string problem;
  std::map<std::string, std::string> variant;
  Texts parameters;
  std::vector<std::string> q, p;
  std::string dt;
};

const Case ellipse{"central-force", {{"potential", "kepler"}}, {}, {"0.4", "0"}, {"0", "2"}, "0.25"};
const Case bodies{"n-body",
                  {},
                  {{"masses", "[1, 0.3, 0.2]"}},
                  {"0", "0", "1", "0", "0", "-1.5"},
                  {"0", "-0.1", "0", "0.3", "0.16", "0"},
                  "0.05"};
const Case pendulum{"pendulum", {}, {}, {"1.5"}, {"0.3"}, "0.2"};
const Case rods{
    "double-pendulum", {{"model", "nonlinear"}, {"angles", "absolute"}}, {}, {"0.5", "-0.4"}, {"0", "0.1"}, "0.05"};

std::unique_ptr<Simulation> simulated(const Case& of, const std::string& method, bool record) {
  Request request;
  request.problem = of.problem;
  request.variant = of.variant;
  request.parameters = of.parameters;
  request.start.q = of.q;
  request.start.p = of.p;
  request.dt = of.dt;
  request.method = parse_method(method);
  request.record = record;
  return make_simulation(request);
}

/// Both in blocks of some lengths, with a turn of time and a stretch of single steps.
void expect_same_bits(const Case& of, const std::string& method, bool recorded = true) {
  SCOPED_TRACE(of.problem + ", " + method);
  const auto ordinary = simulated(of, method, false);
  const auto quick = simulated(of, method, true);
  for (const int steps : {3, 250, 1, 97, -1, 64, 5}) {
    if (steps < 0) {
      ordinary->reverse_time();
      quick->reverse_time();
      continue;
    }
    ASSERT_EQ(ordinary->advance(steps), Outcome::done);
    ASSERT_EQ(quick->advance(steps), Outcome::done);
    ASSERT_TRUE(ordinary->bits() == quick->bits()) << steps;
    ASSERT_TRUE(ordinary->save() == quick->save()) << steps;
  }
  EXPECT_EQ(quick->is_recorded(), recorded);
  EXPECT_FALSE(ordinary->is_recorded());
}

TEST(IterationRunner, EveryProblemHasTheBitsOfTheOrdinaryRoad) {
  int recorded = 0;
  for (const ProblemEntry& problem : problems()) {
    for (const char* method : {"gauss(stages=3,iteration=fixed-point)", "cg(2,3)"}) {
      Request request = test::measured_request(problem);
      request.method = parse_method(method);
      if (!refusal(request.method, problem).empty()) continue;
      SCOPED_TRACE(request.problem + ", " + method);
      request.record = false;
      const auto ordinary = make_simulation(request);
      request.record = true;
      const auto quick = make_simulation(request);
      for (const int steps : {200, 150}) {
        const Outcome outcome = ordinary->advance(steps);
        ASSERT_EQ(quick->advance(steps), outcome);
        ASSERT_TRUE(quick->save() == ordinary->save());
        if (outcome != Outcome::done) break;
      }
      recorded += quick->is_recorded() ? 1 : 0;
    }
  }
  EXPECT_GT(recorded, 20);
}

TEST(IterationRunner, StagesInLanesHaveTheBitsOfStagesOneByOne) {
  for (const int stages : {2, 3, 4, 5, 8, 10}) {
    const std::string method = "gauss(stages=" + std::to_string(stages) + ",iteration=fixed-point)";
    for (const Case* of : {&ellipse, &bodies, &pendulum}) expect_same_bits(*of, method);
  }
}

/// Impulses and increments after some corrections, and the sizes of these.
std::vector<double> in_lanes(LaneSet set, int stages) {
  const CentralForce<double, Kepler> kepler{1.0, Kepler<double>(1.0)};
  const auto problem = StagesInLanes::Traced::of(kepler);
  const std::vector<double> q{0.4, 0.1};
  const std::vector<double> p{-0.2, 1.9};
  auto lanes = StagesInLanes::recorded(problem, stage_table<double>(stages), q, p, set);
  const auto m = 2 * static_cast<std::size_t>(stages);
  std::vector<double> all(2 * m + 4);
  lanes->begin(0.05, q, p, std::span(all).first(m));
  for (int k = 0; k < 9; ++k) {
    EXPECT_TRUE(lanes->correct());
    all.push_back(lanes->size());
  }
  const std::span numbers = std::span(all);
  EXPECT_TRUE(
      lanes->end(numbers.first(m), numbers.subspan(m, 2), numbers.subspan(m + 2, 2), numbers.subspan(m + 4, m)));
  return all;
}

TEST(IterationRunner, LanesOfEveryWidthHaveTheSameBits) {
  for (const int stages : {2, 4, 5, 8, 9, 10}) {
    const std::vector<double> interpreted = in_lanes(LaneSet::generic, stages);
    EXPECT_LT(interpreted.back(), 2.0);  // it converges
    EXPECT_EQ(in_lanes(LaneSet::avx2, stages), interpreted) << stages;
    EXPECT_EQ(in_lanes(LaneSet::avx512, stages), interpreted) << stages;
  }
}

TEST(IterationRunner, RecordedCorrectionsHaveTheBitsOfCallsForEach) {
  for (const char* method : {"gauss(4)", "cg(2,4)", "cg(3,6)", "cg(degree=2,quadrature=4,iteration=fixed-point)"}) {
    // Newton's matrix of three bodies with four stages is too long a program.
    const bool is_long = std::string(method) == "gauss(4)";
    for (const Case* of : {&ellipse, &bodies, &pendulum, &rods}) {
      expect_same_bits(*of, method, !(is_long && of == &bodies));
    }
  }
}

Case typed(const std::string& hamiltonian, std::vector<std::string> coordinates, std::vector<std::string> q,
           std::vector<std::string> p, const std::string& dt) {
  return {FormulaKeys::problem,
          formula_choices(FormulaTexts{.coordinates = std::move(coordinates), .hamiltonian = hamiltonian}),
          {},
          std::move(q),
          std::move(p),
          dt};
}

/// Elements of degree 1 of one, two and three coordinates, with H = T + V and without; of orbits so eccentric that
/// steps leave the loop.
TEST(SegmentLoop, HasTheBitsOfStepsOneByOne) {
  const std::string kepler = "(p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2)";
  const Case cases[] = {
      typed(kepler, {"x", "y"}, {"0.4", "0"}, {"0", "2"}, "0.1"),
      typed(kepler, {"x", "y"}, {"1", "0"}, {"0", "0.3"}, "0.006"),
      typed("p^2/2 - cos(q)", {"q"}, {"1.5"}, {"0.3"}, "0.2"),
      typed("(p_x^2 + 2*p_y^2 + p_z^2)/2 + x^4/4 + x*y*z + exp(y) - y + z^2", {"x", "y", "z"}, {"0.3", "0.2", "-0.1"},
            {"0.1", "0", "0.2"}, "0.05"),
      typed("p^2*(1 + q^2)/2 + q^4/4", {"q"}, {"0.7"}, {"0.2"}, "0.1"),
      typed("p_x^2/(2 + y^2) + p_y^2/2 + x^4/4 + y^2/2 + x*p_y/10", {"x", "y"}, {"0.5", "0.3"}, {"0", "0.4"}, "0.1"),
      typed("p_x^2/(2 + y^2) + p_y^2/2 + p_z^2/2 + x^4/4 + y^2/2 + z^2*x^2 + x*p_z/10", {"x", "y", "z"},
            {"0.5", "0.3", "0.1"}, {"0", "0.4", "0"}, "0.05")};
  for (const Case& of : cases) {
    for (const char* method : {"cg(1,1)", "cg(1,5)", "cg", "cg(1,4,on_divergence=halve)"}) expect_same_bits(of, method);
  }
}

}  // namespace
}  // namespace hamflow
