// Orbital elements and the Kepler drift: conventions, limits, and increments that keep their digits.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../support/near.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/orbits/elements.hpp"
#include "hamflow/orbits/kepler_drift.hpp"
#include "hamflow/orbits/orbit.hpp"

namespace hamflow {
namespace {

using test::epsilon;
using test::within;
using Space = Vector<double, 3>;

constexpr double pi = std::numbers::pi;

/// The largest component of what two numbers of vectors differ by.
template <class A, class B>
double distance(const A& a, const B& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(static_cast<double>(Quad(a[i]) - Quad(b[i]))));
  }
  return most;
}
template <class A>
double largest(const A& a) {
  double most = 0;
  for (const auto& x : a) most = std::max(most, std::abs(static_cast<double>(x)));
  return most;
}

/// A start at random: an ellipse, a hyperbola or nearly a parabola.
struct Start {
  Space r;
  Space v;
  explicit Start(std::uint64_t number) {
    const auto uniform = [&](std::uint64_t part) { return (1 + counter_uniform(11, 16 * number + part)) / 2; };
    Orbit<double> orbit{.pericentre_distance = std::exp(4 * uniform(0) - 2)};
    orbit.e = number % 3 == 0 ? uniform(1) : number % 3 == 1 ? 1 + 3 * uniform(1) : 1 + 1e-6 * (uniform(1) - 0.5);
    orbit.inclination = pi * uniform(2);
    orbit.node = 2 * pi * uniform(3);
    orbit.pericentre = 2 * pi * uniform(4);
    orbit.true_anomaly = 3 * (uniform(5) - 0.5);
    const auto state = state_on(orbit, 1.0).value();
    r = state.position;
    v = state.velocity;
  }
};

TEST(KeplerDrift, IncrementsKeepTheirDigits) {
  // Short drifts on every conic: the increments themselves are right to a few roundings, however small they are.
  for (std::uint64_t number = 0; number < 300; ++number) {
    const Start start(number);
    for (const double t : {1e-12, -1e-9, 1e-6, -1e-3}) {
      KeplerIncrements<double, 3> found;
      KeplerIncrements<Quad, 3> exact;
      ASSERT_EQ(kepler_drift(start.r, start.v, 1.0, t, found), Outcome::done);
      ASSERT_EQ(kepler_drift(cast<Quad>(start.r), cast<Quad>(start.v), Quad(1), Quad(t), exact), Outcome::done);
      EXPECT_LE(distance(found.position, exact.position), 8 * epsilon * largest(exact.position));
      EXPECT_LE(distance(found.velocity, exact.velocity), 8 * epsilon * largest(exact.velocity));
    }
  }
}

TEST(KeplerDrift, ShortAndCarefulPathsAgree) {
  // Both sides of the limit of the short path, on a circle of radius 1.
  const Space r{1, 0, 0};
  const Space v{0, 1, 0};
  for (int k = 1; k < 400; ++k) {
    const double t = k / 400.0 * 1.2;
    KeplerIncrements<double, 3> fast;
    KeplerIncrements<long double, 3> careful;
    const bool is_short = detail::short_drift(r, v, 1.0, t, fast);
    EXPECT_EQ(is_short, t * t < detail::short_step) << t;
    ASSERT_TRUE(detail::careful_drift<long double>(cast<long double>(r), cast<long double>(v), 1, t, careful));
    EXPECT_LE(std::abs(careful.position[0] - (std::cos(static_cast<long double>(t)) - 1)), 8 * 0x1p-64L);
    if (is_short) {
      EXPECT_LE(distance(fast.position, careful.position), 2 * epsilon * t);
    }
  }
}

TEST(KeplerDrift, HasTheRestOfLongIncrements) {
  // From the apocentre of a long ellipse to near its pericentre: the end is 2000 times smaller than the increment.
  Space r{-2, 0, 0};
  Space v{0, -std::sqrt(0.0005), 0};
  const Vector<Quad, 3> exact_r = cast<Quad>(r);
  const Vector<Quad, 3> exact_v = cast<Quad>(v);
  KeplerIncrements<Quad, 3> exact;
  const double t = 3.1404;
  ASSERT_EQ(kepler_drift(exact_r, exact_v, Quad(1), Quad(t), exact), Outcome::done);
  KeplerIncrements<double, 3> found;
  ASSERT_EQ(kepler_drift(r, v, 1.0, t, found), Outcome::done);
  EXPECT_LE(std::abs(static_cast<double>(Quad(found.position[0]) + Quad(found.position_rest[0]) - exact.position[0])),
            epsilon * 0x1p-7);
  EXPECT_NE(found.position_rest[0], 0);
}

