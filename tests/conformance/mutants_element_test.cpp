// Tests of the tests: broken energy-conserving elements have to be caught.
#include "mutants/averages.hpp"
#include "mutants/element.hpp"
#include "mutants/examine.hpp"

namespace hamflow::mutants {
namespace {

TEST(Mutant, TheElementWithoutAFaultIsSound) { expect_sound(examine(ElementBy{})); }

TEST(Mutant, MomentumFromTheDifferenceOfPositions) {
  const PropertyRow row =
      examine(ElementBy{{.name = "cg, p1 = 2 M (q1 - q0)/h - p0", .momentum_from_positions = true}});
  expect_caught(row, "energy conserving");
  EXPECT_EQ(row["order"].agrees, Finding::yes);  // right but for its rounding, which a small step shows
}

TEST(Mutant, TangentWithTheWrongFactor) {
  const PropertyRow row = examine(ElementBy{{.name = "cg, tangent with h^2", .tangent_factor = 1}});
  expect_caught(row, "Newton corrections");
  EXPECT_EQ(row.differing(), "Newton corrections");  // the solution is the same
}

TEST(Mutant, NewtonStopsAfterOneCorrection) {
  const PropertyRow row = examine(ElementBy{{.name = "cg, one correction", .iterations = 1}});
  expect_caught(row, "symmetric");
  EXPECT_NE(row["energy conserving"].agrees, Finding::yes);
}

TEST(Mutant, OneQuadratureWeightWrongInTheTwelfthDigit) {
  // Asymmetric weights: a defect of 1e-12, and the energy drifts.
  expect_caught(examine(ElementBy{{.name = "cg, weight wrong by 1e-12", .weight_error = 1e-12}}), "energy conserving");
}

TEST(Mutant, MidpointRuleThatClaimsToConserve) {
  const ElementBy midpoint{{.name = "midpoint, claiming up to quadrature", .quadrature = 1}};
  expect_caught(examine(midpoint), "energy conserving");
  const ElementBy sure{{.name = "midpoint, claiming yes", .quadrature = 1, .claim = Conservation::yes}};
  expect_caught(examine(sure), "energy conserving");
}

TEST(Mutant, TwoPointsThatClaimToConserveAlways) {
  const ElementBy two{{.name = "cg(1,2), claiming yes", .quadrature = 2, .claim = Conservation::yes}};
  expect_caught(examine(two), "energy conserving");
}

TEST(Mutant, ElementThatDoesNotClaimItsConservation) {
  expect_caught(examine(ElementBy{{.name = "cg(1,5), claiming nothing", .claim = Conservation::no}}),
                "energy conserving");
}

AverageFaults faulty(const AverageOptions& options, const std::string& name) {
  AverageFaults faults(options);
  faults.name = name;
  return faults;
}

TEST(Mutant, AveragesWithoutAFaultAreSound) {
  expect_sound(examine(FaultyMethod{faulty(CgOptions{.degree = 2, .quadrature = 6}, "cg(2,6), sound")}));
  expect_sound(examine(FaultyMethod{faulty(GaussOptions{.stages = 2}, "gauss(2), sound")}));
}

TEST(Mutant, OneIntegralOfALegendrePolynomialWrong) {
  AverageFaults faults = faulty(CgOptions{.degree = 2, .quadrature = 6}, "cg(2,6), int P_1 wrong by 1e-4");
  faults.wrong_integral = 1e-4;
  expect_caught(examine(FaultyMethod{faults}), "energy conserving");
}

TEST(Mutant, OneValueOfALegendrePolynomialWrong) {
  AverageFaults faults = faulty(CgOptions{.degree = 2, .quadrature = 6}, "cg(2,6), P_1 wrong by 1e-6");
  faults.wrong_value = 1e-6;
  expect_caught(examine(FaultyMethod{faults}), "energy conserving");
}

TEST(Mutant, MuRoundedOneByOne) {
  // With the digits of double the defect is a rounding, which the test of the coefficients catches; with 12 binary
  // digits the map is as far from symplectic as mu_ij + mu_ji is from 1.
  AverageFaults faults = faulty(GaussOptions{.stages = 2}, "gauss(2), mu rounded one by one");
  faults.rounded_one_by_one = true;
  expect_caught(examine(FaultyMethod{faults}), "symplectic");
}

TEST(Mutant, AveragesWithNewtonThatStopsOneIterationEarly) {
  AverageFaults faults = faulty(CgOptions{.degree = 2, .quadrature = 6}, "cg(2,6), one iteration early");
  faults.early = 0x1p30;
  expect_caught(examine(FaultyMethod{faults}), "energy conserving");
}

}  // namespace
}  // namespace hamflow::mutants
