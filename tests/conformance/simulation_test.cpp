// Laws of every pair of a method and an arithmetic on every problem: blocks do not matter, watching does not matter,
// nothing is allocated, and trouble leaves the last good state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

#include "../support/allocations.hpp"
#include "../support/measured_request.hpp"
#include "hamflow/detail/run/splitting_named.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/verify/measure.hpp"

namespace hamflow {
namespace {

/// Every request that the catalogue accepts: problem x method x arithmetic.
std::vector<Request> every_request() {
  std::vector<Request> all;
  std::vector<std::string> names;
  // Of the tables, one for each shape of a step: they share their kernels.
  const std::vector<std::string> tables{"euler-a", "euler-b", "verlet", "verlet-dkd", "stv4", "ruth3", "sb3a-4"};
  for (const MethodEntry& entry : methods()) {
    const bool table = splitting_named(entry.name).has_value();
    if (!table || std::find(tables.begin(), tables.end(), entry.name) != tables.end()) names.push_back(entry.name);
  }
  names.insert(names.end(),
               {"cg(1,5)", "cg(quadrature=5,tolerance=1e-13)", "cg(2,4)", "cg(3,auto,iteration=simplified)"});
  for (const ProblemEntry& problem : problems()) {
    const std::map<std::string, std::string> variant(problem.info.variant.begin(), problem.info.variant.end());
    const Region region = region_of(problem.info.name, variant);
    for (const std::string& name : names) {
      const MethodSpec method = parse_method(name);
      if (!test::is_bound(method, problem)) continue;
      // Its equations, of 36 unknowns and more, are those of n-body, of which they are.
      if (problem.info.name == "solar-system" && !describe(method).explicit_step) continue;
      // Beyond double all is compiled alike: one of them, and without what belongs to MPFR, which allocates.
      for (const char* arithmetic : {"double", "compensated", "double-double", "lattice"}) {
        if (!refusal(method, arithmetic).empty() || !refusal(method, problem).empty()) continue;
        Request request;
        request.problem = problem.info.name;
        request.variant = variant;
        request.parameters = region.parameters;
        const std::size_t size = region.centre.size() / 2;
        for (std::size_t i = 0; i < size; ++i) {
          request.start.q.push_back(shortest(region.centre[i]));
          request.start.p.push_back(shortest(region.centre[size + i]));
        }
        request.method = test::with_few_sub_steps(method, arithmetic);
        request.dt = shortest(region.step / 10);  // such that explicit Euler survives 1000 of them
        request.arithmetic = arithmetic;
        all.push_back(request);
      }
    }
  }
  return all;
}

std::string label(const Request& request) {
  return describe(request.method).name + " on " + request.problem + " in " + request.arithmetic;
}

TEST(Problem, EnergyAndInvariantsAreConstantAlongTheExactFlow) {
  for (const ProblemEntry& problem : problems()) {
    const std::map<std::string, std::string> variant(problem.info.variant.begin(), problem.info.variant.end());
    const Region region = region_of(problem.info.name, variant);
    if (problem.info.name == "solar-system") continue;  // as n-body
    if (problem.info.name == "socket") continue;        // it has no forces without a client
    const MethodSpec method = parse_method(refusal(parse_method("rk4"), problem).empty() ? "rk4" : "rattle");
    const auto map = step_map_on(region, method);
    const State<long double> start(region.centre.begin(), region.centre.end());
    std::vector<double> first;
    for (const long double t : {0.0L, 0.3L, 1.7L, 4.0L}) {
      const State<long double> z = map->flow(start, t * region.step * 10);
      Request request;
      request.problem = problem.info.name;
      request.variant = variant;
      request.parameters = region.parameters;
      request.method = method;
      for (std::size_t i = 0; i < z.size(); ++i) {
        auto& texts = i < z.size() / 2 ? request.start.q : request.start.p;
        texts.push_back(shortest(static_cast<double>(z[i])));
      }
      Frame frame;
      make_simulation(request)->look(frame);
      const auto sizes = problem.invariant_sizes(complete(problem.info, region.parameters), z.size() / 2);
      EXPECT_EQ(sizes.size(), problem.info.invariants.size());
      std::vector<double> values;
      std::size_t at = 0;
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        for (const std::size_t end = at + sizes[i]; at < end; ++at) {
          // Of a simulation that begins there the time is 0, of which the centre of mass knows.
          if (problem.info.invariants[i].name != "centre_of_mass") values.push_back(frame.invariants[at]);
        }
      }
      EXPECT_EQ(frame.invariants.size(), at);
      values.push_back(frame.energy);
      if (first.empty()) first = values;
      for (std::size_t i = 0; i < values.size(); ++i) {
        // The states are rounded to double; derivatives of energy and invariants are at most some tens here.
        EXPECT_NEAR(values[i], first[i], 64 * std::numeric_limits<double>::epsilon()) << problem.info.name << ' ' << i;
      }
    }
  }
}

/// Steps are recorded after some hundred, in double; what is not recorded shows what it keeps in fewer.
int steps_of(const Request& request) {
  if (digits_beyond_double(request.arithmetic) > 0) return 100;
  return describe(request.method).explicit_step || request.method.name == "cg" ? 1000 : 200;
}

TEST(Simulation, OneBlockOfAThousandStepsIsAThousandBlocksOfOne) {
  int pairs = 0;
  for (const Request& request : every_request()) {
    const int steps = steps_of(request);
    const auto whole = make_simulation(request);
    const auto single = make_simulation(request);
    const auto odd = make_simulation(request);
    const auto before = whole->bits();
    ASSERT_EQ(whole->advance(steps), Outcome::done) << label(request);
    for (int i = 0; i < steps; ++i) ASSERT_EQ(single->advance(1), Outcome::done) << label(request);
    for (const int part : {1, 0, 2, 7, steps / 2 - 10, steps / 2})
      ASSERT_EQ(odd->advance(part), Outcome::done) << label(request);
    EXPECT_NE(whole->bits(), before) << label(request);
    EXPECT_EQ(whole->bits(), single->bits()) << label(request);
    EXPECT_EQ(whole->bits(), odd->bits()) << label(request);
    EXPECT_EQ(whole->step(), steps);
    EXPECT_EQ(whole->energy().max_error, single->energy().max_error) << label(request);
    EXPECT_EQ(whole->effort().force, single->effort().force) << label(request);
    ++pairs;
  }
  std::cout << pairs << " pairs of method and arithmetic on a problem\n";
}

TEST(Simulation, WatchingDoesNotChangeABit) {
  for (Request request : every_request()) {
    const int steps = steps_of(request);
    const auto watched = make_simulation(request);
    request.watch = false;
    const auto alone = make_simulation(request);
    ASSERT_EQ(watched->advance(steps), Outcome::done) << label(request);
    ASSERT_EQ(alone->advance(steps), Outcome::done) << label(request);
    EXPECT_EQ(watched->bits(), alone->bits()) << label(request);
  }
}

/// Looks at every third step.
class EveryThird final : public Observer {
 public:
  std::int64_t next_due(std::int64_t step) const override { return (step + 2) / 3 * 3; }
  Verdict observe(const Frame& frame) override {
    looks += frame.step % 3 == 0 ? 1 : 1000000;
    return Verdict::go_on;
  }
  int looks = 0;
};

TEST(Simulation, ObserversAreWokenWhenDueAndDoNotChangeABit) {
  for (const Request& request : every_request()) {
    const int steps = steps_of(request);
    const auto observed = make_simulation(request);
    const auto alone = make_simulation(request);
    EveryThird third;
    Observer* const observers[] = {&third};
    ASSERT_EQ(run(*observed, steps, observers), Outcome::done) << label(request);
    ASSERT_EQ(alone->advance(steps), Outcome::done) << label(request);
    EXPECT_EQ(third.looks, steps / 3 + 1);
    EXPECT_EQ(observed->bits(), alone->bits()) << label(request);
  }
}

TEST(Simulation, AdvancingAllocatesNothing) {
  if (!test::counts_allocations()) GTEST_SKIP() << "the address sanitizer brings its own operator new";
  for (const Request& request : every_request()) {
    const int steps = steps_of(request);
    const auto simulation = make_simulation(request);
    // Vectors of any size keep the memory of the first steps, and swap it at the ends of blocks; a step is recorded
    // once after some hundred of them, the programs of an element after 500 runs of each.
    const auto begin = [](Simulation& one, bool recorded) {
      for (int block = 0; block < 3; ++block) (void)one.advance(20);
      if (recorded) (void)one.advance(600);
    };
    const bool recorded = digits_beyond_double(request.arithmetic) == 0;
    if (label(request).find("auto") != std::string::npos) {
      // Coefficients of more points are made once a process, when "auto" first takes them: a run before has them made.
      const auto first = make_simulation(request);
      begin(*first, recorded);
      (void)first->advance(steps);
    }
    begin(*simulation, recorded);
    const long long before = test::allocations();
    const Outcome outcome = simulation->advance(steps);
    EXPECT_EQ(test::allocations(), before) << label(request);
    ASSERT_EQ(outcome, Outcome::done) << label(request);
  }
  const long long before = test::allocations();
  const std::vector<double> one(1);
  EXPECT_EQ(test::allocations(), before + static_cast<long long>(one.size())) << "the counter counts";
}

TEST(Simulation, ReversedTimeMeetsTheSameTimesAndNearlyTheSameStates) {
  for (const Request& request : every_request()) {
    const auto simulation = make_simulation(request);
    if (!simulation->method().symmetric) continue;
    Frame start;
    Frame end;
    simulation->look(start);
    ASSERT_EQ(simulation->advance(200), Outcome::done);
    simulation->reverse_time();
    ASSERT_EQ(simulation->advance(200), Outcome::done) << label(request);
    simulation->look(end);
    EXPECT_EQ(end.time, start.time);
    EXPECT_EQ(end.step, 400);
    for (std::size_t i = 0; i < start.q.size(); ++i) {
      // 400 steps of rounding, amplified at most linearly on these regular orbits: 400^1.5 eps.
      double size = 1;
      for (const double x : start.q) size = std::max(size, std::fabs(x));
      const double bound = 8000 * std::numeric_limits<double>::epsilon() * 10 * size;
      EXPECT_NEAR(end.q[i], start.q[i], bound) << label(request);
      EXPECT_NEAR(end.p[i], start.p[i], bound) << label(request);
    }
  }
}

/// Advances until trouble, in blocks of `block`; the state has to be that of a fresh run of as many steps, finite, and
/// trying again has to change nothing.
void expect_last_good_state(const Request& request, Outcome expected, std::int64_t block) {
  SCOPED_TRACE(label(request) + ", blocks of " + std::to_string(block));
  const auto simulation = make_simulation(request);
  Outcome outcome = Outcome::done;
  for (int i = 0; i < 100000 && outcome == Outcome::done; ++i) outcome = simulation->advance(block);
  ASSERT_EQ(name(outcome), name(expected));
  const std::int64_t good = simulation->step();
  Frame frame;
  simulation->look(frame);
  EXPECT_EQ(frame.step, good);
  if (request.watch) {
    EXPECT_TRUE(std::isfinite(frame.energy));
  }
  for (const double x : frame.q) EXPECT_TRUE(std::isfinite(x));
  for (const double x : frame.p) EXPECT_TRUE(std::isfinite(x));
  const auto bits = simulation->bits();
  EXPECT_EQ(name(simulation->advance(1)), name(expected));
  EXPECT_EQ(simulation->bits(), bits);
  EXPECT_EQ(simulation->step(), good);

  const auto fresh = make_simulation(request);
  ASSERT_EQ(fresh->advance(good), Outcome::done);
  EXPECT_EQ(fresh->bits(), bits);
  if (block == 1) std::cout << label(request) << ": " << name(expected) << " after " << good << " good steps\n";
}

Request request_of(const std::string& problem, const std::string& method, std::vector<std::string> q,
                   std::vector<std::string> p, const std::string& dt) {
  Request request;
  request.problem = problem;
  request.method = parse_method(method);
  request.start.q = std::move(q);
  request.start.p = std::move(p);
  request.dt = dt;
  return request;
}

TEST(Simulation, AnInfiniteStateLeavesTheLastFiniteOne) {
  for (const char* method : {"rk4", "verlet", "euler-a", "verlet-dkd"}) {
    for (const char* arithmetic : {"double", "compensated"}) {
      for (const std::int64_t block : {1, 7, 1000}) {
        for (const bool watch : {true, false}) {
          // Beyond the saddle of Henon-Heiles the particle falls for ever, faster and faster.
          Request request = request_of("henon-heiles", method, {"0", "3"}, {"0", "1"}, "0.1");
          request.arithmetic = arithmetic;
          request.watch = watch;
          expect_last_good_state(request, Outcome::non_finite, block);
        }
      }
    }
  }
}

TEST(Simulation, LeavingTheLatticeLeavesTheLastStateInside) {
  for (const char* method : {"verlet", "stv4-dkd", "euler-b"}) {
    for (const std::int64_t block : {1, 7, 1000}) {
      Request request = request_of("pendulum", method, {"0"}, {"3"}, "0.1");  // rotates: q grows for ever
      request.arithmetic = "lattice";
      request.position_unit = 0x1p-60;  // range +-8
      expect_last_good_state(request, Outcome::lattice_overflow, block);
      request.position_unit = 0x1p-52;
      request.momentum_unit = 0x1p-62;  // range +-2, the momentum is 3
      const auto outside = make_simulation(request);
      EXPECT_EQ(outside->advance(1), Outcome::lattice_overflow);
      EXPECT_EQ(outside->step(), 0);
    }
  }
}

TEST(Simulation, AStepWithoutSolutionIsNotTakenAndSaysWhatHappened) {
  // A fall into the singularity with a step that jumps over it.
  Request request = request_of("central-force", "cg(1,5)", {"0.01", "0"}, {"0", "0"}, "10");
  request.variant = {{"potential", "kepler"}};
  const auto simulation = make_simulation(request);
  const auto before = simulation->bits();
  const Outcome outcome = simulation->advance(5);
  ASSERT_EQ(name(outcome), name(Outcome::not_converged));
  if (simulation->step() == 0) {
    EXPECT_EQ(simulation->bits(), before);
  }
  EXPECT_NE(simulation->failure().find("Newton did not converge in 15 iterations"), std::string::npos)
      << simulation->failure();
}

TEST(Simulation, BlockIndependenceWouldNoticeAForgottenForce) {
  // What the first test is for: the force kept from the last step is dropped when the state is changed from outside.
  Request request = request_of("pendulum", "verlet", {"1"}, {"0.5"}, "0.1");
  const auto a = make_simulation(request);
  const auto b = make_simulation(request);
  (void)a->advance(10);
  (void)b->advance(10);
  a->negate_momenta();
  a->negate_momenta();
  EXPECT_EQ(a->bits(), b->bits());
  const long long forces = a->effort().force;
  (void)a->advance(1);
  (void)b->advance(1);
  EXPECT_EQ(a->effort().force, forces + 2) << "not the kept force but a new one";
  EXPECT_EQ(a->bits(), b->bits());
}

/// The range of H - H0 that a sample has is that of every step since the one before, in every loop, after a resume too.
TEST(Simulation, TheRangeOfEnergiesIsThatOfEveryStep) {
  for (const char* arithmetic : {"double", "compensated", "double-double"}) {
    for (const bool record : {true, false}) {
      Request request;
      request.problem = "henon-heiles";
      request.start = {.q = {"0", "0.1"}, .p = {"0.4", "0"}};
      request.method = parse_method("stv4");
      request.dt = "0.1";
      request.arithmetic = arithmetic;
      request.record = record;
      const auto by_blocks = make_simulation(request);
      const auto by_steps = make_simulation(request);
      const double start = by_steps->energy().initial;
      Frame frame;
      double before = 0;
      for (int sample = 0; sample < 6; ++sample) {
        double least = before;
        double largest = before;
        for (int k = 0; k < 300; ++k) {
          ASSERT_EQ(by_steps->advance(1), Outcome::done);
          by_steps->look(frame);
          before = frame.energy - start;
          least = std::min(least, before);
          largest = std::max(largest, before);
        }
        ASSERT_EQ(by_blocks->advance(100), Outcome::done);
        const auto resumed = make_simulation(request);
        resumed->restore(by_blocks->save());
        ASSERT_EQ(by_blocks->advance(200), Outcome::done);
        ASSERT_EQ(resumed->advance(200), Outcome::done);
        EXPECT_EQ(resumed->save(), by_blocks->save());
        by_blocks->look(frame);
        const double rounding = 4e-16 * std::abs(start);
        EXPECT_NEAR(frame.energy_range.least, least, rounding) << arithmetic << ' ' << record << ' ' << sample;
        EXPECT_NEAR(frame.energy_range.largest, largest, rounding) << arithmetic << ' ' << record << ' ' << sample;
        EXPECT_LT(frame.energy_range.least, frame.energy_range.largest);
        EXPECT_EQ(by_blocks->energy().max_error, by_steps->energy().max_error) << "over every step since the start";
        by_blocks->restart_energy_range();
      }
    }
  }
}

/// Of T + V the largest T of every step, of another H the largest |p . dH/dp|, with the bits of single steps.
TEST(Simulation, TheScaleOfTheEnergyIsWhatTheMotionExchanges) {
  const auto squared = [](const std::vector<double>& p) { return p[0] * p[0]; };
  struct Case {
    const char* hamiltonian;
    const char* method;
    std::function<double(const Frame&)> exchanged;
  };
  const Case cases[] = {
      {"p_a^2/2 + 9.81*sin(a)", "stv4", [&](const Frame& at) { return squared(at.p) / 2; }},
      {"p_a^2/2 + 9.81*sin(a) + 1000", "gauss(4)", [&](const Frame& at) { return squared(at.p) / 2; }},
      {"p_a^2/(2 + a^2) + 9.81*sin(a)", "rk4",
       [&](const Frame& at) { return 2 * squared(at.p) / (2 + at.q[0] * at.q[0]); }},
      {"p_a^2/2 + 9.81*sin(a) - a*cos(t)", "stv4", [&](const Frame& at) { return squared(at.p) / 2; }},
  };
  for (const Case& each : cases) {
    for (const char* arithmetic : {"double", "compensated", "double-double"}) {
      for (const bool record : {true, false}) {
        Request request;
        request.problem = FormulaKeys::problem;
        request.variant = formula_choices({.coordinates = {"a"}, .hamiltonian = each.hamiltonian});
        request.start = {.q = {"0"}, .p = {"0"}};
        request.method = parse_method(each.method);
        request.dt = "0.01";
        request.arithmetic = arithmetic;
        request.record = record;
        const auto by_blocks = make_simulation(request);
        const auto by_steps = make_simulation(request);
        const double at_start = by_steps->energy().scale_at_start;
        double most = 0;
        Frame frame;
        for (int k = 0; k < 1000; ++k) {
          ASSERT_EQ(by_steps->advance(1), Outcome::done);
          by_steps->look(frame);
          most = std::max(most, each.exchanged(frame));
        }
        ASSERT_EQ(by_blocks->advance(600), Outcome::done);
        const auto resumed = make_simulation(request);
        resumed->restore(by_blocks->save());
        ASSERT_EQ(resumed->advance(400), Outcome::done);
        EXPECT_NEAR(resumed->energy().exchanged, most, 1e-14 * most) << each.hamiltonian << ' ' << arithmetic;
        EXPECT_EQ(resumed->energy().exchanged, by_steps->energy().exchanged);
        EXPECT_EQ(resumed->energy_scale(), std::max(at_start, by_steps->energy().exchanged));
      }
    }
  }
}

/// A run that blows up has a large T, and its error is no part of that.
TEST(Simulation, ARunThatBlowsUpTellsNoScale) {
  Request request;
  request.problem = "henon-heiles";
  request.start = {.q = {"0", "0.1"}, .p = {"0.4", "0"}};
  request.method = parse_method("euler");
  request.dt = "0.5";
  const auto simulation = make_simulation(request);
  ASSERT_EQ(simulation->advance(12), Outcome::done);
  const Excursion energy = simulation->energy();
  ASSERT_GT(energy.max_error, 10 * energy.scale_at_start);
  EXPECT_EQ(energy.scale(), energy.scale_at_start);
}

}  // namespace
}  // namespace hamflow