TEST(KeplerDrift, WorksInThePlaneAndOnALine) {
  const Start start(6);
  Orbit<double> orbit{.a = 1.3, .e = 0.3};
  orbit.mean_anomaly = 1;
  const auto state = state_on(orbit, 1.0).value();
  for (const double t : {0.1, 3.0, -40.0}) {
    Space r = state.position;
    Space v = state.velocity;
    Vector<double, 2> plane_r{r[0], r[1]};
    Vector<double, 2> plane_v{v[0], v[1]};
    ASSERT_EQ(advance_on_conic(r, v, 1.0, t), Outcome::done);
    ASSERT_EQ(advance_on_conic(plane_r, plane_v, 1.0, t), Outcome::done);
    EXPECT_EQ(plane_r, (Vector<double, 2>{r[0], r[1]}));
    EXPECT_EQ(plane_v, (Vector<double, 2>{v[0], v[1]}));
  }
  // Thrown upwards with the velocity of escape: r^(3/2) = 1 + 3/2 sqrt(2) t.
  Vector<double, 1> r{1};
  Vector<double, 1> v{std::sqrt(2.0)};
  ASSERT_EQ(advance_on_conic(r, v, 1.0, 10.0), Outcome::done);
  EXPECT_TRUE(test::same_to_rounding(r[0], std::pow(1 + 15 * std::sqrt(2.0), 2 / 3.0), 8.0));
}

TEST(KeplerDrift, GoesStraightWithoutMass) {
  Space r{1, 2, 3};
  Space v{0.5, 0.25, -1};
  ASSERT_EQ(advance_on_conic(r, v, 0.0, 4.0), Outcome::done);
  EXPECT_EQ(r, (Space{3, 3, -1}));
  EXPECT_EQ(v, (Space{0.5, 0.25, -1}));
}

TEST(KeplerDrift, NeverReturnsWhatIsNoState) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const Space r{1, 0, 0};
  const Space v{0, 1, 0};
  const auto refuses = [](Space r_, Space v_, double mu, double t) {
    const Space before = r_;
    return advance_on_conic(r_, v_, mu, t) == Outcome::not_converged && (r_ == before || before[0] != before[0]);
  };
  EXPECT_TRUE(refuses({0, 0, 0}, v, 1, 0.1));
  EXPECT_TRUE(refuses({nan, 0, 0}, v, 1, 0.1));
  EXPECT_TRUE(refuses(r, {0, infinity, 0}, 1, 0.1));
  EXPECT_TRUE(refuses(r, v, nan, 0.1));
  EXPECT_TRUE(refuses(r, v, -1, 0.1));
  EXPECT_TRUE(refuses(r, v, 1, nan));
  EXPECT_TRUE(refuses(r, v, 1, infinity));
  EXPECT_TRUE(refuses(r, {0, 3, 0}, 1, 1.7e308));  // beyond all numbers
}

TEST(KeplerDrift, ComesBack) {
  // There and back in quad, where the drift magnifies rounding by little.
  for (std::uint64_t number = 0; number < 60; ++number) {
    const Start start(number);
    Vector<Quad, 3> r = cast<Quad>(start.r);
    Vector<Quad, 3> v = cast<Quad>(start.v);
    ASSERT_EQ(advance_on_conic(r, v, Quad(1), Quad(20)), Outcome::done);
    ASSERT_EQ(advance_on_conic(r, v, Quad(1), Quad(-20)), Outcome::done);
    EXPECT_LE(distance(r, start.r), 1e-27);
    EXPECT_LE(distance(v, start.v), 1e-27);
  }
}

