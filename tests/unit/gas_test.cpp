// Orders of methods on a gas whose potential ends: what a cut-off leaves of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "hamflow/run/catalog.hpp"

namespace hamflow::test {
namespace {

/// 5 x 5 particles in a periodic box at t = 1/4, by which time some have passed the ends of the potential.
std::vector<double> end_of(const std::string& method, const std::string& kind, int steps) {
  const std::map<std::string, std::string> choices{{"container", "periodic"}, {"cutoff_kind", kind}};
  Texts given{{"scale", "2"}, {"size", "[2.6, 2.6]"}, {"cutoff", "2.4"}};
  if (kind == "smooth") given["inner"] = "1.8";
  Request request{.problem = "gas",
                  .variant = choices,
                  .parameters = complete(find_problem("gas", choices).info, given),
                  .method = {.name = method},
                  .dt = "1/4/" + std::to_string(steps),
                  .arithmetic = "compensated"};
  for (int i = 0; i < 25; ++i) {
    request.start.q.insert(request.start.q.end(), {std::to_string(i % 5) + "/2 - 1", std::to_string(i / 5) + "/2 - 1"});
    request.start.p.insert(request.start.p.end(),
                           {std::to_string(i * 7 % 11 - 5) + "/5", std::to_string(i * 5 % 13 - 6) + "/6"});
  }
  const auto simulation = make_simulation(request);
  EXPECT_EQ(simulation->advance(steps), Outcome::done);
  Frame frame;
  simulation->look(frame);
  std::vector<double> z = frame.q;
  z.insert(z.end(), frame.p.begin(), frame.p.end());
  return z;
}

/// From three runs, each with half the step of the one before.
double order_of(const std::string& method, const std::string& kind, int steps) {
  const auto difference = [&](int n) {
    const std::vector<double> a = end_of(method, kind, n);
    const std::vector<double> b = end_of(method, kind, 2 * n);
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
  };
  return std::log2(difference(steps) / difference(2 * steps));
}

TEST(GasOrders, TwoAndFourSurviveASmoothEnd) {
  EXPECT_NEAR(order_of("verlet", "smooth", 100), 2, 0.05);
  EXPECT_NEAR(order_of("stv4", "smooth", 100), 4, 0.1);
}

/// Each passage of a jump of the force costs an error of the size of the step.
TEST(GasOrders, FourDoesNotSurviveAJumpOfTheForce) { EXPECT_LT(order_of("stv4", "shifted", 100), 3); }

}  // namespace
}  // namespace hamflow::test
