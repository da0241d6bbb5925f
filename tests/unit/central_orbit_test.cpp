// Orbits in a central potential: what the effective potential says of them, and the exact flows in time.
#include <array>
#include <map>
#include <numeric>
#include <string>

#include "../support/near.hpp"
#include "engine/reference_flow.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/detail/problems/central_flow.hpp"
#include "hamflow/detail/problems/effective_potential.hpp"
#include "hamflow/problems/potentials/binomial.hpp"
#include "hamflow/problems/potentials/hooke.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/problems/potentials/linear.hpp"

namespace hamflow {
namespace {

using L = long double;
using test::long_epsilon;
using test::within;

/// V = a r^m + b r^n, m and n real.
template <class R>
class Powers {
 public:
  Powers(R a, R m, R b = R(0), R n = R(1)) : a_{a, b}, m_{m, n} {}
  template <class S>
  S value(const S& u) const {
    return sums(u).value;
  }
  template <class S>
  S slope(const S& u) const {
    return sums(u).first / u;
  }
  template <class S>
  CentralDerivatives<S> derivatives(const S& u) const {
    const auto at = sums(u);
    return {at.first / u, at.second / (u * u)};
  }

 private:
  /// The sums of a r^m, a m r^m and a m (m - 2) r^m.
  template <class S>
  struct Sums {
    S value;
    S first;
    S second;
  };
  template <class S>
  Sums<S> sums(const S& u) const {
    Sums<S> total{S(0), S(0), S(0)};
    for (std::size_t i = 0; i < 2; ++i) {
      if (a_[i] == R(0)) continue;
      const S term = a_[i] * pow(u, S(m_[i] / 2));
      total.value += term;
      total.first += m_[i] * term;
      total.second += m_[i] * (m_[i] - 2) * term;
    }
    return total;
  }
  std::array<R, 2> a_;
  std::array<R, 2> m_;
};

double uniform(std::uint64_t k, double low, double high) {
  return low + (high - low) * (counter_uniform(20, k) + 1) / 2;
}

template <class R>
Vector<R, 4> joined(const Start<R, 2>& z) {
  return {z.q[0], z.q[1], z.p[0], z.p[1]};
}
template <class R>
Start<R, 2> random_start(std::uint64_t k, double size = 1, double speed = 1) {
  Start<R, 2> z{};
  for (std::uint64_t i = 0; i < 2; ++i) {
    z.q[i] = static_cast<R>(size * counter_uniform(21, 4 * k + i));
    z.p[i] = static_cast<R>(speed * counter_uniform(22, 4 * k + i));
  }
  return z;
}

/// The distance of two states; positions in units of the larger radius, momenta of the larger momentum.
template <class R>
L distance(const Start<R, 2>& a, const Start<R, 2>& b) {
  const auto part = [](const Vector<R, 2>& x, const Vector<R, 2>& y) {
    const L size = larger(hypot(L(x[0]), L(x[1])), hypot(L(y[0]), L(y[1])));
    return size > 0 ? hypot(L(x[0]) - L(y[0]), L(x[1]) - L(y[1])) / size : L(0);
  };
  return larger(part(a.q, b.q), part(a.p, b.p));
}

/// How much flow(z, t) magnifies relative errors of the start and of the time, by differences over 2^-24, at least 1: n
/// roundings of the start, of t, of the mass or of k are some n times this many roundings of the result.
template <class R, class Flow>
L condition(const Flow& flow, const Start<R, 2>& z, L t) {
  constexpr L h = 0x1p-24L;
  const Start<L, 2> at{cast<L>(z.q), cast<L>(z.p)};
  const Start<L, 2> end = flow(at, t);
  const L r = hypot(at.q[0], at.q[1]);
  const L p = hypot(at.p[0], at.p[1]);
  L largest = larger(L(1), distance(flow(at, t * (1 + h)), end) / h);
  for (std::size_t i = 0; i < 2; ++i) {
    Start<L, 2> moved = at;
    moved.q[i] += h * r;
    largest = larger(largest, distance(flow(moved, t), end) / h);
    moved = at;
    moved.p[i] += h * p;
    largest = larger(largest, distance(flow(moved, t), end) / h);
  }
  return largest;
}

/// How much the flow by universal variables magnifies its own roundings: those of the terms of t(s), which a time error
/// of their size stands for, and those of the terms of q and p, all of which cancel on the way in from far away.
template <class R, class Flow>
L inner_condition(const Flow& flow, L k, L mass, const Start<R, 2>& start, L t) {
  constexpr L h = 0x1p-24L;
  const Start<L, 2> z{cast<L>(start.q), cast<L>(start.p)};
  const Start<L, 2> end = flow(z, t);
  const L kappa = k / mass;
  const L r0 = hypot(z.q[0], z.q[1]);
  const L p0 = hypot(z.p[0], z.p[1]);
  const L eta = (z.q[0] * z.p[0] + z.q[1] * z.p[1]) / mass;
  const L beta = 2 * kappa / r0 - p0 * p0 / (mass * mass);
  L rest = t;
  if (beta > 0) {
    const L period = 2 * pi_value<L>() * kappa / (beta * sqrt(beta));
    rest -= period * nearbyint(t / period);
  }
  if (rest == 0) return 1;
  const L s = abs(detail::universal_variable({r0, eta, kappa, beta}, rest));
  const Stumpff<L> c = stumpff(beta * s * s);
  const L r = hypot(end.q[0], end.q[1]);
  const L times = s * (r0 * abs(c.c1) + s * (abs(eta * c.c2) + s * abs(kappa * c.c3)));
  const L f = abs(kappa) * s * s * abs(c.c2) / r0;
  const L g = s * (r0 * abs(c.c1) + s * abs(eta * c.c2));
  const L f_rate = abs(kappa) * s * abs(c.c1) / (r * r0);
  const L g_rate = abs(kappa) * s * s * abs(c.c2) / r;
  const L by_time = distance(flow(z, t + h * times), end) / h;
  const L of_q = (r0 + f * r0 + g * p0 / mass) / r;
  const L of_p = (p0 + mass * f_rate * r0 + g_rate * p0) / hypot(end.p[0], end.p[1]);
  return larger(by_time, larger(of_q, of_p));
}

// ---- quadrature and roots ----

TEST(Quadrature, IsExactToRoundingWithSingularEndsToo) {
  const auto expect = [](const Integral& found, L exact, L roundings) {
    EXPECT_TRUE(within(found.value, exact, roundings * long_epsilon * abs(exact)));
    EXPECT_LE(found.error, 1e3L * long_epsilon * abs(exact));
  };
  // A sum of some 200 terms, each with a few roundings of which most cancel.
  expect(integrate([](L x) { return exp(x); }, L(0), L(1)), exp(L(1)) - 1, 8);
  expect(integrate([](L x) { return 1 / (1 + x * x); }, L(0), L(1)), pi_value<L>() / 4, 8);
  expect(integrate([](L x) { return log(x); }, L(0), L(1)), L(-1), 8);
  expect(integrate_from_ends([](L left, L right) { return 1 / sqrt(left * right); }, L(3)), pi_value<L>(), 8);
  expect(integrate_from_ends([](L left, L) { return pow(left, -0.9L); }, L(1)), L(10), 32);
  expect(integrate([](L x) { return 1 / (x * x + 1e-8L); }, L(0), L(1)), atan(L(1e4)) * 1e4L,
         32);  // a pole near the end
  expect(integrate([](L x) { return exp(x); }, L(1), L(0)), 1 - exp(L(1)), 8);
}

TEST(Quadrature, ReportsWhatItCannotReach) {
  const auto kink = integrate([](L x) { return abs(x - 0.3L); }, L(0), L(1));
  EXPECT_GT(kink.error, 1e-12L);
  EXPECT_TRUE(within(kink.value, 0.29L, 1e-3L));
}

TEST(BracketedRoot, FindsRootsToRoundingInWideBrackets) {
  const auto infinity = std::numeric_limits<L>::infinity();
  // The values at the ends known, and only their signs: f is then evaluated strictly between them.
  const auto expect_root = [&](auto f, L a, L b, L exact, L bound) {
    EXPECT_TRUE(within(bracketed_root(f, a, b, f(a), f(b)), exact, bound));
    EXPECT_TRUE(within(bracketed_root(f, b, a, f(b), f(a)), exact, bound));
    const auto inside = [&](L x) {
      EXPECT_TRUE(a < x && x < b);
      return f(x);
    };
    const L sign = f(a) < 0 ? -1 : 1;
    EXPECT_TRUE(within(bracketed_root(inside, a, b, sign * infinity, -sign * infinity), exact, bound));
  };
  const auto square = [](L x) { return x * x - 2; };
  expect_root(square, 0, 1e30L, sqrt(L(2)), 2 * long_epsilon);
  expect_root(square, 1e-30L, 1e30L, sqrt(L(2)), 2 * long_epsilon);
  expect_root([](L x) { return atan(x); }, -3, 100, 0, long_epsilon);
  expect_root([](L x) { return 1 / x - 1e-12L; }, 1e-3L, 1e20L, 1e12L, 2e12L * long_epsilon);
  expect_root([](L x) { return std::cbrt(x - 1); }, 0, 4, 1, 2 * long_epsilon);  // a vertical tangent
  // A zero at an end is that end; a zero that is only rounding is passed over when its sign is given.
  const auto two = [](L x) { return x * (1 - x); };
  EXPECT_EQ(bracketed_root(two, L(0), L(3), two(0), two(3)), 0);
  EXPECT_TRUE(within(bracketed_root(two, L(0), L(3), infinity, -infinity), 1, 2 * long_epsilon));
  EXPECT_TRUE(within(bracketed_root([](double x) { return std::exp(x) - 2; }, 0.0, 1.0, -1.0, std::exp(1.0) - 2),
                     std::log(2.0), 2 * test::epsilon));
}

// ---- the exact Kepler flow ----

TEST(Stumpff, SatisfiesItsIdentitiesOnBothSidesOfTheSeries) {
  for (int k = -400; k <= 400; ++k) {
    const L z = L(k) / 20;
    const auto c = stumpff(z);
    const L size = 1 + abs(z) * (c.c1 * c.c1 + abs(c.c2) + abs(c.c3));  // the sizes of the terms
    EXPECT_TRUE(within(c.c0 * c.c0 + z * c.c1 * c.c1, 1, 8 * size * long_epsilon)) << "z = " << k << "/20";
    EXPECT_TRUE(within(c.c0, 1 - z * c.c2, 8 * size * long_epsilon)) << "z = " << k << "/20";
    EXPECT_TRUE(within(c.c1, 1 - z * c.c3, 8 * size * long_epsilon)) << "z = " << k << "/20";
    const L x = sqrt(abs(z));
    EXPECT_TRUE(within(c.c0, z < 0 ? cosh(x) : cos(x), 8 * size * long_epsilon));
  }
}

template <class R>
class KeplerFlowIn : public ::testing::Test {};
using Numbers = ::testing::Types<double, long double>;
TYPED_TEST_SUITE(KeplerFlowIn, Numbers);

/// (q, p) on an ellipse or hyperbola with pericentre at (a |1 - e|, 0) from the eccentric anomaly x, and its time from
/// Kepler's equation, which is not solved here. off = |1 - e|: written so that nothing cancels near the parabola.
template <class R>
void expect_conic(bool ellipse, L off, L x, L roundings) {
  const R epsilon = std::numeric_limits<R>::epsilon();
  const L mass = 1.25L;
  const L k = 0.75L;
  const L a = 2;
  const L e = ellipse ? 1 - off : 1 + off;
  const L b = a * sqrt(off * (1 + e));
  const L rate = sqrt(k / (mass * a * a * a));
  const L excess = x * x * x * stumpff(ellipse ? x * x : -x * x).c3;  // |x - sin x| or |sinh x - x|
  const L time = (off * x + e * excess) / rate;
  const L per = a * off;
  const auto flow = [&](const Start<L, 2>& z, L t) { return kepler_flow(k, mass, z.q, z.p, t); };
  const Start<L, 2> start{{per, 0}, {0, mass * b * rate * a / per}};
  const Start<R, 2> now = kepler_flow(R(k), R(mass), cast<R>(start.q), cast<R>(start.p), R(time));
  const L half = ellipse ? sin(x / 2) : sinh(x / 2);
  const L s = ellipse ? sin(x) : sinh(x);
  const L c = ellipse ? cos(x) : cosh(x);
  const L rate_x = mass * rate / (off + 2 * e * half * half);  // mu dx/dt
  const Start<L, 2> expected{{a * (off - 2 * half * half), b * s}, {-a * s * rate_x, b * c * rate_x}};
  EXPECT_LE(distance({cast<L>(now.q), cast<L>(now.p)}, expected), roundings * epsilon * condition(flow, start, time))
      << (ellipse ? "ellipse" : "hyperbola") << ", |1 - e| = " << static_cast<double>(off) << ", anomaly "
      << static_cast<double>(x);
}

TYPED_TEST(KeplerFlowIn, SolvesKeplersEquation) {
  using R = TypeParam;
  // The start's four roundings, those of the time and of the result, of beta and of the root.
  for (const L x : {-3.0L, -1.0L, -0.001L, 0.0L, 1e-9L, 0.1L, 0.5L, 2.0L, 3.1L}) {
    for (const L off : {1.0L, 0.9L, 0.4L, 0.01L, 1e-4L, 1e-6L}) expect_conic<R>(true, off, x, 16);
    for (const L off : {1e-6L, 1e-4L, 0.5L, 20.0L}) expect_conic<R>(false, off, x, 16);
  }
  for (const L x : {4.0L, 7.0L, 100.0L, -1000.0L}) expect_conic<R>(true, 0.4L, x, 16);
  for (const L x : {10.0L, -30.0L}) expect_conic<R>(false, 0.5L, x, 16);
}

TYPED_TEST(KeplerFlowIn, SolvesBarkersEquationOnTheParabola) {
  using R = TypeParam;
  // With s = tan(phi/2): q = r_per (1 - s^2, 2 s), t = sqrt(2 r_per^3 mu/k)(s + s^3/3).
  const L per = 0.5L;
  for (const L s : {-20.0L, -1.0L, 1e-6L, 0.3L, 2.0L, 1000.0L}) {
    const L t = sqrt(2 * per * per * per) * (s + s * s * s / 3);
    const Start<L, 2> start{{per, 0}, {0, 2}};
    const auto flow = [&](const Start<L, 2>& z, L time) { return kepler_flow(L(1), L(1), z.q, z.p, time); };
    const auto now = kepler_flow(R(1), R(1), cast<R>(start.q), cast<R>(start.p), R(t));
    const L r = per * (1 + s * s);
    const L v = sqrt(2 * per) / r;  // r^2 phi' = l, so ds/dt = sqrt(2 per)/(2 per r), q' = r_per (-2 s, 2) ds/dt
    EXPECT_LE(distance({cast<L>(now.q), cast<L>(now.p)}, Start<L, 2>{{per * (1 - s * s), per * 2 * s}, {-s * v, v}}),
              8 * std::numeric_limits<R>::epsilon() * condition(flow, start, t))
        << static_cast<double>(s);
  }
}

TYPED_TEST(KeplerFlowIn, IsAGroupAndKeepsEnergyAngularMomentumAndEccentricityVector) {
  using R = TypeParam;
  const R epsilon = std::numeric_limits<R>::epsilon();
  for (std::uint64_t trial = 0; trial < 400; ++trial) {
    const R mass = static_cast<R>(uniform(3 * trial, 0.5, 2));
    const R k = static_cast<R>(uniform(3 * trial + 1, trial % 4 == 3 ? -2 : 0.2, 2));
    const Start<R, 2> z = random_start<R>(trial, 1, trial % 2 == 0 ? 1 : 3);
    const R t = static_cast<R>(uniform(3 * trial + 2, -4, 4));
    const R s = static_cast<R>(counter_uniform(23, trial));
    const auto flow = [&](const Start<L, 2>& x, L time) { return kepler_flow(L(k), L(mass), x.q, x.p, time); };
    const Start<R, 2> after_s = kepler_flow(k, mass, z.q, z.p, s);
    const Start<R, 2> after_both = kepler_flow(k, mass, after_s.q, after_s.p, t);
    const Start<R, 2> at_once = kepler_flow(k, mass, z.q, z.p, R(s + t));
    const R roundings(16);
    L sensitivity = condition(flow, after_s, t) * condition(flow, z, s) + condition(flow, z, s + t);
    if (!std::is_same_v<R, double>) {  // in double the long double inside hides it
      sensitivity += condition(flow, after_s, t) * inner_condition(flow, L(k), L(mass), z, s) +
                     inner_condition(flow, L(k), L(mass), after_s, t) + inner_condition(flow, L(k), L(mass), z, s + t);
    }
    EXPECT_LE(distance(after_both, at_once), roundings * epsilon * sensitivity) << "trial " << trial;

    const auto invariants = [&](const Start<R, 2>& at) {
      const Start<L, 2> x{cast<L>(at.q), cast<L>(at.p)};
      const L r = hypot(x.q[0], x.q[1]);
      const L l = x.q[0] * x.p[1] - x.q[1] * x.p[0];
      const L kinetic = (x.p[0] * x.p[0] + x.p[1] * x.p[1]) / (2 * L(mass));
      const L sizes = kinetic + abs(L(k)) / r;
      return std::array<L, 7>{
          kinetic - k / r,           l, x.p[1] * l / mass - k * x.q[0] / r, -x.p[0] * l / mass - k * x.q[1] / r, sizes,
          r * hypot(x.p[0], x.p[1]), r};
    };
    const auto before = invariants(z);
    const auto after = invariants(after_both);
    const L size = before[4] + after[4];
    const L arm = before[5] + after[5];
    // Each number carries roundings at each of the three states; what cancels on the way is in the condition.
    const L vector_size = abs(L(k)) + 2 * size * larger(before[6], after[6]);
    EXPECT_TRUE(within(after[0], before[0], roundings * epsilon * size * sensitivity)) << "trial " << trial;
    EXPECT_TRUE(within(after[1], before[1], roundings * epsilon * arm * sensitivity)) << "trial " << trial;
    EXPECT_TRUE(within(after[2], before[2], roundings * epsilon * vector_size * sensitivity)) << "trial " << trial;
    EXPECT_TRUE(within(after[3], before[3], roundings * epsilon * vector_size * sensitivity)) << "trial " << trial;
  }
}

/// A flow against the reference flow from random starts that do not come close to the centre: there the reference
/// follows a singularity.
template <template <class> class Potential, class Flow>
void expect_reference(const Potential<L>& potential, std::uint64_t first, int count, L t, const Flow& flow,
                      int looks = 8) {
  const CentralForce<L, Potential> problem(1.25L, potential);
  for (std::uint64_t k = first; count > 0; ++k) {
    const Start<L, 2> z = random_start<L>(k);
    if (abs(z.q[0] * z.p[1] - z.q[1] * z.p[0]) < 0.5L * hypot(z.q[0], z.q[1]) * hypot(z.p[0], z.p[1])) continue;
    --count;
    const Vector<L, 4> expected = reference_flow(problem, joined(z), t);
    // The reference makes an error of a few roundings in each step of 1/8 or less, magnified by what is left of the
    // way.
    L magnified = 0;
    for (int i = 0; i < looks; ++i) {
      const L done = t * i / looks;
      magnified = larger(magnified, condition(flow, flow(z, done), t - done));
    }
    EXPECT_LE(distance(flow(z, t), Start<L, 2>{{expected[0], expected[1]}, {expected[2], expected[3]}}),
              16 * (1 + 8 * abs(t)) * long_epsilon * magnified)
        << "start " << k;
  }
}

TEST(KeplerFlow, IsTheReferenceFlow) {
  for (const L k : {1.0L, 0.125L, -1.0L, 0.0L}) {
    for (const L t : {-1.5L, 3.0L}) {
      expect_reference<Kepler>(Kepler<L>(k), 100, 8, t,
                               [=](const Start<L, 2>& z, L time) { return kepler_flow(k, 1.25L, z.q, z.p, time); });
    }
  }
}

TEST(KeplerFlow, FallsOnALineAndReturns) {
  // From rest: r = r0 cos^2 x, t = sqrt(mu r0^3/(2 k)) (x + sin x cos x).
  const L r0 = 2;
  const L scale = sqrt(r0 * r0 * r0 / 2);
  for (const L x : {0.01L, 0.5L, 1.0L, 1.5L, 1.65L, 2.5L, 3.1L}) {
    const auto now = kepler_flow(L(1), L(1), {r0 * 0.6L, r0 * 0.8L}, {0, 0}, scale * (x + sin(x) * cos(x)));
    const L r = r0 * cos(x) * cos(x);
    // dr/dt = -tan(x)/(r0^(-1/2) 2^(-1/2)): where it is steep, a rounding of the time is worth so much.
    const L bound = 16 * long_epsilon * (r0 + scale * abs(tan(x)));
    EXPECT_TRUE(within(now.q[0], 0.6L * r, bound)) << static_cast<double>(x);
    EXPECT_TRUE(within(now.q[1], 0.8L * r, bound)) << static_cast<double>(x);
    EXPECT_EQ(now.p[0] < 0, x < pi_value<L>() / 2);
  }
}

TEST(KeplerFlow, TakesManyPeriodsOff) {
  // a = 1, k = 1: the period is 2 pi; t carries a relative rounding.
  const Start<L, 2> z{{0.4L, 0}, {0, 2}};
  const L t = 2 * pi_value<L>() * 1000000 + 1;
  const L once = distance(kepler_flow(L(1), L(1), z.q, z.p, t), kepler_flow(L(1), L(1), z.q, z.p, L(1)));
  const auto flow = [&](const Start<L, 2>& x, L time) { return kepler_flow(L(1), L(1), x.q, x.p, time); };
  EXPECT_LE(once, 16 * long_epsilon * condition(flow, z, t));
}

// ---- the exact Hooke flow ----

TEST(HookeFlow, IsTheReferenceFlowAndAGroup) {
  for (const L k : {-1.0L, -1e-3L, -1e-17L, 0.0L, 1e-17L, 1e-3L, 1.0L}) {
    for (const L t : {-1.5L, 4.0L}) {
      const auto flow = [=](const Start<L, 2>& z, L time) { return hooke_flow(k, 1.25L, z.q, z.p, time); };
      expect_reference<Hooke>(Hooke<L>(k), 200, 4, t, flow);
      const Start<L, 2> z = random_start<L>(7);
      const Start<L, 2> half = flow(z, t / 2);
      EXPECT_LE(distance(flow(half, t / 2), flow(z, t)),
                16 * long_epsilon * condition(flow, z, t / 2) * condition(flow, half, t / 2));
    }
  }
  // k -> 0: q + v t + (k/mu)(q t^2/2 + v t^3/6), the next term is of the order of k^2.
  const auto now = hooke_flow(1e-12L, L(1), {1, 2}, {3, 4}, L(2));
  EXPECT_TRUE(within(now.q[0], 7 + 1e-12L * (2 + 4), 8 * 7 * long_epsilon));
  EXPECT_TRUE(within(now.q[1], 10 + 1e-12L * (4 + 16.0L / 3), 8 * 10 * long_epsilon));
}

// ---- the flow of any potential, by quadrature ----

template <class Potential>
auto central(const Potential& potential, L mass) {
  return [=](const Start<L, 2>& z, L t) { return central_flow(potential, mass, z.q, z.p, t).value(); };
}

TEST(CentralFlow, IsTheKeplerAndTheHookeFlow) {
  L worst = 0;
  int refused = 0;
  for (std::uint64_t trial = 0; trial < 60; ++trial) {
    const L t = uniform(5 * trial, -30, 30);
    const L mass = uniform(5 * trial + 1, 0.5, 2);
    const L k = uniform(5 * trial + 2, trial % 3 == 0 ? -2 : 0.2, 2);
    const Start<L, 2> z = random_start<L>(300 + trial, 1, trial % 2 == 0 ? 1 : 3);
    const auto kepler = [&](const Start<L, 2>& x, L time) { return kepler_flow(k, mass, x.q, x.p, time); };
    const auto hooke = [&](const Start<L, 2>& x, L time) { return hooke_flow(-k, mass, x.q, x.p, time); };
    // Turning points, periods and phases carry the roundings of E and l, which is what the condition measures.
    // Where a quadrature does not come to rest nothing is given.
    const auto by_kepler = central_flow(Kepler<L>(k), mass, z.q, z.p, t);
    const auto by_hooke = central_flow(Hooke<L>(-k), mass, z.q, z.p, t);
    refused += (by_kepler ? 0 : 1) + (by_hooke ? 0 : 1);
    const L kepler_error = by_kepler ? distance(*by_kepler, kepler(z, t)) / condition(kepler, z, t) : L(0);
    const L hooke_error = by_hooke ? distance(*by_hooke, hooke(z, t)) / condition(hooke, z, t) : L(0);
    EXPECT_LE(kepler_error, 32 * long_epsilon) << "trial " << trial;
    EXPECT_LE(hooke_error, 32 * long_epsilon) << "trial " << trial;
    worst = larger(worst, larger(kepler_error, hooke_error));
  }
  EXPECT_LE(refused, 3);
  RecordProperty("worst_in_tenths_of_a_rounding", static_cast<int>(10 * worst / long_epsilon));
}

TEST(CentralFlow, IsTheReferenceFlowForOtherPotentials) {
  const auto expect = [](const auto& potential, std::uint64_t first) {
    expect_reference(potential, first, 2, -2, central(potential, 1.25L), 3);
    expect_reference(potential, first + 20, 1, 5, central(potential, 1.25L), 3);
  };
  expect(Linear<L>(1), 400);
  expect(Linear<L>(-1), 440);
  expect(Binomial<L>(1, 0.5L), 480);
  expect(Binomial<L>(1, -2), 520);
  expect(Powers<L>(1, 0.5L), 560);
  expect(Powers<L>(-1, -0.5L, 0.25L, 1.5L), 600);
}

TEST(CentralFlow, HoldsNearCirclesAtApsidesAndAfterNoTime) {
  const auto exact = [](const Start<L, 2>& x, L t) { return kepler_flow(L(1), L(1), x.q, x.p, t); };
  const auto check = [&](const Start<L, 2>& z, L t, const char* what) {
    EXPECT_LE(distance(central(Kepler<L>(1), 1)(z, t), exact(z, t)), 32 * long_epsilon * condition(exact, z, t))
        << what;
  };
  for (const L off : {0.0L, 1e-18L, 1e-15L, 1e-10L, 1e-6L, 1e-3L, 0.02L}) {
    check({{1, 0}, {0, 1 + off}}, 5, "tangential");
    check({{1, 0}, {off, 1}}, 5, "radial");
    check({{1, 0}, {-off, 1 - off}}, 5, "both");
  }
  check({{1, 0}, {0, 1.2L}}, 40, "pericentre");
  check({{1, 0}, {0, 0.8L}}, 40, "apocentre");
  check({{1, 0}, {1e-12L, 0.8L}}, 40, "just before apocentre");
  check({{1, 0}, {0, 1.5L}}, 40, "pericentre of a hyperbola");
  check({{1, 0}, {1e-9L, 1.5L}}, 40, "just after it");
  check({{0, 2}, {-1, 0}}, 40, "parabola");
  check({{0.3L, 0.2L}, {-1, 2}}, 0, "no time");
  check({{1, 0}, {0, 0.01L}}, 40, "a narrow ellipse");
}

TEST(CentralFlow, PassesThroughARegularCentreAndEndsInASingularOne) {
  for (const L t : {-20.0L, -1.0L, 0.5L, 2.0L, 3.0L, 20.0L}) {
    const Start<L, 2> z{{0.6L, 0.8L}, {-0.3L, -0.4L}};
    for (const L k : {-1.0L, 1.0L}) {
      const auto hooke = [=](const Start<L, 2>& x, L time) { return hooke_flow(k, L(1), x.q, x.p, time); };
      EXPECT_LE(distance(central(Hooke<L>(k), 1)(z, t), hooke(z, t)), 32 * long_epsilon * condition(hooke, z, t))
          << static_cast<double>(t);
    }
    // V = |x|: parabolas. From rest at x0 the centre is reached at sqrt(2 x0), the period is 4 times that.
    const auto now = central_flow(Linear<L>(1), 1, {0.6L, 0.8L}, {0, 0}, t).value();
    L since = abs(t) - 4 * sqrt(L(2)) * nearbyint(abs(t) / (4 * sqrt(L(2))));
    since = abs(since);
    const L quarter = sqrt(L(2));
    const L x = since <= quarter ? 1 - since * since / 2 : -1 + (2 * quarter - since) * (2 * quarter - since) / 2;
    EXPECT_TRUE(within(now.q[0], 0.6L * x, 64 * (1 + abs(t)) * long_epsilon)) << static_cast<double>(t);
    EXPECT_TRUE(within(now.q[1], 0.8L * x, 64 * (1 + abs(t)) * long_epsilon)) << static_cast<double>(t);
  }
  // V = -1/r from rest at 1: pi/(2 sqrt 2) = 1.1107 to the centre.
  EXPECT_TRUE(central_flow(Kepler<L>(1), 1, {1, 0}, {0, 0}, 1.1107L).has_value());
  EXPECT_FALSE(central_flow(Kepler<L>(1), 1, {1, 0}, {0, 0}, 1.1108L).has_value());
  EXPECT_FALSE(central_flow(Kepler<L>(1), 1, {1, 0}, {0, 0}, -1.1108L).has_value());
  // Steeper than 1/r^2: V = -1/r^4, l = 1 below the barrier of V_eff.
  const Powers<L> steep(-1, -4);
  const Start<L, 2> z{{1, 0}, {0, 1}};
  const auto before = central_flow(steep, 1, z.q, z.p, 0.3L);
  ASSERT_TRUE(before.has_value());
  const auto expected = reference_flow(CentralForce<L, Powers>(1, steep), joined(z), 0.3L);
  const auto flow = central(steep, 1);
  EXPECT_LE(distance(*before, Start<L, 2>{{expected[0], expected[1]}, {expected[2], expected[3]}}),
            64 * long_epsilon * condition(flow, z, 0.3L));
  EXPECT_FALSE(central_flow(steep, 1, z.q, z.p, 3).has_value());
  // V = -r^4 reaches infinity in finite time.
  EXPECT_TRUE(central_flow(Powers<L>(-1, 4), 1, {1, 0}, {0, 1}, 0.5L).has_value());
  EXPECT_FALSE(central_flow(Powers<L>(-1, 4), 1, {1, 0}, {0, 1}, 50).has_value());
}

TEST(CentralFlow, IsOfferedByThePotentials) {
  const Start<L, 2> z = random_start<L>(5);
  const auto expect = [&](const auto& potential) {
    const auto now = potential.exact(1.5L, z.q, z.p, 2.5L);
    ASSERT_TRUE(now.has_value());
    const auto flow = central(potential, 1.5L);
    EXPECT_LE(distance(*now, flow(z, 2.5L)), 32 * long_epsilon * condition(flow, z, 2.5L));
  };
  expect(Kepler<double>(1));
  expect(Hooke<double>(-1));
  expect(Linear<double>(1));
  expect(Binomial<double>(1, 1));
}

// ---- turning points, types, circles ----

template <class R>
Parameters<R> numbers(const std::map<std::string, R>& values) {
  Parameters<R> all;
  for (const auto& [name, value] : values) all.set(name, value);
  return all;
}

template <template <class> class Potential, class R>
CentralOrbit described(const std::string& kind, Parameters<R> given, const Parameters<R>& orbit) {
  if constexpr (requires { Potential<R>::derive(kind, orbit, given); }) Potential<R>::derive(kind, orbit, given);
  Conditions conditions;
  const Start<R, 2> z = Potential<R>::start(kind, given["mass"], given, orbit, conditions);
  return describe_central_orbit(Potential<R>(given), given["mass"], z.q, z.p);
}

template <class R>
class CentralOrbitIn : public ::testing::Test {};
TYPED_TEST_SUITE(CentralOrbitIn, Numbers);

TYPED_TEST(CentralOrbitIn, HasTheTurningPointsOfItsStart) {
  using R = TypeParam;
  const R epsilon = std::numeric_limits<R>::epsilon();
  const auto expect = [&](const CentralOrbit& orbit, L per, L aph) {
    EXPECT_TRUE(within(orbit.r_min, per, 8 * epsilon * per));
    // From pericentre, E is the difference of terms r_aph/r_per times as large at worst, and l^2 has a few roundings.
    EXPECT_TRUE(within(orbit.r_max, aph, 16 * epsilon * aph * (1 + aph / per) * aph / (aph - per)));
    EXPECT_TRUE(orbit.circular_stable);
    EXPECT_GT(orbit.circular_radius, orbit.r_min);
    EXPECT_LT(orbit.circular_radius, orbit.r_max);
  };
  for (const auto& [per_, aph_] : {std::pair{0.4, 1.6}, {1.0, 1.25}, {1.0, 1.0009765625}, {0.01, 1.99}, {3.0, 17.0}}) {
    const R per(static_cast<R>(per_));
    const R aph(static_cast<R>(aph_));
    const auto radii = numbers<R>({{"r_per", per}, {"r_aph", aph}, {"energy", R(0.7)}});
    const auto given = numbers<R>({{"mass", R(1.3)}, {"k", R(0.8)}, {"lambda", R(0.5)}});
    const CentralOrbit kepler = described<Kepler>("ellipse", given, radii);
    expect(kepler, per, aph);
    EXPECT_EQ(kepler.conic, "ellipse");
    EXPECT_EQ(kepler.type, OrbitType::bounded_closed);
    EXPECT_TRUE(within(kepler.circular_radius, 2 * L(per) * aph / (L(per) + aph), 16 * epsilon * aph));
    const CentralOrbit hooke = described<Hooke>("ellipse", given, radii);
    expect(hooke, per, aph);
    EXPECT_EQ(hooke.conic, "ellipse");
    EXPECT_EQ(hooke.type, OrbitType::bounded_closed);
    EXPECT_TRUE(within(hooke.circular_radius, sqrt(L(per) * aph), 16 * epsilon * aph));
    const CentralOrbit linear = described<Linear>("bounded", given, radii);
    expect(linear, per, aph);
    EXPECT_EQ(linear.conic, "");
    if (per * per + aph * aph >= R(1)) expect(described<Binomial>("bounded", given, radii), per, aph);
  }
}

TYPED_TEST(CentralOrbitIn, IsOfTheKindOfItsStart) {
  using R = TypeParam;
  const auto given = numbers<R>({{"mass", R(1.3)}, {"k", R(0.8)}});
  const auto repulsive = numbers<R>({{"mass", R(1.3)}, {"k", R(-0.8)}});
  for (const double r : {1e-3, 0.3, 1.0, 7.7}) {
    const auto orbit =
        numbers<R>({{"r0", R(r)}, {"r_per", R(r)}, {"energy", R(0.7)}, {"angular_momentum", R(2.5 * std::sqrt(r))}});
    struct Case {
      CentralOrbit found;
      OrbitType type;
      const char* conic;
    };
    for (const Case& c : {Case{described<Kepler>("circle", given, orbit), OrbitType::circle, "circle"},
                          Case{described<Kepler>("parabola", given, orbit), OrbitType::unbounded, "parabola"},
                          Case{described<Kepler>("hyperbola", given, orbit), OrbitType::unbounded, "hyperbola"},
                          Case{described<Hooke>("circle", given, orbit), OrbitType::circle, "circle"},
                          Case{described<Hooke>("line", given, orbit), OrbitType::unbounded, "line"},
                          Case{described<Hooke>("hyperbola", given, orbit), OrbitType::unbounded, "hyperbola"},
                          Case{described<Linear>("circle", given, orbit), OrbitType::circle, ""},
                          Case{described<Linear>("unbounded", repulsive, orbit), OrbitType::unbounded, ""}}) {
      EXPECT_EQ(name_of(c.found.type), std::string(name_of(c.type))) << c.conic << " r = " << r;
      EXPECT_EQ(c.found.conic, c.conic) << "r = " << r;
      EXPECT_TRUE(within(c.found.r_min, R(r), 8 * std::numeric_limits<R>::epsilon() * r)) << c.conic << " r = " << r;
      if (c.type == OrbitType::circle) {
        EXPECT_TRUE(c.found.circular_stable);
        EXPECT_EQ(c.found.r_min, c.found.r_max);
      } else {
        EXPECT_EQ(c.found.r_max, std::numeric_limits<L>::infinity());
      }
    }
  }
}

TEST(CentralOrbit, SpecialCasesAreNamed) {
  const auto at = [](const auto& potential, double x, double y, double px, double py) {
    return describe_central_orbit(potential, 1.0, Vector<double, 2>{x, y}, Vector<double, 2>{px, py});
  };
  const L inf = std::numeric_limits<L>::infinity();
  // Lines through the centre.
  const CentralOrbit fall = at(Kepler<double>(1), 0.6, 0.8, 0, 0);
  EXPECT_TRUE(fall.falls_into_centre);
  EXPECT_EQ(fall.type, OrbitType::bounded_open);
  EXPECT_EQ(fall.conic, "line");
  EXPECT_EQ(fall.r_min, 0);
  EXPECT_TRUE(within(fall.radial_period, pi_value<L>() / sqrt(L(2)), 4 * test::epsilon));
  const CentralOrbit swing = at(Hooke<double>(-1), 0.6, 0.8, -0.3, -0.4);
  EXPECT_FALSE(swing.falls_into_centre);
  EXPECT_EQ(swing.type, OrbitType::bounded_closed);
  EXPECT_EQ(swing.radial_periods, 2);
  EXPECT_TRUE(within(swing.radial_period, pi_value<L>(), 4 * test::epsilon));
  // A line that does not reach the centre, and Duffing's separatrix: E = V(0), lambda = 8, r0 = 4.
  const CentralOrbit side = at(Binomial<double>(1, 2), 1, 0.5, 1, 0.5);
  EXPECT_GT(side.r_min, 0);
  EXPECT_EQ(side.type, OrbitType::bounded_closed);
  const CentralOrbit separatrix = at(Binomial<double>(1, 8), 4, 0, 0, 0);
  EXPECT_EQ(separatrix.radial_period, inf);
  EXPECT_EQ(separatrix.type, OrbitType::bounded_open);
  EXPECT_FALSE(central_flow(Binomial<double>(1, 8), 1, {4, 0}, {0, 0}, 1).has_value());
  // An unstable circle, V = -1/(4 r^4): V_eff' = 0 at r = 1 for l = 1; and both sides of it.
  const Powers<double> steep(-0.25, -4);
  const CentralOrbit circle = at(steep, 1, 0, 0, 1);
  EXPECT_EQ(circle.type, OrbitType::circle);
  EXPECT_FALSE(circle.circular_stable);
  EXPECT_EQ(circle.radial_period, inf);
  const CentralOrbit inside = at(steep, 0.9, 0, 0, 1 / 0.9);
  EXPECT_TRUE(inside.falls_into_centre);
  EXPECT_TRUE(within(inside.r_max, 0.9, 4 * test::epsilon));
  EXPECT_TRUE(within(inside.circular_radius, 1, 8 * test::epsilon));
  EXPECT_FALSE(inside.circular_stable);
  const CentralOrbit outside = at(steep, 1.1, 0, 0, 1 / 1.1);
  EXPECT_EQ(outside.type, OrbitType::unbounded);
  EXPECT_TRUE(within(outside.r_min, 1.1, 4 * test::epsilon));
  // On the maximum's energy, 1/4: to the circle for ever, from outside and from inside.
  const CentralOrbit to_circle = at(steep, 2, 0, -std::sqrt(9.0 / 32), 0.5);
  EXPECT_EQ(to_circle.type, OrbitType::unbounded);
  EXPECT_TRUE(within(to_circle.r_min, 1, 8 * test::epsilon));
  EXPECT_EQ(to_circle.apsidal_angle, inf);
  const CentralOrbit from_inside = at(steep, 0.5, 0, std::sqrt(2 * (0.25 - 2 + 4)), 2);
  EXPECT_EQ(from_inside.type, OrbitType::bounded_open);
  EXPECT_TRUE(within(from_inside.r_max, 1, 8 * test::epsilon));
  EXPECT_EQ(from_inside.radial_period, inf);
  // At rest in an equilibrium; starting in the centre.
  EXPECT_EQ(at(Binomial<double>(1, 4), 2, 0, 0, 0).type, OrbitType::circle);
  const CentralOrbit from_centre = at(Hooke<double>(-1), 0, 0, 0.6, 0.8);
  EXPECT_EQ(from_centre.type, OrbitType::bounded_closed);
  EXPECT_TRUE(within(from_centre.r_max, 1, 4 * test::epsilon));
}

TEST(CentralOrbit, TurnsOnItsWayIntoTheCentre) {
  const auto angle = [](double power, double speed, double around) {
    const Powers<double> potential(-1, power);
    return describe_central_orbit(potential, 1.0, Vector<double, 2>{0.5, 0}, Vector<double, 2>{speed, around})
        .apsidal_angle;
  };
  // The integral of l/(r^2 r') from the centre to apocentre, or to infinity, by Gauss' rule in 40 digits.
  for (const double sign : {1.0, -1.0}) {
    EXPECT_TRUE(within(angle(-2.5, 0, sign / 4), 0.33697377510110164148L, 8 * test::epsilon));
    EXPECT_TRUE(within(angle(-4, 0, sign / 4), 0.057955205851491249911L, 8 * test::epsilon));
    EXPECT_TRUE(within(angle(-6, 0, sign / 4), 0.015492793223139042957L, 8 * test::epsilon));
    EXPECT_TRUE(within(angle(-2.5, 12, sign / 4), 0.27682446494808064431L, 8 * test::epsilon));
    EXPECT_TRUE(within(angle(-6, -12, sign / 4), 0.061902139497431836483L, 8 * test::epsilon));
    EXPECT_EQ(angle(-2, 0, sign / 4), std::numeric_limits<L>::infinity());
    EXPECT_EQ(angle(-2, 12, sign / 4), std::numeric_limits<L>::infinity());
  }
  EXPECT_EQ(angle(-4, 0, 0), 0);
}

TEST(CentralOrbit, OfACircleClosesAfterOneRevolution) {
  const auto at = [](const auto& potential, double around) {
    return describe_central_orbit(potential, 1.0, Vector<double, 2>{1, 0}, Vector<double, 2>{0, around});
  };
  // pi/sqrt(m + 2) for V = r^m/m: m and the radial periods of one revolution, 0 where they are no whole number.
  for (const auto& [m, periods] : {std::pair{-1.0, 1}, {2.0, 2}, {7.0, 3}, {1.0, 0}, {0.25, 0}, {-4.0, 0}}) {
    const CentralOrbit circle = at(Powers<double>(1 / m, m), 1);
    EXPECT_EQ(circle.type, OrbitType::circle) << m;
    EXPECT_TRUE(circle.closed) << m;
    EXPECT_EQ(circle.revolutions, 1) << m;
    EXPECT_EQ(circle.radial_periods, periods) << m;
  }
  const CentralOrbit rest = at(Binomial<double>(1, 1), 0);
  EXPECT_EQ(rest.type, OrbitType::circle);
  EXPECT_EQ(rest.revolutions, 0);
  EXPECT_EQ(rest.radial_periods, 1);
}

TEST(CentralOrbit, ANeutralCircleIsNotStable) {
  // V = -1/r^2 with l^2 = -2 m a: V_eff is constant.
  const CentralOrbit orbit = describe_central_orbit<double>(Powers<L>(-1, -2), 1.0, {1, 0}, {0, std::sqrt(2.0)});
  EXPECT_EQ(orbit.type, OrbitType::circle);
  EXPECT_FALSE(orbit.circular_stable);
  EXPECT_TRUE(std::isinf(orbit.apsidal_angle));
  EXPECT_TRUE(std::isinf(orbit.radial_period));
  // A little less steep, it is stable.
  const double speed = std::sqrt(1.999);
  EXPECT_TRUE(describe_central_orbit<double>(Powers<L>(-1, -1.999L), 1.0, {1, 0}, {0, speed}).circular_stable);
}

TEST(CentralOrbit, FindsTwoCirclesThatAreCloseTogether) {
  // V = -1/r - 1/(3 r^3): circles where r + 1/r = l^2, a stable one outside of an unstable one.
  const Powers<L> potential(-1, -1, -1 / L(3), -3);
  for (const L excess : {1e-2L, 1e-4L, 1e-6L}) {
    const L l = sqrt(2 + excess);
    const L root = sqrt((l * l / 2 - 1) * (l * l / 2 + 1));
    const CentralOrbit falling =
        describe_central_orbit(potential, L(1), Vector<L, 2>{1.3L, 0}, Vector<L, 2>{0, l / 1.3L});
    EXPECT_TRUE(falling.falls_into_centre);
    EXPECT_TRUE(falling.circular_stable);
    // The two are the zeros of a parabola of which l^2 is the height: roundings over the slope there.
    EXPECT_TRUE(within(falling.circular_radius, l * l / 2 + root, 16 * long_epsilon / root));
    // Between them, nearer to the stable one: caught in the hollow.
    const L r = l * l / 2 + root / 2;
    const CentralOrbit caught = describe_central_orbit(potential, L(1), Vector<L, 2>{r, 0}, Vector<L, 2>{0, l / r});
    EXPECT_EQ(caught.r_min, r);
    EXPECT_LT(caught.r_max, l * l / 2 + 2 * root);
    EXPECT_EQ(name_of(caught.type), std::string("bounded open"));
  }
}

TEST(CentralOrbit, FindsABarrier) {
  // V = r^2 plus a bump of height 1 about r = 2, 0.05 wide.
  struct Bump {
    L width;
    L value(L u) const { return u + exp(-(u - 4) * (u - 4) / (width * width)); }
    L slope(L u) const { return 2 * (1 - 2 * (u - 4) / (width * width) * exp(-(u - 4) * (u - 4) / (width * width))); }
    CentralDerivatives<L> derivatives(L u) const {
      const L x = (u - 4) / width;
      return {slope(u), 4 * exp(-x * x) * (4 * x * x - 2) / (width * width)};
    }
  };
  // E = 4.5: without the bump the turning point is at r^2 = 4.5; with it where 4 + 0.5 = u + exp.
  const CentralOrbit orbit =
      describe_central_orbit(Bump{0.2L}, L(1), Vector<L, 2>{1, 0}, Vector<L, 2>{sqrt(L(7)), 0.01L});
  EXPECT_LT(orbit.r_max, 2);
  EXPECT_GT(orbit.r_max, 1.9L);
}

// ---- apsidal angles and closedness ----

TEST(ApsidalAngle, OfKeplerIsPiAndOfHookeHalfOfIt) {
  int trials = 0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const Start<L, 2> z = random_start<L>(600 + k);
    const CentralOrbit hooke = describe_central_orbit(Hooke<L>(-1.5L), L(1.25), z.q, z.p);
    EXPECT_TRUE(within(hooke.apsidal_angle, pi_value<L>() / 2, 16 * long_epsilon)) << k;
    EXPECT_TRUE(within(hooke.radial_period, pi_value<L>() * sqrt(L(1.25) / 1.5L), 16 * long_epsilon)) << k;
    const CentralOrbit kepler = describe_central_orbit(Kepler<L>(1.5L), L(1.25), z.q, z.p);
    if (kepler.type == OrbitType::unbounded) continue;
    ++trials;
    // Far out the state knows E, and with it r_max, only to the rounding of its terms.
    const L lost = 1.5L / hypot(z.q[0], z.q[1]) / abs(kepler.energy);
    EXPECT_TRUE(within(kepler.apsidal_angle, pi_value<L>(), 16 * (1 + lost) * long_epsilon)) << k;
    const L a = 1.5L / (2 * abs(kepler.energy));
    const L period = 2 * pi_value<L>() * sqrt(1.25L / 1.5L * a * a * a);
    EXPECT_TRUE(within(kepler.radial_period, period, 16 * (1 + lost) * long_epsilon * period)) << k;
  }
  EXPECT_GT(trials, 100);
}

TEST(ApsidalAngle, OfTheLinearAndTheQuarticPotentialByAnotherFormula) {
  // k r^3 - E r^2 + l^2/(2 mu) = k (r - r1)(r - r2)(r + r1 r2/(r1 + r2)), and with u = r^2 for V = r^4
  // u^3 - E u + l^2/(2 mu) = (u - u1)(u - u2)(u + u1 + u2); Chebyshev's quadrature, 4000 points.
  constexpr int points = 4000;
  for (const auto& [r1, r2] : {std::pair{0.4L, 1.6L}, {1.0L, 1.01L}, {1.0L, 1.2L}, {0.05L, 1.0L}}) {
    const L mass = 1.25L;
    const L l_linear = r1 * r2 * sqrt(2 * mass / (r1 + r2));
    const L u1 = r1 * r1;
    const L u2 = r2 * r2;
    const L l_quartic = sqrt(2 * mass * u1 * u2 * (u1 + u2));
    L linear = 0;
    L quartic = 0;
    for (int i = 0; i < points; ++i) {
      const L c = cos(pi_value<L>() * (2 * i + 1) / (2 * points));
      const L r = (r1 + r2) / 2 - (r2 - r1) / 2 * c;
      const L u = (u1 + u2) / 2 - (u2 - u1) / 2 * c;
      linear += pi_value<L>() / points * l_linear / (mass * r * sqrt(2 / mass * (r + r1 * r2 / (r1 + r2))));
      quartic += pi_value<L>() / points * l_quartic / (2 * mass * u * sqrt(2 / mass * (u + u1 + u2)));
    }
    // The state fixes the turning points to some roundings times their conditioning, as in the test of the starts.
    const L bound = 64 * long_epsilon * (1 + r2 / r1) * r2 / (r2 - r1);
    const CentralOrbit found = describe_central_orbit(Linear<L>(1), mass, {r1, 0}, {0, l_linear / r1});
    EXPECT_TRUE(within(found.apsidal_angle, linear, bound)) << static_cast<double>(r1);
    EXPECT_FALSE(found.closed);
    const CentralOrbit quartic_found = describe_central_orbit(Powers<L>(1, 4), mass, {r1, 0}, {0, l_quartic / r1});
    EXPECT_TRUE(within(quartic_found.apsidal_angle, quartic, bound)) << static_cast<double>(r1);
    EXPECT_FALSE(quartic_found.closed);
  }
}

TEST(ApsidalAngle, OfARevolvingEllipseAndItsCommensurability) {
  // V = -1/r + b/r^2 adds b to l^2/(2 mu): the angle is pi l/sqrt(l^2 + 2 mu b).
  for (int revolutions = 1; revolutions <= 40; ++revolutions) {
    for (int periods : {1, 2, 3, 7, 24, 32, 33, 37}) {
      if (std::gcd(revolutions, periods) != 1) continue;
      const double l = 0.9;
      const double ratio = static_cast<double>(periods) / revolutions;
      const double b = l * l * (ratio * ratio - 1) / 2;
      const double r = l * l * ratio * ratio * 0.8;  // 0.8 of the circular radius: e = 1/4
      const Powers<double> potential(-1, -1, b, -2);
      const CentralOrbit orbit =
          describe_central_orbit(potential, 1.0, Vector<double, 2>{r, 0}, Vector<double, 2>{0, l / r});
      ASSERT_NE(orbit.type, OrbitType::unbounded) << revolutions << "/" << periods;
      // b and l are rounded: the angle carries (1 + |b|/l^2 ratio^-2) roundings of them.
      const L angle = pi_value<L>() * revolutions / periods;
      EXPECT_TRUE(within(orbit.apsidal_angle, angle, 8 * test::epsilon * angle * (1 + 1 / (ratio * ratio))))
          << revolutions << "/" << periods;
      if (1 / (ratio * ratio) * revolutions / periods > 64) continue;  // more than the tolerance of 1024 roundings
      EXPECT_EQ(orbit.closed, periods <= most_radial_periods) << revolutions << "/" << periods;
      if (!orbit.closed) continue;
      EXPECT_EQ(orbit.revolutions, revolutions);
      EXPECT_EQ(orbit.radial_periods, periods);
    }
  }
}

TEST(ApsidalAngle, OfSmallOscillationsIsThatOfTheCircle) {
  // pi/sqrt(m + 2) for V = r^m; the next term is quadratic in the amplitude.
  for (const double m : {-1.5, -1.0, -0.5, 0.5, 1.0, 2.0, 3.0, 7.0}) {
    const Powers<L> potential(m > 0 ? L(1) : L(-1), L(m));
    const L l = sqrt(abs(L(m)));  // the circle at r = 1
    const L limit = pi_value<L>() / sqrt(L(m) + 2);
    const CentralOrbit circle = describe_central_orbit(potential, L(1), {1, 0}, {0, l});
    EXPECT_EQ(circle.type, OrbitType::circle);
    EXPECT_TRUE(within(circle.apsidal_angle, limit, 8 * long_epsilon * limit));
    for (const L off : {1e-16L, 1e-12L, 1e-9L}) {
      const CentralOrbit near = describe_central_orbit(potential, L(1), {1, 0}, {0, l * (1 + off)});
      EXPECT_NE(near.type, OrbitType::circle);
      EXPECT_LT(near.r_max - near.r_min, 100 * off);
      // Of first order in `off` through l; the radius is exact to rounding.
      EXPECT_TRUE(within(near.apsidal_angle, limit, 32 * long_epsilon + 100 * off * off))
          << m << " " << static_cast<double>(off);
    }
  }
}

TEST(Commensurable, TakesTheSmallestDenominatorWithinTheTolerance) {
  const auto fraction = [](L x, L tolerance) { return commensurable(x, 32, tolerance).value_or(std::pair{0, 0}); };
  EXPECT_EQ(fraction(0, 1e-15L), (std::pair{0, 1}));
  EXPECT_EQ(fraction(0.5L, 1e-15L), (std::pair{1, 2}));
  EXPECT_EQ(fraction(17.0L / 31, 1e-15L), (std::pair{17, 31}));
  EXPECT_EQ(fraction(17.0L / 31 - 1e-16L, 1e-15L), (std::pair{17, 31}));
  EXPECT_EQ(fraction(17.0L / 33, 1e-15L), (std::pair{0, 0}));
  EXPECT_EQ(fraction(1 - 1e-16L, 1e-15L), (std::pair{1, 1}));
  EXPECT_EQ(fraction(sqrt(L(2)), 1e-15L), (std::pair{0, 0}));
  for (int q = 1; q <= 32; ++q) {
    for (int p = 0; p <= 3 * q; ++p) {
      if (std::gcd(p, q) != 1) continue;
      EXPECT_EQ(fraction(L(p) / q, 4 * long_epsilon * 3), (std::pair{p, q}));
    }
  }
}

TEST(Bertrand, OnlyKeplerAndHookeOrbitsAllClose) {
  const auto closed_share = [](const auto& potential) {
    int closed = 0;
    int bounded = 0;
    for (std::uint64_t k = 0; bounded < 25 && k < 1000; ++k) {
      const Start<double, 2> z = random_start<double>(2000 + k, 1.5, 1);
      const CentralOrbit orbit = describe_central_orbit(potential, 1.0, z.q, z.p);
      if (orbit.type == OrbitType::unbounded) continue;
      ++bounded;
      if (orbit.closed) ++closed;
    }
    EXPECT_EQ(bounded, 25);
    return static_cast<double>(closed) / bounded;
  };
  EXPECT_EQ(closed_share(Kepler<double>(1)), 1);
  EXPECT_EQ(closed_share(Hooke<double>(-1)), 1);
  // Elsewhere a start is closed with probability 1e-10.
  EXPECT_EQ(closed_share(Linear<double>(1)), 0);
  EXPECT_EQ(closed_share(Binomial<double>(1, 1)), 0);
  EXPECT_EQ(closed_share(Binomial<double>(1, -1)), 0);
  for (const double m : {-1.01, -0.99, -0.5, 0.5, 1.99, 2.01, 3.0, 6.0}) {
    EXPECT_EQ(closed_share(Powers<double>(m > 0 ? 1 : -1, m)), 0) << m;
  }
  EXPECT_EQ(closed_share(Powers<double>(-1, -1, -1e-6, 2)), 0);
}

// ---- the predicted type against an integrated orbit ----

/// What an integrated orbit did: turned at its extremes, left beyond 10^6, or fell below 10^-4 of its first radius.
struct Seen {
  enum class End { turned, left, fell, undecided } end = End::undecided;
  double r_min = 0;
  double r_max = 0;
};

/// Dormand and Prince's 5(4) with step control, 1e-8 relative.
template <class Potential>
class Watched {
 public:
  using Z = std::array<double, 4>;
  Watched(const Potential& potential, double mass) : potential_(potential), mass_(mass) {}

