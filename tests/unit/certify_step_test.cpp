// A step of somebody else, in C++: those of the catalogue's own tables, and broken ones. More of them are measured in
// python/tests/test_certify.py.
#include "hamflow/verify/certify_step.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/core/error.hpp"

namespace hamflow {
namespace {

StepProblem pendulum() {
  const auto entry = usual_problem("pendulum");
  return {entry, {}, complete(entry->info, {})};
}

StepProblem ellipses() {
  const auto entry = usual_problem("central-force", {{"potential", "kepler"}, {"coordinates", "cartesian"}});
  return {entry, {entry->info.variant.begin(), entry->info.variant.end()}, complete(entry->info, {})};
}
void verlet_on_ellipses(std::vector<double>& q, std::vector<double>& p, double h) {
  const auto kick = [&] {
    const double r = std::hypot(q[0], q[1]);
    for (std::size_t i = 0; i < 2; ++i) p[i] -= h / 2 * q[i] / (r * r * r);
  };
  kick();
  for (std::size_t i = 0; i < 2; ++i) q[i] += h * p[i];
  kick();
}

void verlet(std::vector<double>& q, std::vector<double>& p, double h) {
  p[0] -= h / 2 * std::sin(q[0]);
  q[0] += h * p[0];
  p[0] -= h / 2 * std::sin(q[0]);
}

TEST(CertifyStep, VerletIsWhatItIsSaidToBe) {
  const StepCertificate found = certify_step(verlet, pendulum(), {.order = 2, .symplectic = true, .symmetric = true});
  EXPECT_NEAR(found.order.value(), 2, 0.05);
  EXPECT_EQ(found.agrees, true) << found.reason;
  ASSERT_EQ(found.preserves.size(), 1u);
  EXPECT_EQ(found.preserves[0].second, false);
}

TEST(CertifyStep, ClaimsThatDoNotHoldAreRefuted) {
  EXPECT_EQ(certify_step(verlet, pendulum(), {.order = 4}).agrees, false);
  EXPECT_EQ(certify_step(verlet_on_ellipses, ellipses(), {.order = 1}).agrees, false);
  EXPECT_EQ(certify_step(verlet_on_ellipses, ellipses(), {.symplectic = false}).agrees, false);
  EXPECT_EQ(certify_step(verlet, pendulum(), {.order = 1}).agrees, std::nullopt) << "one degree of freedom";
  EXPECT_EQ(certify_step(verlet, pendulum(), {.symplectic = false}).agrees, std::nullopt);
  EXPECT_EQ(certify_step(verlet, pendulum(), {.preserves = {"energy"}}).agrees, false);
  const auto euler = [](std::vector<double>& q, std::vector<double>& p, double h) {
    const double force = -std::sin(q[0]);
    q[0] += h * p[0];
    p[0] += h * force;
  };
  EXPECT_EQ(certify_step(euler, pendulum(), {.order = 1, .symplectic = true}).agrees, false);
  EXPECT_EQ(certify_step(euler, pendulum(), {.order = 1, .symmetric = true}).agrees, false);
  EXPECT_EQ(certify_step(euler, pendulum(), {.order = 1, .symplectic = false, .symmetric = false}).agrees, true);
}

TEST(CertifyStep, StepsThatCannotBeMeasuredAreRefused) {
  int calls = 0;
  const auto remembers = [&](std::vector<double>& q, std::vector<double>& p, double h) {
    verlet(q, p, h * (1 + 1e-12 * ++calls));
  };
  EXPECT_THROW(certify_step(remembers, pendulum()), Error);
  EXPECT_THROW(certify_step([](auto&, auto&, double) {}, pendulum()), Error);
  EXPECT_THROW(certify_step([](auto& q, auto&, double) { q[0] = std::nan(""); }, pendulum()), Error);
  EXPECT_THROW(certify_step([](auto& q, auto&, double) { q.clear(); }, pendulum()), Error);
  EXPECT_THROW(certify_step(verlet, pendulum(), {.preserves = {"enstrophy"}}), Error);
}

}  // namespace
}  // namespace hamflow
