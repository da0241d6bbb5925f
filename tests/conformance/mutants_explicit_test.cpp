// Tests of the tests: broken explicit methods, and sound ones with wrong claims, have to be caught.
#include "hamflow/methods/runge_kutta.hpp"
#include "mutants/examine.hpp"
#include "mutants/tables.hpp"
#include "mutants/verlet_kernel.hpp"

namespace hamflow::mutants {
namespace {

TEST(Mutant, TheControlsAreSound) {
  expect_sound(examine(sound_stv4()));
  expect_sound(examine(verlet_claiming("what it is", [](MethodInfo&) {})));
  expect_sound(examine(VerletBy{KernelFault::none, "verlet kernel, sound"}));
}

TEST(Mutant, OneDigitChangedAtTheSixthPlace) { expect_caught(examine(stv4_wrong_digit()), "order"); }

TEST(Mutant, SubstepsOutOfPalindromicOrder) {
  const PropertyRow row = examine(stv4_out_of_order());
  expect_caught(row, "symmetric");
  EXPECT_EQ(row["order"].agrees, Finding::no);        // 3 without the palindrome
  EXPECT_EQ(row["symplectic"].agrees, Finding::yes);  // whatever the order, kicks and drifts are symplectic
}

TEST(Mutant, InnerKicksWithTheWrongSign) { expect_caught(examine(stv4_wrong_sign()), "order"); }

TEST(Mutant, LastKickNotHalved) { expect_caught(examine(verlet_whole_last_kick()), "order"); }

TEST(Mutant, WrongWeightInRungeKutta) { expect_caught(examine(RungeKuttaBy<rk4_wrong_weight>{}), "order"); }

TEST(Mutant, ForceNotComputedAnewAfterTheDrift) {
  const PropertyRow row = examine(VerletBy{KernelFault::stale_force, "verlet kernel, stale force"});
  expect_caught(row, "symmetric");
  EXPECT_EQ(row["order"].agrees, Finding::no);
}

TEST(Mutant, ForceComputedTwice) {
  const PropertyRow row = examine(VerletBy{KernelFault::force_computed_twice, "verlet kernel, two forces"});
  expect_caught(row, "forces per step");
  EXPECT_EQ(row.differing(), "forces per step");  // everything else is right
}

TEST(Mutant, ClaimsTooMuch) {
  expect_caught(examine(verlet_claiming("order 3", [](MethodInfo& m) { m.order = 3; })), "order");
  expect_caught(
      examine(verlet_claiming("conserved energy", [](MethodInfo& m) { m.energy_conserving = Conservation::yes; })),
      "energy conserving");
  expect_caught(examine(verlet_claiming("conservation up to quadrature",
                                        [](MethodInfo& m) { m.energy_conserving = Conservation::up_to_quadrature; })),
                "energy conserving");
  expect_caught(examine(verlet_claiming("two forces", [](MethodInfo& m) { m.forces_per_step = 2; })),
                "forces per step");
}

TEST(Mutant, ClaimsTooLittle) {
  expect_caught(examine(verlet_claiming("order 1", [](MethodInfo& m) { m.order = 1; })), "order");
  expect_caught(examine(verlet_claiming("not symmetric", [](MethodInfo& m) { m.symmetric = false; })), "symmetric");
  expect_caught(examine(verlet_claiming("not symplectic", [](MethodInfo& m) { m.symplectic = false; })), "symplectic");
  expect_caught(examine(verlet_claiming("not reversible", [](MethodInfo& m) { m.reversible = false; })), "reversible");
  expect_caught(examine(verlet_claiming("implicit", [](MethodInfo& m) { m.explicit_step = false; })), "explicit");
}

}  // namespace
}  // namespace hamflow::mutants