  Seen watch(const Start<double, 2>& start) const {
    Z z{start.q[0], start.q[1], start.p[0], start.p[1]};
    Seen seen;
    const double r0 = std::hypot(z[0], z[1]);
    const double far = 1e6 * std::max(1.0, r0);
    double h = 1e-3 * r0 / (1 + std::hypot(z[2], z[3]));
    double radial = z[0] * z[2] + z[1] * z[3];
    bool has_min = false;
    bool has_max = false;
    for (int step = 0; step < 20000; ++step) {
      double taken = 0;
      const Z next = advance(z, h, taken);
      const double after = next[0] * next[2] + next[1] * next[3];
      if ((radial > 0) != (after > 0) && radial != 0) {
        double ignored = 0;
        const Z apsis = stage(z, taken * radial / (radial - after), ignored);
        (radial > 0 ? seen.r_max : seen.r_min) = std::hypot(apsis[0], apsis[1]);
        (radial > 0 ? has_max : has_min) = true;
      }
      z = next;
      radial = after;
      const double r = std::hypot(z[0], z[1]);
      if (has_min && has_max) {
        seen.end = Seen::End::turned;
        return seen;
      }
      if (r > far || !(r < 1e300)) {
        seen.end = Seen::End::left;
        return seen;
      }
      if (r < 1e-4 * r0) {
        seen.end = Seen::End::fell;
        return seen;
      }
    }
    return seen;
  }

