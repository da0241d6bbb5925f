// Gauss rules and small linear systems.
#include "../support/near.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/detail/numerics/dense.hpp"
#include "hamflow/detail/numerics/lu_factors.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow {
namespace {

template <class R>
R integral_of_power(const GaussRule<R>& rule, int power) {
  R sum(0);
  for (std::size_t l = 0; l < rule.c.size(); ++l) sum += rule.b[l] * std::pow(rule.c[l], R(power));
  return sum;
}

template <class R>
class GaussRuleIn : public ::testing::Test {};
using Numbers = ::testing::Types<double, long double>;
TYPED_TEST_SUITE(GaussRuleIn, Numbers);

TYPED_TEST(GaussRuleIn, IsExactUpToDegreeTwiceThePointsMinusOne) {
  using R = TypeParam;
  for (int s = 1; s <= most_gauss_points; ++s) {
    const auto& rule = gauss_rule<R>(s);
    for (int power = 0; power < 2 * s; ++power) {
      // s products are added; c^power carries the rounding of c `power` times.
      const R bound = std::numeric_limits<R>::epsilon() * R(s + 2);
      EXPECT_TRUE(test::within(integral_of_power(rule, power), R(1) / R(power + 1), bound))
          << s << " points, x^" << power;
    }
  }
}

TYPED_TEST(GaussRuleIn, IsWrongAtTwiceThePointsByTheKnownAmount) {
  using R = TypeParam;
  // int x^(2s) - rule = (s!)^4/((2s + 1) ((2s)!)^2), the square norm of the monic Legendre polynomial on [0, 1].
  R expected = R(1) / R(12);
  for (int s = 1; expected > 1e6L * std::numeric_limits<R>::epsilon(); ++s) {
    const R error = R(1) / R(2 * s + 1) - integral_of_power(gauss_rule<R>(s), 2 * s);
    EXPECT_TRUE(test::within(error, expected, 1e-5L * expected)) << s << " points";
    const R k(s + 1);
    expected *=
        k * k * k * k * R(2 * s + 1) / (R(2 * s + 3) * (R(2 * s + 1) * R(2 * s + 2)) * (R(2 * s + 1) * R(2 * s + 2)));
  }
}

TYPED_TEST(GaussRuleIn, IsSymmetricBitForBitAndAscending) {
  for (int s = 1; s <= most_gauss_points; ++s) {
    const auto& rule = gauss_rule<TypeParam>(s);
    const auto n = static_cast<std::size_t>(s);
    ASSERT_EQ(rule.c.size(), n);
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_EQ(rule.b[i], rule.b[n - 1 - i]);
      EXPECT_EQ(rule.offset[i], -rule.offset[n - 1 - i]);
      EXPECT_TRUE(test::within(rule.c[i], TypeParam(0.5) + rule.offset[i], std::numeric_limits<TypeParam>::epsilon()));
      if (i > 0) {
        EXPECT_LT(rule.c[i - 1], rule.c[i]);
      }
    }
  }
}

TEST(GaussRule, RefusesNumbersOfPointsThatItDoesNotHave) {
  EXPECT_EQ(test::message_of<Error>([] { (void)gauss_rule<double>(0); }), "a Gauss rule has 1 to 64 points, not 0");
  EXPECT_EQ(test::message_of<Error>([] { (void)gauss_rule<double>(65); }), "a Gauss rule has 1 to 64 points, not 65");
}

template <std::size_t N>
void solve_random_systems() {
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    Matrix<double, N> m{};
    Vector<double, N> x{};
    std::uint64_t k = 1000 * trial;
    for (std::size_t i = 0; i < N; ++i) {
      x[i] = counter_uniform(11, k++);
      for (std::size_t j = 0; j < N; ++j) m[i][j] = counter_uniform(11, k++);
      m[i][i] += 4.0;  // well conditioned: diagonally dominant up to N = 4, at worst condition 50 above
    }
    const Vector<double, N> b = apply(m, x);
    const Vector<double, N> found = solve(m, b);
    const Matrix<double, N> product_with_inverse = [&] {
      const Matrix<double, N> r = inverse(m);
      Matrix<double, N> product{};
      for (std::size_t j = 0; j < N; ++j) {
        Vector<double, N> column{};
        for (std::size_t i = 0; i < N; ++i) column[i] = r[i][j];
        const Vector<double, N> image = apply(m, column);
        for (std::size_t i = 0; i < N; ++i) product[i][j] = image[i];
      }
      return product;
    }();
    const double bound = 50 * 8 * static_cast<double>(N * N) * test::epsilon;
    for (std::size_t i = 0; i < N; ++i) {
      EXPECT_TRUE(test::within(found[i], x[i], bound)) << N << " unknowns";
      for (std::size_t j = 0; j < N; ++j) EXPECT_TRUE(test::within(product_with_inverse[i][j], i == j ? 1 : 0, bound));
    }
  }
}

