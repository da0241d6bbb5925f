// Kepler drifts, states and elements against motions in 120 digits (tests/data/orbits.json, made by
// tools/orbit_reference.py from the textbook formulas of each conic). `allowed` of a case: 4 units in the last place of
// the largest component of double, or what a change of one input by one unit makes.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/orbits/elements.hpp"
#include "hamflow/orbits/kepler_drift.hpp"
#include "hamflow/orbits/orbit.hpp"
#include "reference_data.hpp"

namespace hamflow::test {
namespace {

template <class R>
struct OrbitCases : ::testing::Test {
  // The bounds are those of double. The others may use 64 units, as no type with more digits stands behind them.
  static constexpr double scale = std::is_same_v<R, double> ? 1 : std::is_same_v<R, DoubleDouble> ? 0x1p-48 : 0x1p-56;

  template <class F>
  static void for_each(const std::string& kind, F&& f) {
    for (const nlohmann::json& one : reference_file("orbits.json")) {
      if (one["kind"] != kind) continue;
      std::vector<std::optional<R>> inputs;
      for (const auto& x : one["inputs"]) {
        inputs.push_back(x.is_null() ? std::nullopt : std::optional<R>(R(x.template get<double>())));
      }
      std::vector<R> exact;
      for (const std::string& x : texts(one["exact"])) {
        exact.push_back(x == "nan"    ? std::numeric_limits<R>::quiet_NaN()
                        : x == "+inf" ? std::numeric_limits<R>::infinity()
                                      : parse_decimal<R>(x));
      }
      SCOPED_TRACE(one["conic"].template get<std::string>() + " " + one["inputs"].dump());
      f(inputs, exact, doubles(one["allowed"]));
    }
  }