 private:
  Z rate(const Z& z) const {
    const double slope = potential_.slope(z[0] * z[0] + z[1] * z[1]);
    return {z[2] / mass_, z[3] / mass_, -slope * z[0], -slope * z[1]};
  }
  Z stage(const Z& z, double h, double& error) const {
    static constexpr double a[6][6] = {{1.0 / 5},
                                       {3.0 / 40, 9.0 / 40},
                                       {44.0 / 45, -56.0 / 15, 32.0 / 9},
                                       {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                       {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                       {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    static constexpr double e[7] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                    -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    Z k[7];
    k[0] = rate(z);
    Z y = z;
    for (int s = 0; s < 6; ++s) {
      y = z;
      for (int j = 0; j <= s; ++j) {
        for (std::size_t i = 0; i < 4; ++i) y[i] += h * a[s][j] * k[j][i];
      }
      k[s + 1] = rate(y);
    }
    Z wrong{};
    for (int s = 0; s < 7; ++s) {
      for (std::size_t i = 0; i < 4; ++i) wrong[i] += h * e[s] * k[s][i];
    }
    error = std::max(std::hypot(wrong[0], wrong[1]) / std::hypot(z[0], z[1]),
                     std::hypot(wrong[2], wrong[3]) / (std::hypot(z[2], z[3]) + std::hypot(y[2], y[3])));
    return y;
  }
  Z advance(const Z& z, double& h, double& taken) const {
    for (;;) {
      double error = 0;
      const Z y = stage(z, h, error);
      const double factor = 0.9 * std::pow(1e-8 / (error + 1e-30), 0.2);
      taken = h;
      if (std::isfinite(error)) {
        h *= std::min(4.0, std::max(0.2, factor));
        if (error <= 1e-8) return y;
      } else {
        h *= 0.1;
      }
      if (!(h > 1e-30)) return y;
    }
  }
  const Potential& potential_;
  double mass_;
};

/// Agreement of a description with an orbit: bounded ones turn at r_min and r_max, unbounded ones leave without having
/// turned back before, falling ones fall. Some hundred local errors of 1e-8 are allowed; an error made at the one
/// turning point counts r_max/r_min times as much at the other.
enum class Verdict { agrees, differs, skipped };
Verdict judge(const CentralOrbit& orbit, const Seen& seen, double r0) {
  const L span = orbit.r_min > 0 && orbit.r_max < 1e300L ? orbit.r_max / orbit.r_min : L(1);
  const auto same = [span](double a, L b) { return abs(a - b) <= 1e-5L * (1 + span) * b; };
  const L far = 1e6L * std::max(1.0, r0);
  if (orbit.r_max < std::numeric_limits<L>::infinity() && orbit.r_max > far / 2) return Verdict::skipped;
  if (orbit.r_min > 0 && orbit.r_min < 2e-4L * r0) return Verdict::skipped;
  Seen::End expected = Seen::End::turned;
  if (orbit.type == OrbitType::unbounded) expected = Seen::End::left;
  if (orbit.falls_into_centre && orbit.r_max < far) expected = Seen::End::fell;
  if (orbit.falls_into_centre && orbit.type == OrbitType::unbounded && seen.end == Seen::End::fell)
    return Verdict::agrees;
  if (seen.end != expected) return Verdict::differs;
  if (expected == Seen::End::turned && !(same(seen.r_min, orbit.r_min) && same(seen.r_max, orbit.r_max)))
    return Verdict::differs;
  if (expected != Seen::End::turned && seen.r_min > 0 && !same(seen.r_min, orbit.r_min)) return Verdict::differs;
  if (expected != Seen::End::turned && seen.r_max > 0 && !same(seen.r_max, orbit.r_max)) return Verdict::differs;
  return Verdict::agrees;
}

struct Tally {
  int agrees = 0;
  int differs = 0;
  int skipped = 0;
  int bounded = 0;
  int unbounded = 0;
  int falling = 0;
};

/// @param as_described the potential that is described; the motion is in `potential`
template <class Potential, class Described>
void classify(const Potential& potential, const Described& as_described, double mass, const Start<double, 2>& z,
              Tally& tally) {
  const CentralOrbit orbit = describe_central_orbit(as_described, mass, z.q, z.p);
  const Seen seen = Watched<Potential>(potential, mass).watch(z);
  const Verdict verdict = judge(orbit, seen, std::hypot(z.q[0], z.q[1]));
  ++(verdict == Verdict::agrees ? tally.agrees : verdict == Verdict::differs ? tally.differs : tally.skipped);
  ++(orbit.falls_into_centre ? tally.falling : orbit.type == OrbitType::unbounded ? tally.unbounded : tally.bounded);
}

/// V - l^2/(mu r^2): what it makes of V_eff has the wrong sign of the centrifugal term.
template <class Potential>
struct WrongSign {
  Potential potential;
  double term;  // l^2/mu
  template <class S>
  S value(const S& u) const {
    return potential.value(u) - term / u;
  }
  template <class S>
  S slope(const S& u) const {
    return potential.slope(u) + 2 * term / (u * u);
  }
  template <class S>
  CentralDerivatives<S> derivatives(const S& u) const {
    const auto d = potential.derivatives(u);
    return {slope(u), d.curvature - 8 * term / (u * u * u)};
  }
};

template <class Check>
Tally random_orbits(int count, const Check& check) {
  Tally tally;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
    const double mass = uniform(8 * i + 100000, 0.3, 3);
    const double a = uniform(8 * i + 100001, -2, 2);
    const double b = uniform(8 * i + 100002, -2, 2);
    const double m = uniform(8 * i + 100003, -3, 4);
    const double n = uniform(8 * i + 100004, -3, 4);
    const Start<double, 2> z = random_start<double>(10000 + i, 1.5, 2);
    if (i % 6 == 0) check(Kepler<double>(a), mass, z, tally);
    if (i % 6 == 1) check(Hooke<double>(a), mass, z, tally);
    if (i % 6 == 2) check(Linear<double>(a), mass, z, tally);
    if (i % 6 == 3) check(Binomial<double>(a, b), mass, z, tally);
    if (i % 6 == 4) check(Powers<double>(a, m), mass, z, tally);
    if (i % 6 == 5) check(Powers<double>(a, m, b, n), mass, z, tally);
  }
  return tally;
}

TEST(Classification, OfTenThousandRandomOrbitsIsThatOfTheIntegratedOnes) {
  const Tally tally = random_orbits(10000, [](const auto& potential, double mass, const Start<double, 2>& z,
                                              Tally& out) { classify(potential, potential, mass, z, out); });
  EXPECT_EQ(tally.differs, 0);
  EXPECT_LT(tally.skipped, 200);
  EXPECT_GT(tally.bounded, 1000);
  EXPECT_GT(tally.unbounded, 1000);
  EXPECT_GT(tally.falling, 100);
  RecordProperty("skipped", tally.skipped);
  RecordProperty("bounded", tally.bounded);
  RecordProperty("unbounded", tally.unbounded);
  RecordProperty("falling", tally.falling);
}

TEST(Classification, NoticesAWrongSignInTheEffectivePotential) {
  const Tally tally = random_orbits(600, [](const auto& potential, double mass, const Start<double, 2>& z, Tally& out) {
    const double l = z.q[0] * z.p[1] - z.q[1] * z.p[0];
    using Potential = std::remove_cvref_t<decltype(potential)>;
    classify(potential, WrongSign<Potential>{potential, l * l / mass}, mass, z, out);
  });
  EXPECT_GT(tally.differs, 300);
}

TEST(ApsidalAngle, NoticesAWrongSignInTheEffectivePotential) {
  // The correct one is pi; with -l^2 in place of l^2 a narrow shell near the centre would remain, or none.
  const double term = 0.1;
  const WrongSign<Kepler<double>> wrong{Kepler<double>(1), term};
  const CentralOrbit orbit = describe_central_orbit(wrong, 1.0, Vector<double, 2>{1, 0}, Vector<double, 2>{0, 0.9});
  EXPECT_GT(abs(orbit.apsidal_angle - pi_value<L>()), 0.1L);
  EXPECT_FALSE(orbit.closed);
}

}  // namespace
}  // namespace hamflow
