// Long steps are found from the turns of coordinates, and from nothing that only looks like turns.
#include <gtest/gtest.h>

#include <cmath>

#include "hamflow/detail/verify/turning_points.hpp"

namespace hamflow {
namespace {

using Coordinates = std::vector<double> (*)(double t);

/// What a run of that many steps shows of q(t).
TurningPointObserver watched(Coordinates q, double dt, std::int64_t steps) {
  TurningPointObserver watch(dt);
  for (std::int64_t step = watch.next_due(0); step <= steps; step = watch.next_due(step + 1)) {
    Frame frame;
    frame.step = step;
    frame.q = q(dt * static_cast<double>(step));
    (void)watch.observe(frame);
  }
  return watch;
}

TEST(Turns, APeriodOfAFewStepsIsFound) {
  const auto circle = [](double t) { return std::vector<double>{std::cos(t), std::sin(t)}; };
  for (const double steps : {5.3, 8.0, 12.7}) {
    const auto seen = watched(circle, 2 * M_PI / steps, 200).fastest();
    ASSERT_TRUE(seen);
    // A parabola through three samples, 1/steps of a period apart, misses an extremum by less than 0.06 of a sample.
    EXPECT_NEAR(seen->period, 2 * M_PI, 2 * M_PI * 0.06 / steps) << steps;
  }
}

TEST(Turns, WhatIsSlowerThanAWindowShowsIsNotSeen) {
  const auto slow = [](double t) { return std::vector<double>{std::cos(t)}; };
  EXPECT_FALSE(watched(slow, 2 * M_PI / 40, 10000).fastest());
}

TEST(Turns, OfSeveralCoordinatesTheFastestCounts) {
  const auto two = [](double t) { return std::vector<double>{100 * std::cos(t), 0.01 * std::cos(7 * t)}; };
  const auto seen = watched(two, 2 * M_PI / 7 / 9, 64).fastest();
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->coordinate, 1);
  EXPECT_NEAR(seen->period, 2 * M_PI / 7, 0.01);
}

TEST(Turns, AnUnevenOrbitCountsWhole) {
  // y of an ellipse with e = 0.9 turns after 0.21 and 0.79 of a period.
  const auto ellipse = [](double t) {
    double anomaly = t;
    for (int i = 0; i < 200; ++i)
      anomaly -= (anomaly - 0.9 * std::sin(anomaly) - t) / (1 - 0.9 * std::cos(anomaly)) / 2;
    return std::vector<double>{std::sin(anomaly)};
  };
  const auto seen = watched(ellipse, 2 * M_PI / 12, 64).fastest();
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->period, 2 * M_PI, 0.3);
}

TEST(Turns, WhatGrowsOrStandsStillIsNoOscillation) {
  const auto angle = [](double t) { return std::vector<double>{3 * t, 7.0}; };
  EXPECT_FALSE(watched(angle, 1, 1000).fastest());
  const auto noise = [](double t) {  // last bits that go up and down
    const double bit = std::fmod(t, 2) == 0 ? 0x1p-52 : 0;
    return std::vector<double>{1 + bit, bit * t, 1e-3 * t};
  };
  EXPECT_FALSE(watched(noise, 1, 1000).fastest());
}

TEST(Turns, LongRunsAreRarelyLookedAt) {
  const auto circle = [](double t) { return std::vector<double>{std::cos(t)}; };
  TurningPointObserver watch(1);
  int looks = 0;
  for (std::int64_t step = watch.next_due(0); step <= 1'000'000'000; step = watch.next_due(step + 1)) {
    Frame frame;
    frame.step = step;
    frame.q = circle(static_cast<double>(step));
    (void)watch.observe(frame);
    ++looks;
  }
  EXPECT_EQ(looks, 65 * 24);  // at the start and from 2^7 .. 2^29 on
}

TEST(Turns, ARunThatGoesOnSeesTheSame) {
  const auto late = [](double t) { return std::vector<double>{t < 140 ? t : 140 + std::sin(t - 140)}; };
  const auto whole = watched(late, 1, 400).fastest();
  ASSERT_TRUE(whole);
  for (const std::int64_t cut : {0, 30, 64, 127, 150, 192, 300}) {
    TurningPointObserver first = watched(late, 1, cut);
    Writer out;
    first.archive(out);
    const auto bytes = out.take();
    TurningPointObserver second(1);
    Reader in(bytes);
    second.archive(in);
    in.finish();
    for (std::int64_t step = second.next_due(cut); step <= 400; step = second.next_due(step + 1)) {
      Frame frame;
      frame.step = step;
      frame.q = late(static_cast<double>(step));
      (void)second.observe(frame);
    }
    ASSERT_TRUE(second.fastest()) << cut;
    EXPECT_EQ(second.fastest()->period, whole->period) << cut;
  }
}

TEST(Turns, AnotherStepLengthBeginsAnew) {
  TurningPointObserver watch(1);
  Frame frame;
  const auto walk = [&](std::int64_t from, std::int64_t to, double omega) {
    for (std::int64_t step = watch.next_due(from); step <= to; step = watch.next_due(step + 1)) {
      frame.step = step;
      frame.q = {std::cos(omega * static_cast<double>(step))};
      (void)watch.observe(frame);
    }
  };
  walk(0, 100, 1);
  watch.restart(100, 0.1, true);
  walk(100, 200, 0.1);
  EXPECT_EQ(watch.fastest()->dt, 1) << "what was too long before stays";
  watch.restart(200, 3, false);
  EXPECT_EQ(watch.next_due(200), Observer::never) << "sub-steps of a method's own are not judged";
}

}  // namespace
}  // namespace hamflow
