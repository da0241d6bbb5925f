// Energies of which nothing else is known.
#include "hamflow/verify/log_certificate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/error.hpp"

namespace hamflow {
namespace {

struct Log {
  std::vector<double> t;
  std::vector<double> energy;
  LogCertificate certified(std::optional<double> scale = {}) const { return certify_log(t, energy, scale); }
};
template <class F>
Log log_of(F&& energy, std::size_t samples = 3000) {
  Log all;
  for (std::size_t i = 0; i < samples; ++i) {
    all.t.push_back(0.1 * static_cast<double>(i));
    all.energy.push_back(energy(all.t.back()));
  }
  return all;
}
double oscillation(double t) { return -0.5 + 1e-6 * std::sin(3 * t); }

TEST(LogCertificate, ClassesOfLogs) {
  EXPECT_EQ(log_of(oscillation).certified().drift.drift, DriftClass::bounded);
  EXPECT_EQ(log_of([](double t) { return oscillation(t) + 1e-7 * t; }).certified().drift.drift, DriftClass::linear);
  EXPECT_EQ(log_of([](double t) { return 1 + 1e-9 * t; }).certified().drift.drift, DriftClass::linear);
  EXPECT_EQ(log_of([](double t) { return std::exp(-1e-3 * t); }).certified().drift.drift, DriftClass::linear);
  int walks = 0;
  for (std::uint64_t s = 0; s < 20; ++s) {
    double sum = 1;
    std::uint64_t i = 0;
    const auto found = log_of([&](double) { return sum += 1e-16 * counter_uniform(s, i++); }).certified().drift.drift;
    EXPECT_NE(found, DriftClass::bounded);
    EXPECT_NE(found, DriftClass::linear);
    walks += found == DriftClass::random_walk ? 1 : 0;
  }
  EXPECT_GT(walks, 10);
}

TEST(LogCertificate, PartsOfSlowOscillationsHaveNoClass) {
  for (const double periods : {0.4, 0.6, 1.0, 1.5}) {
    for (int k = 0; k < 8; ++k) {
      const auto slow = [&](double t) { return 1 + 1e-4 * std::sin(k * 0.785 + periods * 6.2832 * t / 300); };
      EXPECT_EQ(log_of(slow).certified().drift.drift, std::nullopt) << periods << " " << k;
      EXPECT_EQ(log_of([&](double t) { return slow(t) + 1e-5 * std::sin(20 * t); }).certified().drift.drift,
                std::nullopt)
          << periods << " " << k;
    }
  }
}

TEST(LogCertificate, LevelAndScale) {
  const Log log = log_of(oscillation);
  EXPECT_EQ(log.certified().scale, 0.5);
  EXPECT_NEAR(*log.certified().energy_level, 2e-6, 1e-8);
  EXPECT_NEAR(*log.certified(2.0).energy_level, 5e-7, 1e-9);
  EXPECT_EQ(log_of([](double t) { return std::sin(3 * t); }).certified().energy_level, std::nullopt);
  EXPECT_EQ(log_of(oscillation, 32).certified().growth_exponent(), std::nullopt);
  EXPECT_TRUE(log_of(oscillation, 33).certified().growth_exponent().has_value());
}

TEST(LogCertificate, UnevenTimes) {
  Log log = log_of(oscillation);
  for (std::size_t i = 0; i < log.t.size(); ++i) {
    log.t[i] += 0.04 * counter_uniform(1, i);
    log.energy[i] = oscillation(log.t[i]);
  }
  EXPECT_EQ(log.certified().drift.drift, DriftClass::bounded);
  log.t.push_back(600);
  log.energy.push_back(oscillation(600));
  EXPECT_EQ(log.certified().drift.drift, std::nullopt);
}

TEST(LogCertificate, WrongLogsAreRefused) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(certify_log({0, 1}, {1}), Error);
  EXPECT_THROW(certify_log({0}, {1}), Error);
  EXPECT_THROW(certify_log({0, 0}, {1, 1}), Error);
  EXPECT_THROW(certify_log({0, nan}, {1, 1}), Error);
  EXPECT_THROW(certify_log({0, 1}, {1, nan}), Error);
  for (const double scale : {0.0, -1.0, nan}) EXPECT_THROW(certify_log({0, 1}, {1, 1}, scale), Error);
  EXPECT_EQ(first_time_that_does_not_rise({0, 1, 1}), 2u);
}

}  // namespace
}  // namespace hamflow
