// What each arithmetic promises of `add`.
#include <bit>

#include "../support/near.hpp"
#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/run/digits.hpp"
#include "hamflow/methods/compositions/kahan_li8.hpp"
#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/compositions/verlet.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/problems/potentials/kepler.hpp"

namespace hamflow {
namespace {

static_assert(Arithmetic<Plain<double>> && Arithmetic<Plain<long double>>);
static_assert(Arithmetic<Compensated<double>> && Arithmetic<Lattice>);
static_assert(Lattice::exact_undo && !Plain<double>::exact_undo && !Compensated<double>::exact_undo);

TEST(Compensated, KeepsWhatPlainAdditionLoses) {
  Plain<double> plain;
  Compensated<double> compensated;
  auto a = plain.position.store(1.0);
  auto b = compensated.position.store(1.0);
  constexpr int times = 1'000'000;
  const double small = 0x1p-60;  // below half a unit of 1
  for (int i = 0; i < times; ++i) {
    plain.position.add(a, small);
    compensated.position.add(b, small);
  }
  EXPECT_EQ(plain.position.read(a), 1.0);
  EXPECT_EQ(compensated.position.read(b) + b.low, 1.0 + times * small);
}

TEST(Compensated, TheTwoPartsAreTheExactSumAfterOneAddition) {
  Compensated<double> arithmetic;
  for (std::uint64_t k = 0; k < 2000; ++k) {
    const double x = std::ldexp(counter_uniform(5, 2 * k), static_cast<int>(k % 41) - 20);
    const double y = counter_uniform(5, 2 * k + 1);
    auto s = arithmetic.position.store(x);
    arithmetic.position.add(s, y);
    // x + y needs at most 53 + 21 bits: more than a long double has, so compare the parts with the two-sum of x and y
    // in the order of magnitude, which is exact by Dekker's theorem [Dekker1971].
    const double large = std::fabs(x) > std::fabs(y) ? x : y;
    const double little = std::fabs(x) > std::fabs(y) ? y : x;
    const double sum = x + y;
    EXPECT_EQ(s.high, sum);
    EXPECT_EQ(s.low, little - (sum - large));
  }
}

// Zeros of both signs and the smallest numbers, too: states are compared by their bits.
TEST(Compensated, AddingSoonerIsAddingBitForBit) {
  using Axis = Compensated<double>::Axis;
  const auto expect_alike = [](const Compensated<double>::Stored& s, double r) {
    auto a = s;
    auto b = s;
    Axis::add(a, r);
    Axis::add_without_branch(b, r);
    ASSERT_EQ(std::bit_cast<std::uint64_t>(a.high), std::bit_cast<std::uint64_t>(b.high)) << s.high << ' ' << r;
    ASSERT_EQ(std::bit_cast<std::uint64_t>(a.low), std::bit_cast<std::uint64_t>(b.low))
        << s.high << " + " << s.low << " + " << r;
  };
  const double eps = std::numeric_limits<double>::epsilon();
  std::vector<double> corners;
  for (const double x :
       {0.0, 4.9e-324, 3 * 4.9e-324, 2.3e-308, 1e-20, eps / 2, eps, 1 - eps / 2, 1.0, 1 + eps, 3.0, 1e20}) {
    corners.push_back(x);
    corners.push_back(-x);
  }
  for (const double high : corners) {
    for (const double low : corners) {
      for (const double r : corners) expect_alike({high, low}, r);
    }
  }
  const auto any = [](std::uint64_t k) {
    const double x = counter_uniform(7, 2 * k) - 0.5;
    return std::ldexp(x, static_cast<int>(120 * counter_uniform(7, 2 * k + 1)) - 60);
  };
  for (std::uint64_t k = 0; k < 100'000; ++k) {
    expect_alike({any(3 * k), any(3 * k + 1) * eps}, any(3 * k + 2));
  }
}

// In a step the errors of sums are found late (Splitting::step); what is found must be the same.
template <const CompositionTable& table>
void expect_step_of_single_actions() {
  using A = Compensated<double>;
  const CentralForce<double, Kepler> problem(2, Kepler<double>(1));
  const double h = 0.1;
  const Composition<table> recipe;
  auto method = recipe.template bind<CentralForce<double, Kepler>, A>(problem);
  const auto c = sequence_of<double>(table, StartsWith::kick).coefficients;
  PhasePoint<A, 2> z;
  z.store({1, 0}, {0, 1.7});
  PhasePoint<A, 2> single = z;
  for (int step = 0; step < 1000; ++step) {
    ASSERT_EQ(method.step(problem, h, z), Outcome::done);
    for (std::size_t i = 0; i < c.size(); ++i) {
      Vector<double, 2> increment{};
      if (i % 2 == 0) {
        scaled_force(problem, h * c[i], single.positions(), increment);
        single.push(increment);
      } else {
        scaled_velocity(problem, h * c[i], single.momenta(), increment);
        single.move(increment);
      }
    }
    for (std::size_t i = 0; i < 2; ++i) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(z.q[i].high), std::bit_cast<std::uint64_t>(single.q[i].high)) << step;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(z.q[i].low), std::bit_cast<std::uint64_t>(single.q[i].low)) << step;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(z.p[i].high), std::bit_cast<std::uint64_t>(single.p[i].high)) << step;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(z.p[i].low), std::bit_cast<std::uint64_t>(single.p[i].low)) << step;
    }
  }
}
TEST(Compensated, AStepIsItsKicksAndDriftsOneByOne) {
  expect_step_of_single_actions<compositions::verlet>();
  expect_step_of_single_actions<compositions::stv4>();
  expect_step_of_single_actions<compositions::kahan_li8>();
}

