// Tests of the tests: broken energy-conserving elements have to be caught.
#include <cmath>

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

AverageFaults faulty(const AverageOptions& options) { return AverageFaults(options); }
AverageFaults element() { return faulty(CgOptions{.degree = 2, .quadrature = 6}); }

/// The property that a fault of averages shows in, on the pendulum, as `verify` measures it.
struct OnPendulum {
  StepMapOf<Pendulum, FaultyMethod> map;
  explicit OnPendulum(const AverageFaults& faults)
      : map([]<class R>() { return Pendulum<R>(); }, FaultyMethod{faults}) {}
  std::optional<Conservation> conserved() const {
    return measure_energy(map, region_of("pendulum")).conserving(map.claims().order);
  }
  /// With one degree of freedom symplectic means det = 1. In units of rounding, the largest of some states.
  double area_defect() const {
    const Region region = region_of("pendulum");
    double most = 0;
    for (std::uint64_t k = 0; k < 8; ++k) {
      const auto m = map.jacobian(random_state(region, k), 3 * region.step);
      most = std::max(most, std::abs(m[0][0] * m[1][1] - m[0][1] * m[1][0] - 1));
    }
    return most / std::numeric_limits<double>::epsilon();
  }
};

TEST(Mutant, AveragesWithoutAFaultAreSound) {
  EXPECT_EQ(OnPendulum(element()).conserved(), Conservation::yes);
  EXPECT_LE(OnPendulum(faulty(GaussOptions{.stages = 2})).area_defect(), 64);
}

TEST(Mutant, OneIntegralOfALegendrePolynomialWrong) {
  AverageFaults faults = element();
  faults.wrong_integral = 1e-4;
  EXPECT_EQ(OnPendulum(faults).conserved(), Conservation::no);
}

TEST(Mutant, OneValueOfALegendrePolynomialWrong) {
  AverageFaults faults = element();
  faults.wrong_value = 1e-3;
  EXPECT_EQ(OnPendulum(faults).conserved(), Conservation::no);
}

TEST(Mutant, MuRoundedOneByOne) {
  // With the digits of double the defect is a rounding, which the test of the coefficients catches; with 12 binary
  // digits the map is as far from symplectic as mu_ij + mu_ji is from 1.
  AverageFaults faults = faulty(GaussOptions{.stages = 2});
  faults.rounded_one_by_one = true;
  EXPECT_GE(OnPendulum(faults).area_defect(), 0x1p20);
}

TEST(Mutant, AveragesWithNewtonThatStopsOneIterationEarly) {
  AverageFaults faults = element();
  faults.early = 0x1p48;
  EXPECT_EQ(OnPendulum(faults).conserved(), Conservation::no);
}

}  // namespace
}  // namespace hamflow::mutants
