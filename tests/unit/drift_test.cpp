// The drift statistics on series whose class is known.
#include "hamflow/detail/verify/drift.hpp"

#include <cmath>
#include <numbers>

#include "../support/near.hpp"
#include "hamflow/core/counter_random.hpp"

namespace hamflow {
namespace {

using Ensemble = std::vector<std::vector<double>>;
constexpr std::size_t starts = 32;
constexpr std::size_t series_blocks = 511;

template <class F>
Ensemble ensemble(F&& error) {
  Ensemble all;
  for (std::size_t s = 0; s < starts; ++s) {
    std::vector<double> series{-0.5};
    for (std::size_t b = 1; b <= series_blocks; ++b) series.push_back(-0.5 + error(s, b, series));
    all.push_back(series);
  }
  return all;
}
double noise(std::size_t s, std::size_t b) { return counter_uniform(31, s * 1000 + b); }

TEST(Drift, StudentTMatchesTheTables) {
  // Two-sided 5 % and 1 % points; t has three decimals there, the density is below 0.06. [AbramowitzStegun1964, 26.10]
  const double bound = 0.0005 * 0.06;
  EXPECT_NEAR(student_p_value(2.228, 10), 0.05, bound);
  EXPECT_NEAR(student_p_value(2.042, 30), 0.05, bound);
  EXPECT_NEAR(student_p_value(2.750, 30), 0.01, bound);
  EXPECT_NEAR(student_p_value(-3.106, 11), 0.01, bound);
  // Closed forms with one and two degrees of freedom.
  for (const double t : {0.3, 4.0, 50.0}) {
    EXPECT_TRUE(test::within(student_p_value(t, 1), 1 - 2 / std::numbers::pi * std::atan(t), 4 * test::epsilon));
    EXPECT_TRUE(test::within(student_p_value(t, 2), 1 - t / std::sqrt(2 + t * t), 4 * test::epsilon));
  }
  EXPECT_EQ(student_p_value(0, 7), 1);
  // Far out, where 1 - P has no digits left: with two degrees of freedom 2/t^2 (1 - 3/t^2 + ...)/(1 + ...), here from
  // 1 - x = (1 - x^2)/(1 + x) with x = t/sqrt(2 + t^2).
  const double t = 1e12;
  EXPECT_TRUE(test::same_to_rounding(student_p_value(t, 2), 2 / (2 + t * t) / (1 + t / std::sqrt(2 + t * t)), 16.0));
}

TEST(Drift, AnOscillationIsBounded) {
  const auto found = classify_drift(ensemble([](std::size_t s, std::size_t b, const auto&) {
    return 1e-3 * std::sin(0.9 * static_cast<double>(b) + static_cast<double>(s));
  }));
  EXPECT_EQ(found.drift, DriftClass::bounded);
  EXPECT_NEAR(found.growth_exponent, 0, 0.1);
}

TEST(Drift, ASumOfIndependentErrorsIsARandomWalk) {
  const auto found = classify_drift(ensemble([](std::size_t s, std::size_t b, const std::vector<double>& series) {
    return series.back() + 0.5 + 1e-15 * noise(s, b);
  }));
  EXPECT_EQ(found.drift, DriftClass::random_walk);
  EXPECT_NEAR(found.growth_exponent, 0.5, 0.15);
  EXPECT_GT(found.p_value, DriftStatistics::level);
}

TEST(Drift, ABiasBelowTheNoiseIsFoundByTheTest) {
  // A fortieth of the step of the walk, in one start of 32 only; the growth exponent cannot see it.
  const auto found = classify_drift(ensemble([](std::size_t s, std::size_t b, const std::vector<double>& series) {
    return series.back() + 0.5 + 1e-3 * (noise(s, b) + (s == 7 ? 0.2 : 0.0));
  }));
  EXPECT_LT(found.p_value, DriftStatistics::level);
  EXPECT_LT(found.growth_exponent, DriftStatistics::linear_above);
  EXPECT_EQ(found.drift, DriftClass::linear);
}

TEST(Drift, DriftsOfEitherSignAreFound) {
  const auto found = classify_drift(ensemble([](std::size_t s, std::size_t b, const auto&) {
    return (s % 2 == 0 ? 1e-6 : -1e-6) * static_cast<double>(b) + 1e-5 * std::sin(static_cast<double>(b));
  }));
  EXPECT_EQ(found.drift, DriftClass::linear);
  EXPECT_GT(found.growth_exponent, 0.7);
}

TEST(Drift, OfABrokenRunNothingIsKnown) {
  Ensemble short_one = ensemble([](auto, auto, const auto&) { return 0.0; });
  short_one[3].resize(100);
  EXPECT_FALSE(classify_drift(short_one).drift.has_value());
  EXPECT_TRUE(std::isnan(classify_drift(short_one).p_value));
  Ensemble infinite = ensemble([](auto, auto, const auto&) { return 0.0; });
  infinite[3][50] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(classify_drift(infinite).drift.has_value());
  EXPECT_EQ(classify_drift(ensemble([](auto, auto, const auto&) { return 0.0; })).drift, DriftClass::bounded);
}

TEST(Drift, FittedSlopeIsThatOfTheLine) {
  EXPECT_TRUE(test::same_to_rounding(fitted_slope({0, 1, 2, 5}, {1, 3, 5, 11}), 2.0, 8.0));
}

}  // namespace
}  // namespace hamflow
