// The tableau of DOP853 against the order conditions, one for each rooted tree, in 34 digits; then its order on
// nonlinear problems.   [HNW1993, II.2, theorem 2.13]
#include "hamflow/methods/dop853.hpp"

#include <map>
#include <string>

#include "../support/near.hpp"
#include "engine/reference_flow.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/problems/henon_heiles.hpp"

namespace hamflow {
namespace {

__extension__ typedef __float128 Quad;

/// Digit by digit, to a few roundings.
Quad quad(std::string_view text) {
  Quad value = 0;
  Quad unit = 1;
  bool fraction = false;
  for (const char c : text) {
    if (c == '.') fraction = true;
    if (c < '0' || c > '9') continue;
    value = value * 10 + (c - '0');
    if (fraction) unit *= 10;
    if (value > Quad(1e33L)) break;  // an integer as long as the mantissa
  }
  return text.front() == '-' ? -value / unit : value / unit;
}

constexpr std::size_t stages = dop853::stages;
using Row = std::array<Quad, stages>;
struct Tableau {
  std::array<Row, stages> a{};
  Row b{}, fifth{}, third{};
};

Tableau tableau() {
  Tableau t;
  for (const auto& e : dop853::a) t.a[e.row][e.column] = quad(e.value);
  for (const auto& w : dop853::b) t.b[w.stage] = quad(w.value);
  t.fifth = t.third = t.b;
  for (const auto& w : dop853::error5) t.fifth[w.stage] -= quad(w.value);
  for (const auto& w : dop853::error3) t.third[w.stage] -= quad(w.value);
  return t;
}

/// A rooted tree: its elementary weights at the stages, and its density gamma.
struct Tree {
  Row weight;
  int density;
};
/// All rooted trees with that many nodes. Each is a forest of subtrees, in an order by size and number, under a root.
std::vector<Tree> rooted_trees(const Tableau& t, int nodes) {
  std::vector<std::vector<Tree>> by_size(static_cast<std::size_t>(nodes) + 1);
  Tree leaf{{}, 1};
  leaf.weight.fill(1);
  by_size[1] = {leaf};
  for (int n = 2; n <= nodes; ++n) {
    const auto grow = [&](const auto& self, const Tree& root, int left, int size, std::size_t from) -> void {
      if (left == 0) {
        by_size[static_cast<std::size_t>(n)].push_back({root.weight, root.density * n});
        return;
      }
      for (int s = size; s <= left; ++s) {
        const auto& subtrees = by_size[static_cast<std::size_t>(s)];
        for (std::size_t k = s == size ? from : 0; k < subtrees.size(); ++k) {
          Tree more = root;
          more.density *= subtrees[k].density;
          for (std::size_t i = 0; i < stages; ++i) {
            Quad sum = 0;
            for (std::size_t j = 0; j < i; ++j) sum += t.a[i][j] * subtrees[k].weight[j];
            more.weight[i] *= sum;
          }
          self(self, more, left - s, s, k);
        }
      }
    };
    grow(grow, leaf, n - 1, 1, 0);
  }
  return by_size[static_cast<std::size_t>(nodes)];
}

/// The largest defect sum_i b_i Phi_i(t) - 1/gamma(t) among the trees with that many nodes.
double defect(const Tableau& t, const Row& weights, int nodes) {
  Quad most = 0;
  for (const Tree& tree : rooted_trees(t, nodes)) {
    Quad sum = 0;
    for (std::size_t i = 0; i < stages; ++i) sum += weights[i] * tree.weight[i];
    Quad d = sum - Quad(1) / tree.density;
    if (d < 0) d = -d;
    if (!(d <= most)) most = d;
  }
  return static_cast<double>(most);
}

// The terms of a condition reach 30 (b_i up to 6, weights of stages up to 5 on the way), a few dozen of them, in a
// number of 113 bits: 2^-112 * 30 * 30 = 2e-31. The published 30 digits leave 6e-29.
constexpr double quad_rounding = 1e-30;

TEST(Dop853Tableau, meets_all_200_order_conditions_of_order_8) {
  const Tableau t = tableau();
  std::size_t count = 0;
  for (int n = 1; n <= 8; ++n) {
    count += rooted_trees(t, n).size();
    EXPECT_LE(defect(t, t.b, n), quad_rounding) << "trees with " << n << " nodes";
  }
  EXPECT_EQ(count, 200u);  // 1 + 1 + 2 + 4 + 9 + 20 + 48 + 115
  EXPECT_GE(defect(t, t.b, 9), 1e-7) << "order 9 is more than it claims";
}

TEST(Dop853Tableau, estimators_have_orders_5_and_3) {
  const Tableau t = tableau();
  for (int n = 1; n <= 5; ++n) EXPECT_LE(defect(t, t.fifth, n), quad_rounding) << n;
  EXPECT_GE(defect(t, t.fifth, 6), 1e-5);
  for (int n = 1; n <= 3; ++n) EXPECT_LE(defect(t, t.third, n), quad_rounding) << n;
  EXPECT_GE(defect(t, t.third, 4), 1e-5);
}

TEST(Dop853Tableau, a_wrong_digit_is_seen) {
  for (const auto& e : dop853::a) {
    Tableau t = tableau();
    t.a[e.row][e.column] += Quad(1e-24L);
    double most = 0;
    for (int n = 1; n <= 8; ++n) most = std::max(most, defect(t, t.b, n));
    EXPECT_GE(most, 2 * quad_rounding) << "a(" << e.row << ", " << e.column << ")";
  }
}

TEST(Dop853Tableau, holds_60_digits_or_more) {
  EXPECT_GE(dop853::digits, 60);
  for (const auto& e : dop853::a) EXPECT_GE(e.value.size(), 60u + 2u);
}

/// log2 of the ratio of the errors with steps h and h/2, over 4 halvings, the middle one.
template <class P>
long double slope(const P& problem, const Vector<long double, 2>& q, const Vector<long double, 2>& p, long double time,
                  int steps) {
  using A = Plain<long double>;
  const auto exact = reference_flow(problem, Vector<long double, 4>{q[0], q[1], p[0], p[1]}, time);
  std::vector<long double> errors;
  for (int halving = 0; halving < 5; ++halving, steps *= 2) {
    auto method = Dop853{{.fixed = true}}.bind<P, A>(problem);
    PhasePoint<A, 2> z;
    z.store(q, p);
    for (int i = 0; i < steps; ++i) EXPECT_EQ(method.step(problem, time / steps, z), Outcome::done);
    EXPECT_EQ(Separable<P> ? method.effort().force : method.effort().gradient, 12 * steps);
    errors.push_back(
        std::hypot(std::hypot(z.q[0] - exact[0], z.q[1] - exact[1]), std::hypot(z.p[0] - exact[2], z.p[1] - exact[3])));
  }
  long double sum = 0;
  for (std::size_t i = 0; i + 1 < errors.size(); ++i) sum += std::log2(errors[i] / errors[i + 1]);
  return sum / 4;
}

// Two-sided: an error of 8 % of the slope is what the next power of h does over these four halvings.
TEST(Dop853, has_order_8_on_henon_heiles) {
  EXPECT_NEAR(static_cast<double>(slope(HenonHeiles<long double>(), {0.1L, 0.2L}, {0.4L, 0.15L}, 3.7L, 5)), 8, 0.5);
}
TEST(Dop853, has_order_8_on_the_double_pendulum) {
  EXPECT_NEAR(
      static_cast<double>(slope(DoublePendulumNonlinearAbsolute<long double>(), {0.5L, -0.3L}, {1.0L, 0.4L}, 1.3L, 12)),
      8, 0.5);
}

}  // namespace
}  // namespace hamflow
