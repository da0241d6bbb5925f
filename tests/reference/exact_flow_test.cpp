// Exact flows to 25 digits: the reference flow of the verification reproduces them to the rounding of long double, and
// the methods of the catalogue come to them at their order.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hamflow/verify/measure.hpp"
#include "reference_data.hpp"

namespace hamflow::test {
namespace {

struct Case {
  const char* reference;
  const char* problem;
  std::map<std::string, std::string> variant{};
  Texts parameters{};
  friend void PrintTo(const Case& c, std::ostream* out) { *out << c.reference; }
};

class ExactFlow : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    const nlohmann::json file = reference_file("exact_flow.json");
    for (const auto& p : file["problems"]) {
      if (p["problem"] == GetParam().reference) data_ = p;
    }
    ASSERT_FALSE(data_.is_null());
    region_ = region_of(GetParam().problem, GetParam().variant);  // of a central force: Kepler
    for (const auto& [key, value] : GetParam().parameters) region_.parameters[key] = value;
    map_ = step_map_on(region_, parse_method("gauss(3)"));
    for (const std::string& x : texts(data_["initial_state_values"])) start_.push_back(evaluate_number<long double>(x));
  }
  static long double time_of(const nlohmann::json& result) {
    const std::string text =
        result.contains("t_value") ? result["t_value"].get<std::string>() : result["t"].get<std::string>();
    return evaluate_number<long double>(text);
  }
  static State<long double> state_of(const nlohmann::json& result) {
    State<long double> z;
    for (const std::string& x : texts(result["state"])) z.push_back(evaluate_number<long double>(x));
    return z;
  }
  static long double distance(const State<long double>& a, const State<long double>& b) {
    long double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::fabs(a[i] - b[i]));
    return most;
  }

  /// The state at t = 1.
  State<long double> wanted() const {
    for (const auto& result : data_["results"]) {
      if (time_of(result) == 1.0L) return state_of(result);
    }
    return {};
  }

  nlohmann::json data_;
  Region region_;
  std::unique_ptr<StepMap> map_;
  State<long double> start_;
};

TEST_P(ExactFlow, ReferenceFlow) {
  for (const auto& result : data_["results"]) {
    const long double t = time_of(result);
    if (t > 150) continue;  // minutes, for nothing new
    // Each of about 8 t extrapolated steps rounds by a few 2^-64; along an orbit of a regular system errors grow like
    // t.
    const long double bound = 64 * 0x1p-63L * (1 + t) * (1 + t);
    const long double error = distance(map_->flow(start_, t), state_of(result));
    EXPECT_LE(error, bound) << "t = " << static_cast<double>(t);
    std::printf("  %s, t = %.6g: %.1Le\n", GetParam().reference, static_cast<double>(t), error);
  }
}

TEST_P(ExactFlow, Yoshida6ConvergesToIt) {
  if (!find_problem(region_)->accepts(parse_method("yoshida6"))) return;
  const auto map = step_map_on(region_, parse_method("yoshida6"));
  constexpr long double rounding = 4096 * 0x1p-63L;  // some hundred steps of some ten roundings: slopes end there
  long double previous = 0;
  int slopes = 0;
  for (const int steps : {8, 16, 32, 64, 128, 256}) {
    State<long double> z = start_;
    ASSERT_TRUE(map->advance(z, 1.0L / steps, steps));
    const long double error = distance(z, wanted());
    if (previous > 0 && previous < 1e-7L && error > rounding) {  // small enough for the leading term to rule
      EXPECT_NEAR(static_cast<double>(std::log2(previous / error)), 6.0, 0.3) << steps;
      ++slopes;
    }
    previous = error;
  }
  EXPECT_GE(slopes, 1);
}

TEST_P(ExactFlow, ImplicitMethodsConvergeToIt) {
  constexpr long double rounding = 4096 * 0x1p-63L;
  for (const auto& [name, order] :
       {std::pair{"cg(2,auto)", 4}, std::pair{"cg(3,auto)", 6}, std::pair{"gauss(2)", 4}, std::pair{"gauss(3)", 6},
        std::pair{"gauss(4)", 8}, std::pair{"eg(1)", 2}, std::pair{"eg(2)", 4}, std::pair{"eg(3)", 6},
        std::pair{"lobatto-3a-3b(3)", 4}, std::pair{"lobatto-3a-3b(4)", 6}, std::pair{"discrete-gradient", 2}}) {
    if (!find_problem(region_)->accepts(parse_method(name))) continue;
    const auto map = step_map_on(region_, parse_method(name));
    long double previous = 0;
    double slope = 0;  // the last one that is not rounding: what follows the leading term is a quarter each halving
    int slopes = 0;
    for (const int steps : {4, 8, 16, 32, 64, 128, 256}) {
      State<long double> z = start_;
      if (!map->advance(z, 1.0L / steps, steps)) {
        ASSERT_LT(steps, 8) << name;  // a step of a quarter of the time may be too long
        continue;
      }
      const long double error = distance(z, wanted());
      if (error <= rounding) break;
      if (previous > 0) {
        slope = static_cast<double>(std::log2(previous / error));
        ++slopes;
      }
      previous = error;
    }
    ASSERT_GE(slopes, 1) << name;
    EXPECT_NEAR(slope, order, 0.3) << name;
    std::printf("  %s on %s: %.1Le, slope %.3f\n", name, GetParam().reference, previous, slope);
  }
}

TEST_P(ExactFlow, BackwardsIsTheInverse) {
  const State<long double> end = map_->flow(start_, 2.5L);
  EXPECT_GT(distance(end, start_), 0.01L);
  // The bound of the flow, once there and once back, of numbers of the size of the largest.
  const long double size = std::max(1.0L, distance(end, State<long double>(end.size())));
  EXPECT_LE(distance(map_->flow(end, -2.5L), start_), 2 * 64 * 0x1p-63L * 3.5L * 3.5L * size);
}

TEST(ReferenceFlow, ACollisionIsNotANumberAndEnds) {
  const auto map = step_map_on(region_of("central-force"), parse_method("verlet"));
  // From rest at r = 0.4 the centre is reached after pi sqrt(0.4^3/8) = 0.28.
  const State<long double> end = map->flow({0.4L, 0.0L, 0.0L, 0.0L}, 1.0L);
  EXPECT_TRUE(std::isnan(end[0]));
}

INSTANTIATE_TEST_SUITE_P(Problems, ExactFlow,
                         ::testing::Values(Case{"kepler_e0.6", "central-force"},
                                           Case{"henon_heiles_regular_gni", "henon-heiles"},
                                           Case{"pendulum_q2.5", "pendulum"},
                                           Case{"lj_oscillator", "lennard-jones-oscillator"},
                                           Case{"double_pendulum_midrod",
                                                "double-pendulum",
                                                {{"model", "nonlinear"}, {"angles", "absolute"}},
                                                {{"masses", "[2, 2]"}, {"half_lengths", "[3, 3]"}}},
                                           Case{"binomial_k1",
                                                "central-force",
                                                {{"potential", "binomial"}, {"coordinates", "cartesian"}},
                                                {{"k", "1"}, {"lambda", "1"}}},
                                           Case{"duffing_a1_b1", "duffing", {}, {{"alpha", "1"}, {"beta", "1"}}}),
                         [](const auto& each) {
                           std::string name = each.param.reference;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

}  // namespace
}  // namespace hamflow::test
