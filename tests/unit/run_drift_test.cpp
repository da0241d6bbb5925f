// The drift of a single run, on series whose class is known, and the observer that takes the samples.
#include <cmath>
#include <numbers>
#include <tuple>

#include "../support/near.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/verify/certificate.hpp"

namespace hamflow {
namespace {

constexpr int blocks = 128;
double noise(std::uint64_t s, std::uint64_t b) { return std::sqrt(3.0) * counter_uniform(s, b); }  // variance 1

/// Deviations of the energy at the ends of blocks, over many periods, far above rounding.
template <class F>
EnergySeries series(F&& error, int count = blocks) {
  EnergySeries all;
  all.deviations = {0};
  all.periods = 100;
  all.scale = 1e300;
  for (int b = 1; b <= count; ++b) all.deviations.push_back(error(b, all.deviations.back()));
  return all;
}
/// The same for sums of rounding errors.
template <class F>
EnergySeries rounded(F&& error, int count = blocks) {
  EnergySeries all = series(error, count);
  all.rounding = 1;
  all.roundings = 1e4;
  return all;
}
double place(int b, std::uint64_t s = 5) { return b + 0.25 * (1 + counter_uniform(s, static_cast<std::uint64_t>(b))); }

TEST(RunDrift, TooFewBlocksOrPeriodsHaveNoClass) {
  const auto still = [](int count) { return series([](int, double) { return 0.0; }, count); };
  EXPECT_FALSE(classify_run(still(31)).drift);
  EXPECT_NE(classify_run({}).reason, "");
  EXPECT_EQ(classify_run(still(32)).drift, std::nullopt);  // not one bit has changed: bounded, but for the roundings
  for (const std::optional<double> periods : {std::optional<double>(), std::optional<double>(1.99)}) {
    EnergySeries drift = series([](int b, double) { return 1e-3 * b; });
    drift.periods = periods;
    EXPECT_FALSE(classify_run(drift).drift);
    EXPECT_NE(classify_run(drift).reason, "");
    drift.deviations[9] = std::nan("");
    EXPECT_FALSE(classify_run(drift).drift);
  }
}

TEST(RunDrift, AWalkIsOne) {
  // The standard deviation of the exponent is 0.9/sqrt(B), as the statistics say of themselves: 400 walks, of which 5
  // in 10^5 may lie beyond four of them. The mean is biased by less than half a one.
  double sum = 0;
  double squares = 0;
  double uncertainty = 0;
  int called_walks = 0;
  for (std::uint64_t s = 0; s < 400; ++s) {
    const auto found = classify_run(
        rounded([&](int b, double before) { return before + 10 * noise(s, static_cast<std::uint64_t>(b)); }));
    sum += found.growth_exponent;
    squares += std::pow(found.growth_exponent - 0.5, 2);
    called_walks += found.drift == DriftClass::random_walk ? 1 : 0;
    if (s == 0) uncertainty = found.growth_uncertainty;
    EXPECT_NE(found.drift, DriftClass::linear);
  }
  EXPECT_NEAR(sum / 400, 0.5, uncertainty / 2);
  EXPECT_LT(std::sqrt(squares / 400), 1.1 * uncertainty);  // the spread of a spread over 400 is 4 %
  EXPECT_GE(called_walks, 388);  // 1 % lie beyond a walk's trend, 12 are twice three deviations
}

TEST(RunDrift, TwoLevelsInTurnAreNoWalkOverAFewPeriods) {
  // The parts that are compared are a period each: what differs between them is where they stand in it.
  for (std::uint64_t s = 0; s < 20; ++s) {
    EnergySeries two =
        rounded([&](int b, double) { return (b / (blocks / 8)) % 2 + 0.3 * noise(s, static_cast<std::uint64_t>(b)); });
    two.periods = 8;
    EXPECT_NE(classify_run(two).drift, DriftClass::random_walk) << s;
  }
}

TEST(RunDrift, AWalkOverFewPeriodsOrOfGrowingRoundingsHasNoClass) {
  for (std::uint64_t s = 0; s < 20; ++s) {
    EnergySeries walk =
        rounded([&](int b, double before) { return before + 10 * noise(s, static_cast<std::uint64_t>(b)); });
    walk.periods = 15.9;
    EXPECT_FALSE(classify_run(walk).drift) << s;
    walk.periods = 100;
    walk.rounding_grows = true;
    EXPECT_NE(classify_run(walk).drift, DriftClass::random_walk) << s;
  }
}

TEST(RunDrift, PeaksThatBlocksMeetByChanceAreOscillationsLikeAnyOther) {
  // What 1/r leaves near the pericentre, over ten revolutions in 128 blocks: the peaks are seen at any height.
  EnergySeries peaks = series([](int b, double) {
    const double phase = 2 * std::numbers::pi * place(b) / 12.8;
    return 1 / (1.003 - std::cos(phase));
  });
  peaks.periods = 10;
  EXPECT_GT(classify_run(peaks).periods.value(), 8);
}

TEST(RunDrift, AWalkLargerThanRoundingHasNoClass) {
  for (std::uint64_t s = 0; s < 50; ++s) {
    EnergySeries walk = rounded([&](int b, double before) { return before + noise(s, static_cast<std::uint64_t>(b)); });
    walk.rounding = 1e-6;
    EXPECT_FALSE(classify_run(walk).drift) << s;
  }
}

TEST(RunDrift, AWalkBeneathTheRoundingOfTheEnergyItselfIsNeverADrift) {
  int bounded = 0;
  for (std::uint64_t s = 0; s < 400; ++s) {
    double sum = 0;
    const auto found = classify_run(rounded([&](int b, double) {
      sum += 10 * noise(s, static_cast<std::uint64_t>(b));
      return sum + 20 * noise(s + 1000, static_cast<std::uint64_t>(b));
    }));
    EXPECT_NE(found.drift, DriftClass::linear) << s;
    bounded += found.drift == DriftClass::bounded ? 1 : 0;
  }
  EXPECT_LE(bounded, 8);  // 0.4 % of 4000; 8 of 400 once in 10^4 (Poisson)
}

TEST(RunDrift, FalseAlarmsAreAsRareAsTheLevelSays) {
  // 20000 walks at the level 1e-4: 2 expected, and more than 9 once in 20000 such tests (Poisson).
  int alarms = 0;
  for (std::uint64_t s = 0; s < 20000; ++s) {
    const auto found = classify_run(
        series([&](int b, double before) { return before + noise(s, static_cast<std::uint64_t>(b)); }, 64));
    alarms += found.p_value < DriftStatistics::level || found.sign_p_value < RunDrift::sign_level ? 1 : 0;
  }
  EXPECT_LE(alarms, 9);
}

TEST(RunDrift, AnOscillationIsBoundedOverManyPeriodsAndUndecidedOverFew) {
  for (const double periods : {2.0, 3.0, 7.3, 31.0, 64.0, 128.0, 1e5 / 3}) {
    for (int phase = 0; phase < 8; ++phase) {
      const auto wave = [&](int b) {
        const double at = b == 0 ? 0 : place(b);
        return std::sin(2 * std::numbers::pi * (at / blocks * periods + phase / 8.0));
      };
      EnergySeries oscillation = series([&](int b, double) { return 1e-4 * (wave(b) - wave(0)); });
      oscillation.periods = periods;
      const auto found = classify_run(oscillation);
      EXPECT_EQ(found.drift, periods < 16 ? std::nullopt : std::optional(DriftClass::bounded))
          << periods << " periods, phase " << phase << ": " << found.reason;
    }
  }
}

TEST(RunDrift, TheEnergysOwnSlowOscillationCounts) {
  const auto found = classify_run(
      series([](int b, double) { return 1 - std::cos(2 * std::numbers::pi * 3.5 * b / blocks); }));  // q and p: 100
  EXPECT_NEAR(found.periods.value_or(0), 3.5, 0.1);
  EXPECT_FALSE(found.drift);
}

TEST(RunDrift, ASawToothIsNoDrift) {
  // Up in nine tenths of its period, down in one: nearly all increments have one sign.
  EnergySeries saw = series(
      [](int b, double) {
        const double phase = b / 16.0 - std::floor(b / 16.0);
        return phase < 0.9 ? phase / 0.9 : (1 - phase) / 0.1;
      },
      256);
  saw.periods = 16;
  const auto found = classify_run(saw);
  EXPECT_LT(found.sign_p_value, RunDrift::sign_level);
  EXPECT_NE(found.drift, DriftClass::linear);
}

TEST(RunDrift, ADriftIsLinear) {
  for (const double sign : {-1.0, 1.0}) {
    const auto found = classify_run(series([&](int b, double) { return sign * 1e-9 * place(b); }));
    EXPECT_EQ(found.drift, DriftClass::linear);
    EXPECT_LT(found.p_value, 1e-20);
    // The ends of the series are moved by up to half a block.
    EXPECT_NEAR(found.mean_increment, sign * 1e-9, 1e-9 / blocks);
    EXPECT_NEAR(found.growth_exponent, 1, 0.02);
  }
}

TEST(RunDrift, ADriftShowsFromThirtyTimesTheOscillationOnAndForbidsBoundedFarBelow) {
  // 32 increments d/32 with the deviation a of a difference of two sines: t = d/32/a sqrt(32) is 5 for d = 28 a, and
  // the level of 1e-4 lies at 4.5 with 31 degrees of freedom. A trend of d = 3 has the rank correlation 0.6 with time.
  const auto with_drift = [](double total, std::uint64_t s) {
    return classify_run(series([&](int b, double) {
      return total * b / blocks + std::sin(2 * std::numbers::pi * counter_uniform(s, static_cast<std::uint64_t>(b)));
    }));
  };
  for (std::uint64_t s = 0; s < 20; ++s) {
    EXPECT_EQ(with_drift(50, s).drift, DriftClass::linear);
    EXPECT_NE(with_drift(5, s).drift, DriftClass::bounded);
    EXPECT_NE(with_drift(3, s).drift, DriftClass::bounded);
    EXPECT_EQ(with_drift(0.1, s).drift, DriftClass::bounded);
  }
}

TEST(RunDrift, ADriftThatSlowsDownIsSeenByItsSigns) {
  const auto found = classify_run(series([](int b, double) { return 1 - std::pow(b + 1.0, -0.5); }));
  EXPECT_LT(found.sign_p_value, RunDrift::sign_level);
  EXPECT_EQ(found.drift, DriftClass::linear);
  // With nearly all of it in the first blocks only the motion tells it from an oscillation that began at an extreme.
  EnergySeries sudden = series([](int b, double) { return 1 - std::pow(b + 1.0, -2); });
  EXPECT_GT(classify_run(sudden).p_value, DriftStatistics::level);  // one increment outweighs the rest
  sudden.outgrown = true;
  EXPECT_EQ(classify_run(sudden).drift, DriftClass::linear);
}

TEST(RunDrift, NothingIsBoundedAboveItsScaleOrOnceOutgrown) {
  EnergySeries wave = series([](int b, double) { return std::sin(2.4 * b); });
  EXPECT_EQ(classify_run(wave).drift, DriftClass::bounded);
  wave.steady = false;
  EXPECT_FALSE(classify_run(wave).drift);
  wave.steady = true;
  wave.scale = 0.5;
  EXPECT_FALSE(classify_run(wave).drift);
}

TEST(RunDrift, NothingIsBoundedByOscillationsThatAreOver) {
  EnergySeries wave = series([](int b, double) { return std::sin(2.4 * b); });
  wave.still = 0.994;
  const auto found = classify_run(wave);
  EXPECT_FALSE(found.drift);
  EXPECT_NE(found.reason.find("last 99 % of the run"), std::string::npos) << found.reason;
}

TEST(RunDrift, ATrendContradictsASymplecticMethodAboveRoundingAndBelowTheScale) {
  const auto with_trend = [](double size, double rounding) {
    EnergySeries trend = series([&](int b, double) { return size * b / blocks; });
    trend.rounding = rounding;
    trend.roundings = 1e4;
    trend.scale = 1;
    return trend;
  };
  EXPECT_EQ(classify_run(with_trend(1e-6, 1e-16)).drift, DriftClass::linear);
  for (const auto& [size, rounding, drift] : {std::tuple(1e-6, 1e-16, std::optional<DriftClass>()),
                                              std::tuple(1e-12, 1e-16, std::optional(DriftClass::linear)),
                                              std::tuple(0.5, 1e-16, std::optional(DriftClass::linear))}) {
    EnergySeries trend = with_trend(size, rounding);
    trend.symplectic = true;
    EXPECT_EQ(classify_run(trend).drift, drift) << size;
  }
}

TEST(RunDrift, OffWallsThatTheEnergyWalksAtNothingIsBounded) {
  EnergySeries wave = series([](int b, double) { return std::sin(2.4 * b); });
  wave.bounces = true;
  EXPECT_FALSE(classify_run(wave).drift);
}

TEST(RunDrift, AMethodWithACopyIsNotBounded) {
  EnergySeries wave = series([](int b, double) { return std::sin(2.4 * b); });
  wave.copies = true;
  EXPECT_FALSE(classify_run(wave).drift);
}

TEST(RunDrift, OneStepOfTheEnergyIsNoDrift) {
  // A close encounter in an otherwise quiet run: level before it, and level after it.
  for (const int at : {blocks / 8, blocks / 3, blocks / 2, 2 * blocks / 3}) {
    const auto found = classify_run(
        series([&](int b, double) { return (b > at ? 1.0 : 0.0) + 1e-3 * noise(7, static_cast<std::uint64_t>(b)); }));
    EXPECT_EQ(found.drift, std::nullopt) << at << found.reason;
  }
}

TEST(RunDrift, ErrorsOfTheSizeOfSummedRoundingsAreNotBounded) {
  EnergySeries wave = rounded([](int b, double) { return 100 * std::sin(2.4 * b); });
  EXPECT_FALSE(classify_run(wave).drift);  // 10^4 roundings of 1 walk as far
  wave.rounding = 1e-3;
  EXPECT_EQ(classify_run(wave).drift, DriftClass::bounded);
}

TEST(RunDrift, ATrendBelowAWalkIsNotExcluded) {
  // A trend of half a deviation of the walk over the run: no test sees it, and the bound has to be above it.
  int below = 0;
  for (std::uint64_t s = 0; s < 200; ++s) {
    const double trend = 0.5 * 10 / std::sqrt(static_cast<double>(blocks));
    const auto found = classify_run(
        rounded([&](int b, double before) { return before + trend + 10 * noise(s, static_cast<std::uint64_t>(b)); }));
    below += found.trend_not_excluded < trend ? 1 : 0;
    EXPECT_LT(found.trend_not_excluded, 100 * trend);
  }
  EXPECT_EQ(below, 0);  // 1 in 10^4 is expected
}

TEST(RunDrift, HugeAndBrokenEnergies) {
  EXPECT_EQ(classify_run(series([](int b, double) { return 1e300 * b; })).drift, DriftClass::linear);
  EXPECT_FALSE(classify_run(series([](int b, double) { return b == 70 ? std::nan("") : 0; })).drift ==
               DriftClass::bounded);
}

TEST(OscillationCounter, CountWhatTurnsBack) {
  constexpr double period = 100;
  const auto watched = [](auto&& x, std::int64_t steps, std::int64_t apart = 1) {
    OscillationCounter swings;
    for (std::int64_t step = 0; step <= steps; step += apart) swings.look(step, x(static_cast<double>(step)));
    return swings;
  };
  const auto wave = [](double t) { return std::sin(2 * std::numbers::pi * t / period); };
  EXPECT_NEAR(watched(wave, 1000).period(1000).value(), period, 1);
  EXPECT_NEAR(watched(wave, 100000, 7).period(100000).value(), period, 1);
  EXPECT_FALSE(watched([](double t) { return t; }, 1000).period(1000));                 // never turns
  EXPECT_FALSE(watched([&](double t) { return t + 9 * wave(t); }, 5000).period(5000));  // only grows
  EXPECT_FALSE(watched([](double) { return 1.0; }, 1000).period(1000));                 // does not move
  EXPECT_NEAR(watched([&](double t) { return wave(t) + 0.2 * wave(9 * t); }, 1000).period(1000).value(), period, 9);
  EXPECT_EQ(watched(wave, 60).period(60).value(), 120);  // one turn: long, and no more is known
  const OscillationCounter widening = watched([&](double t) { return t * t * t * wave(t); }, 450);
  EXPECT_GT(widening.earlier_periods(), 1);
}

/// As a run looks at it: every step at first, later once in blocks that are as long as the run is many times 256 steps.
template <class F>
OscillationCounter seen_by_a_run(F&& x, std::int64_t steps) {
  EnergyBlocks watch;
  Frame frame;
  for (frame.step = watch.next_due(0); frame.step <= steps; frame.step = watch.next_due(frame.step + 1)) {
    frame.q = {x(static_cast<double>(frame.step))};
    frame.p = {0};
    (void)watch.observe(frame);
  }
  return watch.state().swings.front();
}

TEST(OscillationCounter, PeriodsAreNotCountedBeyondTheLastTurnNorBeforeTheFirst) {
  constexpr double period = 40;
  const auto wave = [](double t) { return std::cos(2 * std::numbers::pi * t / period); };
  for (const double last : {4.0, 10.0, 30.0}) {  // periods, of 1000
    const auto seen = seen_by_a_run([&](double t) { return t < last * period ? wave(t) : 1.0; }, 40000).seen(40000);
    ASSERT_TRUE(seen);
    EXPECT_TRUE(seen->is_over) << last;
    EXPECT_NEAR(seen->periods, last, 1);
    EXPECT_LE(static_cast<double>(seen->last_turn), last * period);
  }
  const auto late = seen_by_a_run([&](double t) { return t < 400 * period ? 1.0 : wave(t); }, 16400).seen(16400);
  ASSERT_TRUE(late);
  EXPECT_LE(late->periods, 16);
}

TEST(OscillationCounter, WhatSamplesAreTooFarApartForIsNotOver) {
  // A sine, and a peak that lasts a twentieth of its period: after a thousand periods both are met by chance alone.
  const auto phase = [](double t) { return 2 * std::numbers::pi * t / 40.37; };
  for (const std::int64_t steps : {400, 3000, 40000, 1000000}) {
    const auto wave = seen_by_a_run([&](double t) { return std::sin(phase(t)); }, steps).seen(steps);
    const auto peak =
        seen_by_a_run([&](double t) { return std::exp(-20 * (1 - std::cos(phase(t)))); }, steps).seen(steps);
    ASSERT_TRUE(wave && peak);
    EXPECT_FALSE(wave->is_over) << steps;
    EXPECT_FALSE(peak->is_over) << steps;
    EXPECT_NEAR(wave->periods / (static_cast<double>(steps) / 40.37), 1, 0.05) << steps;
  }
}

TEST(OscillationCounter, WhatWidensSlowlyIsCountedThrough) {
  // A coordinate of an eccentric orbit whose axis turns: 1000 periods, of which few are sampled when it has doubled.
  const auto wide = [](double t) { return (1 + 1.3e-5 * t) * std::cos(2 * std::numbers::pi * t / 113.1); };
  const auto seen = seen_by_a_run(wide, 113100).seen(113100);
  ASSERT_TRUE(seen);
  EXPECT_NEAR(seen->periods, 1000, 50);
}

TEST(OscillationCounter, WhatSlowsDownIsCountedByItsTurns) {
  // 20 periods of 40 steps, then four of 16000.
  const auto slowing = [](double t) {
    return std::cos(2 * std::numbers::pi * (t < 800 ? t / 40 : 20 + (t - 800) / 16000));
  };
  const auto seen = seen_by_a_run(slowing, 64800).seen(64800);
  ASSERT_TRUE(seen);
  EXPECT_FALSE(seen->is_over);
  EXPECT_NEAR(seen->periods, 24, 2);
}

std::vector<std::int64_t> looked_at(std::int64_t steps, EnergyBlocks& watch) {
  std::vector<std::int64_t> all;
  Frame frame;
  for (frame.step = watch.next_due(0); frame.step <= steps; frame.step = watch.next_due(frame.step + 1)) {
    frame.energy = static_cast<double>(frame.step);
    (void)watch.observe(frame);
    all.push_back(frame.step);
  }
  EXPECT_LE(static_cast<double>(all.size()), 257 + 128 * std::max(1.0, std::log2(static_cast<double>(steps) / 256)));
  return all;
}

TEST(EnergyBlocks, OneSampleInEachOfEqualBlocksHoweverLongTheRun) {
  for (const std::int64_t steps : {40, 255, 256, 257, 1000, 99999, 1000000}) {
    EnergyBlocks watch;
    (void)looked_at(steps, watch);
    const auto& state = watch.state();
    const auto samples = static_cast<std::int64_t>(state.energies.size());
    EXPECT_LE(samples, 257);
    if (state.block_steps > 1) {
      EXPECT_GE(samples, 128) << steps;
    }
    EXPECT_GT(samples * state.block_steps + state.block_steps, steps);
    for (std::int64_t b = 0; b < samples; ++b) {  // the energy is the step
      const double at = state.energies[static_cast<std::size_t>(b)] / static_cast<double>(state.block_steps);
      EXPECT_EQ(std::floor(at), static_cast<double>(b)) << steps << " " << state.block_steps;
    }
  }
}

TEST(EnergyBlocks, BlocksInStepWithAPeriodDoNotMakeADrift) {
  // A period of 100 steps and a bit: 1000 steps are ten of them but for a slow slip. Samples at the ends of blocks of
  // 1024 steps would show a beat.
  for (const double slip : {1e-6, 1e-5, 2.4e-2 / 1.024}) {
    EnergyBlocks watch;
    Frame frame;
    for (frame.step = watch.next_due(0); frame.step <= 200000; frame.step = watch.next_due(frame.step + 1)) {
      frame.energy = std::sin(2 * std::numbers::pi * static_cast<double>(frame.step) / 102.4 * (1 + slip));
      (void)watch.observe(frame);
    }
    EnergySeries seen;
    for (const double h : watch.state().energies) seen.deviations.push_back(h - watch.state().energies.front());
    seen.periods = 2000;
    seen.scale = 100;
    EXPECT_EQ(classify_run(seen).drift, DriftClass::bounded) << slip;
  }
}

TEST(EnergyBlocks, TheStateIsAllThereIs) {
  EnergyBlocks whole;
  (void)looked_at(1000, whole);
  Writer ar;
  whole.archive(ar);
  Reader back(ar.bytes());
  EnergyBlocks copy;
  copy.archive(back);
  Writer again;
  copy.archive(again);
  EXPECT_EQ(ar.bytes(), again.bytes());
}

TEST(LongNumber, SmallerThanADouble) {
  EXPECT_EQ(times_power_of_ten(2, -400).text.substr(0, 3), "2.0");
  EXPECT_EQ(times_power_of_ten(2, -10).text, "");
  EXPECT_TRUE(at_most(times_power_of_ten(2, -400), times_power_of_ten(3, -400)));
  EXPECT_FALSE(at_most(times_power_of_ten(2, -399), times_power_of_ten(3, -400)));
  EXPECT_DOUBLE_EQ(quotient(times_power_of_ten(6, -400), times_power_of_ten(3, -400)), 2);
  const ScaledDifferences d = differences_to_first(
      {"1", "1.0000000000000000000000000000000000000002", "0.9999999999999999999999999999999999999999"});
  EXPECT_EQ(d.values[0], 0);
  EXPECT_DOUBLE_EQ(d.values[1], 1);
  EXPECT_NEAR(d.values[2], -0.5, 1e-11);
  EXPECT_NEAR(times(1, d.unit), 2e-40, 1e-51);  // computed with ten digits more than are written
}

}  // namespace
}  // namespace hamflow