  static void expect_state(const Vector<R, 3>& r, const Vector<R, 3>& v, const std::vector<R>& exact,
                           const std::vector<double>& allowed) {
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_LE(static_cast<double>(abs(r[i] - exact[i])), allowed[0] * scale) << "position " << i;
      EXPECT_LE(static_cast<double>(abs(v[i] - exact[i + 3])), allowed[1] * scale) << "velocity " << i;
    }
  }
};

using NumberTypes = ::testing::Types<double, DoubleDouble, Quad>;
TYPED_TEST_SUITE(OrbitCases, NumberTypes);

TYPED_TEST(OrbitCases, DriftsAreRight) {
  using R = TypeParam;
  int count = 0;
  this->for_each("drift", [&](const auto& given, const std::vector<R>& exact, const std::vector<double>& allowed) {
    Vector<R, 3> r{*given[0], *given[1], *given[2]};
    Vector<R, 3> v{*given[3], *given[4], *given[5]};
    EXPECT_EQ(advance_on_conic(r, v, *given[6], *given[7]), Outcome::done);
    this->expect_state(r, v, exact, allowed);
    ++count;
  });
  EXPECT_GT(count, 100);
}

TYPED_TEST(OrbitCases, StatesOfElementsAreRight) {
  using R = TypeParam;
  this->for_each("state", [&](const auto& g, const std::vector<R>& exact, const std::vector<double>& allowed) {
    const Orbit<R> orbit{g[2], g[3],  g[4],  g[5].value(), g[6].value(), g[7].value(), g[8],
                         g[9], g[10], g[11], g[12],        g[13],        g[14]};
    const auto state = state_on(orbit, *g[0], *g[1]);
    ASSERT_TRUE(state);
    this->expect_state(state->position, state->velocity, exact, allowed);
  });
}

// Elements are computed in R throughout: each of some ten roundings may be like a change of the inputs by half a unit.
TYPED_TEST(OrbitCases, ElementsOfStatesAreRight) {
  using R = TypeParam;
  const double factor = std::is_same_v<R, double> ? 4 : 1;
  this->for_each("elements", [&](const auto& g, const std::vector<R>& exact, const std::vector<double>& allowed) {
    const OrbitalElements<R> o = elements_of<R>({*g[0], *g[1], *g[2]}, {*g[3], *g[4], *g[5]}, *g[6]);
    const R found[] = {o.a,
                       o.e,
                       o.pericentre_distance,
                       o.inclination,
                       o.node,
                       o.pericentre,
                       o.longitude_of_pericentre,
                       o.true_anomaly,
                       o.mean_anomaly,
                       o.mean_longitude,
                       o.period,
                       o.time_since_pericentre};
    const R one(1);
    const bool is_ellipse = exact[10] == exact[10];
    EXPECT_LE(static_cast<double>(abs(one / found[0] - one / exact[0])), allowed[0] * factor * this->scale);
    for (std::size_t k = 1; k < 12; ++k) {
      R difference = abs(found[k] - exact[k]);
      const bool is_angle = (k >= 4 && k <= 7) || k == 9 || (k == 8 && is_ellipse);
      const R rest = abs(R(2) * pi_value<R>() - difference);
      if (is_angle && rest < difference) difference = rest;
      // On one side of the parabola alone there is a period, and on it no mean anomaly. Within some units of it the
      // rounding of beta decides.
      const bool is_number = found[k] == found[k];
      if (!is_number || exact[k] != exact[k]) {
        EXPECT_TRUE(is_number == (exact[k] == exact[k]) ||
                    allowed[0] * factor >= static_cast<double>(abs(one / exact[0])));
        continue;
      }
      EXPECT_LE(static_cast<double>(difference), allowed[k] * factor * this->scale) << "element " << k;
    }
  });
}

/// Bodies of every kind in any order: short steps on ellipses and hyperbolas, long ones, steps that need two
/// corrections, massless bodies, and one in free fall.
TEST(KeplerDrifts, HaveTheBitsOfSingleDrifts) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  std::size_t many_of_a_group = 0;
  for (int group = 0; group < 3000; ++group) {
    const std::size_t count = 1 + random() % 9;
    const double t = 0.3 * number(random);
    std::vector<Vector<double, 3>> r(count), v(count), new_r(count), new_v(count);
    std::vector<double> mu(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double size = group % 3 == 0 ? 1 + 4 * std::abs(number(random)) : std::pow(10, number(random));
      for (std::size_t k = 0; k < 3; ++k) {
        r[i][k] = size * number(random);
        v[i][k] = number(random) / std::sqrt(size);
      }
      mu[i] = random() % 20 == 0 ? 0 : 1;
      if (random() % 20 == 0) v[i] = {};
    }
    std::vector<int> added(count);
    const Outcome outcome = kepler_drifts(
        r, v, count, [](std::size_t k) { return k; }, [&](std::size_t i) -> const double& { return mu[i]; }, t,
        [&](std::size_t i, const KeplerIncrements<double, 3>& by) {
          ++added[i];
          for (std::size_t k = 0; k < 3; ++k) {
            new_r[i][k] = (r[i][k] + by.position[k]) + by.position_rest[k];
            new_v[i][k] = (v[i][k] + by.velocity[k]) + by.velocity_rest[k];
          }
        });
    Outcome expected = Outcome::done;
    for (std::size_t i = 0; i < count && expected == Outcome::done; ++i) {
      expected = advance_on_conic(r[i], v[i], mu[i], t);
      ASSERT_EQ(added[i], expected == Outcome::done ? 1 : 0) << group << " " << i;
      if (expected != Outcome::done) break;
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(std::bit_cast<std::uint64_t>(new_r[i][k]), std::bit_cast<std::uint64_t>(r[i][k])) << group;
        ASSERT_EQ(std::bit_cast<std::uint64_t>(new_v[i][k]), std::bit_cast<std::uint64_t>(v[i][k])) << group;
      }
    }
    ASSERT_EQ(outcome, expected) << group;
    if (count >= 4) ++many_of_a_group;
  }
  EXPECT_GT(many_of_a_group, 1000u);
}

}  // namespace
}  // namespace hamflow::test
