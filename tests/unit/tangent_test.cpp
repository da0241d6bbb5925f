// Tangent vectors through steps, Lyapunov exponents and eigenvalues of their product, on problems where all of it is
// known, and on Henon-Heiles against a method without derivatives.
#include "../support/near.hpp"
#include "engine/step_map_of.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/runge_kutta.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/tableaus/rk4.hpp"
#include "hamflow/problems/harmonic.hpp"
#include "hamflow/problems/henon_heiles.hpp"
#include "hamflow/problems/potentials/hooke.hpp"
#include "hamflow/problems/potentials/kepler.hpp"
#include "hamflow/verify/lyapunov_of.hpp"
#include "verify/monodromy.hpp"

namespace hamflow {
namespace {

using test::epsilon;
using test::within;
using Stv4 = Composition<compositions::stv4>;
using Verlet = Composition<compositions::verlet>;
using Rk4 = RungeKuttaBy<tableaus::rk4>;

template <template <class> class Family, class Recipe, class... Numbers>
auto map_of(Recipe recipe, Numbers... parameters) {
  const auto make = [=]<class R>() { return Family<R>(static_cast<R>(parameters)...); };
  return StepMapOf<Family, Recipe>(make, recipe);
}
template <class Recipe>
auto henon_heiles(Recipe recipe) {
  return map_of<HenonHeiles>(recipe, 1.0);
}
template <class R>
using HookeForce = CentralForce<R, Hooke>;
template <class R>
using KeplerForce = CentralForce<R, Kepler>;
/// V = -k r^2/2 in the plane.
template <class Recipe>
auto hooke(Recipe recipe, double k) {
  const auto make = [=]<class R>() { return HookeForce<R>(R(1), Hooke<R>(static_cast<R>(k))); };
  return StepMapOf<HookeForce, Recipe>(make, recipe);
}
Cg element(int points) {
  CgOptions options;
  options.degree = 1;
  options.quadrature = points;
  return Cg{options};
}

/// q1 = 0 with the energy of the escape, 1/6, where nearly all orbits are chaotic.   [HLW2006, Sect. I.3.4]
State<double> chaotic() {
  const double q2 = -0.15;
  const double p2 = 0.1;
  const double potential = q2 * q2 / 2 - q2 * q2 * q2 / 3;
  return {0, q2, std::sqrt(2 * (1.0 / 6 - potential) - p2 * p2), p2};
}
/// Energy about 1/100, where none is.
State<double> regular() { return {0.05, 0.04, 0.1, 0.06}; }

double largest_entry(const State<double>& v) {
  double largest = 0;
  for (const double x : v) largest = std::max(largest, std::abs(x));
  return largest;
}

/// The tangent of 7 steps: against the product of Jacobians, and against divided differences of the steps in long
/// double, whose truncation is d^2/6 times a third derivative.
void check_tangents(const StepMap& map, const State<double>& z) {
  const double h = 0.1;
  const std::int64_t steps = 7;
  const State<double> v{0.3, -1, 0.5, 0.7};
  State<double> expected = v;
  State<double> end = z;
  for (std::int64_t i = 0; i < steps; ++i) {
    const auto rows = map.jacobian(end, h);
    State<double> next(4);
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) next[a] += rows[a][b] * expected[b];
    }
    expected = next;
    ASSERT_TRUE(map.advance(end, h, 1));
  }
  end = z;
  ASSERT_TRUE(map.advance(end, h, steps));
  State<double> moved = z;
  std::vector<State<double>> tangents{v, {1, 0, 0, 0}};
  ASSERT_TRUE(map.advance_with_tangents(moved, tangents, h, steps));
  EXPECT_EQ(moved, end) << "the orbit has to be that of advance()";
  constexpr long double d = 0x1p-18L;
  State<long double> plus(4);
  State<long double> minus(4);
  for (std::size_t i = 0; i < 4; ++i) {
    plus[i] = static_cast<long double>(z[i]) + d * static_cast<long double>(v[i]);
    minus[i] = static_cast<long double>(z[i]) - d * static_cast<long double>(v[i]);
  }
  ASSERT_TRUE(map.advance(plus, h, steps) && map.advance(minus, h, steps));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(within(tangents[0][i], expected[i], 64 * epsilon * largest_entry(expected))) << i;
    EXPECT_TRUE(within(tangents[0][i], (plus[i] - minus[i]) / (2 * d), 16 * static_cast<double>(d * d))) << i;
  }
}

TEST(Tangent, IsTheProductOfJacobiansAndTheDerivativeOfTheSteps) {
  const State<double> z{0.1, -0.2, 0.3, 0.25};
  check_tangents(henon_heiles(Stv4{}), z);
  check_tangents(henon_heiles(Rk4{}), z);
  check_tangents(henon_heiles(element(2)), z);
  const auto kepler = []<class R>() { return KeplerForce<R>(R(1), Kepler<R>(R(1))); };
  check_tangents(StepMapOf<KeplerForce, Stv4>(kepler, Stv4{}), {1, -0.2, 0.1, 0.9});
}

