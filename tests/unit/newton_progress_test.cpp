// The decisions of an iteration from the sizes of its corrections alone.
#include "hamflow/detail/numerics/newton_progress.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace hamflow {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Decisions about sizes in units of noise, up to the first that ends the iteration.
std::vector<NewtonDecision> decisions(NewtonProgress<double>& progress, const std::vector<double>& sizes) {
  std::vector<NewtonDecision> all;
  for (const double size : sizes) {
    all.push_back(progress.judge(size, size, 1.0));
    if (all.back() == NewtonDecision::settled || all.back() == NewtonDecision::not_finite) break;
  }
  return all;
}

/// After how many corrections the iteration settles; 0: after none of these.
std::size_t settles_after(Convergence convergence, const std::vector<double>& sizes) {
  NewtonProgress<double> progress(convergence);
  const std::vector<NewtonDecision> all = decisions(progress, sizes);
  return all.back() == NewtonDecision::settled ? all.size() : 0;
}

TEST(NewtonProgress, SettlesBelowTheNoise) {
  EXPECT_EQ(settles_after(Convergence::quadratic, {1.0}), 1U);
  EXPECT_EQ(settles_after(Convergence::quadratic, {0.0}), 1U);
  EXPECT_EQ(settles_after(Convergence::quadratic, {1e9, 0.5}), 2U);
  EXPECT_EQ(settles_after(Convergence::linear, {0x1p-14}), 1U);
  EXPECT_EQ(settles_after(Convergence::linear, {0.5}), 0U) << "what is left has the sign of the last correction";
}

TEST(NewtonProgress, QuadraticConvergencePredictsTheNextCorrection) {
  EXPECT_EQ(settles_after(Convergence::quadratic, {1e8, 1e2}), 2U);  // rate 1e-6, next 1e-10
  EXPECT_EQ(settles_after(Convergence::quadratic, {1e8, 1e5}), 0U);  // rate 1e-3, next 0.1
  EXPECT_EQ(settles_after(Convergence::linear, {1e8, 1e2}), 0U);     // next 1e-4, above 1/16384
  EXPECT_EQ(settles_after(Convergence::linear, {1e4, 1e-2}), 2U);    // next 1e-8
}

TEST(NewtonProgress, CorrectionsThatStopToShrinkAreNoise) {
  EXPECT_EQ(settles_after(Convergence::quadratic, {60}), 1U) << "without a rate the estimate counts 64 times";
  EXPECT_EQ(settles_after(Convergence::quadratic, {300, 200, 195, 196}), 4U) << "two in a row below 4096 estimates";
  EXPECT_EQ(settles_after(Convergence::quadratic, {1e6, 5000, 5000, 5000}), 0U) << "larger ones are a cycle";
  EXPECT_EQ(settles_after(Convergence::linear, {10, 0.9, 0.9}), 3U);
  EXPECT_EQ(settles_after(Convergence::linear, {10, 3, 3, 3}), 4U);
  std::vector<double> twelve(14, 100.0);
  twelve.front() = 200;
  EXPECT_EQ(settles_after(Convergence::linear, twelve), 14U);
}

TEST(NewtonProgress, StallsAboveTheNoise) {
  const auto expect_stall = [](Convergence convergence, std::size_t corrections) {
    NewtonProgress<double> progress(convergence);
    const std::vector<NewtonDecision> all = decisions(progress, std::vector<double>(corrections, 1e6));
    for (std::size_t i = 0; i + 1 < all.size(); ++i) EXPECT_EQ(all[i], NewtonDecision::go_on) << i;
    EXPECT_EQ(all.back(), NewtonDecision::stalled);
    EXPECT_EQ(progress.stalls(), static_cast<int>(corrections) - 1);
  };
  expect_stall(Convergence::quadratic, 5);
  expect_stall(Convergence::linear, 13);
}

TEST(NewtonProgress, GrowthStallsAndAShrinkingCorrectionEndsTheRow) {
  NewtonProgress<double> progress;
  EXPECT_EQ(decisions(progress, {1e6, 1e7, 1e8, 1e9, 1e10}).back(), NewtonDecision::stalled);
  EXPECT_EQ(progress.judge(1e6, 1e6, 1.0), NewtonDecision::go_on);
  EXPECT_EQ(progress.stalls(), 0);
  // Linear: "no smaller" means than the least of all, not than the one before.
  NewtonProgress<double> linear(Convergence::linear);
  (void)decisions(linear, {1e6, 1e8, 1e7});
  EXPECT_EQ(linear.stalls(), 2);
}

TEST(NewtonProgress, WhatIsNotFiniteEndsTheIteration) {
  for (const double bad : {nan, infinity}) {
    for (const Convergence convergence : {Convergence::quadratic, Convergence::linear}) {
      NewtonProgress<double> progress(convergence);
      EXPECT_EQ(progress.judge(bad, bad, 1.0), NewtonDecision::not_finite);
      EXPECT_EQ(progress.judge(0.0, bad, 1.0), NewtonDecision::not_finite) << "an entry that the size does not show";
    }
  }
  NewtonProgress<double> progress;
  EXPECT_EQ(progress.judge(1e300, 1e300, nan), NewtonDecision::go_on) << "noise that is no number settles nothing";
}

