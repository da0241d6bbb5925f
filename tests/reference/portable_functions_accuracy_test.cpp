// The errors of the portable functions, measured against MPFR with 200 digits.
#include <gtest/gtest.h>
#include <mpfr.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "hamflow/detail/core/portable_functions.hpp"

namespace hamflow {
namespace {

/// The sums of two doubles that the functions end with have relative errors of up to some 2^-65, which is 2^-12 units
/// in the last place; rounding them adds 1/2. The largest error of 2 * 10^7 arguments was 0.50028.
constexpr double allowed_error = 0.5 + 0x1p-11;
/// Correspondingly, the result is the wrong neighbour for at most one argument in 2^11. Measured: one in 60 000.
constexpr double allowed_share = 0x1p-11;

using Arguments = std::pair<double, double>;
using Function = std::function<double(Arguments)>;
using Reference = std::function<int(mpfr_t, mpfr_t, mpfr_t)>;
using Draw = std::function<Arguments()>;

class PortableAccuracy : public ::testing::Test {
 protected:
  PortableAccuracy() {
    mpfr_inits2(53, x_, y_, static_cast<mpfr_ptr>(nullptr));
    mpfr_inits2(200, exact_, error_, static_cast<mpfr_ptr>(nullptr));
  }
  ~PortableAccuracy() override { mpfr_clears(x_, y_, exact_, error_, static_cast<mpfr_ptr>(nullptr)); }

  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  double finite() {
    for (;;) {
      const std::uint64_t bits = random_();
      double x = 0;
      std::memcpy(&x, &bits, sizeof x);
      if (std::isfinite(x)) return x;
    }
  }
  double whole(double low, double high) { return std::floor(between(low, high)); }
  /// Of a size between two powers of two, with any sign.
  double sized(int low, int high) {
    const double m = std::ldexp(between(1, 2), static_cast<int>(whole(low, high + 1)));
    return random_() % 2 == 0 ? m : -m;
  }

  void compare(const Function& function, const Reference& reference, Arguments at) {
    const double result = function(at);
    mpfr_set_d(x_, at.first, MPFR_RNDN);
    mpfr_set_d(y_, at.second, MPFR_RNDN);
    reference(exact_, x_, y_);
    const double nearest = mpfr_get_d(exact_, MPFR_RNDN);
    ++compared_;
    if (std::isnan(nearest) || std::isinf(nearest)) {
      ASSERT_TRUE(result == nearest || (std::isnan(result) && std::isnan(nearest))) << at.first << ' ' << at.second;
      return;
    }
    ASSERT_TRUE(std::isfinite(result)) << at.first << ' ' << at.second;
    if (result != nearest) ++wrong_;
    int exponent = 0;
    std::frexp(nearest, &exponent);
    mpfr_sub_d(error_, exact_, result, MPFR_RNDN);
    mpfr_mul_2si(error_, error_, std::min(53 - exponent, 1074), MPFR_RNDN);
    const double error = std::fabs(mpfr_get_d(error_, MPFR_RNDN));
    if (error > largest_) {
      largest_ = error;
      where_ = at;
    }
  }

  void measure(const std::string& name, const Function& function, const Reference& reference,
               const std::vector<Draw>& draws) {
    largest_ = 0;
    wrong_ = compared_ = 0;
    for (const Draw& draw : draws) {
      for (std::size_t n = 0; n < 60000 / draws.size(); ++n) {
        compare(function, reference, draw());
        if (HasFatalFailure()) FAIL() << name;
      }
    }
    const auto share = std::to_string(wrong_) + " of " + std::to_string(compared_);
    RecordProperty("wrongly_rounded_" + name, share);
    RecordProperty("largest_error_" + name, std::to_string(largest_));
    EXPECT_LE(largest_, allowed_error) << name << " at " << std::hexfloat << where_.first << ' ' << where_.second;
    EXPECT_LE(static_cast<double>(wrong_), allowed_share * static_cast<double>(compared_)) << name << ": " << share;
  }
  void measure(const std::string& name, double (*function)(double), int (*reference)(mpfr_t, const mpfr_t, mpfr_rnd_t),
               const std::vector<std::function<double()>>& draws) {
    std::vector<Draw> both;
    for (const auto& draw : draws) both.emplace_back([&draw] { return Arguments{draw(), 0}; });
    measure(
        name, [&](Arguments at) { return function(at.first); },
        [&](mpfr_t out, mpfr_t x, mpfr_t) { return reference(out, x, MPFR_RNDN); }, both);
  }
  void measure(const std::string& name, double (*function)(double, double),
               int (*reference)(mpfr_t, const mpfr_t, const mpfr_t, mpfr_rnd_t), const std::vector<Draw>& draws) {
    measure(
        name, [&](Arguments at) { return function(at.first, at.second); },
        [&](mpfr_t out, mpfr_t x, mpfr_t y) { return reference(out, x, y, MPFR_RNDN); }, draws);
  }