TEST(Tangent, FirstFrameIsOrthonormalAndSymplectic) {
  for (const std::size_t n : {1U, 2U, 5U}) {
    const TangentFrame frame(n, 2 * n);
    const auto& v = frame.vectors();
    for (std::size_t a = 0; a < 2 * n; ++a) {
      for (std::size_t b = 0; b < 2 * n; ++b) {
        double product = 0;
        double form = 0;
        for (std::size_t i = 0; i < n; ++i) {
          product += v[a][i] * v[b][i] + v[a][n + i] * v[b][n + i];
          form += v[a][i] * v[b][n + i] - v[a][n + i] * v[b][i];
        }
        EXPECT_TRUE(within(product, a == b ? 1 : 0, 8 * epsilon));
        EXPECT_TRUE(within(std::abs(form), a + b == 2 * n - 1 ? 1 : 0, 8 * epsilon));
      }
    }
  }
}

/// Rounding: some 16 epsilon a step, amplified by what a block stretches and contracts, for Henon-Heiles less than 2^4.
double pair_rounding(std::int64_t steps, double h) {
  return static_cast<double>(steps) * 256 * epsilon / (static_cast<double>(steps) * h);
}

TEST(Lyapunov, RegularOrbitGoesToZero) {
  const auto map = henon_heiles(Stv4{});
  for (const std::int64_t steps : {2000, 20000, 200000}) {
    const LyapunovSpectrum found = lyapunov_spectrum(map, regular(), 0.1, steps);
    EXPECT_LT(std::abs(found.exponents[0]), 10 * std::log(found.time) / found.time);
    for (const double sum : found.pair_sums) EXPECT_LT(std::abs(sum), pair_rounding(steps, 0.1));
  }
}

/// Two orbits 1e-7 apart, their distance reset every 8 steps: no derivative anywhere. The other orbit is off the
/// tangent by the distance times second derivatives.   [BenettinGalganiStrelcyn1976]
template <class R>
std::vector<double> growth_of_distance(const StepMap& map, State<R> z, R h, int resets,
                                       const State<double>& direction) {
  const R distance = R(1e-7);
  State<R> other = z;
  for (std::size_t i = 0; i < z.size(); ++i) other[i] += distance * static_cast<R>(direction[i]);
  std::vector<double> logs;
  for (int k = 0; k < resets; ++k) {
    EXPECT_TRUE(map.advance(z, h, 8) && map.advance(other, h, 8));
    R square = 0;
    for (std::size_t i = 0; i < z.size(); ++i) square += (other[i] - z[i]) * (other[i] - z[i]);
    const R length = std::sqrt(square);
    for (std::size_t i = 0; i < z.size(); ++i) other[i] = z[i] + (other[i] - z[i]) * (distance / length);
    logs.push_back(std::log(static_cast<double>(length / distance)));
  }
  return logs;
}

TEST(Lyapunov, ChaoticOrbitAgreesWithTwoNeighbours) {
  const auto map = henon_heiles(Stv4{});
  const double h = 0.1;
  const State<double> first = TangentFrame(2, 1).vectors()[0];
  {  // The same orbit, for so short a time that the arithmetic does not matter.
    double sum = 0;
    for (const double x : growth_of_distance<long double>(map, {0, -0.15L, chaotic()[2], 0.1L}, 0.1L, 125, first))
      sum += x;
    EXPECT_TRUE(within(largest_lyapunov(map, chaotic(), h, 1000), sum / 100, 1e-4));
  }
  // For long: averages over different pieces of one chaotic orbit.
  const auto logs = growth_of_distance<double>(map, chaotic(), h, 25000, first);
  std::vector<double> blocks(32);
  for (std::size_t k = 0; k < logs.size() / 32 * 32; ++k) blocks[k / (logs.size() / 32)] += logs[k];
  double mean = 0;
  double variance = 0;
  for (double& x : blocks) mean += (x /= static_cast<double>(logs.size() / 32) * 8 * h) / 32;
  for (const double x : blocks) variance += (x - mean) * (x - mean) / (31 * 32);
  const LyapunovSpectrum found = lyapunov_spectrum(map, chaotic(), h, 200000);
  EXPECT_GT(found.exponents[0], 20 * found.standard_errors[0]);
  // Neighbouring blocks are correlated: 6 of the errors that independent ones would have.
  EXPECT_TRUE(within(found.exponents[0], mean, 6 * std::hypot(found.standard_errors[0], std::sqrt(variance))));
  for (const double sum : found.pair_sums) EXPECT_LT(std::abs(sum), pair_rounding(200000, h));
  EXPECT_LT(std::abs(found.exponents[1]), 0.02);  // along the flow and across the energy
}