TEST(NewtonProgress, ARestartForgetsTheCorrectionBefore) {
  NewtonProgress<double> progress;
  (void)decisions(progress, {1e12, 1e10, 1e10});
  EXPECT_EQ(progress.stalls(), 1);
  progress.restart();
  EXPECT_EQ(progress.judge(1e3, 1e3, 1.0), NewtonDecision::go_on) << "1e3/1e10 is no rate";
  EXPECT_EQ(progress.stalls(), 0);
  NewtonProgress<double> simplified(Convergence::linear);
  (void)decisions(simplified, {1e4, 1e4, 1e4});
  simplified.restart(Convergence::quadratic);
  EXPECT_EQ(simplified.judge(1.0, 1.0, 1.0), NewtonDecision::settled);
}

TEST(NewtonProgress, KnowsWhetherItBeganFarAway) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  NewtonProgress<double> far;
  EXPECT_FALSE(far.began_far_away(1.0)) << "no correction yet";
  (void)decisions(far, {2 / epsilon, 1e3, 0.1});
  EXPECT_TRUE(far.began_far_away(1.0));
  EXPECT_FALSE(far.began_far_away(4.0));
  NewtonProgress<double> near;
  (void)decisions(near, {1 / epsilon, 0.1});
  EXPECT_FALSE(near.began_far_away(1.0));
}

TEST(NewtonProgress, GoesOnWhileHidingTermsShrink) {
  NewtonProgress<double> progress;
  EXPECT_TRUE(progress.continues_with_terms(100));
  EXPECT_TRUE(progress.continues_with_terms(100));
  EXPECT_FALSE(progress.continues_with_terms(100)) << "twice whatever they are";
  EXPECT_TRUE(progress.continues_with_terms(49));
  EXPECT_FALSE(progress.continues_with_terms(49));
  EXPECT_TRUE(progress.continues_with_terms(1));
}

TEST(NewtonProgress, GuessesAreTrustedAfterThreeGoodOnesInARow) {
  int wanted = good_guesses_needed;
  wanted = good_guesses_needed_after(wanted, true);
  wanted = good_guesses_needed_after(wanted, true);
  EXPECT_EQ(good_guesses_needed_after(wanted, false), good_guesses_needed);
  EXPECT_EQ(good_guesses_needed_after(wanted, true), 0);
}

TEST(CorrectionSize, IsInUnitsOfNoise) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  EXPECT_EQ(in_units_of_noise(6.0, 2.0), 3.0);
  EXPECT_EQ(in_units_of_noise(6.0, 0.0), 1 / epsilon) << "an entry at 0 is measured by its own rounding";
  EXPECT_EQ(in_units_of_noise(0.0, 0.0), 0.0);
  EXPECT_TRUE(std::isnan(in_units_of_noise(nan, 1.0)));
  EXPECT_TRUE(std::isnan(larger_size(1.0, nan)));
  EXPECT_EQ(larger_size(1.0, 2.0), 2.0);
  EXPECT_EQ(larger_size(2.0, 1.0), 2.0);
}

TEST(CorrectionSize, OfALaneIsThatOfItsNumbersAlone) {
  constexpr std::size_t count = 3;
  constexpr std::size_t width = 5;
  const double corrections[count * width] = {1, -2, 0, nan, infinity, -4, 1e-300, 0, 1, 1, 3, 5, 1e-320, 2, 1};
  const double units[count * width] = {1, 0.5, 0, 1, 1, 2, 0, 1, 1, 1, 0, 1, 0, 1, 1};
  double sizes[width];
  double totals[width];
  measure_corrections(corrections, units, count, width, sizes, totals);
  for (std::size_t lane = 0; lane < width; ++lane) {
    SCOPED_TRACE(lane);
    std::vector<double> of_lane;
    std::vector<double> units_of_lane;
    for (std::size_t i = 0; i < count; ++i) {
      of_lane.push_back(corrections[i * width + lane]);
      units_of_lane.push_back(units[i * width + lane]);
    }
    double size = 0;
    double total = 0;
    measure_corrections(of_lane.data(), units_of_lane.data(), count, 1, &size, &total);
    const bool is_finite = lane < 3;
    EXPECT_EQ(std::isfinite(totals[lane]), is_finite);
    EXPECT_EQ(std::isfinite(total), is_finite);
    if (is_finite) {
      EXPECT_EQ(size, sizes[lane]);
      EXPECT_EQ(total, totals[lane]);
    }
    EXPECT_EQ(hidden_by_rounding(units_of_lane.data(), of_lane.data(), count, 1),
              hidden_by_rounding(units + lane, corrections + lane, count, width));
  }
}

TEST(CorrectionSize, RoundingThatIsAMillionthHidesTheUnknowns) {
  EXPECT_FALSE(hidden_by_rounding(0x1p-21, 1.0));
  EXPECT_FALSE(hidden_by_rounding(0x1p-20, 1.0));
  EXPECT_TRUE(hidden_by_rounding(0x1p-19, 1.0));
  EXPECT_TRUE(hidden_by_rounding(1e-30, 0.0)) << "a step at rest";
}

}  // namespace
}  // namespace hamflow
