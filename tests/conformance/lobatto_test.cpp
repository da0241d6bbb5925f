// lobatto-3a-3b: its coefficients by their defining conditions, its definition with the printed table, Verlet,
// structure.
#include "hamflow/methods/lobatto.hpp"

#include "../support/near.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "mutants/examine.hpp"

namespace hamflow {

namespace mutants {
/// A mutant: one coefficient of three stages wrong. Symplectic all the same, but not of order 4.
template <class P, class R>
struct WrongCoefficient : LobattoStages<P, R> {
  using Base = LobattoStages<P, R>;
  using Base::Base;
  struct Setup : Base::Setup {
    Setup(const P& problem, const LobattoOptions& chosen) : Base::Setup(problem, chosen) {
      static const LobattoPair<R> wrong = [] {
        LobattoPair<R> changed = lobatto_pair<R>(3);
        changed.nu[4] += R(0.01);
        return changed;
      }();
      this->pair = &wrong;
    }
  };
};
struct Wrong {
  static constexpr bool implicit = true;
  static constexpr bool bijective = false;
  template <class P>
  static constexpr bool accepts = Smooth<P>;
  LobattoOptions options{.stages = 3};
  template <class P, class A>
  using Stepper = ImplicitMethod<P, A, WrongCoefficient<P, typename A::Real>>;
  template <class P, class A>
  Stepper<P, A> bind(const P& problem) const {
    return Stepper<P, A>(problem, options);
  }
};
}  // namespace mutants

namespace {

static_assert(StepEquations<LobattoStages<HenonHeiles<double>, double>>);

/// c, b and the matrices of IIIA and IIIB.
template <class R>
struct Tables {
  std::vector<R> c, b;
  std::vector<std::vector<R>> a, hat;
  explicit Tables(int stages) {
    const LobattoPair<R>& pair = lobatto_pair<R>(stages);
    const auto s = static_cast<std::size_t>(stages);
    b = pair.b;
    for (const R& x : pair.offset) c.push_back(R(1) / R(2) + x);
    for (std::size_t i = 0; i < s; ++i) {
      a.emplace_back();
      hat.emplace_back();
      for (std::size_t j = 0; j < s; ++j) {
        a[i].push_back(b[j] * (R(1) / R(2) + pair.nu[i * s + j]));
        hat[i].push_back(b[j] * (R(1) / R(2) - pair.nu[j * s + i]));
      }
    }
  }
};

/// B(2 s - 2), C(s) and D(s - 2) of IIIA, C(s - 2) and D(s) of IIIB determine the tables.   [HLW2006, (II.1.12), IV.2]
template <class R>
void expect_conditions(int stages, double bound) {
  const Tables<R> t(stages);
  const auto s = static_cast<std::size_t>(stages);
  const auto power = [](const R& x, int n) {
    R y(1);
    for (int i = 0; i < n; ++i) y *= x;
    return y;
  };
  const auto near = [&](const R& x, const R& y) { return static_cast<double>(abs(x - y)) <= bound; };
  for (int m = 1; m <= 2 * stages - 2; ++m) {
    R sum(0);
    for (std::size_t i = 0; i < s; ++i) sum += t.b[i] * power(t.c[i], m - 1);
    EXPECT_TRUE(near(sum, R(1) / R(m))) << "B " << stages << ' ' << m;
  }
  for (int m = 1; m <= stages; ++m) {
    for (std::size_t i = 0; i < s; ++i) {
      R of_a(0), of_hat(0), down(0);
      for (std::size_t j = 0; j < s; ++j) {
        of_a += t.a[i][j] * power(t.c[j], m - 1);
        of_hat += t.hat[i][j] * power(t.c[j], m - 1);
        down += t.b[j] * power(t.c[j], m - 1) * t.hat[j][i];
      }
      EXPECT_TRUE(near(of_a, power(t.c[i], m) / R(m))) << "C of IIIA " << stages << ' ' << m;
      if (m <= stages - 2) {
        EXPECT_TRUE(near(of_hat, power(t.c[i], m) / R(m))) << "C of IIIB " << stages << ' ' << m;
      }
      EXPECT_TRUE(near(down, t.b[i] * (R(1) - power(t.c[i], m)) / R(m))) << "D of IIIB " << stages << ' ' << m;
    }
  }
}
TEST(Lobatto, CoefficientsMeetTheirConditionsInEveryArithmetic) {
  for (int s = 2; s <= 10; ++s) {
    expect_conditions<double>(s, 16 * test::epsilon);
    expect_conditions<Quad>(s, 1e-31);  // 31 digits; the recurrences lose some ten roundings at 10 stages
    const MpDigits scope(40);
    expect_conditions<Mp>(s, 1e-38);
  }
}
TEST(Lobatto, CoefficientsAreSymmetricToTheLastBit) {
  for (int s = 2; s <= 10; ++s) {
    const LobattoPair<double>& pair = lobatto_pair<double>(s);
    const auto n = static_cast<std::size_t>(s);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_EQ(pair.offset[i], -pair.offset[n - 1 - i]);
      EXPECT_EQ(pair.b[i], pair.b[n - 1 - i]);
      EXPECT_EQ(pair.nu[i], -0.5);
      for (std::size_t j = 0; j < n; ++j) EXPECT_EQ(pair.nu[i * n + j], -pair.nu[(n - 1 - i) * n + (n - 1 - j)]);
    }
  }
}

TEST(Lobatto, ThreeStagesAreThePrintedTable) {
  const double a[3][3] = {{0, 0, 0}, {5.0 / 24, 1.0 / 3, -1.0 / 24}, {1.0 / 6, 2.0 / 3, 1.0 / 6}};
  const double hat[3][3] = {{1.0 / 6, -1.0 / 6, 0}, {1.0 / 6, 1.0 / 3, 0}, {1.0 / 6, 5.0 / 6, 0}};
  const Tables<double> t(3);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(t.a[i][j], a[i][j], 2 * test::epsilon);
      EXPECT_NEAR(t.hat[i][j], hat[i][j], 2 * test::epsilon);
    }
  }
}

