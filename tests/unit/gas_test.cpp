// Orders of methods on a gas whose potential ends: what a cut-off leaves of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/arithmetics.hpp"
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
                  .parameters = complete(find_problem("gas", choices)->info, given),
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

/// Six particles in a periodic box, the last one so many edges away.
Request far_apart(const std::string& edges) {
  const std::map<std::string, std::string> choices{{"container", "periodic"}};
  Request request{.problem = "gas",
                  .variant = choices,
                  .parameters = complete(find_problem("gas", choices)->info, {{"size", "[7.3, 7.3]"}}),
                  .method = {.name = "verlet"},
                  .dt = "0.01"};
  request.start.q = {"-2.1", "-2", "0.2", "-1.9", "2.3", "-2.2", "-2", "0.3", "0.1", "0.2", "2.2 - 7.3*" + edges,
                     "0.4"};
  request.start.p = {"0.1", "0.2", "-0.3", "0.1", "0.2", "-0.1", "0.3", "0.1", "-0.2", "0.2", "-0.1", "0.3"};
  return request;
}

/// Images are found in the same way by recorded steps and others, before a save and behind it.
TEST(GasImages, HaveTheSameBitsEveryWay) {
  for (const char* edges : {"0", "2", "3"}) {
    Request request = far_apart(edges);
    const auto whole = make_simulation(request);
    EXPECT_EQ(whole->advance(300), Outcome::done);
    const auto first = make_simulation(request);
    EXPECT_EQ(first->advance(150), Outcome::done);
    const auto second = make_simulation(request);
    second->restore(first->save());
    EXPECT_EQ(second->advance(150), Outcome::done);
    request.record = false;
    const auto ordinary = make_simulation(request);
    EXPECT_EQ(ordinary->advance(300), Outcome::done);
    EXPECT_EQ(whole->bits(), second->bits()) << edges;
    EXPECT_EQ(whole->bits(), ordinary->bits()) << edges;
  }
}

/// However far away: forces of an image do not vanish.
TEST(GasImages, AreFoundAtAnyDistance) {
  for (const std::string& arithmetic : test::present({"double", "quad"})) {
    const auto momenta = [&](const std::string& edges) {
      Request request = far_apart(edges);
      request.arithmetic = arithmetic;
      const auto run = make_simulation(request);
      EXPECT_EQ(run->advance(1), Outcome::done);
      Frame frame;
      run->look(frame);
      return frame.p;
    };
    const std::vector<double> near = momenta("0");
    const std::vector<double> far = momenta("10000000");
    for (std::size_t i = 0; i < near.size(); ++i) EXPECT_NEAR(near[i], far[i], 1e-7) << arithmetic << " " << i;
  }
}

}  // namespace
}  // namespace hamflow::test
