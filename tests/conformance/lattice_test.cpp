// Bit-exact return on the lattice: forward, momenta reversed, forward again, and every bit is back.
#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/detail/core/hash.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {
namespace {

constexpr std::int64_t there = 100'000;

struct Orbit {
  std::string problem;
  std::map<std::string, std::string> variant;
  std::vector<std::string> q, p;
  std::string dt;
};

const std::vector<Orbit>& orbits() {
  static const std::vector<Orbit> all{
      {"henon-heiles", {}, {"0.3", "-0.15"}, {"0.2", "0.25"}, "0.1"},
      {"pendulum", {}, {"2"}, {"0.5"}, "0.1"},
      {"central-force", {{"potential", "kepler"}}, {"1", "0"}, {"0", "1.2"}, "0.05"},
      {"central-force", {{"potential", "binomial"}}, {"1", "0"}, {"0.2", "1"}, "0.05"},
      {"lennard-jones-oscillator", {}, {"1.5"}, {"0"}, "0.02"},
      {"harmonic", {}, {"1"}, {"0.5"}, "0.1"},
  };
  return all;
}

Request on_lattice(const Orbit& orbit, const std::string& method) {
  Request request;
  request.problem = orbit.problem;
  request.variant = orbit.variant;
  request.start.q = orbit.q;
  request.start.p = orbit.p;
  request.dt = orbit.dt;
  request.method = parse_method(method);
  request.arithmetic = "lattice";
  request.watch = false;
  return request;
}

std::vector<std::string> methods_on_lattice(bool palindromic) {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods()) {
    const MethodSpec spec = parse_method(entry.name);
    if (refusal(spec, "lattice").empty() && describe(spec).symmetric == palindromic) names.push_back(entry.name);
  }
  return names;
}

TEST(Lattice, EveryPalindromicMethodReturnsEveryBit) {
  const auto names = methods_on_lattice(true);
  ASSERT_FALSE(names.empty());
  for (const Orbit& orbit : orbits()) {
    for (const std::string& name : names) {
      SCOPED_TRACE(name + " on " + orbit.problem);
      const auto simulation = make_simulation(on_lattice(orbit, name));
      const std::int64_t steps = there / std::max(1, simulation->method().forces_per_step);
      const auto start = simulation->bits();
      ASSERT_EQ(simulation->advance(steps), Outcome::done);
      const auto far = simulation->bits();
      EXPECT_NE(far, start);
      simulation->negate_momenta();
      ASSERT_EQ(simulation->advance(steps), Outcome::done);
      simulation->negate_momenta();
      EXPECT_EQ(simulation->bits(), start);
      std::printf("%-12s %-25s start %016llx, after %lld steps %016llx, back %016llx\n", name.c_str(),
                  orbit.problem.c_str(), static_cast<unsigned long long>(fnv1a(start)), static_cast<long long>(steps),
                  static_cast<unsigned long long>(fnv1a(far)),
                  static_cast<unsigned long long>(fnv1a(simulation->bits())));
    }
  }
}

TEST(Lattice, ReversingTimeReturnsEveryBitToo) {
  for (const std::string& name : methods_on_lattice(true)) {
    const auto simulation = make_simulation(on_lattice(orbits()[0], name));
    const auto start = simulation->bits();
    ASSERT_EQ(simulation->advance(10'000), Outcome::done);
    simulation->reverse_time();
    ASSERT_EQ(simulation->advance(10'000), Outcome::done);
    EXPECT_EQ(simulation->bits(), start) << name;
  }
}

TEST(Lattice, InPlainDoubleTheSameRunDoesNotReturn) {
  Request request = on_lattice(orbits()[0], "verlet");
  request.arithmetic = "double";
  const auto simulation = make_simulation(request);
  const auto start = simulation->bits();
  ASSERT_EQ(simulation->advance(there), Outcome::done);
  simulation->negate_momenta();
  ASSERT_EQ(simulation->advance(there), Outcome::done);
  simulation->negate_momenta();
  EXPECT_NE(simulation->bits(), start);
}

TEST(Lattice, MethodsThatAreNotPalindromicRunButDoNotReturnByReversedMomenta) {
  const auto names = methods_on_lattice(false);
  EXPECT_NE(std::find(names.begin(), names.end(), "euler-a"), names.end());
  EXPECT_NE(std::find(names.begin(), names.end(), "euler-b"), names.end());
  for (const std::string& name : names) {
    const auto simulation = make_simulation(on_lattice(orbits()[1], name));
    const auto start = simulation->bits();
    ASSERT_EQ(simulation->advance(1000), Outcome::done);
    simulation->negate_momenta();
    ASSERT_EQ(simulation->advance(1000), Outcome::done);
    simulation->negate_momenta();
    EXPECT_NE(simulation->bits(), start) << name;
  }
}

TEST(Lattice, TheAdjointAtMinusHUndoesEveryBit) {
  // euler-b is the adjoint of euler-a. Units of 2^-45 keep every lattice number within the 53 bits of a double, so
  // that a state can be handed over as text.
  const auto text = [](const std::vector<double>& x) {
    std::vector<std::string> all;
    for (const double value : x) all.push_back(shortest(value));
    return all;
  };
  for (const auto& [method, adjoint] : {std::pair{"euler-a", "euler-b"}, {"euler-b", "euler-a"}}) {
    Request request = on_lattice(orbits()[0], method);
    request.position_unit = request.momentum_unit = 0x1p-45;
    const auto forward = make_simulation(request);
    const auto start = forward->bits();
    ASSERT_EQ(forward->advance(there), Outcome::done);
    Frame frame;
    forward->look(frame);
    request.method = parse_method(adjoint);
    request.start.q = text(frame.q);
    request.start.p = text(frame.p);
    request.dt = "-" + request.dt;
    const auto back = make_simulation(request);
    ASSERT_EQ(back->bits(), forward->bits());
    ASSERT_EQ(back->advance(there), Outcome::done);
    EXPECT_EQ(back->bits(), start) << method << " undone by " << adjoint;
  }
}

TEST(Lattice, IsTheSameMethod) {
  // The lattice rounds each action to 2.2e-16: after 1000 steps the orbit is that of plain double, to a walk of that.
  for (const Orbit& orbit : orbits()) {
    Request request = on_lattice(orbit, "stv4");
    const auto lattice = make_simulation(request);
    request.arithmetic = "double";
    const auto plain = make_simulation(request);
    ASSERT_EQ(lattice->advance(1000), Outcome::done);
    ASSERT_EQ(plain->advance(1000), Outcome::done);
    Frame a;
    Frame b;
    lattice->look(a);
    plain->look(b);
    // 7000 actions of half a unit, amplified linearly in time on regular orbits.
    for (std::size_t i = 0; i < a.q.size(); ++i) EXPECT_NEAR(a.q[i], b.q[i], 1e6 * 0x1p-52) << orbit.problem;
  }
}

}  // namespace
}  // namespace hamflow
