// Steps that are recorded and compiled have the bits of the typed templates and of the ordinary road behind virtual
// calls: states, energies, invariants, counters, and what the method keeps.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <set>

#include "../support/measured_request.hpp"
#include "hamflow/detail/run/splitting_named.hpp"
#include "hamflow/methods/compositions/kahan_li8.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/force_gradient.hpp"
#include "hamflow/methods/force_gradient/chin4a.hpp"
#include "hamflow/methods/runge_kutta.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/tableaus/rk4.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/problems/of_any_size/fput.hpp"
#include "hamflow/problems/of_any_size/n_body.hpp"
#include "hamflow/problems/pendulum.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/problems/support/polar.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace hamflow {
namespace {

/// Steps of each comparison: HAMFLOW_TEST_STEPS, or as many as an ordinary test takes.
int compared_steps() {
  const char* const given = std::getenv("HAMFLOW_TEST_STEPS");
  return given != nullptr ? std::atoi(given) : 500;
}

/// Of problems of any size the ordinary road is that of the typed template, which saves its numbers in another form.
void expect_same(const Simulation& a, const Simulation& b, bool save_alike) {
  ASSERT_EQ(a.bits(), b.bits());
  ASSERT_EQ(a.energy().max_error, b.energy().max_error);
  ASSERT_EQ(a.effort().force, b.effort().force);
  const auto of_a = a.invariants();
  const auto of_b = b.invariants();
  ASSERT_EQ(of_a.size(), of_b.size());
  for (std::size_t k = 0; k < of_a.size(); ++k) ASSERT_EQ(of_a[k].max_error, of_b[k].max_error);
  if (save_alike) {
    ASSERT_EQ(a.save(), b.save());
  }
}

/// States within a step, shown so often that the part of a step is recorded.
void expect_same_within_steps(const Simulation& a, const Simulation& b) {
  constexpr int enough = 420;
  Frame of_a, of_b;
  for (int k = 1; k <= enough; ++k) {
    const double theta = k / static_cast<double>(enough);
    const Outcome outcome = a.look_part(theta, of_a);
    ASSERT_EQ(outcome, b.look_part(theta, of_b));
    if (outcome != Outcome::done) continue;
    ASSERT_EQ(of_a.time, of_b.time);
    ASSERT_EQ(of_a.q, of_b.q);
    ASSERT_EQ(of_a.p, of_b.p);
    ASSERT_EQ(of_a.energy, of_b.energy);
    ASSERT_EQ(of_a.energy_range.least, of_b.energy_range.least);
    ASSERT_EQ(of_a.energy_range.largest, of_b.energy_range.largest);
    ASSERT_EQ(of_a.invariants.size(), of_b.invariants.size());
    for (std::size_t i = 0; i < of_a.invariants.size(); ++i) {
      ASSERT_TRUE(of_a.invariants[i] == of_b.invariants[i] ||
                  (std::isnan(of_a.invariants[i]) && std::isnan(of_b.invariants[i])));
    }
    ASSERT_EQ(of_a.effort.force, of_b.effort.force);
  }
}

const std::set<std::string> not_recorded{
    "avf",      "boris",         "cg",     "discrete-gradient", "dop853", "eg", "gauss", "implicit-midpoint",
    "itoh-abe", "lobatto-3a-3b", "rattle", "rattle4",           "taylor"};

TEST(Recorded, EveryMethodOnEveryProblemHasTheBitsOfTheOrdinaryRoad) {
  int cases = 0;
  int recorded = 0;
  for (const ProblemEntry& problem : problems()) {
    Request request = test::measured_request(problem);
    for (const MethodEntry& entry : methods()) {
      request.method = {.name = entry.name};
      if (!refusal(request.method, problem).empty() || not_recorded.contains(entry.name)) continue;
      for (const char* const arithmetic : {"double", "compensated"}) {
        if (!refusal(request.method, arithmetic).empty()) continue;
        request.arithmetic = arithmetic;
        SCOPED_TRACE(entry.name + " on " + request.problem + " in " + arithmetic);
        const int steps = compared_steps();
        request.record = true;
        const auto loop = make_simulation(request);
        request.record = false;
        const auto ordinary = make_simulation(request);
        for (const int block : {steps, 1, 7, steps / 2}) {
          ASSERT_EQ(loop->advance(block), ordinary->advance(block));
        }
        expect_same_within_steps(*loop, *ordinary);
        expect_same(*loop, *ordinary, problem.dimension != 0);
        loop->negate_momenta();
        ordinary->negate_momenta();
        loop->reverse_time();
        ordinary->reverse_time();
        ASSERT_EQ(loop->advance(steps), ordinary->advance(steps));
        expect_same(*loop, *ordinary, problem.dimension != 0);
        EXPECT_FALSE(ordinary->is_recorded());
        ++cases;
        recorded += loop->is_recorded() ? 1 : 0;
      }
    }
  }
  std::cout << cases << " cases of " << 2 * compared_steps() << " steps and more, " << recorded
            << " of them recorded\n";
  EXPECT_GT(recorded, 1000);
}

/// The typed template, which is the oracle, against the simulation by name.
template <class A, class P, class Recipe>
void expect_typed_bits(const std::string& problem, const std::map<std::string, std::string>& variant,
                       const std::string& method, const Recipe& recipe) {
  SCOPED_TRACE(method + " on " + problem + " in " + std::string(A::name));
  Request request = test::measured_request(*find_problem(problem, variant));
  request.method = {.name = method};
  request.arithmetic = std::is_same_v<A, Plain<double>> ? "double" : "compensated";
  const auto by_name = make_simulation(request);
  const std::size_t n = request.start.q.size();
  const Parameters<double> parameters(complete(find_problem(problem, variant)->info, request.parameters));
  const P made = [&] {
    if constexpr (P::dimension == dynamic) {
      return P(parameters, n);
    } else {
      return P(parameters);
    }
  }();
  auto q = zeros<double, P::dimension>(n);
  auto p = zeros<double, P::dimension>(n);
  for (std::size_t i = 0; i < n; ++i) {
    q[i] = evaluate_number<double>(request.start.q[i]);
    p[i] = evaluate_number<double>(request.start.p[i]);
  }
  auto typed = simulate<true>(made, recipe, q, p, evaluate_number<double>(request.dt), A{});
  const int steps = 20 * compared_steps();
  ASSERT_EQ(typed.advance(steps), by_name->advance(steps));
  EXPECT_TRUE(by_name->is_recorded());
  EXPECT_EQ(typed.bits(), by_name->bits());
  EXPECT_EQ(typed.energy().max_error, by_name->energy().max_error);
  EXPECT_EQ(typed.energy().final, by_name->energy().final);
  EXPECT_EQ(typed.effort().force + typed.effort().gradient, by_name->effort().force + by_name->effort().gradient);
  const auto a = typed.invariants();
  const auto b = by_name->invariants();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].max_error, b[k].max_error);
}