TEST(Dense, SolvesAndInverts) {
  solve_random_systems<1>();
  solve_random_systems<2>();
  solve_random_systems<3>();
  solve_random_systems<4>();
  solve_random_systems<6>();
}

TEST(Dense, ASingularMatrixGivesEntriesThatAreNotFinite) {
  const Vector<double, 2> x = solve(Matrix<double, 2>{Vector<double, 2>{1, 2}, Vector<double, 2>{2, 4}}, {1, 1});
  EXPECT_FALSE(std::isfinite(x[0]) && std::isfinite(x[1]));
  EXPECT_FALSE(std::isfinite(solve(Matrix<double, 1>{Vector<double, 1>{0}}, {1})[0]));
}

/// Few equations with one right side are solved by hand; those with two, which are the same here, by Eigen.
template <class R>
void expect_bits_of_eigen(std::size_t size, std::uint64_t seed) {
  std::uint64_t drawn = 0;
  const auto draw = [&] {
    const double x = counter_uniform(seed, drawn++);
    return static_cast<R>(seed % 3 == 0 ? std::round(2 * x) : x);  // with equal pivots, zeros and singular matrices
  };
  std::vector<R> m(size * size);
  std::vector<R> one(size);
  for (R& x : m) x = draw();
  for (R& x : one) x = draw();
  std::vector<R> two(2 * size);
  for (std::size_t i = 0; i < size; ++i) two[2 * i] = two[2 * i + 1] = one[i];
  detail::solve_large(m.data(), one.data(), size, 1);
  detail::solve_large(m.data(), two.data(), size, 2);
  for (std::size_t i = 0; i < size; ++i) {
    const bool same = one[i] == two[2 * i] && std::signbit(one[i]) == std::signbit(two[2 * i]);
    EXPECT_TRUE(same || (std::isnan(one[i]) && std::isnan(two[2 * i]))) << size << " equations of seed " << seed;
  }
}

TEST(Dense, FewEquationsAreSolvedWithTheBitsOfMany) {
  for (std::size_t size = 1; size <= 6; ++size) {
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
      expect_bits_of_eigen<double>(size, seed);
      expect_bits_of_eigen<long double>(size, seed);
    }
  }
}

/// Every row is solved to the rounding of its own terms, whatever the units of rows are: with pivots that may be a
/// sixteenth of the largest entry the factors grow by at most 17 a column.
TEST(Dense, FactorsSolveSystemsWhoseRowsHaveUnitsOfTheirOwn) {
  for (std::size_t size = 1; size <= 4; ++size) {
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
      std::uint64_t drawn = 0;
      const auto draw = [&] { return counter_uniform(seed, drawn++); };
      Matrix<double, dynamic> m = zero_matrix<double, dynamic>(Vector<double, dynamic>(size));
      Vector<double, dynamic> b(size);
      for (std::size_t i = 0; i < size; ++i) {
        const double unit = std::exp2(std::round(20 * draw()));
        for (std::size_t j = 0; j < size; ++j) m[i][j] = unit * draw();
        b[i] = unit * draw();
      }
      if (seed % 4 == 0) m[0][0] = 0;  // a row that has to be exchanged
      if (seed % 4 == 0 && size == 1) continue;
      LuFactors<double> factors;
      factors.factor(m);
      const Vector<double, dynamic> x = factors.solve(b);
      const double growth = std::pow(17, static_cast<double>(size));
      for (std::size_t i = 0; i < size; ++i) {
        Quad rest = b[i];
        double largest = std::abs(b[i]);
        for (std::size_t j = 0; j < size; ++j) {
          rest -= Quad(m[i][j]) * Quad(x[j]);
          largest = std::max(largest, std::abs(m[i][j]));
        }
        EXPECT_LE(std::abs(static_cast<double>(rest)),
                  3 * static_cast<double>(size) * test::epsilon * growth * largest * (1 + max_norm(x)))
            << size << " equations of seed " << seed;
      }
    }
  }
}

TEST(Dense, MaxNormIsTheLargestAbsoluteEntry) { EXPECT_EQ(max_norm(Vector<double, 3>{1, -3, 2}), 3); }

}  // namespace
}  // namespace hamflow
