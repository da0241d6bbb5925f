// The gas as the thesis lists it, against hamflow's: the experiments take it for a second implementation.
#include "gas_listing.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "gas_runs.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/workflow/run.hpp"

namespace hamflow::reproduction {
namespace {

RunReport run_of(const std::string& toml) {
  const Reading reading = read_scenario_text(toml, "gas.toml", {});
  return run(*reading.scenario);
}

RunReport gas(const std::string& scale, int steps) {
  return run_of("[problem]\nname = \"gas\"\nparticles_per_side = 5\nscale = \"" + scale +
                "\"\n\n[method]\nname = \"stv4\"\n\n[run]\ndt = 0.001\nsteps = " + std::to_string(steps) +
                "\nrecord_every = 20\n");
}

TEST(GasListing, IsTheGas) {
  for (const auto& [name, S] : {std::pair{"per-side", 2.0}, std::pair{"listing", 12.0}}) {
    const RunReport start = gas(name, 0), end = gas(name, 20);
    ListedGas listed(S, 0.001, start.final.q, start.final.p);
    EXPECT_NEAR(listed.energy(), start.energy.initial, 100 * 0x1p-53 * start.energy_scale);
    for (int k = 0; k < 20; ++k) listed.step();
    for (std::size_t i = 0; i < start.final.q.size(); ++i) {
      // 61 kicks of some ten roundings each, of numbers up to 1; the listed factors have 15 digits.
      EXPECT_NEAR(listed.q()[i], end.final.q[i], 61 * (10 * 0x1p-52 + 5e-15 * 0.001));
      EXPECT_NEAR(listed.p()[i], end.final.p[i], 61 * (10 * 0x1p-52 + 5e-15 * 0.001));
    }
    EXPECT_EQ(listed.outside(), 0);
  }
}

/// c times the numbers, as an array of TOML.
std::string times(double c, const std::vector<double>& numbers) {
  std::string all;
  for (const double x : numbers) all += (all.empty() ? "" : ", ") + fmt::format("{}", c * x);
  return "[" + all + "]";
}

/// hamflow's wall goes with S^-(2 + 2e). With all else of H times c = S^(2 - 2e), the inertia too, it is the listed
/// one, S^-4, in other units.
TEST(GasListing, HasPowersOfTheWallThatKeepTheListedFactor) {
  constexpr int e = 4;
  constexpr double S = 2, c = 1.0 / 64;
  const RunReport start = gas("per-side", 0);
  const RunReport end = run_of(fmt::format(
      "[problem]\nname = \"gas\"\nscale = {}\nmasses = {}\npair = \"formula\"\nphi = \"c*(r^(-12) - 2*r^(-6))\"\n"
      "parameters = {{ c = {} }}\ncontainer = {{ kind = \"circle\", radius = 1.5, exponent = {} }}\n"
      "initial = {{ q = {}, p = {} }}\n\n[method]\nname = \"stv4\"\n\n[run]\ndt = 0.001\nsteps = 200\n",
      S, c, c, e, times(1, start.final.q), times(c, start.final.p)));
  ListedGas listed(S, 0.001, start.final.q, start.final.p, e);
  const double energy = listed.energy();
  for (int k = 0; k < 200; ++k) listed.step();
  for (std::size_t i = 0; i < start.final.q.size(); ++i) {
    EXPECT_NEAR(listed.q()[i], end.final.q[i], 1e-9);  // the rounding of 601 kicks, which bounces enlarge
    EXPECT_NEAR(c * listed.p()[i], end.final.p[i], c * 1e-8);
  }
  EXPECT_NEAR(listed.energy(), energy, 1e-3 * std::abs(energy));
}

TEST(GasRuns, DigitsAreThoseOfTheArithmetic) {
  SharedWork others(1);
  Study study({.id = "S-one"}, WorkExtent::quick, {}, std::filesystem::temp_directory_path(), others);
  EXPECT_DOUBLE_EQ(digits_of(study, "double"), 52 * std::log10(2.0));
  EXPECT_NEAR(digits_of(study, "quad"), 112 * std::log10(2.0), 1e-12);
  EXPECT_GT(digits_of(study, "mp(40)"), 39);
}

TEST(GasListing, TellsWhoFliesOffFromWhoPassesTheWall) {
  // Less than a length of the potential apart, which the first part of a step makes a quarter.
  const Passage flown = passage({60, 0.01, {-0.0075, 0, 0.0075, 0}, {0.7, 0, -0.7, 0}, 4}, 10, [] {});
  EXPECT_GT(flown.step, 0);
  EXPECT_TRUE(flown.is_after_collision);
  const std::vector<double> q{1.49, 0, -1, 0}, p{1, 0, 0, 0};
  const Passage passed = passage({60, 0.05, q, p}, 10, [] {});
  EXPECT_EQ(passed.step, 1);
  EXPECT_FALSE(passed.is_after_collision);
  // The listed wall lets it through with a step that is short enough for the power 4.
  EXPECT_GT(passage({60, 0.001, q, p}, 100, [] {}).step, 0);
  EXPECT_EQ(passage({60, 0.001, q, p, 4}, 100, [] {}).step, 0);
}

TEST(GasListing, ReturnsAndSeesCrossers) {
  const RunReport start = gas("per-side", 0);
  const ListedReturn back = listed_return({2, 0.001, start.final.q, start.final.p}, 20, false, [] {});
  EXPECT_LT(back.position, 122 * 10 * 0x1p-52);
  EXPECT_EQ(back.first_outside, 0);
  std::vector<double> q = start.final.q;
  q[0] = -1.3, q[1] = -1.3;
  ListedGas crossed(2, 0.001, q, start.final.p);
  EXPECT_EQ(crossed.outside(), 1);
  EXPECT_EQ(crossed.put_crossers_at_the_origin(), 1);
  EXPECT_EQ(crossed.q()[0], 0);
  EXPECT_EQ(crossed.outside(), 0);
}

}  // namespace
}  // namespace hamflow::reproduction
