// Kepler orbits by the programs printed in the first thesis, at each step that the reference lists.
#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/run/catalog.hpp"
#include "reference_data.hpp"

namespace hamflow::test {
namespace {

class Listing : public ::testing::TestWithParam<const char*> {};

TEST_P(Listing, SameStates) {
  const auto data = reference_file("listings.json")["kepler_cartesian"][GetParam()];
  Request request{
      .problem = "central-force", .variant = {{"potential", "kepler"}}, .parameters = {}, .start = {}, .method = {}};
  request.parameters = {{"mass", data["mass"].dump()}, {"k", data["k"].dump()}};
  request.start.q = texts(data["q0"]);
  request.start.p = texts(data["p0"]);
  request.dt = data["dt"].dump();
  request.method.name = "cg";
  request.method.cg = {.quadrature = data["ir"].get<int>(), .tolerance = data["tol"].get<double>()};
  const auto simulation = make_simulation(request);
  Frame frame;
  for (const auto& state : data["states"]) {
    const auto step = state["step"].get<std::int64_t>();
    ASSERT_EQ(simulation->advance(step - simulation->step()), Outcome::done);
    simulation->look(frame);
    const auto q = doubles(state["q"]);
    const auto p = doubles(state["p"]);
    double distance = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      distance = std::max({distance, std::fabs(frame.q[i] - q[i]), std::fabs(frame.p[i] - p[i])});
    }
    // The printed programs stop at a residual of 1e-13, iterate in q1, and take p1 = 2 mu (q1 - q0)/h - p0, which
    // rounds by 2 mu epsilon |q|/h = 4e-14 a step; the phase error of a Kepler orbit grows like t^2.
    const double t = static_cast<double>(step) * data["dt"].get<double>();
    EXPECT_LE(distance, 2e-13 * (1 + t * t / 2)) << "step " << step;
    std::printf("  %s, step %lld: distance %.1e\n", GetParam(), static_cast<long long>(step), distance);
  }
  const Effort effort = simulation->effort();
  std::printf(
      "  %s: Newton min %lld, mean %.3f, max %lld; the listing: %d, %.3f, %d; energy error %.1e; the listing: %.1e\n",
      GetParam(), effort.solves_min, static_cast<double>(effort.linear_solves) / static_cast<double>(effort.steps),
      effort.solves_max, data["newton_iter_min"].get<int>(), data["newton_iter_mean"].get<double>(),
      data["newton_iter_max"].get<int>(), simulation->energy().max_error, data["max_abs_E_minus_E0"].get<double>());
  EXPECT_LE(effort.solves_max, data["newton_iter_max"].get<int>());
  if (data["ir"].get<int>() > 2) {  // a random walk of rounding errors in place of the listing's growth
    EXPECT_LT(simulation->energy().max_error, data["max_abs_E_minus_E0"].get<double>());
  }
}

INSTANTIATE_TEST_SUITE_P(Kepler, Listing, ::testing::Values("circle_r2", "ellipse_ir5", "ellipse_ir2"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace
}  // namespace hamflow::test
