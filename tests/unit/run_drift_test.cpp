// The drift of a single run, on series whose class is known, and the observer that takes the samples.
#include <cmath>
#include <numbers>

#include "../support/near.hpp"
#include "hamflow/verify/certificate.hpp"
#include "hamflow/verify/counter_random.hpp"

namespace hamflow {
namespace {

constexpr int blocks = 128;
double noise(std::uint64_t s, std::uint64_t b) { return std::sqrt(3.0) * counter_uniform(s, b); }  // variance 1

template <class F>
std::vector<double> series(F&& error, int count = blocks) {
  std::vector<double> all{-0.5};
  for (int b = 1; b <= count; ++b) all.push_back(-0.5 + error(b, all.back() + 0.5));
  return all;
}
double place(int b, std::uint64_t s = 5) { return b + 0.25 * (1 + counter_uniform(s, static_cast<std::uint64_t>(b))); }

TEST(RunDrift, TooFewBlocksHaveNoClass) {
  EXPECT_FALSE(classify_run(std::vector<double>(32, -0.5)).drift);
  EXPECT_NE(classify_run({}).reason, "");
  EXPECT_EQ(classify_run(std::vector<double>(33, -0.5)).drift, DriftClass::bounded);
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
        series([&](int b, double before) { return before + 1e-15 * noise(s, static_cast<std::uint64_t>(b)); }));
    sum += found.growth_exponent;
    squares += std::pow(found.growth_exponent - 0.5, 2);
    called_walks += found.drift == DriftClass::random_walk ? 1 : 0;
    if (s == 0) uncertainty = found.growth_uncertainty;
  }
  EXPECT_NEAR(sum / 400, 0.5, uncertainty / 2);
  EXPECT_LT(std::sqrt(squares / 400), 1.1 * uncertainty);  // the spread of a spread over 400 is 4 %
  EXPECT_GE(called_walks, 394);                            // 0.2 is 2.5 deviations: 1.2 % lie beyond
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

TEST(RunDrift, AnOscillationIsBoundedFromTwoPeriodsOn) {
  for (const double periods : {2.0, 3.0, 7.3, 31.0, 64.0, 128.0, 1e5 / 3}) {
    for (int phase = 0; phase < 8; ++phase) {
      const auto wave = [&](int b) {
        const double at = b == 0 ? 0 : place(b);
        return std::sin(2 * std::numbers::pi * (at / blocks * periods + phase / 8.0));
      };
      EXPECT_EQ(classify_run(series([&](int b, double) { return 1e-4 * (wave(b) - wave(0)); })).drift,
                DriftClass::bounded)
          << periods << " periods, phase " << phase;
    }
  }
}

TEST(RunDrift, NothingButTheFirstSampleMoves) {
  EXPECT_EQ(classify_run(series([](int, double) { return 1e-16; })).drift, DriftClass::bounded);
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

TEST(RunDrift, ADriftShowsFromThirtyTimesTheOscillationOn) {
  // 32 increments d/32 with the deviation a of a difference of two sines: t = d/32/a sqrt(32) is 5 for d = 28 a, and
  // the level of 1e-4 lies at 4.5 with 31 degrees of freedom. Below, it is called a walk or bounded.
  const auto with_drift = [](double total, std::uint64_t s) {
    return classify_run(series([&](int b, double) {
      return total * b / blocks + std::sin(2 * std::numbers::pi * counter_uniform(s, static_cast<std::uint64_t>(b)));
    }));
  };
  for (std::uint64_t s = 0; s < 20; ++s) {
    EXPECT_EQ(with_drift(50, s).drift, DriftClass::linear);
    EXPECT_EQ(with_drift(5, s).drift, DriftClass::bounded);
  }
}

TEST(RunDrift, ADriftThatSlowsDownIsSeenByItsSigns) {
  const auto found = classify_run(series([](int b, double) { return 1 - std::pow(b + 1.0, -2); }));
  EXPECT_GT(found.p_value, DriftStatistics::level);  // one increment outweighs the rest
  EXPECT_LT(found.sign_p_value, RunDrift::sign_level);
  EXPECT_EQ(found.drift, DriftClass::linear);
}

TEST(RunDrift, HugeAndBrokenEnergies) {
  EXPECT_EQ(classify_run(series([](int b, double) { return 1e300 * b; })).drift, DriftClass::linear);
  EXPECT_EQ(classify_run(series([](int b, double) { return b == 70 ? std::nan("") : 0; })).drift, DriftClass::linear);
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
    EXPECT_EQ(watch.drift().drift, DriftClass::bounded) << slip;
  }
}

TEST(EnergyBlocks, TheStateIsAllThereIs) {
  struct Copier {  // an archive that copies field by field
    std::vector<double> kept;
    void operator()(std::int64_t& a, std::int64_t& b, std::vector<double>& c, std::vector<double>& d) {
      kept = {static_cast<double>(a), static_cast<double>(b), static_cast<double>(c.size()),
              static_cast<double>(d.size())};
    }
  } copier;
  EnergyBlocks watch;
  (void)looked_at(100, watch);
  EnergyBlockState state = watch.state();
  state.archive(copier);
  EXPECT_EQ(copier.kept, (std::vector<double>{1, 101, 101, 4}));
}

}  // namespace
}  // namespace hamflow
