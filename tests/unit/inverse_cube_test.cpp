// u^(-3/2) by estimate and series: its error, its edges, its fallback, and the problem that uses it.
#include "hamflow/core/inverse_cube.hpp"

#include "../support/near.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/problems/support/fast_kernel.hpp"
#include "hamflow/run/simulation_of.hpp"

namespace hamflow {
namespace {

long double longer(double x) { return static_cast<long double>(x); }

/// u^(-3/2) with an error of at most 3 x 2^-64 of it: far below what is looked for.
long double reference(double u) { return 1 / (longer(u) * std::sqrt(longer(u))); }

struct Errors {
  long double largest = 0;  // in units of 2^-53, relative
  long double mean_square = 0;
};

/// Over `count` random u of the exponents of the domain, mantissas uniform.
template <class F>
Errors errors_of(const F& f, std::uint64_t count, int lowest = -681, int highest = 669) {
  Errors errors;
  for (std::uint64_t k = 0; k < count; ++k) {
    const auto span = static_cast<std::uint64_t>(highest - lowest + 1);
    const int exponent = lowest + static_cast<int>(counter_bits(71, 2 * k) % span);
    const double u = std::ldexp(1.5 + counter_uniform(71, 2 * k + 1) / 2, exponent);  // [1, 2) 2^exponent
    const long double exact = reference(u);
    const long double error = std::fabs(static_cast<long double>(f(u)) - exact) / exact * 0x1p53L;
    errors.largest = std::max(errors.largest, error);
    errors.mean_square += error * error / static_cast<long double>(count);
  }
  return errors;
}

constexpr std::uint64_t many = 2'000'000;

bool has_fused_operations() {
#if defined(__x86_64__) && defined(__GNUC__)
  return __builtin_cpu_supports("fma") != 0;
#else
  return true;
#endif
}

/// u^(-1/2), off by delta and then rounded to so many binary digits.
double rough_root(double u, double delta, int digits) {
  const double y = (1 + delta) / std::sqrt(u);
  int exponent = 0;
  const double mantissa = std::frexp(y, &exponent);
  return std::ldexp(std::nearbyint(std::ldexp(mantissa, digits)), exponent - digits);
}

TEST(InverseCube, ErrorOfSquareRootAndDivision) {
  // Three roundings; that of the root counts fully, u sqrt(u) and the division too: at most 3, never seen above 2.5.
  const Errors errors = errors_of([](double u) { return 1 / (u * std::sqrt(u)); }, many);
  EXPECT_LT(errors.largest, 3);
  EXPECT_GT(errors.largest, 2.2L);
}

TEST(InverseCube, ErrorOnThisMachine) {
  RecordProperty("instruction_set", std::string(name(fast_kernel_instruction_set())));
  const Errors errors = errors_of([](double u) { return inverse_cube(u); }, many);
  std::printf("%s: largest %.4Lf, root mean square %.4Lf units of 2^-53\n",
              std::string(name(fast_kernel_instruction_set())).c_str(), errors.largest, std::sqrt(errors.mean_square));
  if (!fast_kernel_available()) {
    EXPECT_LT(errors.largest, 3);
    return;
  }
  // With an estimate of at most 17 digits y^3 is exact; else y^2 (counting half) and y^3 are rounded before the end.
  bool short_estimates = true;
  for (std::uint64_t k = 0; k < 1000; ++k) {
    const double u = 2.5 + counter_uniform(3, k) * 1.5;
    const double y = detail::inverse_root_estimate(u);
    EXPECT_TRUE(test::within(longer(y) * std::sqrt(longer(u)), 1, 0x1p-14L)) << u;
    short_estimates = short_estimates && std::fmod(std::ldexp(y, 17), 1.0) == 0;  // y is in [1/2, 1]
  }
  EXPECT_LT(errors.largest, short_estimates ? 1.002L : 2.6L);
  EXPECT_LT(std::sqrt(errors.mean_square), short_estimates ? 0.45L : 1.0L);
}

/// The series itself runs wherever there are fused operations; the estimate is then made up, with the largest error
/// that the instruction may have on either side, and with as many digits as y^3 can have without rounding.
TEST(InverseCube, ErrorOfTheSeriesWithTheWorstEstimates) {
  if (!has_fused_operations()) GTEST_SKIP() << "no fused multiply-add";
  for (const double delta : {-0x1p-14, -0x1p-15, 0.0, 0x1p-15, 0x1p-14}) {
    const double allowed = delta * (1 - 0x1p-3);  // rounding to 17 digits adds 2^-17
    const Errors errors =
        errors_of([&](double u) { return detail::inverse_cube_series(u, rough_root(u, allowed, 17), 1.0); }, many / 5);
    EXPECT_LT(errors.largest, 1.002L) << delta;
    EXPECT_LT(std::sqrt(errors.mean_square), 0.45L) << delta;
  }
  // The bound has teeth: at 8 times the error of the estimate the missing fifth power shows.
  const Errors worse =
      errors_of([](double u) { return detail::inverse_cube_series(u, rough_root(u, 0x1p-11, 17), 1.0); }, many / 20);
  EXPECT_GT(worse.largest, 1.01L);
}

TEST(InverseCube, OutsideItsDomainNothingFiniteIsWrong) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  constexpr double smallest = std::numeric_limits<double>::denorm_min();
  EXPECT_FALSE(std::isfinite(inverse_cube(0.0)));
  EXPECT_FALSE(std::isfinite(inverse_cube(-0.0)));
  EXPECT_FALSE(std::isfinite(inverse_cube(smallest)));
  EXPECT_FALSE(std::isfinite(inverse_cube(0x1p-1023)));
  EXPECT_FALSE(std::isfinite(inverse_cube(std::numeric_limits<double>::min())));
  EXPECT_TRUE(std::isnan(inverse_cube(-1.0)));
  EXPECT_TRUE(std::isnan(inverse_cube(-inf)));
  EXPECT_TRUE(std::isnan(inverse_cube(std::numeric_limits<double>::quiet_NaN())));
  const double at_infinity = inverse_cube(inf);
  EXPECT_TRUE(at_infinity == 0 || std::isnan(at_infinity));
  // Where u^(-3/2) itself leaves the normal numbers: not finite above, above them; small below, below them.
  for (std::uint64_t k = 0; k < 100'000; ++k) {
    const double mantissa = 1.5 + counter_uniform(5, 2 * k) / 2;
    const auto up_to = [&](int n) { return static_cast<int>(counter_bits(5, 2 * k + 1) % static_cast<unsigned>(n)); };
    const double tiny = std::ldexp(mantissa, -684 - up_to(390));
    EXPECT_FALSE(std::isfinite(inverse_cube(tiny))) << tiny;
    const double huge = std::ldexp(mantissa, 683 + up_to(341));
    EXPECT_TRUE(test::within(longer(inverse_cube(huge)), reference(huge), 0x1p-1022L)) << huge;
  }
}

TEST(InverseCube, AStrengthCostsOneMoreRounding) {
  const double k = 0.3;
  const Errors errors = errors_of([=](double u) { return longer(inverse_cube(u, k)) / longer(k); }, many / 5);
  EXPECT_LT(errors.largest, fast_kernel_available() ? 2.002L : 3.0L);
}

TEST(FastKernel, ChangesTheForceAndNothingElse) {
  using Exact = CentralForce<double, Kepler>;
  using Fast = FastKernel<Exact>;
  static_assert(Separable<Fast> && QuadraticKinetic<Fast> && TwiceDifferentiable<Fast>);
  const Exact exact(2.0, Kepler<double>(0.7));
  const Fast fast(exact);
  for (std::uint64_t k = 0; k < 10'000; ++k) {
    const Vector<double, 2> q{counter_uniform(9, 2 * k), counter_uniform(9, 2 * k + 1)};
    Vector<double, 2> a{}, b{};
    force(exact, q, a);
    force(fast, q, b);
    for (std::size_t i = 0; i < 2; ++i) {
      // 5 units of 2^-53 for either (two for u, doing three halves of it, three for the slope, one for the product).
      const double bound = fast_kernel_available() ? 5 * test::epsilon * std::fabs(a[i]) : 0;
      EXPECT_LE(std::fabs(b[i] - a[i]), bound);
    }
    // With a factor the same kernel, and neither the exact force of the base class nor one multiplication more.
    const double slope = inverse_cube(q[0] * q[0] + q[1] * q[1], -0.3 * 0.7);
    scaled_force(fast, -0.3, q, b);
    EXPECT_EQ(b, (Vector<double, 2>{-(slope * q[0]), -(slope * q[1])}));
    EXPECT_EQ(potential_energy(fast, q), potential_energy(exact, q));
  }
  // In other arithmetic there is no fast form: the same bits.
  const CentralForce<long double, Kepler> exact_long(2.0L, Kepler<long double>(0.7L));
  const FastKernel<CentralForce<long double, Kepler>> fast_long(exact_long);
  Vector<long double, 2> a{}, b{};
  force(exact_long, {0.3L, -0.4L}, a);
  force(fast_long, {0.3L, -0.4L}, b);
  EXPECT_EQ(a, b);
}

TEST(FastKernel, EndsAnOrbitWhereTheExactForceDoes) {
  const CentralForce<double, Kepler> exact(2.0, Kepler<double>(1.0));
  const FastKernel fast{exact};
  const Vector<double, 2> q{1, 0}, p{0, std::sqrt(3.0)};
  auto a = simulate(exact, Composition<compositions::stv4>{}, q, p, 0.1);
  auto b = simulate(fast, Composition<compositions::stv4>{}, q, p, 0.1);
  constexpr int steps = 1000;
  ASSERT_EQ(a.advance(steps), Outcome::done);
  ASSERT_EQ(b.advance(steps), Outcome::done);
  // Defects of 12 epsilon a step shift the phase by at most 6 h steps^2 times as much (bench/library.hpp).
  const double bound = fast_kernel_available() ? 12 * test::epsilon * (10.0 * steps + 0.6 * steps * steps) : 0;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LE(std::fabs(b.state().q[i] - a.state().q[i]), bound);
    EXPECT_LE(std::fabs(b.state().p[i] - a.state().p[i]), bound);
  }
}

}  // namespace
}  // namespace hamflow
