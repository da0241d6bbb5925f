// Tests of the tests: broken energy-conserving elements have to be caught.
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

}  // namespace
}  // namespace hamflow::mutants