template <class P>
void expect_typed_splittings(const std::string& problem, const std::map<std::string, std::string>& variant = {}) {
  const auto both = [&](const std::string& method, const auto& recipe) {
    expect_typed_bits<Plain<double>, P>(problem, variant, method, recipe);
    expect_typed_bits<Compensated<double>, P>(problem, variant, method, recipe);
  };
  both("verlet", Composition<compositions::verlet>{});
  both("verlet-dkd", Composition<compositions::verlet, StartsWith::drift>{});
  both("stv4", Composition<compositions::stv4>{});
  both("chin4a", ForceGradient{&force_gradient::chin4a});
}
template <class P>
void expect_typed_rk4(const std::string& problem, const std::map<std::string, std::string>& variant = {}) {
  expect_typed_bits<Plain<double>, P>(problem, variant, "rk4", RungeKuttaBy<tableaus::rk4>{});
  expect_typed_bits<Compensated<double>, P>(problem, variant, "rk4", RungeKuttaBy<tableaus::rk4>{});
}

TEST(Recorded, TheTypedTemplatesHaveTheSameBits) {
  expect_typed_splittings<CentralForce<double, Kepler>>("central-force", {{"potential", "kepler"}});
  expect_typed_splittings<HenonHeiles<double>>("henon-heiles");
  expect_typed_splittings<Pendulum<double>>("pendulum");
  expect_typed_splittings<Fput<double>>("fput");
  expect_typed_splittings<NBody<double>>("n-body");
  expect_typed_rk4<CentralForce<double, Kepler>>("central-force", {{"potential", "kepler"}});
  expect_typed_rk4<PolarCentralForce<double, Kepler>>("central-force",
                                                      {{"potential", "kepler"}, {"coordinates", "polar"}});
  expect_typed_rk4<DoublePendulumNonlinearAbsolute<double>>("double-pendulum",
                                                            {{"model", "nonlinear"}, {"angles", "absolute"}});
  expect_typed_bits<Plain<double>, HenonHeiles<double>>("henon-heiles", {}, "kahan-li8",
                                                        Composition<compositions::kahan_li8>{});
}

}  // namespace
}  // namespace hamflow
