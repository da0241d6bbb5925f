// The order conditions of the tables of saba, and the derivative of the Kepler drift.
//
// Seen from the Kepler motion a step kicks by e b_i B(c_i) at the times c_i, where the exact motion has e B(t) dt. With
// B(t) as a series in t both are sums over ordered products; they agree where the sums below are the integrals.
#include "hamflow/methods/kepler_tables.hpp"

#include <gtest/gtest.h>

#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/orbits/kepler_tangent.hpp"

namespace hamflow {
namespace {

struct Kicks {
  std::vector<Quad> at;
  std::vector<Quad> by;
};

Kicks kicks_of(const KeplerTable& table) {
  Kicks all;
  Quad time(0);
  for (std::size_t k = 0; k < table.kicks; ++k) {
    time += evaluate_number<Quad>(table.drifts_by[table.drift_index(k)]);
    all.at.push_back(time);
    all.by.push_back(evaluate_number<Quad>(table.kicks_by[table.kick_index(k)]));
  }
  time += evaluate_number<Quad>(table.drifts_by[table.drift_index(table.kicks)]);
  EXPECT_LT(abs(time - Quad(1)), Quad(1e-32)) << table.name;
  return all;
}

Quad power(const Quad& x, int n) {
  Quad product(1);
  for (int k = 0; k < n; ++k) product *= x;
  return product;
}

double linear_defect(const Kicks& k, int m) {
  Quad sum(0);
  for (std::size_t i = 0; i < k.at.size(); ++i) sum += k.by[i] * power(k.at[i], m);
  return static_cast<double>(abs(sum - Quad(1) / Quad(m + 1)));
}
/// Kicks of one time count half.
double square_defect(const Kicks& k, int m, int n) {
  Quad sum(0);
  for (std::size_t j = 0; j < k.at.size(); ++j) {
    for (std::size_t i = 0; i <= j; ++i) {
      const Quad part = k.by[i] * power(k.at[i], m) * k.by[j] * power(k.at[j], n);
      sum += i == j ? part / Quad(2) : part;
    }
  }
  return static_cast<double>(abs(sum - Quad(1) / Quad((m + 1) * (m + n + 2))));
}
double cube_defect(const Kicks& k, int l, int m, int n) {
  Quad sum(0);
  for (std::size_t i = 0; i < k.at.size(); ++i) {
    for (std::size_t j = i; j < k.at.size(); ++j) {
      for (std::size_t h = j; h < k.at.size(); ++h) {
        const Quad part = k.by[i] * power(k.at[i], l) * k.by[j] * power(k.at[j], m) * k.by[h] * power(k.at[h], n);
        const int share = i == j && j == h ? 6 : i == j || j == h ? 2 : 1;
        sum += part / Quad(share);
      }
    }
  }
  return static_cast<double>(abs(sum - Quad(1) / Quad((l + 1) * (l + m + 2) * (l + m + n + 3))));
}

TEST(KeplerTables, OrderConditions) {
  const auto check = [](std::size_t table, int p, int q, int r) {
    const KeplerTable& chosen = kepler_tables().at(table);
    const Kicks kicks = kicks_of(chosen);
    constexpr double tolerance = 1e-31;  // the roundings of up to 120 products
    for (int m = 0; m < p; ++m) EXPECT_LT(linear_defect(kicks, m), tolerance) << chosen.name << " " << m;
    EXPECT_GT(linear_defect(kicks, p), 1e-8) << chosen.name;
    double next = 0;
    for (int m = 0; m <= q; ++m) {
      for (int n = 0; m + n + 2 <= q + 1; ++n) {
        const double defect = square_defect(kicks, m, n);
        if (m + n + 2 <= q) {
          EXPECT_LT(defect, tolerance) << chosen.name << " " << m << " " << n;
        }
        next = std::max(next, m + n + 2 > q ? defect : 0);
      }
    }
    EXPECT_GT(next, 1e-8) << chosen.name;
    for (int l = 0; l <= r; ++l) {
      for (int m = 0; l + m + 3 <= r; ++m) {
        for (int n = 0; l + m + n + 3 <= r; ++n) EXPECT_LT(cube_defect(kicks, l, m, n), tolerance) << chosen.name;
      }
    }
  };
  check(0, 2, 2, 2);
  check(1, 4, 2, 2);
  check(2, 6, 2, 2);
  check(3, 8, 2, 2);
  check(4, 8, 4, 4);
  check(5, 8, 6, 4);
  check(6, 10, 6, 4);
}

/// Beside differences in quad, for ellipses, hyperbolas, many revolutions and both directions.
TEST(KeplerTangent, IsTheDerivative) {
  using D = Dual<double, 1>;
  for (const double t : {0.1, -0.3, 5.0, 100.0, -77.0}) {
    for (const double speed : {1.0, 1.3, 1.5, 0.4}) {
      for (std::size_t c = 0; c < 8; ++c) {
        Vector<D, 3> r{D(1.0), D(0.2), D(-0.1)};
        Vector<D, 3> v{D(0.1), D(speed), D(0.3)};
        D mu(1.0);
        D time(t);
        (c < 3 ? r[c] : c < 6 ? v[c - 3] : c == 6 ? mu : time).slope[0] = 1;
        KeplerIncrements<D, 3> found;
        ASSERT_EQ(kepler_drift(r, v, mu, time, found), Outcome::done);
        const auto moved = [&](double by) {
          const Quad step(by);
          const auto at = [&](const D& x) { return Quad(x.value) + step * Quad(x.slope[0]); };
          KeplerIncrements<Quad, 3> out;
          EXPECT_EQ(kepler_drift(Vector<Quad, 3>{at(r[0]), at(r[1]), at(r[2])},
                                 Vector<Quad, 3>{at(v[0]), at(v[1]), at(v[2])}, at(mu), at(time), out),
                    Outcome::done);
          return out;
        };
        constexpr double step = 0x1p-30;  // the difference has an error of 1e-18 times the third derivative
        const auto above = moved(step);
        const auto below = moved(-step);
        for (std::size_t k = 0; k < 3; ++k) {
          for (const auto& [slope, a, b] :
               {std::tuple{found.position[k].slope[0], above.position[k], below.position[k]},
                std::tuple{found.velocity[k].slope[0], above.velocity[k], below.velocity[k]}}) {
            const double exact = static_cast<double>((a - b) / Quad(2 * step));
            EXPECT_NEAR(slope, exact, 1e-10 * (1 + std::abs(t) * std::abs(exact))) << t << " " << speed << " " << c;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace hamflow
