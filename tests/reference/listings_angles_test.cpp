// The programs of Gross1999 in polar coordinates (a line through the centre) and for the double pendulum, at each step
// that the reference lists; the linear pendulum's modal solution, and condition numbers along the nonlinear one.
#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/run/catalog.hpp"
#include "reference_data.hpp"

namespace hamflow::test {
namespace {

double distance(const Frame& frame, const std::vector<double>& q, const std::vector<double>& p) {
  double largest = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    largest = std::max({largest, std::fabs(frame.q[i] - q[i]), std::fabs(frame.p[i] - p[i])});
  }
  return largest;
}

Request element_request(const std::string& problem, const std::map<std::string, std::string>& variant) {
  Request request;
  request.problem = problem;
  request.variant = variant;
  request.method = parse_method("cg(quadrature=5,tolerance=1e-13)");
  return request;
}

/// Goes through the listed states. A residual below 1e-13 and coordinates rounded to epsilon leave errors that a phase
/// error makes grow linearly: `per_step` for each step.
void compare(Simulation& simulation, const nlohmann::json& states, double per_step) {
  Frame frame;
  for (const auto& state : states) {
    const auto step = state["step"].get<std::int64_t>();
    ASSERT_EQ(simulation.advance(step - simulation.step()), Outcome::done);
    simulation.look(frame);
    const double far = distance(frame, doubles(state["q"]), doubles(state["p"]));
    EXPECT_LE(far, 1e-12 + per_step * static_cast<double>(step)) << "step " << step;
    std::printf("  step %lld: distance %.1e\n", static_cast<long long>(step), far);
  }
}

class DuffingListing : public ::testing::TestWithParam<const char*> {};

TEST_P(DuffingListing, SameStatesInPolarCoordinatesThroughTheCentre) {
  const auto data = reference_file("listings.json")["duffing_polar"][GetParam()];
  Request request = element_request("central-force", {{"potential", "binomial"}, {"coordinates", "polar"}});
  request.parameters = {{"mass", data["mass"].dump()}, {"k", data["k"].dump()}, {"lambda", data["lambda"].dump()}};
  request.start.q = texts(data["q0"]);
  request.start.p = texts(data["p0"]);
  request.dt = data["dt"].dump();
  const auto simulation = make_simulation(request);
  // The printed program's own energy wanders by 9e-13 in 100 steps (dt = 0.1), 9e-12 in 1000 (0.01): phase errors of
  // some 1e-14 a step, times the steps.
  compare(*simulation, data["states"], 3e-13);
  ASSERT_EQ(simulation->advance(data["steps_done"].get<std::int64_t>() - simulation->step()), Outcome::done);
  EXPECT_LE(simulation->effort().solves_max, data["newton_iter_max"].get<int>());
  EXPECT_LE(simulation->energy().max_error, data["max_abs_E_minus_E0"].get<double>());
}
INSTANTIATE_TEST_SUITE_P(Cases, DuffingListing, ::testing::Values("case1_dt0p1_corrected", "case3_dt0p01_corrected"));

class LinearPendulumListing : public ::testing::TestWithParam<const char*> {};

TEST_P(LinearPendulumListing, SameStatesAndTheModalSolution) {
  const auto data = reference_file("listings.json")["linear_double_pendulum"]["absolute"][GetParam()];
  Request request = element_request("double-pendulum", {{"model", "linear"}, {"angles", "absolute"}});
  request.parameters = {{"masses", "[0.25, 0.25]"}, {"half_lengths", "[0.5, 0.5]"}};  // tables 3.1, 3.2
  request.start.q = texts(data["q0"]);
  request.start.v = texts(data["qdot0"]);
  request.dt = data["cG1_dt"].dump();
  const auto simulation = make_simulation(request);
  const double size = std::max(std::fabs(doubles(data["q0"])[0]), std::fabs(doubles(data["q0"])[1]));
  compare(*simulation, data["cG1"], 1e-14 * size);
  EXPECT_EQ(simulation->effort().solves_max, 1);  // a linear system: one correction
  const auto found_entry = find_problem(request);
  const ProblemEntry& entry = *found_entry;
  const Texts parameters = complete(entry.info, request.parameters);
  const Frame start = entry.start([&] {
    Request full = request;
    full.parameters = parameters;
    return full;
  }());
  for (const auto& state : data["analytic"]) {
    const auto exact = entry.exact(parameters, start.q, start.p, state["t"].get<double>());
    ASSERT_TRUE(exact);
    const double t = state["t"].get<double>();
    // The phase of the faster mode, 12.2 t, rounds.
    EXPECT_LE(distance(*exact, doubles(state["q"]), doubles(state["p"])), 1e-15 * size * (8 + 12.3 * t) * 8)
        << "t = " << t;
  }
}
INSTANTIATE_TEST_SUITE_P(Starts, LinearPendulumListing, ::testing::Values("ic1", "ic2", "ic3"));

TEST(NonlinearPendulumListing, SameStatesAndConditionNumbers) {
  const auto data = reference_file("listings.json")["nonlinear_double_pendulum"]["absolute"];
  Request request = element_request("double-pendulum", {{"model", "nonlinear"}, {"angles", "absolute"}});
  request.parameters = {{"masses", "[2, 2]"}, {"half_lengths", "[3, 3]"}};
  request.start.q = texts(data["q0"]);
  request.start.p = texts(data["p0"]);
  request.dt = data["dt"].dump();
  request.method = parse_method("cg(quadrature=5,tolerance=1e-13,diagnostics=true)");
  const auto simulation = make_simulation(request);
  Frame frame;
  for (const auto& state : data["states"]) {
    const auto step = state["step"].get<std::int64_t>();
    ASSERT_EQ(simulation->advance(step - simulation->step()), Outcome::done);
    simulation->look(frame);
    const double far = distance(frame, doubles(state["q"]), doubles(state["p"]));
    // The motion is chaotic: errors of 1e-13 a step grow as they go; the listing's energy wanders by 1.4e-11.
    EXPECT_LE(far, 1e-12 + 1e-14 * static_cast<double>(step * step)) << "step " << step;
    const StepDiagnostics d = frame.diagnostics;
    std::printf("  step %lld: distance %.1e, cond K_T %.10g (%.10g), det %.10g (%.10g), cond M^-1 %.10g (%.10g)\n",
                static_cast<long long>(step), far, d.condition_tangent, state["condKt"].get<double>(),
                d.determinant_tangent, state["detKt"].get<double>(), d.condition_inverse_mass,
                state["condMinv"].get<double>());
    EXPECT_NEAR(d.condition_inverse_mass, state["condMinv"].get<double>(), 1e-9 * d.condition_inverse_mass + 10 * far);
    EXPECT_NEAR(d.determinant_tangent, state["detKt"].get<double>(), 1e-5);  // of the last iterate, here or there
    EXPECT_NEAR(d.condition_tangent, state["condKt"].get<double>(), 1e-3 * d.condition_tangent);
  }
  ASSERT_EQ(simulation->advance(data["steps_done"].get<std::int64_t>() - simulation->step()), Outcome::done);
  const Effort effort = simulation->effort();
  EXPECT_LE(effort.solves_max, data["newton_iter_true_max"].get<int>());
  EXPECT_LE(simulation->energy().max_error, data["max_abs_E_minus_E0"].get<double>());
  std::printf("  Newton %lld, %.3f, %lld; energy error %.1e (listing %.1e)\n", effort.solves_min,
              static_cast<double>(effort.linear_solves) / static_cast<double>(effort.steps), effort.solves_max,
              simulation->energy().max_error, data["max_abs_E_minus_E0"].get<double>());
}

}  // namespace
}  // namespace hamflow::test
