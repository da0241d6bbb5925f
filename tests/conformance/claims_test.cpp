// Every claim of every method of the catalogue against its measurement, both ways.
#include <gtest/gtest.h>

#include <algorithm>

#include "hamflow/verify/measure.hpp"

namespace hamflow {
namespace {

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods()) {
    if (entry.kind != MethodKind::cg) names.push_back(entry.name);
  }
  for (const char* cg : {"cg(1,1)", "cg(1,2)", "cg(1,5)", "cg(1,auto)"}) names.emplace_back(cg);
  return names;
}

/// Names of gtest consist of letters, digits and underscores.
std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

class Claims : public ::testing::TestWithParam<std::string> {};

TEST_P(Claims, AreWhatIsMeasured) {
  const std::vector<Region> regions = default_regions();
  const std::vector<PropertyRow> rows{measure_method(parse_method(GetParam()), regions)};
  EXPECT_TRUE(rows[0].agrees()) << rows[0].differing() << '\n' << property_table(rows);
}

TEST_P(Claims, HoldOnTheKeplerEllipse) {
  const std::vector<Region> regions{region_of("central-force")};
  const std::vector<PropertyRow> rows{measure_method(parse_method(GetParam()), regions)};
  EXPECT_TRUE(rows[0].agrees()) << rows[0].differing() << '\n' << property_table(rows);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, Claims, ::testing::ValuesIn(method_names()), test_name);

/// The expectations of the thesis [Sonnleitner2010, p. 64], written down apart from the claims.
TEST(Expected, PropertiesOfTheMethodsOfTheThesis) {
  struct Expectation {
    const char* method;
    int order;
    bool symplectic, symmetric, reversible;
  };
  const std::vector<Region> regions = default_regions();
  for (const Expectation& e : {Expectation{"euler", 1, false, false, false},
                               {"euler-a", 1, true, false, false},
                               {"euler-b", 1, true, false, false},
                               {"verlet", 2, true, true, true},
                               {"stv4", 4, true, true, true},
                               {"rk4", 4, false, false, false}}) {
    const PropertyRow row = measure_method(parse_method(e.method), regions);
    SCOPED_TRACE(e.method);
    for (const Measurement& m : row.on) {
      EXPECT_EQ(m.order.is(e.order), Finding::yes) << m.order.slope;
      EXPECT_EQ(m.symplectic.holds == Finding::yes, e.symplectic) << m.symplectic.defect;
      EXPECT_EQ(m.symmetric.holds == Finding::yes, e.symmetric) << m.symmetric.defect;
      EXPECT_EQ(m.reversible.holds == Finding::yes, e.reversible) << m.reversible.defect;
      EXPECT_EQ(m.weakly_reversible.holds, Finding::yes) << m.weakly_reversible.defect;
      EXPECT_TRUE(m.cost.explicit_step);
      EXPECT_EQ(m.energy.conserving(e.order), Conservation::no);
    }
  }
}

TEST(Expected, NobodyConservesEnergyButTheElementsWithTwoPointsAndMore) {
  const std::vector<Region> regions = default_regions();
  for (const std::string& name : method_names()) {
    const MethodSpec spec = parse_method(name);
    const bool element = spec.name == "cg" && spec.cg.quadrature != 1;
    for (const Region& region : regions) {
      const ProblemEntry& entry = find_problem(region.problem, {});
      const auto map = entry.step_map(complete(entry.info, {}), spec);
      const EnergyMeasurement energy = measure_energy(*map, region);
      EXPECT_EQ(energy.conserving(map->claims().order) != Conservation::no, element)
          << name << " on " << region.problem << ": level " << energy.level << ", drift "
          << hamflow::name(energy.drift.drift);
    }
  }
}

TEST(Expected, SymplecticOnesDoNotDriftAndRungeKuttaDoes) {
  for (const char* name : {"verlet", "stv4", "yoshida6", "rk4", "euler"}) {
    for (const Region& region : default_regions()) {
      const ProblemEntry& entry = find_problem(region.problem, {});
      const auto map = entry.step_map(complete(entry.info, {}), parse_method(name));
      EXPECT_EQ(measure_energy(*map, region).drift.drift == DriftClass::bounded, map->claims().symplectic) << name;
    }
  }
}

TEST(Expected, AFixedQuadratureConservesOnlyAsFarAsItIsExact) {
  // At the pericentre of the ellipse with a step so large that five points miss the force along the chord; "auto"
  // takes more points.
  Region coarse = region_of("central-force");
  coarse.step = 0.4;
  const ProblemEntry& entry = find_problem("central-force", {});
  const auto energy_of = [&](const char* method) {
    return measure_energy(*entry.step_map(complete(entry.info, {}), parse_method(method)), coarse);
  };
  const EnergyMeasurement five = energy_of("cg(1,5)");
  const EnergyMeasurement automatic = energy_of("cg(1,auto)");
  EXPECT_GT(five.level, 100 * five.rounding);
  EXPECT_NEAR(five.step_exponent, 10, 1);  // h^(2 s)
  EXPECT_EQ(five.conserving(2), Conservation::up_to_quadrature);
  EXPECT_LE(automatic.level, automatic.rounding);
  EXPECT_EQ(automatic.conserving(2), Conservation::yes);
}

}  // namespace
}  // namespace hamflow
