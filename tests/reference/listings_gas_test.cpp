// The gas by the program printed in Sonnleitner2010, with neighbours at the distance of equilibrium: 5 x 5 particles.
#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/run/catalog.hpp"
#include "reference_data.hpp"

namespace hamflow::test {
namespace {

class GasListing : public ::testing::Test {
 protected:
  const nlohmann::json data_ = reference_file("listings.json")["gas"]["corr_5x5_dt0.001"];
  const std::shared_ptr<const ProblemEntry> entry_ = find_problem("gas", {});
  const ProblemEntry& gas_ = *entry_;
  const Texts parameters_ = complete(gas_.info, {{"scale", data_["inputs"]["SkalierFaktor"].dump()}});

  static std::vector<std::string> flat(const nlohmann::json& rows) {
    std::vector<std::string> all;
    for (const auto& row : rows) {
      for (const auto& x : row) all.push_back(x.dump());
    }
    return all;
  }
  static std::vector<double> numbers(const nlohmann::json& rows) {
    std::vector<double> all;
    for (const auto& row : rows) {
      for (const auto& x : row) all.push_back(x.get<double>());
    }
    return all;
  }
};

TEST_F(GasListing, EnergyItsPartsAndTheFirstForces) {
  const std::vector<double> q = numbers(data_["q0"]);
  const std::vector<double> p = numbers(data_["p0"]);
  const std::vector<double> rest(q.size(), 0.0);
  const double epsilon = std::numeric_limits<double>::epsilon();
  // 300 pairs, each to some epsilon of its own size.
  const double bound = 50 * epsilon * 30;
  EXPECT_NEAR(gas_.energy(parameters_, q, p), data_["E0"].get<double>(), bound);
  const auto parts = doubles(data_["E0_parts_kin_pair_wall"]);
  EXPECT_NEAR(gas_.energy(parameters_, q, p) - gas_.energy(parameters_, q, rest), parts[0], bound);
  EXPECT_NEAR(gas_.energy(parameters_, q, rest), parts[1] + parts[2], bound);
  // The forces are what one kick of verlet adds to the momenta: 1 after a first half step of length 2^-30.
  Request request{.problem = "gas",
                  .parameters = parameters_,
                  .start = {.q = flat(data_["q0"]), .p = std::vector<std::string>(q.size(), "0")},
                  .method = {.name = "euler-b"},
                  .dt = "2^-30"};
  const auto simulation = make_simulation(request);
  ASSERT_EQ(simulation->advance(1), Outcome::done);
  Frame frame;
  simulation->look(frame);
  const std::vector<double> forces = numbers(data_["force0_selected"]);
  // Pairs of up to 12 (2^14 - 2^8) cancel near the equilibrium.
  for (std::size_t i = 0; i < q.size(); ++i) EXPECT_NEAR(frame.p[i] * 0x1p30, forces[i], 100 * epsilon) << i;
}

/// By the seed's own step, with its force in another order of sums: what is left is rounding, and its growth.
TEST_F(GasListing, States) {
  Request request{.problem = "gas",
                  .parameters = parameters_,
                  .start = {.q = flat(data_["q0"]), .p = flat(data_["p0"])},
                  .method = {.name = "stv4"},
                  .dt = "0.001"};
  for (const char* const arithmetic : {"double", "compensated", "lattice"}) {
    request.arithmetic = arithmetic;
    const auto simulation = make_simulation(request);
    Frame frame;
    for (const int step : {1, 10, 100, 200}) {
      const auto state = data_["step_" + std::to_string(step)];
      ASSERT_EQ(simulation->advance(step - simulation->step()), Outcome::done);
      simulation->look(frame);
      const std::vector<double> q = numbers(state["q"]);
      const std::vector<double> p = numbers(state["p"]);
      // Some epsilon each step; near the wall, where forces reach 100, they grow a hundredfold over the 200 steps.
      const double bound = 1e-15 * (1 + step) * (step > 10 ? 100 : 1);
      for (std::size_t i = 0; i < q.size(); ++i) {
        EXPECT_NEAR(frame.q[i], q[i], bound) << arithmetic << " step " << step;
        EXPECT_NEAR(frame.p[i], p[i], 10 * bound) << arithmetic << " step " << step;
      }
      EXPECT_NEAR(frame.energy, state["E"].get<double>(), 100 * bound);
    }
    EXPECT_NEAR(simulation->energy().max_error, data_["forward_max_abs_dE"].get<double>(), 1e-11);
  }
}

}  // namespace
}  // namespace hamflow::test
