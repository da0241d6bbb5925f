// Elliptic integrals and Jacobi's functions against printed values, series, identities, limits, and the differential
// equations that define them.
#include "hamflow/detail/numerics/elliptic.hpp"

#include "../support/near.hpp"
#include "engine/reference_flow.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/derivatives.hpp"

namespace hamflow {
namespace {

using Long = long double;
using test::long_epsilon;
using test::within;

const Long pi = pi_value<Long>();

/// K by its power series in m, for m <= 1/2.   [DLMF, (19.5.1)]
Long k_by_series(Long m) {
  Long sum = 0;
  Long term = 1;
  for (int n = 0; n < 90; ++n) {  // terms decrease faster than 2^-n
    sum += term;
    const Long ratio = (n + 0.5L) / (n + 1);
    term *= ratio * ratio * m;
  }
  return pi / 2 * sum;
}

TEST(Elliptic, CompleteIntegralHasItsPrintedValues) {
  // K(1/2) = Gamma(1/4)^2/(4 sqrt pi), and K((2 - sqrt 3)/4) = 3^(1/4) Gamma(1/3)^3/(2^(7/3) pi).   [DLMF, Sect. 19.6]
  EXPECT_TRUE(
      test::same_to_rounding(complete_k(0.5L), parse_decimal<Long>("1.8540746773013719184338503471952600"), 2.0L));
  const Long gamma_third = parse_decimal<Long>("2.6789385347077476336556929409746776");
  const Long singular =
      std::pow(3.0L, 0.25L) * gamma_third * gamma_third * gamma_third / (std::pow(2.0L, 7 / 3.0L) * pi);
  EXPECT_TRUE(test::same_to_rounding(complete_k((2 - std::sqrt(3.0L)) / 4), singular, 8.0L));
  EXPECT_TRUE(test::same_to_rounding(complete_k(0.0L), pi / 2, 1.0L));
  EXPECT_TRUE(std::isinf(complete_k(1.0L)));
  EXPECT_TRUE(std::isnan(complete_k(1.5L)) && std::isnan(complete_k(-0.5L)));
  EXPECT_TRUE(test::same_to_rounding(complete_k(0.5), 1.8540746773013719, 2.0));
}

TEST(Elliptic, CompleteIntegralAgreesWithItsSeries) {
  for (const Long m : {1e-18L, 1e-9L, 0.01L, 0.1L, 0.25L, 0.4L, 0.5L}) {
    EXPECT_TRUE(test::same_to_rounding(complete_k(m), k_by_series(m), 8.0L)) << static_cast<double>(m);
  }
  // Near m = 1: K = L + (L - 1) m1/4 + O(m1^2 L), L = ln(4/sqrt m1).   [DLMF, (19.12.1)]
  for (const Long m1 : {1e-12L, 1e-18L, 1e-300L, 1e-4000L}) {
    const Long l = std::log(4.0L) - std::log(m1) / 2;
    EXPECT_TRUE(within(complete_k_of_complement(m1), l + (l - 1) * m1 / 4, l * (8 * long_epsilon + m1 * m1)));
  }
}

TEST(Elliptic, LegendreTransformationsHold) {
  // K(m) = (1 + k1) K(k1^2), k1 = (1 - k')/(1 + k'): an identity between different parameters.   [DLMF, (19.8.12)]
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Long complement_root = 0.5L + 0.499L * counter_uniform(31, i);
    const Long k1 = (1 - complement_root) / (1 + complement_root);
    const Long m1 = 4 * complement_root / ((1 + complement_root) * (1 + complement_root));  // 1 - k1^2
    EXPECT_TRUE(test::same_to_rounding(complete_k_of_complement(complement_root * complement_root),
                                       (1 + k1) * complete_k_of_complement(m1), 8.0L));
  }
}

TEST(Elliptic, FunctionsSatisfyTheirIdentities) {
  for (std::uint64_t i = 0; i < 400; ++i) {
    const Long m1 = std::exp(-25 * (1 + counter_uniform(32, 3 * i)));  // 2e-22 .. 1
    const Long k = complete_k_of_complement(m1);
    const Long u = 3 * k * counter_uniform(32, 3 * i + 1);
    const Long v = 2 * k * counter_uniform(32, 3 * i + 2);
    const Jacobi<Long> a = jacobi_of_complement(u, m1);
    const Jacobi<Long> b = jacobi_of_complement(v, m1);
    const Jacobi<Long> c = jacobi_of_complement(u + v, m1);
    SCOPED_TRACE(static_cast<double>(m1));
    EXPECT_TRUE(within(a.sn * a.sn + a.cn * a.cn, 1, 4 * long_epsilon));
    EXPECT_TRUE(
        test::same_to_rounding(a.cn * a.cn + m1 * a.sn * a.sn, a.dn * a.dn, 16.0L));  // relative: no cancellation
    EXPECT_TRUE(within(std::sin(a.am), a.sn, 4 * (1 + std::fabs(a.am)) * long_epsilon));
    EXPECT_TRUE(within(std::cos(a.am), a.cn, 4 * (1 + std::fabs(a.am)) * long_epsilon));
    // Addition.   [DLMF, (22.8.1), denominator 1 - m s^2 s^2 = c^2 + s^2 d^2]   The phases carry eps |u|, which the
    // denominator magnifies.
    const Long denominator = a.cn * a.cn + a.sn * a.sn * b.dn * b.dn;
    const Long bound = 16 * long_epsilon * (1 + std::fabs(u) + std::fabs(v)) / denominator;
    EXPECT_TRUE(within(c.sn, (a.sn * b.cn * b.dn + b.sn * a.cn * a.dn) / denominator, bound));
    EXPECT_TRUE(within(c.cn, (a.cn * b.cn - a.sn * b.sn * a.dn * b.dn) / denominator, bound));
    EXPECT_TRUE(within(c.dn, (a.dn * b.dn - (1 - m1) * a.sn * b.sn * a.cn * b.cn) / denominator, bound));
  }
}

TEST(Elliptic, IncompleteIntegralInvertsTheAmplitude) {
  for (std::uint64_t i = 0; i < 400; ++i) {
    const Long m1 = std::exp(-25 * (1 + counter_uniform(33, 2 * i)));
    const Long k = complete_k_of_complement(m1);
    const Long u = k * counter_uniform(33, 2 * i + 1);
    const Jacobi<Long> j = jacobi_of_complement(u, m1);
    // cn carries the phase: d(cn)/cn = -sn dn/cn du, and F answers with du. Relative roundings of cn and sn give as
    // much.
    EXPECT_TRUE(within(incomplete_f_of_complement(j.sn, std::fabs(j.cn), m1), u, 16 * (1 + k) * long_epsilon));
    const Long m = 0.5L + 0.45L * counter_uniform(34, i);
    const Long phi = 20 * counter_uniform(35, i);
    // d(am)/du = dn >= sqrt(0.05) here, so that roundings of phi grow by at most 5 in F, and shrink again.
    EXPECT_TRUE(within(jacobi(incomplete_f(phi, m), m).am, phi, 32 * (1 + std::fabs(phi)) * long_epsilon));
  }
  EXPECT_TRUE(std::isinf(incomplete_f_of_complement(1.0L, 0.0L, 0.0L)));
  EXPECT_TRUE(
      test::same_to_rounding(incomplete_f_of_complement(1.0L, 0.0L, 1e-30L), complete_k_of_complement(1e-30L), 16.0L));
  // F(1, 1) = artanh(sin 1), and F(phi, 0) = phi.
  EXPECT_TRUE(test::same_to_rounding(incomplete_f(1.0L, 1.0L), std::atanh(std::sin(1.0L)), 16.0L));
  EXPECT_TRUE(test::same_to_rounding(incomplete_f(7.0L, 0.0L), 7.0L, 8.0L));
}

TEST(Elliptic, IncompleteIntegralCountsHalfTurns) {
  // A few roundings about the odd quarter turns, where phi/pi rounds to either side. There dF = dphi/dn, dn^2 = 0.01.
  const Long m = 0.99L;
  const Long k = complete_k(m);
  for (int n = -25; n <= 25; n += 2) {
    const Long quarter = n * (pi / 2);
    for (const Long offset : {-3.0L, -2.0L, -1.0L, 0.0L, 1.0L, 2.0L, 3.0L}) {
      const Long phi = quarter * (1 + offset * long_epsilon);
      EXPECT_TRUE(within(incomplete_f(phi, m), n * k, 16 * std::abs(n) * 10 * long_epsilon)) << n << ", " << offset;
    }
  }
}

TEST(Elliptic, SmallArgumentsFollowTheSeries) {
  // sn u = u - (1 + m) u^3/6 + (1 + 14 m + m^2) u^5/120 - ..., the next term below u^7.   [DLMF, (22.10.1)]
  for (const Long m : {0.0L, 0.3L, 1.0L}) {
    for (const Long u : {1e-3L, 1e-5L, 1e-9L, 3e-10L, 1e-11L, 1e-4000L}) {
      const Long series = u * (1 - (1 + m) * u * u / 6 + (1 + 14 * m + m * m) * u * u * u * u / 120);
      const Jacobi<Long> j = jacobi(u, m);
      EXPECT_TRUE(test::same_to_rounding(j.sn, series, 8.0L)) << static_cast<double>(u);
      EXPECT_TRUE(within(j.cn, 1 - u * u / 2, u * u * u * u + 2 * long_epsilon));
      EXPECT_TRUE(within(j.dn, 1 - m * u * u / 2, u * u * u * u + 2 * long_epsilon));
    }
  }
}

TEST(Elliptic, LimitsAreTrigonometricAndHyperbolic) {
  for (Long u = -12; u <= 12; u += 0.37L) {
    const Jacobi<Long> low = jacobi_of_complement(u, 1.0L);
    const Long phase = 4 * (1 + std::fabs(u)) * long_epsilon;
    EXPECT_TRUE(within(low.sn, std::sin(u), phase));
    EXPECT_TRUE(within(low.cn, std::cos(u), phase));
    EXPECT_EQ(low.dn, 1);
    EXPECT_TRUE(within(low.am, u, phase));
    const Jacobi<Long> high = jacobi_of_complement(u, 0.0L);
    EXPECT_TRUE(within(high.sn, std::tanh(u), phase));
    EXPECT_TRUE(within(high.am, 2 * std::atan(std::tanh(u / 2)), phase));
    // First order in m1: cn = sech u - m1/4 (sinh u cosh u - u) tanh u sech u, relative error O((m1 e^2u)^2).
    const Long m1 = 1e-24L;
    const Long sech = 1 / std::cosh(u);
    const Long slope = (std::sinh(u) * std::cosh(u) - u) * std::tanh(u);
    const Long second = m1 * std::exp(2 * std::fabs(u));
    const Jacobi<Long> near = jacobi_of_complement(u, m1);
    EXPECT_TRUE(within(near.cn, sech * (1 - m1 / 4 * slope), sech * (second * second + 2 * phase)));
    EXPECT_EQ(high.cn, high.dn);
  }
}

/// H = p^2/2 + (1 + m) q^2/2 - m q^4/2: sn solves q'' = -(1 + m) q + 2 m q^3.
struct SineAmplitude {
  using Real = Long;
  static constexpr std::size_t dimension = 1;
  Long m;
  template <class S>
  S kinetic(const Vector<S, 1>& p) const {
    return p[0] * p[0] / 2.0L;
  }
  template <class S>
  S potential(const Vector<S, 1>& q) const {
    return q[0] * q[0] * (1.0L + m - q[0] * q[0] * m) / 2.0L;
  }
};

TEST(Elliptic, FunctionsSolveTheirDifferentialEquation) {
  for (const Long m : {0.02L, 0.3L, 0.7L, 0.95L}) {
    const SineAmplitude problem{m};
    for (const Long u : {0.3L, 1.1L, -2.7L, 6.0L}) {
      const auto z = reference_flow(problem, Vector<Long, 2>{0.0L, 1.0L}, u);
      const Jacobi<Long> j = jacobi(u, m);
      // The flow rounds about eight times per unit of time; the orbit shears and grows as (1 + u)/m1 at most.
      const Long bound = 64 * (1 + std::fabs(u)) * (1 + std::fabs(u)) / (1 - m) * long_epsilon;
      EXPECT_TRUE(within(j.sn, z[0], bound)) << static_cast<double>(m);
      EXPECT_TRUE(within(j.cn * j.dn, z[1], bound)) << static_cast<double>(m);
      EXPECT_FALSE(within(jacobi(u, m + 1e-10L).sn, z[0], bound));  // the check can fail
    }
  }
}

TEST(Elliptic, WorksInDouble) {
  for (std::uint64_t i = 0; i < 200; ++i) {
    const double m = 0.5 + 0.5 * counter_uniform(36, 2 * i);
    const double u = 10 * counter_uniform(36, 2 * i + 1);
    const Jacobi<double> j = jacobi(u, m);
    const Jacobi<Long> l = jacobi<Long>(u, m);
    const double bound = 8 * (1 + std::fabs(u)) * test::epsilon;
    EXPECT_TRUE(within(j.sn, l.sn, bound));
    EXPECT_TRUE(within(j.cn, l.cn, bound));
    EXPECT_TRUE(within(j.dn, l.dn, bound));
    EXPECT_TRUE(within(j.am, l.am, bound));
  }
}

}  // namespace
}  // namespace hamflow