TEST(Compensated, AMillionIncrementsRoundLikeTheIncrements) {
  Compensated<double> arithmetic;
  auto s = arithmetic.position.store(0.0);
  double plain = 0;
  long double exact = 0;
  constexpr int times = 1'000'000;
  for (std::uint64_t k = 0; k < times; ++k) {
    const double r = 0.1 * (1 + counter_uniform(6, k));
    arithmetic.position.add(s, r);
    plain += r;
    exact += r;  // 64 bits: its own error is 10^6 steps of a walk at 1e5 * 5e-20
  }
  // Each addition rounds r + low to 53 bits of r: a walk of 1e-17 per step, 1e-14 after 10^6; half a unit of the sum
  // besides. Plain addition rounds at the size of the sum.
  EXPECT_TRUE(test::within(s.high, exact, 1e5L * test::epsilon));
  EXPECT_GT(std::fabs(plain - static_cast<double>(exact)), 20 * 1e5 * test::epsilon);
}

TEST(Lattice, RoundsToNearestTiesToEvenAndOddly) {
  Lattice lattice;
  lattice.position.set_unit(1.0);
  const std::pair<double, std::int64_t> rounded[] = {{0.4, 0}, {0.5, 0}, {0.6, 1}, {1.5, 2},
                                                     {2.5, 2}, {3.5, 4}, {7.49, 7}};
  for (const auto& [x, n] : rounded) {
    EXPECT_EQ(lattice.position.store(x), n);
    EXPECT_EQ(lattice.position.store(-x), -n);
  }
  for (std::uint64_t k = 0; k < 10000; ++k) {
    const double x = 1000 * counter_uniform(7, k);
    EXPECT_EQ(lattice.position.store(-x), -lattice.position.store(x));
  }
}

TEST(Lattice, EveryAdditionIsUndoneExactly) {
  Lattice lattice;
  std::int64_t s = lattice.position.store(0.3);
  const std::int64_t before = s;
  for (std::uint64_t k = 0; k < 10000; ++k) lattice.position.add(s, counter_uniform(8, k));
  EXPECT_NE(s, before);
  for (std::uint64_t k = 10000; k-- > 0;) lattice.position.add(s, -counter_uniform(8, k));
  EXPECT_EQ(s, before);
  EXPECT_FALSE(lattice.lost());
  // Plain addition does not return.
  double x = 0.3;
  for (std::uint64_t k = 0; k < 10000; ++k) x += counter_uniform(8, k);
  for (std::uint64_t k = 10000; k-- > 0;) x -= counter_uniform(8, k);
  EXPECT_NE(x, 0.3);
}

TEST(Lattice, UnitsArePowersOfTwoForPositionsAndMomentaApart) {
  Lattice lattice;
  lattice.position.set_unit(0x1p-30);
  lattice.momentum.set_unit(0x1p-10);
  EXPECT_EQ(lattice.position.store(1.0), std::int64_t{1} << 30);
  EXPECT_EQ(lattice.momentum.store(-3.0), -3 * (std::int64_t{1} << 10));
  EXPECT_EQ(lattice.position.read(std::int64_t{3} << 29), 1.5);
  EXPECT_EQ(lattice.momentum.read(1), 0x1p-10);
}