TEST(Lyapunov, PairsTellWhetherAStepIsSymplectic) {
  const double h = 0.4;
  const std::int64_t steps = 5000;
  State<double> start = regular();
  for (double& x : start) x /= 16;
  const auto worst = [&](const StepMap& map) {
    double largest = 0;
    for (const double sum : lyapunov_spectrum(map, start, h, steps).pair_sums) {
      largest = std::max(largest, std::abs(sum));
    }
    return largest;
  };
  EXPECT_LT(worst(henon_heiles(Stv4{})), pair_rounding(steps, h));
  EXPECT_LT(worst(henon_heiles(element(1))), 16 * pair_rounding(steps, h));  // implicit: what the solver leaves
  // rk4 contracts areas by 1 - h^6/72 + h^8/576 in each step of a harmonic oscillator, which Henon-Heiles is near rest:
  // at distance r the squares of its frequencies are 1 +- 2 r, here r < 0.01.
  const double contraction = std::log1p(-std::pow(h, 6) / 72 + std::pow(h, 8) / 576) / h;
  EXPECT_NEAR(worst(henon_heiles(Rk4{})), std::abs(contraction), 0.01 * std::abs(contraction));
}

/// Its force is right, and one derivative of it is off by 1e-6.
template <class R>
class WrongHessian : public HenonHeiles<R> {
 public:
  using HenonHeiles<R>::HenonHeiles;
  template <class S>
  void force(const Vector<S, 2>& q, Vector<S, 2>& f) const {
    HenonHeiles<R>::force(q, f);
    if constexpr (IsDual<S>::value) f[0].slope[0] += 1e-6 * q[1].slope[0];
  }
};

TEST(Lyapunov, MutantDerivativeIsCaught) {
  const auto map = map_of<WrongHessian>(Stv4{}, 1.0);
  // An antisymmetric part of the Hessian is no Hamiltonian's: the product is not symplectic.
  const auto found = symplectic_eigenvalues(derivative_of_steps(map, regular(), 0.1, 100));
  const auto sound = symplectic_eigenvalues(derivative_of_steps(henon_heiles(Stv4{}), regular(), 0.1, 100));
  EXPECT_LT(sound.symplectic_defect, 100 * 16 * epsilon * sound.norm * sound.norm);
  EXPECT_GT(found.symplectic_defect, 1e-7);
}

TEST(Lyapunov, HarmonicOscillatorHasNone) {
  const auto map = map_of<Harmonic>(Stv4{}, 1.0, 1.0);
  const LyapunovSpectrum found = lyapunov_spectrum(map, {1, 0}, 0.1, 100000);
  // The orbits of M^n are ellipses: lengths stay within the ratio of their axes, here below 1.01, for ever.
  EXPECT_LT(std::abs(found.exponents[0]) * found.time, 0.01 + 100000 * 16 * epsilon);
  EXPECT_LT(std::abs(found.pair_sums[0]) * found.time, 100000 * 16 * epsilon);
}

TEST(Lyapunov, InvertedOscillatorHasThoseOfItsStepMatrix) {
  const double k = 2;
  const double h = 0.1;
  const double exact = std::acosh(1 + h * h * k / 2) / h;  // trace of a Verlet step: 2 cosh(lambda h)
  const auto map = hooke(Verlet{}, k);
  LyapunovOptions options;
  options.transient = 300;  // e^(-2 lambda t) is far below rounding
  // Few steps: the orbit itself grows, to e^140.
  const LyapunovSpectrum found = lyapunov_spectrum(map, {1e-3, 0, 0, 1e-3}, h, 700, 0, options);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(within(found.exponents[i], i < 2 ? exact : -exact, 64 * epsilon / h)) << i;
  }
  EXPECT_NEAR(exact, std::sqrt(k), 0.01 * std::sqrt(k));
  EXPECT_TRUE(within(largest_lyapunov(map, {1e-3, 0, 0, 1e-3}, h, 700, options), exact, 64 * epsilon / h));
}

TEST(Lyapunov, TypedKernelAgrees) {
  const auto map = henon_heiles(Stv4{});
  const State<double> z = chaotic();
  const double typed = largest_lyapunov(HenonHeiles<double>(), Stv4{}, {z[0], z[1]}, {z[2], z[3]}, 0.1, 1000);
  // The same operations but for one kick in 64 steps; e^13 is what 1000 steps make of a rounding.
  EXPECT_TRUE(within(typed, largest_lyapunov(map, z, 0.1, 1000), 1e-9));
}

