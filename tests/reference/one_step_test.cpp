// One and ten steps against 25 digits computed elsewhere from the definition of each method.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/run/catalog.hpp"
#include "reference_data.hpp"

namespace hamflow::test {
namespace {

// One step is a dozen operations on numbers up to 2, each rounding by at most 2^-53 of its size; ten steps at e = 0.6
// pass pericentre, where errors grow by about the ratio of the forces, 10.
constexpr double one_step_bound = 16 * 0x1p-52;
constexpr double ten_steps_bound = 10 * 10 * one_step_bound;

struct StepCase {
  const char* method;     // hamflow's
  const char* reference;  // the file's
  friend void PrintTo(const StepCase& c, std::ostream* out) { *out << c.method; }
};

class OneStep : public ::testing::TestWithParam<StepCase> {};

TEST_P(OneStep, MatchesTheDefinition) {
  const auto file = reference_file("one_step.json")["one_step"][0];
  nlohmann::json wanted;
  for (const auto& m : file["methods"]) {
    if (m["method"] == GetParam().reference) wanted = m;
  }
  ASSERT_FALSE(wanted.is_null());
  for (const std::string arithmetic : {"double", "compensated"}) {
    Request request{.problem = "central-force",
                    .variant = {{"potential", "kepler"}},
                    .parameters = {},
                    .start = {},
                    .method = parse_method(GetParam().method)};
    request.start.q = texts(file["q0"]);
    request.start.p = texts(file["p0"]);
    request.dt = file["h"].get<std::string>();
    request.arithmetic = arithmetic;
    const auto simulation = make_simulation(request);
    Frame frame;
    for (const auto& [steps, q_key, p_key, bound] :
         {std::tuple{1, "q1", "p1", one_step_bound}, std::tuple{9, "q10", "p10", ten_steps_bound}}) {
      ASSERT_EQ(simulation->advance(steps), Outcome::done);
      simulation->look(frame);
      const auto q = doubles(wanted[q_key]);
      const auto p = doubles(wanted[p_key]);
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(frame.q[i], q[i], bound) << arithmetic << " " << q_key;
        EXPECT_NEAR(frame.p[i], p[i], bound) << arithmetic << " " << p_key;
      }
    }
  }
}

TEST_P(OneStep, MatchesTheDefinitionInLongDouble) {
  // The same to the digits of long double: nothing on the way, no coefficient either, is a double.
  const auto file = reference_file("one_step.json")["one_step"][0];
  const auto found_entry = find_problem("central-force", {{"potential", "kepler"}});
  const ProblemEntry& entry = *found_entry;
  const auto map = entry.step_map({.problem = "central-force",
                                   .variant = {},
                                   .parameters = complete(entry.info, {}),
                                   .start = {},
                                   .method = parse_method(GetParam().method)},
                                  2);
  const auto state = [](const nlohmann::json& q, const nlohmann::json& p) {
    State<long double> z;
    for (const auto& part : {texts(q), texts(p)}) {
      for (const std::string& x : part) z.push_back(evaluate_number<long double>(x));
    }
    return z;
  };
  const auto h = evaluate_number<long double>(file["h"].get<std::string>());
  for (const auto& m : file["methods"]) {
    if (m["method"] != GetParam().reference) continue;
    for (const auto& [steps, q_key, p_key, bound] :
         {std::tuple{1, "q1", "p1", one_step_bound}, std::tuple{10, "q10", "p10", ten_steps_bound}}) {
      State<long double> z = state(file["q0"], file["p0"]);
      ASSERT_TRUE(map->advance(z, h, steps));
      const State<long double> wanted = state(m[q_key], m[p_key]);
      long double distance = 0;
      for (std::size_t i = 0; i < z.size(); ++i) distance = std::max(distance, std::fabs(z[i] - wanted[i]));
      EXPECT_LE(distance, 0x1p-11L * bound) << q_key;  // 64 bits instead of 53
      std::printf("  %s, %d steps: %.1Le\n", GetParam().method, steps, distance);
    }
  }
}

/// |a - b| of two decimal literals, in 60 digits.
long double distance(const std::string& a, const std::string& b) {
  const MpDigits scope(60);
  return static_cast<long double>(abs(evaluate_number<Mp>(a) - evaluate_number<Mp>(b)));
}

TEST_P(OneStep, MatchesTheDefinitionInAllDigits) {
  // Through the catalogue, from the digits of the scenario to those of the result. The file was computed with 32
  // digits, hence rounds by some 1e-31 itself; rounding here is that of double times 2^-51 (106 bits), 2^-60 (113) and
  // 2^-80.
  const auto file = reference_file("one_step.json")["one_step"][0];
  nlohmann::json wanted;
  for (const auto& m : file["methods"]) {
    if (m["method"] == GetParam().reference) wanted = m;
  }
  for (const auto& [arithmetic, unit] :
       {std::pair{"double-double", 0x1p-51L}, std::pair{"quad", 0x1p-60L}, std::pair{"mp(40)", 0x1p-80L}}) {
    Request request{.problem = "central-force", .variant = {{"potential", "kepler"}}};
    request.method = parse_method(GetParam().method);
    request.start.q = texts(file["q0"]);
    request.start.p = texts(file["p0"]);
    request.dt = file["h"].get<std::string>();
    request.arithmetic = arithmetic;
    const auto simulation = make_simulation(request);
    Frame frame;
    for (const auto& [steps, q_key, p_key, bound] :
         {std::tuple{1, "q1", "p1", one_step_bound}, std::tuple{9, "q10", "p10", ten_steps_bound}}) {
      ASSERT_EQ(simulation->advance(steps), Outcome::done);
      simulation->look(frame);
      long double worst = 0;
      for (std::size_t i = 0; i < 2; ++i) {
        worst = std::max(
            {worst, distance(frame.digits.q[i], wanted[q_key][i]), distance(frame.digits.p[i], wanted[p_key][i])});
      }
      // "auto" takes no further point when what it adds to the energy is below an estimate of rounding, which is some
      // hundred times what rounding does: its quadrature differs from the exact one by that.
      const bool automatic = std::string(GetParam().method).find("auto") != std::string::npos;
      EXPECT_LE(worst, (automatic ? 512 : 1) * unit * bound + 1e-31L) << arithmetic << " " << q_key;
      std::printf("  %s in %s, %s: %.1Le\n", GetParam().method, arithmetic, q_key, worst);
    }
  }
}

/// The double pendulum, H of size 40, to 1/40 of the digits.
TEST(OneStepOfTheDoublePendulum, MatchesTheDefinition) {
  const auto file = reference_file("one_step.json")["one_step"][1];
  const std::vector<StepCase> cases{{"implicit-midpoint", "implicit_midpoint"},
                                    {"gauss(1)", "implicit_midpoint"},
                                    {"avf(5)", "cG1_5gauss"},
                                    {"cg(1,5,iteration=simplified)", "cG1_5gauss"},
                                    {"cg(2,64)", "cG2_exact"},
                                    {"cg(2,64,iteration=fixed-point)", "cG2_exact"},
                                    {"cg(2,auto)", "cG2_exact"}};
  for (const StepCase& each : cases) {
    bool found = false;
    for (const auto& m : file["methods"]) {
      if (m["method"] != each.reference) continue;
      found = true;
      Request request{.problem = "double-pendulum", .variant = {{"model", "nonlinear"}, {"angles", "absolute"}}};
      request.parameters = {{"masses", "[2, 2]"}, {"half_lengths", "[3, 3]"}};
      request.method = parse_method(each.method);
      request.start.q = texts(file["q0"]);
      request.start.p = texts(file["p0"]);
      request.dt = file["h"].get<std::string>();
      const auto simulation = make_simulation(request);
      Frame frame;
      for (const auto& [steps, q_key, p_key, bound] :
           {std::tuple{1, "q1", "p1", 40 * one_step_bound}, std::tuple{9, "q10", "p10", 40 * ten_steps_bound}}) {
        ASSERT_EQ(simulation->advance(steps), Outcome::done) << each.method;
        simulation->look(frame);
        const auto q = doubles(m[q_key]);
        const auto p = doubles(m[p_key]);
        for (std::size_t i = 0; i < 2; ++i) {
          EXPECT_NEAR(frame.q[i], q[i], bound) << each.method << " " << q_key;
          EXPECT_NEAR(frame.p[i], p[i], bound) << each.method << " " << p_key;
        }
      }
    }
    EXPECT_TRUE(found) << each.reference;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Methods, OneStep,
    ::testing::Values(StepCase{"euler-a", "symplectic_euler_q_first"}, StepCase{"euler-b", "symplectic_euler_p_first"},
                      StepCase{"verlet", "verlet_KDK"}, StepCase{"stv4", "StV4_triple_jump_KDK"},
                      StepCase{"cg(1,1)", "implicit_midpoint"}, StepCase{"cg(1,5)", "cG1_5gauss"},
                      StepCase{"cg(1,auto)", "cG1_exact"}, StepCase{"gauss(1)", "implicit_midpoint"},
                      StepCase{"gauss(2)", "gauss_2"}, StepCase{"gauss(2,iteration=fixed-point)", "gauss_2"},
                      StepCase{"cg(2,2)", "gauss_2"}, StepCase{"cg(2,2,iteration=simplified)", "gauss_2"},
                      StepCase{"cg(2,64)", "cG2_exact"}, StepCase{"cg(2,auto)", "cG2_exact"}),
    [](const auto& each) {
      std::string name = each.param.method;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
      return name;
    });

}  // namespace
}  // namespace hamflow::test