 private:
  std::mt19937_64 random_{1971};
  mpfr_t x_, y_, exact_, error_;
  double largest_ = 0;
  std::size_t wrong_ = 0;
  std::size_t compared_ = 0;
  Arguments where_;
};

TEST_F(PortableAccuracy, OfExponentialsAndLogarithms) {
  measure("exp", portable::exp, mpfr_exp,
          {[&] { return finite(); }, [&] { return between(-1, 1); }, [&] { return between(-750, 715); },
           [&] { return between(-746, -707); }, [&] { return between(709.7, 709.8); }});
  measure("log", portable::log, mpfr_log,
          {[&] { return std::fabs(finite()); }, [&] { return between(0.5, 2); }, [&] { return 1 + sized(-52, -6); },
           [&] { return between(0, 0x1p-1022); }});
}

TEST_F(PortableAccuracy, OfSinesAndTangents) {
  const std::vector<std::function<double()>> draws{
      [&] { return sized(-1074, 1023); },
      [&] { return between(-7, 7); },
      [&] { return between(-26000, 26000); },
      [&] { return sized(-30, -2); },
      [&] { return whole(-40000, 40000) * M_PI_2 * (1 + whole(-8, 9) * 0x1p-52); },
      [&] { return whole(-20000, 20000) * (M_PI / 128) + sized(-40, -7); },
      // of all doubles nearest to a multiple of pi/2, relative to their own digits   [PayneHanek1983]
      [&] { return std::ldexp(6381956970095103, 797); },
  };
  measure("sin", portable::sin, mpfr_sin, draws);
  measure("cos", portable::cos, mpfr_cos, draws);
  measure("tan", portable::tan, mpfr_tan, draws);
}

TEST_F(PortableAccuracy, OfInverseFunctions) {
  const std::vector<std::function<double()>> draws{
      [&] { return between(-1, 1); },
      [&] { return sized(-62, -2); },
      [&] { return std::copysign(1 - std::fabs(sized(-53, -2)), between(-1, 1)); },
  };
  measure("asin", portable::asin, mpfr_asin, draws);
  measure("acos", portable::acos, mpfr_acos, draws);
  measure("atan", portable::atan, mpfr_atan,
          {[&] { return finite(); }, [&] { return between(-2, 2); }, [&] { return sized(-64, 64); }});
  measure("atan2", portable::atan2, mpfr_atan2,
          {[&] {
             return Arguments{finite(), finite()};
           },
           [&] {
             return Arguments{between(-1, 1), between(-1, 1)};
           },
           [&] {
             const double x = sized(-900, 900);
             return Arguments{x * sized(-70, 70), x};
           },
           [&] {
             return Arguments{sized(-1074, -1000), sized(-1074, -1000)};
           },
           [&] {
             const double x = sized(-3, 3);
             return Arguments{x * whole(0, 129) / 64 * (1 + sized(-60, -7)), x};
           }});
}

TEST_F(PortableAccuracy, OfHyperbolicFunctions) {
  const std::vector<std::function<double()>> draws{
      [&] { return sized(-1074, 10); },      [&] { return between(-2, 2); }, [&] { return between(-25, 25); },
      [&] { return between(-712, 712); },    [&] { return sized(-30, -3); }, [&] { return between(0.1, 0.25); },
      [&] { return between(710.4, 710.5); },
  };
  measure("sinh", portable::sinh, mpfr_sinh, draws);
  measure("cosh", portable::cosh, mpfr_cosh, draws);
  measure("tanh", portable::tanh, mpfr_tanh, draws);
}

TEST_F(PortableAccuracy, OfPowersAndHypotenuses) {
  const auto with_log_of_power = [this](double x, double low, double high) {
    return Arguments{x, between(low, high) / std::log(x)};
  };
  measure("pow", portable::pow, mpfr_pow,
          {[&] { return with_log_of_power(std::fabs(finite()), -750, 715); },
           [&] {
             return Arguments{between(0, 10), between(-20, 20)};
           },
           [&] { return with_log_of_power(1 + sized(-52, -3), -750, 715); },
           [&] { return with_log_of_power(std::fabs(finite()), -746, -707); },
           [&] {
             return Arguments{between(-10, 10), whole(-20, 21)};
           },
           [&] {
             const double y = whole(2, 8);
             return Arguments{whole(1, std::exp2(53 / y)), y};  // exact powers
           }});
  measure("hypot", portable::hypot, mpfr_hypot,
          {[&] {
             return Arguments{finite(), finite()};
           },
           [&] {
             return Arguments{between(-1, 1), between(-1, 1)};
           },
           [&] {
             const double x = sized(-1000, 950);
             return Arguments{x, x * sized(-62, 62)};
           },
           [&] {
             return Arguments{sized(-1074, -1010), sized(-1074, -1010)};
           }});
}

}  // namespace
}  // namespace hamflow