/// The definition with the printed table of three stages, by fixed-point iteration in mp(60).
TEST(Lobatto, IsItsDefinition) {
  const double start[4] = {0.7, -0.5, 0.5, 0.6};
  const MpDigits forty(40);
  auto simulation = simulate(DoublePendulumNonlinearAbsolute<Mp>{}, Lobatto{{.stages = 3}},
                             {Mp(start[0]), Mp(start[1])}, {Mp(start[2]), Mp(start[3])}, Mp(0.0625));
  ASSERT_EQ(simulation.advance(1), Outcome::done) << simulation.failure();
  const auto q = simulation.state().positions();
  const auto p = simulation.state().momenta();
  const MpDigits scope(60);
  const DoublePendulumNonlinearAbsolute<Mp> problem;
  const auto part = [](int x, int y) { return Mp(x) / Mp(y); };
  const std::vector<std::vector<Mp>> a{
      {Mp(0), Mp(0), Mp(0)}, {part(5, 24), part(1, 3), part(-1, 24)}, {part(1, 6), part(2, 3), part(1, 6)}};
  const std::vector<std::vector<Mp>> hat{
      {part(1, 6), part(-1, 6), Mp(0)}, {part(1, 6), part(1, 3), Mp(0)}, {part(1, 6), part(5, 6), Mp(0)}};
  std::vector<Vector<Mp, 2>> v(3), f(3);
  for (int pass = 0; pass < 200; ++pass) {
    auto next_v = v;
    auto next_f = f;
    for (std::size_t i = 0; i < 3; ++i) {
      Vector<Mp, 2> x{Mp(start[0]), Mp(start[1])}, y{Mp(start[2]), Mp(start[3])}, dq, dp;
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t d = 0; d < 2; ++d) {
          x[d] += Mp(0.0625) * a[i][j] * v[j][d];
          y[d] += Mp(0.0625) * hat[i][j] * f[j][d];
        }
      }
      gradient(problem, x, y, dq, dp);
      for (std::size_t d = 0; d < 2; ++d) {
        next_v[i][d] = dp[d];
        next_f[i][d] = -dq[d];
      }
    }
    v = next_v;
    f = next_f;
  }
  const Mp b[3] = {part(1, 6), part(2, 3), part(1, 6)};
  for (std::size_t d = 0; d < 2; ++d) {
    Mp x(start[d]);
    Mp y(start[2 + d]);
    for (std::size_t i = 0; i < 3; ++i) {
      x += Mp(0.0625) * b[i] * v[i][d];
      y += Mp(0.0625) * b[i] * f[i][d];
    }
    EXPECT_LE(std::fabs(static_cast<double>(q[d] - x)), 1e-38);
    EXPECT_LE(std::fabs(static_cast<double>(p[d] - y)), 1e-37);  // forces of size 30
  }
}

TEST(Lobatto, OfTwoStagesIsVerlet) {
  auto pair = simulate(HenonHeiles<double>{}, Lobatto{{.stages = 2}}, {0.3, -0.15}, {0.2, 0.25}, 0.2);
  auto verlet = simulate(HenonHeiles<double>{}, Composition<compositions::verlet>{}, {0.3, -0.15}, {0.2, 0.25}, 0.2);
  ASSERT_EQ(pair.advance(100), Outcome::done) << pair.failure();
  ASSERT_EQ(verlet.advance(100), Outcome::done);
  for (std::size_t d = 0; d < 2; ++d) {
    EXPECT_NEAR(pair.state().q[d].high, verlet.state().q[d], 1e4 * test::epsilon);
    EXPECT_NEAR(pair.state().p[d].high, verlet.state().p[d], 1e4 * test::epsilon);
  }
}

TEST(Lobatto, HasOrderTwiceItsStagesLessTwo) {
  for (int s = 2; s <= 6; ++s) {
    const auto end = [&](int n) {
      auto simulation = simulate(HenonHeiles<Quad>{}, Lobatto{{.stages = s}}, {Quad(0.3), Quad(-0.15)},
                                 {Quad(0.2), Quad(0.25)}, Quad(1) / Quad(n));
      EXPECT_EQ(simulation.advance(n), Outcome::done);
      return simulation.state().positions();
    };
    const auto change = [&](int n) {
      const auto a = end(n);
      const auto b = end(2 * n);
      return static_cast<double>(abs(a[0] - b[0]) + abs(a[1] - b[1]));
    };
    EXPECT_NEAR(std::log2(change(4) / change(16)) / 2, 2 * s - 2, 0.15) << s;
  }
}

// That the pairs are what they claim to be is measured with the catalogue (claims_test.cpp).
TEST(Lobatto, AWrongCoefficientIsCaught) {
  const StepMapOf<HenonHeiles, mutants::Wrong> map([]<class R>() { return HenonHeiles<R>(); }, mutants::Wrong{});
  const OrderMeasurement order = measure_order(map, region_of("henon-heiles"));
  EXPECT_EQ(order.is(map.claims().order), Finding::no) << order.slope;
}

}  // namespace
}  // namespace hamflow
