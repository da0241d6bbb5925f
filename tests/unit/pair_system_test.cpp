// Forces and Hessians of every pair law, cut-off and container against dual numbers, and what ends at a cut-off.
#include <gtest/gtest.h>

#include <cmath>

#include "gas/gas_system.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/dual.hpp"
#include "hamflow/problems/pairs/lennard_jones.hpp"
#include "hamflow/problems/pairs/newton.hpp"

namespace hamflow::test {
namespace {

using Laws = std::variant<pairs::LennardJones<double>, pairs::Newton<double>>;
using System = GasSystem<double, Laws>;
using D = Dual<double, 1>;

struct Case {
  const char* name;
  Laws law;
  CutoffKind cutoff = CutoffKind::none;
  ContainerKind container = ContainerKind::none;
  double exponent = 1;
};

pairs::LennardJones<double> seeds_law() { return pairs::LennardJones<double>(Parameters<double>{}); }
pairs::LennardJones<double> usual_law() {
  return pairs::LennardJones<double>(Parameters<double>(Texts{{"epsilon", "0.7"}, {"sigma", "0.9"}}));
}
pairs::Newton<double> newton() { return pairs::Newton<double>(Parameters<double>(Texts{{"softening", "0.1"}})); }

System system_of(const Case& c, std::size_t space) {
  auto model = std::make_shared<System::Model>(c.law);
  model->space = space;
  model->set_masses({1, 2, 0.5, 1, 3});
  model->scale = 1.25;
  model->scale_squared = 1.25 * 1.25;
  model->cutoff = std::visit([&](const auto& law) { return Cutoff<double>(c.cutoff, 1.9, 1.2, law); }, c.law);
  model->container = c.container;
  model->wall = SoftWall<double>(4, c.exponent, 1.25);
  model->edges.assign(space, 3.1);
  return System(model);
}

class PairSystems : public ::testing::TestWithParam<Case> {};

TEST_P(PairSystems, DerivativesAreThoseOfDualNumbers) {
  for (const std::size_t space : {std::size_t{2}, std::size_t{3}}) {
    const System system = system_of(GetParam(), space);
    const std::size_t n = system.size();
    Vector<double, dynamic> q(n);
    // Some apart from each other, two of them images across the edge.
    for (std::size_t i = 0; i < n; ++i) {
      q[i] = 0.8 * static_cast<double>(i / space) - 1.4 + 0.2 * counter_uniform(7, i) * (i % space == 0 ? 1 : 2);
    }
    Vector<double, dynamic> f(n);
    Vector<double, dynamic> again(n);
    Matrix<double, dynamic> h(n);
    system.force(q, f);
    system.force_and_hessian(q, again, h);
    EXPECT_EQ(f, again);
    double size = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) size = std::max(size, std::abs(h[i][j]));
    }
    // Some tens of roundings of terms that are at most a few times the largest entry.
    const double bound = 200 * std::numeric_limits<double>::epsilon() * size;
    for (std::size_t k = 0; k < n; ++k) {
      Vector<D, dynamic> x(n);
      for (std::size_t i = 0; i < n; ++i) x[i].value = q[i];
      x[k].slope[0] = 1;
      EXPECT_NEAR(system.potential(x).slope[0], -f[k], bound) << k;
      Vector<D, dynamic> g(n);
      system.force(x, g);
      for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(g[i].slope[0], -h[i][k], bound) << i << ", " << k;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, PairSystems,
    ::testing::Values(Case{"lennard_jones", seeds_law()}, Case{"usual_form", usual_law()}, Case{"newton", newton()},
                      Case{"shifted", seeds_law(), CutoffKind::shifted},
                      Case{"force_shifted", seeds_law(), CutoffKind::force_shifted},
                      Case{"smooth", usual_law(), CutoffKind::smooth},
                      Case{"smooth_newton", newton(), CutoffKind::smooth},
                      Case{"circle", seeds_law(), CutoffKind::none, ContainerKind::circle},
                      Case{"steeper_circle", seeds_law(), CutoffKind::none, ContainerKind::circle, 4},
                      Case{"broken_exponent", newton(), CutoffKind::none, ContainerKind::circle, 1.5},
                      Case{"periodic", seeds_law(), CutoffKind::smooth, ContainerKind::periodic}),
    [](const auto& each) { return std::string(each.param.name); });

/// At the cut-off the potential is 0 and has as many derivatives as its kind says; at `inner` smooth has four.
TEST(Cutoffs, EndAsSmoothAsTheySay) {
  const auto law = seeds_law();
  const double radius = 2.5;
  const double inner = 2;
  const auto value = [&](CutoffKind kind, double r) {
    const Cutoff<double> cutoff(kind, radius, inner, law);
    return cutoff.ends(r * r) ? 0.0 : cutoff.value(r * r, law.value(r * r));
  };
  // phi(R - d) behaves as d^m, where m - 1 derivatives vanish: halving d divides it by 2^m.
  const auto order = [&](CutoffKind kind) {
    return std::log2(std::abs(value(kind, radius - 0x1p-5) / value(kind, radius - 0x1p-6)));
  };
  EXPECT_NEAR(order(CutoffKind::shifted), 1, 0.1);
  EXPECT_NEAR(order(CutoffKind::force_shifted), 2, 0.1);
  EXPECT_NEAR(order(CutoffKind::smooth), 5, 0.3);
  EXPECT_EQ(value(CutoffKind::smooth, inner), law.value(inner * inner));
  const auto faded = [&](double d) {
    return value(CutoffKind::smooth, inner + d) / law.value((inner + d) * (inner + d)) - 1;
  };
  EXPECT_NEAR(std::log2(faded(0x1p-5) / faded(0x1p-6)), 5, 0.3);
}

/// V of one particle at r = 1.2 in the circle of radius 1.5, e = 1, S = 2, by the formula of the errata.
TEST(SoftWalls, AreThoseOfTheErrata) {
  const double q[2] = {0.72, 0.96};
  const SoftWall<double> wall(1.5, 1, 2);
  EXPECT_NEAR(wall.potential(q, 2, 0), 1 / (2 * 16 * (2.25 - 1.44)), 1e-15);
  EXPECT_NEAR(wall.pull(q, 2, 0), -1 / (16 * (2.25 - 1.44) * (2.25 - 1.44)), 1e-15);
  std::optional<std::size_t> who;
  const OutsideNote note(who);
  const double beyond[2] = {1.5, 0};
  EXPECT_TRUE(std::isnan(wall.potential(beyond, 2, 3)));
  EXPECT_EQ(who, std::optional<std::size_t>(3));
}

}  // namespace
}  // namespace hamflow::test
