// Kepler orbits by the programs printed in Gross1999, at each step that the reference lists.
#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/run/catalog.hpp"
#include "reference_data.hpp"

namespace hamflow::test {
namespace {

struct Case {
  const char* group;
  const char* name;
  const char* potential;
};

class Listing : public ::testing::TestWithParam<Case> {};

TEST_P(Listing, SameStates) {
  const auto data = reference_file("listings.json")[GetParam().group][GetParam().name];
  Request request{.problem = "central-force",
                  .variant = {{"potential", GetParam().potential}},
                  .parameters = {},
                  .start = {},
                  .method = {}};
  request.parameters = {{"mass", data["mass"].dump()}, {"k", data["k"].dump()}};
  request.start.q = texts(data["q0"]);
  request.start.p = texts(data["p0"]);
  request.dt = data["dt"].dump();
  request.method = parse_method("cg(quadrature=" + data["ir"].dump() + ",tolerance=" + data["tol"].dump() + ")");
  const auto simulation = make_simulation(request);
  const double r_min = data["rmin"].get<double>();
  const double fastest = std::max(1.0, data["l0"].get<double>() / (data["mass"].get<double>() * r_min * r_min));
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
    // rounds by 2 mu epsilon |q|/h = 4e-14 a step; phase errors grow with the square of the angle, taken at its
    // fastest.
    const double angle = static_cast<double>(step) * data["dt"].get<double>() * fastest;
    EXPECT_LE(distance, 2e-13 * (1 + angle * angle / 2)) << "step " << step;
    std::printf("  %s, step %lld: distance %.1e\n", GetParam().name, static_cast<long long>(step), distance);
  }
  const Effort effort = simulation->effort();
  std::printf(
      "  %s: Newton min %lld, mean %.3f, max %lld; the listing: %d, %.3f, %d; energy error %.1e; the listing: %.1e\n",
      GetParam().name, effort.solves_min, static_cast<double>(effort.linear_solves) / static_cast<double>(effort.steps),
      effort.solves_max, data["newton_iter_min"].get<int>(), data["newton_iter_mean"].get<double>(),
      data["newton_iter_max"].get<int>(), simulation->energy().max_error, data["max_abs_E_minus_E0"].get<double>());
  EXPECT_LE(effort.solves_max, data["newton_iter_max"].get<int>());
  if (data["ir"].get<int>() > 2) {
    // A residual below the tolerance leaves v.R/2 of energy a step; the listings' own error comes on top of theirs.
    double speed = 0;
    for (const double x : doubles(data["p0"])) speed = std::max(speed, std::fabs(x) / data["mass"].get<double>());
    const double bound = static_cast<double>(effort.steps) * data["tol"].get<double>() * speed / 2;
    EXPECT_LT(simulation->energy().max_error, bound);
  }
}

INSTANTIATE_TEST_SUITE_P(Orbits, Listing,
                         ::testing::Values(Case{"kepler_cartesian", "circle_r2", "kepler"},
                                           Case{"kepler_cartesian", "ellipse_ir5", "kepler"},
                                           Case{"kepler_cartesian", "ellipse_ir2", "kepler"},
                                           Case{"central_cartesian", "hooke_ellipse", "hooke"},
                                           Case{"central_cartesian", "linear_bounded", "linear"},
                                           Case{"central_cartesian", "binomial_bounded", "binomial"},
                                           Case{"central_cartesian", "binomial_stiff_k1e3_dt0p01", "binomial"}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace hamflow::test