TEST(Lattice, LeavingTheRangeIsFoundAndChangesNothing) {
  const double limit = 0x1p62 * Lattice::default_unit;  // 1024
  const auto lost_after = [](double start, double step) {
    Lattice lattice;
    std::int64_t s = lattice.position.store(start);
    EXPECT_FALSE(lattice.lost());
    const std::int64_t before = s;
    lattice.position.add(s, step);
    if (lattice.lost()) {
      EXPECT_EQ(s, before);
    }
    return lattice.lost();
  };
  EXPECT_FALSE(lost_after(limit / 4, limit / 4));
  EXPECT_TRUE(lost_after(0, limit));
  EXPECT_TRUE(lost_after(0, -limit));
  EXPECT_TRUE(lost_after(1, std::numeric_limits<double>::infinity()));
  EXPECT_TRUE(lost_after(1, std::numeric_limits<double>::quiet_NaN()));

  Lattice lattice;  // a sum that overflows though both parts are inside
  std::int64_t s = lattice.momentum.store(0.49 * limit);
  lattice.momentum.add(s, 0.49 * limit);
  EXPECT_FALSE(lattice.lost());
  const std::int64_t before = s;
  lattice.momentum.add(s, 0.49 * limit);
  EXPECT_TRUE(lattice.lost());
  EXPECT_EQ(s, before);
  lattice.momentum.add(s, -0.2 * limit);
  EXPECT_TRUE(lattice.lost()) << "the flag stays";
}

TEST(Lattice, TheRangeIsSymmetricSoThatMomentaCanBeNegated) {
  Lattice lattice;
  std::int64_t s = -(std::int64_t{1} << 62);
  lattice.momentum.set_unit(1.0);
  lattice.momentum.add(s, -0x1.fffffffffffffp61);
  std::int64_t least = INT64_MIN + 1;
  lattice.momentum.add(least, -1.0);
  EXPECT_TRUE(lattice.lost());
  EXPECT_EQ(least, INT64_MIN + 1);
  EXPECT_EQ(Lattice::Axis::negated(least), INT64_MAX);
}

/// Also where QD goes by the logarithm of a negative number, divides infinity by infinity, reads beyond its tables, or
/// knows no number at all.
TEST(DoubleDouble, FunctionsHaveTheValuesAndTheEdgesOfThoseOfDouble) {
  using Traits = ExtendedTraits<dd_real>;
  const double edges[] = {-800, -3,   -2.5, -1,       -0.3,      -0.0, 0.0, 0.3,  1,     2,
                          2.5,  64.0, 800,  INFINITY, -INFINITY, NAN,  1e9, 1e25, 1e300, 1e-300};
  const auto agree = [](const dd_real& found, double wanted) {
    if (std::isnan(wanted)) return std::isnan(found.x[0]);
    if (wanted == 0 || std::isinf(wanted)) return found.x[0] == wanted;
    return std::abs(found.x[0] - wanted) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(wanted);
  };
  using Two = std::pair<dd_real (*)(const dd_real&), double (*)(double)>;
  const Two functions[] = {{Traits::sqrt, std::sqrt}, {Traits::exp, std::exp},   {Traits::log, std::log},
                           {Traits::sin, std::sin},   {Traits::cos, std::cos},   {Traits::tan, std::tan},
                           {Traits::asin, std::asin}, {Traits::acos, std::acos}, {Traits::atan, std::atan},
                           {Traits::sinh, std::sinh}, {Traits::cosh, std::cosh}, {Traits::tanh, std::tanh}};
  for (const double x : edges) {
    for (std::size_t k = 0; k < std::size(functions); ++k) {
      EXPECT_TRUE(agree(functions[k].first(dd_real(x)), functions[k].second(x))) << "function " << k << " of " << x;
    }
    for (const double y : edges) {
      if ((y == 0 && std::signbit(y)) || (x == 0 && std::signbit(x))) continue;  // QD has one zero
      EXPECT_TRUE(agree(Traits::atan2(dd_real(y), dd_real(x)), std::atan2(y, x))) << y << " beside " << x;
    }
    for (const double y : {-3.0, -2.5, -1.0, 0.0, 0.5, 1.0, 2.0, 3.0, 7.0, 100.0, 101.0}) {
      EXPECT_TRUE(agree(Traits::pow(dd_real(x), dd_real(y)), std::pow(x, y))) << x << " to the power " << y;
    }
  }
  // To its own digits: (-1.1)^7 of the double 1.1, as a product.
  const dd_real x(-1.1);
  const dd_real product = x * x * x * x * x * x * x;
  EXPECT_LT(std::abs((Traits::pow(x, dd_real(7.0)) - product).x[0]), 64 * 0x1p-104);
}

