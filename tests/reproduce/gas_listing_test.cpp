// The gas as the thesis lists it, against hamflow's: the experiments take it for a second implementation.
#include "gas_listing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hamflow/scenario/scenario.hpp"
#include "hamflow/workflow/run.hpp"

namespace hamflow::reproduction {
namespace {

RunReport gas(const std::string& scale, int steps) {
  const Reading reading =
      read_scenario_text("[problem]\nname = \"gas\"\nparticles_per_side = 5\nscale = \"" + scale +
                             "\"\n\n[method]\nname = \"stv4\"\n\n[run]\ndt = 0.001\nsteps = " + std::to_string(steps) +
                             "\nrecord_every = 20\n",
                         "gas.toml", {});
  return run_scenario(*reading.scenario);
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