TEST(Elements, HaveConventionsWhereAnglesAreUndefined) {
  // A circle in the plane: the longitude is the place.
  auto o = elements_of<double>({0, 1, 0}, {-1, 0, 0}, 1);
  EXPECT_EQ(o.e, 0);
  EXPECT_EQ(o.a, 1);
  EXPECT_EQ(o.inclination, 0);
  EXPECT_EQ(o.node, 0);
  EXPECT_EQ(o.pericentre, 0);
  EXPECT_TRUE(test::same_to_rounding(o.mean_longitude, pi / 2, 2.0));
  EXPECT_TRUE(test::same_to_rounding(o.mean_anomaly, pi / 2, 2.0));
  EXPECT_TRUE(test::same_to_rounding(o.true_anomaly, pi / 2, 2.0));
  EXPECT_TRUE(test::same_to_rounding(o.period, 2 * pi, 2.0));
  // The same circle the other way round, whose node is on the x axis.
  o = elements_of<double>({0, 1, 0}, {1, 0, 0}, 1);
  EXPECT_EQ(o.inclination, pi);
  EXPECT_EQ(o.node, 0);
  EXPECT_TRUE(test::same_to_rounding(o.mean_longitude, 3 * pi / 2, 2.0));
  // An ellipse in the plane: the pericentre is that from the x axis.
  o = elements_of<double>({0, 0.5, 0}, {-std::sqrt(3.0), 0, 0}, 1);
  EXPECT_TRUE(test::same_to_rounding(o.e, 0.5, 4.0));
  EXPECT_TRUE(test::same_to_rounding(o.pericentre, pi / 2, 2.0));
  EXPECT_TRUE(test::same_to_rounding(o.longitude_of_pericentre, pi / 2, 2.0));
  // A line through the centre.
  o = elements_of<double>({1, 0, 0}, {0.5, 0, 0}, 1);
  EXPECT_EQ(o.e, 1);
  EXPECT_EQ(o.pericentre_distance, 0);
  EXPECT_TRUE(test::same_to_rounding(o.a, 1 / 1.75, 2.0));
  EXPECT_EQ(o.true_anomaly, pi);
  EXPECT_FALSE(std::isnan(o.mean_anomaly) || std::isnan(o.mean_longitude));
  // A parabola.
  o = elements_of<double>({1, 0, 0}, {0, std::sqrt(2.0), 0}, 1);
  EXPECT_TRUE(within(o.e, 1, 4 * epsilon));
  EXPECT_TRUE(test::same_to_rounding(o.pericentre_distance, 1.0, 4.0));
}

TEST(Elements, TellNearlyCircularPlanarAndRetrogradeOrbits) {
  // What is small keeps its digits, and the mean longitude is right whatever e and inclination are.
  for (const double small : {1e-14, 1e-11, 1e-8, 1e-4}) {
    for (const bool is_retrograde : {false, true}) {
      Orbit<double> orbit{.a = 2, .e = small};
      orbit.inclination = is_retrograde ? pi - small : small;
      orbit.node = 1;
      orbit.pericentre = 2;
      orbit.mean_longitude = 5;
      const auto state = state_on(orbit, 3.0).value();
      const auto o = elements_of(state.position, state.velocity, 3.0);
      EXPECT_TRUE(test::same_to_rounding(o.a, 2.0, 8.0));
      EXPECT_TRUE(within(o.e, small, 8 * epsilon));
      EXPECT_TRUE(within(o.inclination, orbit.inclination, 4 * epsilon * (is_retrograde ? pi : small)));
      EXPECT_TRUE(within(o.node, 1, 16 * epsilon));
      EXPECT_TRUE(within(o.pericentre, 2, 8 * epsilon / small));
      EXPECT_TRUE(within(o.mean_longitude, 5, 16 * epsilon));
      const double difference = std::remainder(o.longitude_of_pericentre + o.mean_anomaly - 5, 2 * pi);
      EXPECT_LE(std::abs(difference), 32 * epsilon);
    }
  }
}

TEST(Elements, ReturnFromStates) {
  // Quad: elements to state and back, on every conic.
  for (std::uint64_t number = 0; number < 200; ++number) {
    const auto uniform = [&](std::uint64_t part) { return Quad((1 + counter_uniform(5, 16 * number + part)) / 2); };
    Orbit<Quad> orbit{.pericentre_distance = uniform(0) + Quad(0.5)};
    orbit.e = number % 3 == 0 ? uniform(1) : number % 3 == 1 ? Quad(1) + uniform(1) : Quad(1) + Quad(1e-9) * uniform(1);
    orbit.inclination = uniform(2) + Quad(1);
    orbit.node = uniform(3) * Quad(6);
    orbit.pericentre = uniform(4) * Quad(6);
    orbit.time_of_pericentre = -uniform(5);
    const auto state = state_on(orbit, Quad(1)).value();
    const auto o = elements_of(state.position, state.velocity, Quad(1));
    EXPECT_LE(static_cast<double>(abs(o.pericentre_distance - *orbit.pericentre_distance)), 1e-31);
    EXPECT_LE(static_cast<double>(abs(o.e - orbit.e)), 1e-31);
    EXPECT_LE(static_cast<double>(abs(o.inclination - orbit.inclination)), 1e-31);
    EXPECT_LE(static_cast<double>(abs(o.node - orbit.node)), 1e-31);
    EXPECT_LE(static_cast<double>(abs(o.pericentre - *orbit.pericentre) * orbit.e), 1e-30);
    EXPECT_LE(static_cast<double>(abs(o.time_since_pericentre + *orbit.time_of_pericentre) * orbit.e), 1e-29);
  }
}