/// The text of x in its fixed length, read again.
dd_real written_and_read(const dd_real& x, std::size_t& longest) {
  const std::string text = written_digits(DoubleDouble(x));
  longest = std::max(longest, text.size());
  return evaluate_number<DoubleDouble>(text).value;
}

TEST(DoubleDouble, DigitsReadBackHoweverFarApartTheHalvesAre) {
  const auto from_1_to_2 = [](std::uint64_t k) { return 1.5 + 0.5 * counter_uniform(20, k); };
  std::uint64_t at = 0;
  std::size_t longest = 0;
  for (int gap = 0; gap <= 260; ++gap) {  // zeros between the halves: they span 108 + gap bits
    for (int i = 0; i < 40; ++i) {
      const int exponent = static_cast<int>(at % 600) - 300;
      const double high = std::ldexp(from_1_to_2(at++), exponent);
      const double part = from_1_to_2(at++) * (i % 2 == 0 ? 1 : -1);
      const double low = gap == 260 ? 0 : std::ldexp(part, std::ilogb(high) - 55 - gap);
      const dd_real x(i % 3 == 0 ? -high : high, low);
      ASSERT_EQ(x.x[0] + x.x[1], x.x[0]);
      const dd_real y = written_and_read(x, longest);
      if (gap <= 212 || gap == 260) {
        ASSERT_EQ(y.x[0], x.x[0]);
        ASSERT_EQ(y.x[1], x.x[1]) << gap;
      }
    }
  }
  EXPECT_LE(longest, longest_digits("double-double"));
  EXPECT_GT(longest, longest_digits("double-double") - 3);
  for (const double x : {0.0, 1.0, 0.1, 0x1p-1074, std::numeric_limits<double>::max()}) {
    const dd_real y = written_and_read(dd_real(x), longest);
    EXPECT_EQ(y.x[0], x);
    EXPECT_EQ(y.x[1], 0);
  }
}

TEST(Digits, HaveALengthThatHoldsEveryNumber) {
  EXPECT_EQ(longest_digits("double"), 0U);
  EXPECT_EQ(longest_digits("lattice"), 0U);
  if (!has_quad_and_mp) return;
  const Quad smallest(std::numeric_limits<Quad>::min() * std::numeric_limits<Quad>::epsilon());
  EXPECT_LE(written_digits(-smallest / Quad(3) * Quad(3)).size(), longest_digits("quad"));
  EXPECT_LE(written_digits(-std::numeric_limits<Quad>::max()).size(), longest_digits("quad"));
  EXPECT_GE(longest_digits("mp(50)"), 50U + 24);
  EXPECT_LT(longest_digits("mp(50)"), 50U + 28);
}

TEST(Digits, DifferencesAreTakenBeforeTheyAreRounded) {
  const std::vector<long double> found = differences_from_first(
      {"-0.25", "-0.2500000000000000000000000000000000000012", "-0.24999999999999999999999999999999", "1e-4000"});
  EXPECT_EQ(found[0], 0);
  EXPECT_TRUE(test::within(static_cast<double>(found[1] / -1.2e-39L), 1, 4 * test::epsilon));
  EXPECT_TRUE(test::within(static_cast<double>(found[2] / 1e-32L), 1, 4 * test::epsilon));
  EXPECT_EQ(found[3], 0.25L);
}

TEST(PhasePoint, StoresReadsMovesAndNegates) {
  PhasePoint<Plain<double>, 2> z;
  z.store({1, 2}, {3, 4});
  z.move(0.5, {2, 4});
  z.push(2.0, {1, -1});
  EXPECT_EQ(z.positions(), (Vector<double, 2>{2, 4}));
  EXPECT_EQ(z.momenta(), (Vector<double, 2>{5, 2}));
  z.negate_momenta();
  EXPECT_EQ(z.momenta(), (Vector<double, 2>{-5, -2}));
  EXPECT_EQ(z.positions(), (Vector<double, 2>{2, 4}));
}

}  // namespace
}  // namespace hamflow
