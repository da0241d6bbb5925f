// The T-tube by the program printed in Sonnleitner2010: steps that leave are rejected.
#include <gtest/gtest.h>

#include <cmath>

#include "../support/walled_request.hpp"
#include "reference_data.hpp"

namespace hamflow::test {
namespace {

class WalledListing : public ::testing::TestWithParam<const char*> {};

/// A kick after a rejection by the force of the new position, or of the wrong component, is off by 1e-3 at once.
TEST_P(WalledListing, SameStatesAndReflections) {
  const auto data = reference_file("listings.json")["t_tube"][GetParam()];
  const auto simulation =
      make_simulation(t_tube("stv4", WallRule::reject, data["dt"].dump(), data["eps"].dump(), texts(data["p0"])));
  Frame frame;
  for (const auto& state : data["states"]) {
    const auto step = state["step"].get<std::int64_t>();
    ASSERT_EQ(simulation->advance(step - simulation->step()), Outcome::done);
    simulation->look(frame);
    const auto q = doubles(state["q"]);
    const auto p = doubles(state["p"]);
    // Roundings of a step are some 4 epsilon of the largest momentum; what they become grows like the number of steps,
    // and at each of the bounces, whose times they shift, a little more.
    const double bound = 1e-13 * (1 + static_cast<double>(step) / 10);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(frame.q[i], q[i], bound) << "step " << step;
      EXPECT_NEAR(frame.p[i], p[i], 100 * bound) << "step " << step;
    }
    const std::vector<WallCount> counts = simulation->wall_counts();
    ASSERT_EQ(counts.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(counts[k].bounces, state["reflections_xm1_xp1_y0p1_y2p1"][k].get<std::int64_t>()) << "step " << step;
    }
  }
  EXPECT_NEAR(simulation->energy().max_error, data["max_abs_E_minus_E0"].get<double>(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(TTube, WalledListing, ::testing::Values("epsm0p6_v6_1_dt0p01", "epsp0p6_v1_1_dt0p001"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace hamflow::test
