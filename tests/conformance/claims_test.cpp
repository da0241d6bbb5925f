// Every claim of every method of the catalogue against its measurement, both ways.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "hamflow/detail/run/splitting_named.hpp"
#include "hamflow/verify/measure.hpp"

namespace hamflow {
namespace {

/// Other names of a map that is measured by its first one, with its bits (NamesOfOneMap), degrees between those that
/// are, and tables with the drift first: their coefficients are those with the kick first, whose order conditions are
/// tested for themselves, and the shape of the step is that of verlet-dkd. `hamflow verify --all` measures them all.
bool adds_nothing(const std::string& name) {
  const MethodSpec spec = parse_method(name);
  if (spec.name == "avf" || spec.name == "implicit-midpoint") return true;
  if (name.ends_with("-dkd") && name != "verlet-dkd" && name != "stv4-dkd" && name != "kahan-li8-dkd") return true;
  const std::vector<std::string> between{"gauss(1)", "gauss(2)",   "gauss(3)",         "cg(2,2)",         "cg(2,3)",
                                         "cg(3,4)",  "cg(4,auto)", "lobatto-3a-3b(2)", "lobatto-3a-3b(4)"};
  return std::find(between.begin(), between.end(), name) != between.end();
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods()) {
    const std::vector<std::string>& forms = entry.family->representatives;
    if (forms.empty() && !adds_nothing(entry.name)) names.push_back(entry.name);
    std::copy_if(forms.begin(), forms.end(), std::back_inserter(names),
                 [](const std::string& form) { return !adds_nothing(form); });
  }
  return names;
}

/// Names of gtest consist of letters, digits and underscores.
std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

/// The expectations of the thesis [Sonnleitner2010, p. 64], written down apart from the claims.
struct Expectation {
  const char* method;
  int order;
  bool symplectic, symmetric, reversible;
};
constexpr Expectation expected[]{{"euler", 1, false, false, false},  {"euler-a", 1, true, false, false},
                                 {"euler-b", 1, true, false, false}, {"verlet", 2, true, true, true},
                                 {"stv4", 4, true, true, true},      {"rk4", 4, false, false, false}};

void expect_properties(const Expectation& e, const PropertyRow& row) {
  for (const Measurement& m : row.on) {
    EXPECT_EQ(m.order.is(e.order), Finding::yes) << m.order.slope;
    EXPECT_EQ(m.symplectic.holds == Finding::yes, e.symplectic) << m.symplectic.defect;
    EXPECT_EQ(m.symmetric.holds == Finding::yes, e.symmetric) << m.symmetric.defect;
    EXPECT_EQ(m.reversible.holds == Finding::yes, e.reversible) << m.reversible.defect;
    EXPECT_EQ(m.weakly_reversible.holds, Finding::yes) << m.weakly_reversible.defect;
    EXPECT_EQ(m.cost.explicit_step, Finding::yes);
    EXPECT_EQ(m.energy.conserving(e.order), Conservation::no);
  }
}

/// Nobody conserves the energy, on any problem, but the elements with two points and more. Not all are asked: the
/// energy error of a table of order 6 and more is so near rounding that its exponent is not that of the limit.
constexpr const char* asked_for_conservation[]{"euler", "euler-a", "euler-b",  "verlet",  "verlet-dkd",
                                               "stv4",  "suzuki4", "yoshida6", "rk4",     "chin4a",
                                               "pefrl", "cg(1,1)", "cg(1,2)",  "cg(1,5)", "cg(1,auto)"};

/// The symplectic ones do not drift, on any problem, and Runge and Kutta do.
constexpr const char* asked_for_drift[]{"verlet", "stv4", "yoshida6", "rk4", "euler"};

class Claims : public ::testing::TestWithParam<std::string> {};

TEST_P(Claims, AreWhatIsMeasured) {
  const std::string& method = GetParam();
  std::vector<Region> regions = default_regions(parse_method(method));
  // The slowest by far: on the others by verify --all.
  if (method == "itoh-abe" || method.starts_with("rattle")) regions.resize(1);
  const std::vector<PropertyRow> rows{measure_method(parse_method(method), regions)};
  EXPECT_TRUE(rows[0].agrees()) << rows[0].differing() << '\n' << property_table(rows);

  const auto is_this = [&](const char* name) { return method == name; };
  for (const Expectation& e : expected) {
    if (is_this(e.method)) expect_properties(e, rows[0]);
  }
  if (std::any_of(std::begin(asked_for_conservation), std::end(asked_for_conservation), is_this)) {
    const bool element = describe(parse_method(method)).energy_conserving != Conservation::no;
    for (const Measurement& m : rows[0].on) {
      EXPECT_EQ(m.energy.conserving(rows[0].claims.order) != Conservation::no, element)
          << "on " << m.problem << ": level " << m.energy.level << ", drift " << name(m.energy.drift.drift.value());
    }
  }
  if (std::any_of(std::begin(asked_for_drift), std::end(asked_for_drift), is_this)) {
    for (const Measurement& m : rows[0].on) {
      EXPECT_EQ(m.energy.drift.drift == DriftClass::bounded, rows[0].claims.symplectic) << "on " << m.problem;
    }
  }
}

TEST(Expected, WhatIsAskedOfSomeMethodsIsAskedOfMeasuredOnesOnBothProblems) {
  const std::vector<std::string> measured = method_names();
  std::vector<std::string> asked(std::begin(asked_for_conservation), std::end(asked_for_conservation));
  asked.insert(asked.end(), std::begin(asked_for_drift), std::end(asked_for_drift));
  for (const Expectation& e : expected) asked.emplace_back(e.method);
  for (const std::string& name : asked) {
    EXPECT_EQ(std::count(measured.begin(), measured.end(), name), 1) << name;
    const std::vector<Region> regions = default_regions(parse_method(name));
    ASSERT_EQ(regions.size(), 2u) << name;
    EXPECT_EQ(regions[0].problem, "pendulum");
    EXPECT_EQ(regions[1].problem, "henon-heiles");
  }
}

/// Tables differ in their coefficients alone, which the other tests look at. What a problem can do to the one kernel
/// that runs them shows in one table of each shape and need.
bool stands_for_others(const std::string& name) {
  const MethodSpec spec = parse_method(name);
  // Of the elements those with as many points as it takes: with fixed points the map is one of theirs. Those of higher
  // degree have one kernel for all problems, whose three ways to solve are tested below, and stages are a map of theirs
  // (StagesAreTheMapOfElementsWithAsManyPoints). The adaptive references are tested by themselves.
  if (spec.name == "cg") return name == "cg(1,auto)";
  // The other implicit methods have one kernel for all problems too.
  const std::vector<std::string> below{"gauss",    "eg",     "lobatto-3a-3b", "discrete-gradient",
                                       "itoh-abe", "rattle", "rattle4"};
  if (std::find(below.begin(), below.end(), spec.name) != below.end()) return false;
  if (spec.name == "tao4") return false;  // three steps of tao2
  if (describe(spec).own_substeps) return false;
  if (!splitting_named(spec.name)) return true;
  const std::vector<std::string> chosen{"euler-a", "euler-b", "verlet", "verlet-dkd", "stv4", "sb3a-4"};
  return std::find(chosen.begin(), chosen.end(), name) != chosen.end();
}

/// A method, and a part of the problems: every so-manyth of the catalogue's.
struct Share {
  std::string method;
  std::size_t part = 0;
  std::size_t parts = 1;
};

/// Newton in every step makes the elements the slowest by far, a minute over all problems: those are dealt out.
std::vector<Share> shares() {
  std::vector<Share> all;
  for (const std::string& name : method_names()) {
    if (!stands_for_others(name)) continue;
    const std::size_t parts = describe(parse_method(name)).explicit_step ? 1 : 12;
    for (std::size_t part = 0; part < parts; ++part) all.push_back({name, part, parts});
  }
  return all;
}
std::string share_name(const ::testing::TestParamInfo<Share>& info) {
  const std::string name = test_name({info.param.method, info.index});
  return info.param.parts == 1 ? name : name + "_part_" + std::to_string(info.param.part + 1);
}

class SharedClaims : public ::testing::TestWithParam<Share> {};

TEST_P(SharedClaims, HoldOnEveryOtherProblem) {
  const auto& [method, part, parts] = GetParam();
  const MethodSpec spec = parse_method(method);
  std::vector<Region> regions;
  std::vector<Measurement> found;
  std::size_t count = 0;
  for (const ProblemEntry& problem : problems()) {
    if (count++ % parts != part) continue;
    std::map<std::string, std::string> variant(problem.info.variant.begin(), problem.info.variant.end());
    if (!problem.accepts(parse_method(method))) continue;
    if (problem.info.name == "solar-system") continue;  // n-body with other numbers, which take long
    // Polar potentials differ as they do in Cartesian coordinates, where each is measured.
    if (variant["coordinates"] == "polar" && variant["potential"] != "kepler") continue;
    // Every step of a constant force rounds alike: the 10^7 steps to which its order is followed sum that up.
    if (describe(parse_method(method)).carries_copy && problem.info.name == "free-fall") continue;
    SCOPED_TRACE(problem.info.name + ": " + problem.info.formula);
    regions.push_back(region_of(problem.info.name, variant));
    const auto map = step_map_on(regions.back(), spec);
    found.push_back(measure(*map, regions.back()));
    const std::vector<PropertyRow> rows{judge(map->claims(), {found.back()})};
    EXPECT_TRUE(rows[0].agrees()) << rows[0].differing() << '\n' << property_table(rows);
  }
  // What measure_method does besides, here once: runs on the Kepler ellipse and three bodies are in every certificate.
  if (regions.empty()) return;
  EXPECT_EQ(certificate_of(spec, regions, found).reversals.size(), regions.size());
}

/// Implicit methods that are compiled once for all problems, beside pendulum and henon-heiles: where H is not
/// separable, with forces of more bodies than one.
struct Beside {
  std::string method;
  std::string problem;
  std::map<std::string, std::string> variant{};
};
class ClaimsBeside : public ::testing::TestWithParam<Beside> {};
TEST_P(ClaimsBeside, HoldForTheOtherShapesOfH) {
  const std::vector<Region> regions{region_of(GetParam().problem, GetParam().variant)};
  const std::vector<PropertyRow> rows{measure_method(parse_method(GetParam().method), regions)};
  EXPECT_TRUE(rows[0].agrees()) << rows[0].differing() << '\n' << property_table(rows);
}
const std::map<std::string, std::string> nonlinear{{"model", "nonlinear"}};
INSTANTIATE_TEST_SUITE_P(Catalogue, ClaimsBeside,
                         ::testing::Values(Beside{"lobatto-3a-3b(3)", "double-pendulum", nonlinear},
                                           Beside{"discrete-gradient", "double-pendulum", nonlinear},
                                           Beside{"eg(2)", "n-body"},
                                           Beside{"rattle", "double-pendulum", {{"coordinates", "cartesian"}}}),
                         [](const auto& each) {
                           return test_name({each.param.method + "_" + each.param.problem, each.index});
                         });

INSTANTIATE_TEST_SUITE_P(Catalogue, SharedClaims, ::testing::ValuesIn(shares()), share_name);
INSTANTIATE_TEST_SUITE_P(Catalogue, Claims, ::testing::ValuesIn(method_names()), test_name);

TEST(Expected, AnOscillationInStepWithTheBlocksIsNoDrift) {
  // Of the starts on the pendulum one has a period that fits so nearly into a block that its oscillation is seen to
  // turn once in 511 of them.
  const Region region = region_of("pendulum");
  EXPECT_EQ(measure_energy(*step_map_on(region, parse_method("gauss(4)")), region).drift.drift, DriftClass::bounded);
}

TEST(Expected, AFixedQuadratureConservesOnlyAsFarAsItIsExact) {
  // At the pericentre of the ellipse with a step so large that five points miss the force along the chord; "auto"
  // takes more points.
  Region coarse = region_of("central-force");
  coarse.step = 0.4;
  const auto energy_of = [&](const char* method) {
    return measure_energy(*step_map_on(coarse, parse_method(method)), coarse);
  };
  const EnergyMeasurement five = energy_of("cg(1,5)");
  const EnergyMeasurement automatic = energy_of("cg(1,auto)");
  EXPECT_GT(five.level, 100 * five.rounding);
  EXPECT_NEAR(five.step_exponent, 10, 1);  // h^(2 s)
  EXPECT_EQ(five.conserving(2), Conservation::up_to_quadrature);
  EXPECT_LE(automatic.level, automatic.rounding);
  EXPECT_EQ(automatic.conserving(2), Conservation::yes);
}

TEST(Expected, WhatIsLeftOfTheElementsDriftIsFarBelowARoundingPerStep) {
  // Newton's last corrections are of the size of a few roundings, not random, and their rounding adds up. The bound is
  // what was reached: H then changes by less than 10^-9 of its size in 10^9 steps.
  constexpr int blocks = 32;
  constexpr std::int64_t block_steps = 8192;
  const Region region = region_of("pendulum");
  for (const char* name : {"cg(1,5)", "cg(1,auto)"}) {
    const auto map = step_map_on(region, parse_method(name));
    for (const double h : {0.1, 0.07, 0.05}) {
      for (std::uint64_t k = 0; k < 4; ++k) {
        const std::vector<double> h_of_t = map->energies(random_state(region, k), h, blocks, block_steps);
        ASSERT_EQ(h_of_t.size(), blocks + 1u);
        const double per_step = (h_of_t.back() - h_of_t.front()) / static_cast<double>(blocks * block_steps);
        EXPECT_LT(std::abs(per_step), std::numeric_limits<double>::epsilon() / 256) << name << ", h = " << h;
      }
    }
  }
}

TEST(Expected, AutomaticQuadratureKeepsTheEnergyAtRoundingWhateverTheStep) {
  // Down to steps where one point is right to 10^-17 of H in each step but not in 10^5 of them.
  const Region region = region_of("pendulum");
  const auto map = step_map_on(region, parse_method("cg(1,auto)"));
  for (int k = 0; k <= 13; ++k) {
    const double h = std::ldexp(region.step, -k);
    const auto steps = static_cast<std::int64_t>(5 / h / 16);  // most of a period
    double worst = 0;
    for (const double energy : map->energies(region.centre, h, 16, steps)) {
      worst = std::max(worst, std::abs(energy - map->energies(region.centre, h, 0, 0).front()));
    }
    EXPECT_LT(worst, 16 * std::numeric_limits<double>::epsilon() * map->energy_scale(region.centre)) << "h = " << h;
  }
}

/// 4096 steps, each of which rounds the work that it does, an eighth of the energy at most.
void expect_energy_at_rounding(const char* method, const Region& region) {
  const auto map = step_map_on(region, parse_method(method));
  for (std::uint64_t k = 0; k < 2; ++k) {
    const State<double> start = random_state(region, k);
    const std::vector<double> energies = map->energies(start, region.step, 64, 64);
    ASSERT_EQ(energies.size(), 65u);
    double worst = 0;
    for (const double energy : energies) worst = std::max(worst, std::abs(energy - energies.front()));
    EXPECT_LT(worst, 8 * std::numeric_limits<double>::epsilon() * map->energy_scale(start)) << method;
  }
}

TEST(Expected, AutomaticQuadratureHoldsForBodies) {
  // Forces of bodies cancel: an estimate of rounding by the sizes of their terms would let 10^-12 of the energy pass.
  for (const char* name : {"cg(1,auto)", "cg(2,auto)", "cg(3,auto)"}) {
    expect_energy_at_rounding(name, region_of("n-body"));
  }
}

TEST(Expected, ElementsOfDegreeTwoWhereACoordinateIsCyclicAndWhereHIsNotSeparable) {
  // Where momenta are eliminated they are measured by Claims; that all ways to solve are one map, by Averages.
  for (const Region& region : {region_of("central-force", {{"coordinates", "polar"}}),
                               region_of("double-pendulum", {{"model", "nonlinear"}})}) {
    expect_energy_at_rounding("cg(2,auto)", region);
    EXPECT_EQ(measure_order(*step_map_on(region, parse_method("cg(2,auto)")), region).is(4), Finding::yes);
  }
}

TEST(Expected, NamesOfOneMapHaveItsBitsAndItsClaims) {
  const auto end_of = [](const char* name, const char* problem) {
    const Region region = region_of(problem);
    State<double> z = region.centre;
    EXPECT_TRUE(step_map_on(region, parse_method(name))->advance(z, region.step, 50));
    return z;
  };
  for (const auto& [name, first] : {std::pair{"implicit-midpoint", "cg(1,1)"}, std::pair{"avf(1)", "cg(1,1)"},
                                    std::pair{"avf(4)", "cg(1,4)"}, std::pair{"avf(auto)", "cg(1,auto)"}}) {
    for (const char* problem : {"pendulum", "double-pendulum"})
      EXPECT_EQ(end_of(name, problem), end_of(first, problem));
    const MethodInfo claims = describe(parse_method(name));
    const MethodInfo other = describe(parse_method(first));
    EXPECT_EQ(std::tie(claims.order, claims.symplectic, claims.symmetric, claims.energy_conserving),
              std::tie(other.order, other.symplectic, other.symmetric, other.energy_conserving))
        << name;
  }
}

TEST(Judgement, OnOneProblemAPropertyMayHoldByItsMerit) {
  // The midpoint rule conserves quadratic Hamiltonians; on two problems the other one shows that it is no conserver.
  const std::vector<Region> two{region_of("harmonic"), region_of("pendulum")};
  const PropertyRow both = measure_method(parse_method("cg(1,1)"), two);
  const PropertyRow alone = judge(both.claims, {both.on.at(0)});
  EXPECT_EQ(alone["energy conserving"].measured, "yes");
  EXPECT_TRUE(alone.agrees());
  EXPECT_EQ(both["energy conserving"].measured, "no");
  EXPECT_TRUE(both.agrees());
}

TEST(Judgement, WhatWasNotMeasuredIsUnclear) {
  const PropertyRow sound = measure_method(parse_method("verlet"), default_regions());
  ASSERT_EQ(sound.verdict(), Finding::yes);
  const auto without = [&](const auto& forget) {
    std::vector<Measurement> on = sound.on;
    forget(on.at(1));
    return judge(sound.claims, std::move(on));
  };
  const auto unclear = [](const PropertyRow& row, const char* property) {
    EXPECT_EQ(row.verdict(), Finding::unclear);
    EXPECT_EQ(row.differing(), property);
    EXPECT_NE(row[property].reason.find("it broke"), std::string::npos) << row[property].reason;
  };
  const std::string why = "it broke";
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  unclear(without([&](Measurement& m) { m.symmetric = {unknown, unknown, Finding::unclear, why}; }), "symmetric");
  unclear(without([&](Measurement& m) { m.order = {unknown, 1, unknown, unknown, why}; }), "order");
  unclear(without([&](Measurement& m) { m.cost = {unknown, unknown, unknown, unknown, Finding::yes, unknown, why}; }),
          "forces per step");
  // That the energy is not conserved on the other problem is enough; the conserver's claim is what stays open.
  const auto open = [&](Measurement& m) {
    m.energy.level = unknown;
    m.energy.drift = classify_drift({{0}});
    m.energy.reason = why;
  };
  EXPECT_EQ(without(open).verdict(), Finding::yes);
  std::vector<Measurement> both = sound.on;
  for (Measurement& m : both) open(m);
  unclear(judge(sound.claims, both), "energy conserving");
}

TEST(Judgement, WhereNoStepConvergesNothingIsFound) {
  const PropertyRow row = measure_method(parse_method("gauss(2,max_iterations=1)"), default_regions());
  EXPECT_EQ(row.verdict(), Finding::unclear);
  for (const PropertyCell& cell : row.cells) {
    if (cell.claimed == "-") continue;
    EXPECT_EQ(cell.agrees, Finding::unclear) << cell.property;
  }
  EXPECT_FALSE(row.certificate.drift.has_value());
}

TEST(Judgement, WhatLeavesItsScaleKeepsNothing) {
  // With steps so long that the Sun does not hold them the planets go straight on, to where the rounding of what they
  // are is as large as it was at the start.
  Region region = region_of("solar-system");
  region.step *= 1e9;
  int left = 0;
  for (const MethodCertificate::Map& map : certificate_of(parse_method("verlet"), {&region, 1}, {}).momentum_maps) {
    if (map.problem != "solar-system") {
      EXPECT_EQ(map.conserved, true) << map.problem << ' ' << map.name;
      continue;
    }
    ++left;
    EXPECT_EQ(map.steps, 20000) << map.name;
    EXPECT_FALSE(map.conserved.has_value()) << map.name;
    EXPECT_NE(map.reason.find("grew too much"), std::string::npos) << map.reason;
  }
  EXPECT_GT(left, 0);
}

TEST(Report, FlagsWhatDiffers) {
  const std::vector<Region> regions = default_regions();
  PropertyRow row = measure_method(parse_method("verlet"), regions);
  const std::string sound = property_table(std::vector<PropertyRow>{row});
  EXPECT_EQ(sound.find(" !!", sound.find('\n')), std::string::npos) << sound;  // the first line explains the mark
  MethodInfo wrong = row.claims;
  wrong.order = 4;
  wrong.symmetric = false;
  const std::vector<PropertyRow> rows{judge(wrong, row.on)};
  EXPECT_FALSE(rows[0].agrees());
  EXPECT_EQ(rows[0].differing(), "order, symmetric");
  const std::string table = property_table(rows);
  EXPECT_NE(table.find("4 / 2.00 !!"), std::string::npos) << table;
  EXPECT_NE(table.find("no / yes !!"), std::string::npos) << table;
  EXPECT_NE(table.find("DIFFERS: order, symmetric"), std::string::npos) << table;
  const std::string json = property_json(rows);
  EXPECT_NE(json.find("\"agrees\": false"), std::string::npos);
  EXPECT_EQ(json.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace hamflow
