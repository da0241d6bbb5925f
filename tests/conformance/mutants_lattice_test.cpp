// Tests of the tests: a lattice that rounds down instead of to nearest loses the exact return, and so does a kernel
// with a force that is not a function of the positions alone.
#include <gtest/gtest.h>

#include <iostream>

#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "mutants/verlet_kernel.hpp"

namespace hamflow::mutants {
namespace {

/// Lattice, but for the rounding: floor(-x) is not -floor(x).
struct FloorLattice {
  using Real = double;
  using Stored = std::int64_t;
  static constexpr std::string_view name = "floor lattice";
  static constexpr bool exact_undo = true;  // so it claims
  struct Axis {
    static constexpr double unit = Lattice::default_unit;
    static Stored store(Real x) { return static_cast<Stored>(std::floor(x / unit)); }
    static Real read(Stored s) { return static_cast<Real>(s) * unit; }
    static void add(Stored& s, Real r) { s += store(r); }
    static Stored negated(Stored s) { return -s; }
  };
  Axis position;
  Axis momentum;
  static bool lost() { return false; }
};

/// Whether every bit is back after `steps` steps each way.
template <class A, class Recipe>
bool returns(const Recipe& recipe, std::int64_t steps) {
  auto simulation =
      simulate<false, HenonHeiles<double>, Recipe, A>(HenonHeiles<double>(), recipe, {0.3, -0.15}, {0.2, 0.25}, 0.1);
  const auto start = simulation.bits();
  EXPECT_EQ(simulation.advance(steps), Outcome::done);
  simulation.negate_momenta();
  EXPECT_EQ(simulation.advance(steps), Outcome::done);
  simulation.negate_momenta();
  return simulation.bits() == start;
}

constexpr std::int64_t there = 100'000;

TEST(Mutant, TheLatticeReturnsWithTheRealRoundingAndKernel) {
  EXPECT_TRUE((returns<Lattice>(Composition<compositions::verlet>{}, there)));
  EXPECT_TRUE((returns<Lattice>(VerletBy{KernelFault::none, "sound"}, there)));
}

TEST(Mutant, RoundingDownLosesTheExactReturn) {
  EXPECT_FALSE((returns<FloorLattice>(Composition<compositions::verlet>{}, there)));
  EXPECT_FALSE((returns<FloorLattice>(Composition<compositions::verlet>{}, 10)));
  std::cout << "mutant \"lattice rounding down\" caught by: exact return\n";
}

TEST(Mutant, AStaleForceLosesTheExactReturn) {
  EXPECT_FALSE((returns<Lattice>(VerletBy{KernelFault::stale_force, "stale"}, 10)));
  std::cout << "mutant \"lattice with a stale force\" caught by: exact return\n";
}

}  // namespace
}  // namespace hamflow::mutants