TEST(Lyapunov, WatchedRunGivesTheSameAndKeepsItsBits) {
  const State<double> z = chaotic();
  const auto map =
      std::make_shared<StepMapOf<HenonHeiles, Stv4>>([]<class R>() { return HenonHeiles<R>(R(1)); }, Stv4{});
  const std::int64_t steps = 1001;
  auto watched = simulate(HenonHeiles<double>(), Stv4{}, {z[0], z[1]}, {z[2], z[3]}, 0.1);
  auto alone = watched;
  LyapunovObserver lyapunov(map, 0.1, steps);
  MonodromyObserver product(map, 0.1, steps);
  Observer* const observers[] = {&lyapunov, &product};
  ASSERT_EQ(run(watched, steps, observers), Outcome::done);
  ASSERT_EQ(alone.advance(steps), Outcome::done);
  EXPECT_EQ(watched.bits(), alone.bits());
  EXPECT_TRUE(lyapunov.followed() && product.followed());
  // The watches are due at different steps; neither changes the blocks of the other.
  const LyapunovSpectrum found = lyapunov.spectrum();
  const LyapunovSpectrum expected = lyapunov_spectrum(*map, z, 0.1, steps);
  EXPECT_EQ(found.exponents, expected.exponents);
  EXPECT_EQ(found.time, expected.time);
  const auto rows = product.rows();
  const auto whole = derivative_of_steps(*map, z, 0.1, steps);
  const double norm = symplectic_eigenvalues(whole).norm;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) EXPECT_TRUE(within(rows[i][j], whole[i][j], 1e3 * epsilon * norm));
  }
}

TEST(Lyapunov, FailureIsTold) {
  const auto map = henon_heiles(Stv4{});
  EXPECT_TRUE(std::isnan(largest_lyapunov(map, {0, 30, 0, 30}, 0.1, 1000)));  // beyond the saddle: to infinity
  EXPECT_THROW((void)TangentFrame(2, 5), Error);
}

TEST(Monodromy, EigenvaluesOfLinearSteps) {
  // M^N of a Verlet step on the oscillator has e^(+-i N theta), cos theta = 1 - h^2/2.
  const double h = 0.1;
  const int steps = 61;
  const auto turn = symplectic_eigenvalues(derivative_of_steps(map_of<Harmonic>(Verlet{}, 1.0, 1.0), {1, 0}, h, steps));
  const double theta = steps * std::acos(1 - h * h / 2);
  ASSERT_EQ(turn.values.size(), 2U);
  for (const auto& value : turn.values) {
    EXPECT_TRUE(within(value.real(), std::cos(theta), 64 * steps * epsilon));
    EXPECT_TRUE(within(std::abs(value.imag()), std::abs(std::sin(theta)), 64 * steps * epsilon));
  }
  EXPECT_LT(turn.pair_defect, 16 * steps * epsilon);
  EXPECT_LT(turn.symplectic_defect, 16 * steps * epsilon);
  const auto growth = symplectic_eigenvalues(derivative_of_steps(hooke(Verlet{}, 1.0), {1, 0, 0, 1}, h, 20));
  const double lambda = std::exp(20 * std::acosh(1 + h * h / 2));
  ASSERT_EQ(growth.values.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(within(growth.values[i].real(), i % 2 == 0 ? lambda : 1 / lambda, 20 * 16 * epsilon * growth.norm));
  }
  EXPECT_LT(growth.pair_defect, 20 * 16 * epsilon * growth.norm * growth.norm);
}

TEST(Monodromy, KeplerPeriodHasEigenvaluesOne) {
  const auto make = []<class R>() { return KeplerForce<R>(R(1), Kepler<R>(R(1))); };
  const StepMapOf<KeplerForce, Stv4> map(make, Stv4{});
  const int steps = 2000;
  // a = 1, e = 0.3. All eigenvalues of the flow are 1, in Jordan blocks: perturbed by d they move by some root of d.
  const auto found = symplectic_eigenvalues(
      derivative_of_steps(map, {0.7, 0, 0, std::sqrt(1.3 / 0.7)}, 2 * std::acos(-1.0) / steps, steps));
  for (const auto& value : found.values) EXPECT_LT(std::abs(value - 1.0), 1e-3);
  EXPECT_LT(found.symplectic_defect, steps * 16 * epsilon * found.norm * found.norm);
  EXPECT_LT(found.pair_defect, 1e-5);
}

TEST(Monodromy, PairsOfAMatrixThatIsNotSymplectic) {
  const auto found = symplectic_eigenvalues({{2, 0}, {0, 1}});
  EXPECT_EQ(found.pair_defect, 1);
  EXPECT_EQ(found.symplectic_defect, 1);
  EXPECT_THROW((void)symplectic_eigenvalues({{std::nan(""), 0}, {0, 1}}), Error);
}

}  // namespace
}  // namespace hamflow