TEST(Elements, ArcTangentsAreThoseOfTheLibrary) {
  for (std::uint64_t number = 0; number < 20000; ++number) {
    const auto draw = [&](std::uint64_t part) {
      const double x = counter_uniform(9, 2 * number + part);
      return number % 2 == 0 ? x : std::copysign(std::exp(100 * x), counter_uniform(10, 2 * number + part));
    };
    const double one_y = draw(0);
    const double one_x = draw(1);
    const double y[6] = {one_y, 0, -0.0, 1, -1, one_x};
    const double x[6] = {one_x, 0, -1, 0, 0, one_y};
    double angle[6];
    detail::arc_tangents(y, x, angle);
    EXPECT_TRUE(test::same_to_rounding(angle[0], std::atan2(one_y, one_x), 2.0));
    EXPECT_TRUE(test::same_to_rounding(angle[5], std::atan2(one_x, one_y), 2.0));
    EXPECT_EQ(angle[1], 0);
    EXPECT_EQ(angle[2], -pi);
    EXPECT_EQ(angle[3], pi / 2);
    EXPECT_EQ(angle[4], -pi / 2);
  }
}

/// What is wrong with an orbit: "KEY: MESSAGE", lines.
std::string wrong(const Orbit<double>& orbit) {
  std::string all;
  for (const Complaint& one : complaints_about(orbit)) all += one.key + ": " + one.message + "\n";
  return all;
}

TEST(Orbit, SaysWhatIsWrong) {
  EXPECT_EQ(wrong({.a = 1, .e = 0.1, .mean_anomaly = 1}), "");
  EXPECT_EQ(wrong({.a = -1, .e = 1.1, .true_anomaly = 1}), "");
  EXPECT_EQ(wrong({.pericentre_distance = 1, .e = 1, .time_of_pericentre = 3}), "");
  EXPECT_EQ(wrong({}), "a: found no size of the orbit; allowed one of a, period, pericentre_distance\n");
  EXPECT_EQ(wrong({.a = 1, .period = 1}), "period: found a and period; allowed one of them\n");
  EXPECT_EQ(wrong({.a = 1, .pericentre = 1, .longitude_of_pericentre = 1}),
            "longitude_of_pericentre: found pericentre and longitude_of_pericentre; allowed one of them\n");
  EXPECT_EQ(wrong({.a = 1, .mean_anomaly = 1, .true_anomaly = 1, .mean_longitude = 0}),
            "mean_longitude: found mean_anomaly, true_anomaly and mean_longitude; allowed one of them\n");
  EXPECT_EQ(wrong({.a = 1, .e = 1.5}), "a: found 1 with e = 1.5; allowed a number below 0 (hyperbola), or e below 1\n");
  EXPECT_EQ(wrong({.a = -1, .e = 0.5}), "a: found -1 with e = 0.5; allowed a number above 0 (ellipse), or e above 1\n");
  EXPECT_EQ(wrong({.a = 1, .e = 1}), "a: found a with e = 1; allowed pericentre_distance\n");
  EXPECT_EQ(wrong({.period = 1, .e = 1}), "period: found a period with e = 1; allowed pericentre_distance\n");
  EXPECT_EQ(wrong({.period = 1, .e = 2}),
            "period: found a period with e = 2; allowed pericentre_distance, or a, which is "
            "negative on a hyperbola\n");
  EXPECT_EQ(wrong({.period = -1}), "period: found -1; allowed a number above 0\n");
  EXPECT_EQ(wrong({.pericentre_distance = 0}), "pericentre_distance: found 0; allowed a number above 0\n");
  EXPECT_EQ(wrong({.a = 1, .e = -0.1}), "e: found -0.1; allowed a number from 0\n");
  EXPECT_EQ(wrong({.a = 1, .inclination = 4}),
            "inclination: found 4 radians; allowed 0 to pi (retrograde orbits: more than pi/2)\n");
  EXPECT_EQ(wrong({.pericentre_distance = 1, .e = 1, .mean_anomaly = 1}),
            "mean_anomaly: found mean_anomaly with e = 1; allowed true_anomaly, time_of_pericentre\n");
  EXPECT_EQ(
      wrong({.a = -1, .e = 2, .true_anomaly = 2.1}),
      "true_anomaly: found 2.1 with e = 2; allowed angles between -2.0943951023931953 and 2.0943951023931953, where "
      "the asymptotes are\n");
  EXPECT_EQ(wrong({.pericentre_distance = 1, .e = 1, .true_anomaly = -pi}),
            "true_anomaly: found -3.141592653589793 with e = 1; allowed angles between -3.141592653589793 and "
            "3.141592653589793, where the asymptotes are\n");
  EXPECT_EQ(wrong({.a = std::nan("")}), "a: found nan; allowed a finite number\n");
}

}  // namespace
}  // namespace hamflow
