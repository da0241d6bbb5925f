// [Sonnleitner2010], chapter 2: the table of properties (page 64), the variant of Stoermer-Verlet (53), five factors
// and order 6 (64), and the force evaluations of a step (70). What verify measures of a method is put beside the text.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "../experiment.hpp"
#include "../trajectories.hpp"
#include "hamflow/verify/measure.hpp"

namespace hamflow::reproduction {

namespace sonnleitner_methods {

PropertyRow measured(const std::string& method) {
  const MethodSpec spec = parse_method(method);
  return measure_method(spec, default_regions(spec));
}

/// Of several problems: a property that is missing on one is missing; 1, 0, or no number where that is unclear.
double found(const PropertyRow& row, const std::function<Finding(const Measurement&)>& property) {
  bool unclear = false;
  for (const Measurement& one : row.on) {
    const Finding finding = property(one);
    if (finding == Finding::no) return 0;
    unclear = unclear || finding == Finding::unclear;
  }
  return unclear ? std::nan("") : 1;
}

/// A row of the table: explicit, symplectic, weakly reversible, symmetric, reversible, and the order.
struct Row {
  const char* method;
  std::array<int, 5> has;
  int order;
};
constexpr std::array<Row, 5> table{{{"euler", {1, 0, 1, 0, 0}, 1},
                                    {"euler-a", {1, 1, 1, 0, 0}, 1},
                                    {"euler-b", {1, 1, 1, 0, 0}, 1},
                                    {"verlet", {1, 1, 1, 1, 1}, 2},
                                    {"stv4", {1, 1, 1, 1, 1}, 4}}};

void claim_row(Study& study, const Row& row, const std::string& page) {
  study.breathe();
  const PropertyRow found_row = measured(row.method);
  const std::array<double, 5> has{found(found_row, [](const Measurement& m) { return m.cost.explicit_step; }),
                                  found(found_row, [](const Measurement& m) { return m.symplectic.holds; }),
                                  found(found_row, [](const Measurement& m) { return m.weakly_reversible.holds; }),
                                  found(found_row, [](const Measurement& m) { return m.symmetric.holds; }),
                                  found(found_row, [](const Measurement& m) { return m.reversible.holds; })};
  double different = 0;
  std::string texts;
  for (std::size_t i = 0; i < has.size(); ++i) {
    different += std::abs(has[i] - row.has[i]);
    texts += (texts.empty() ? "" : ", ") + std::string(row.has[i] != 0 ? "yes" : "no");
  }
  double slope_off = 0;
  std::string slopes;
  for (const Measurement& one : found_row.on) {
    slope_off = std::max(slope_off, std::abs(one.order.slope - row.order));
    slopes += fmt::format("{}{:.3f}", slopes.empty() ? "" : ", ", one.order.slope);
  }
  study.claim(
      {fmt::format("properties_{}", row.method),
       fmt::format("{}: explicit, symplectic, weakly reversible, symmetric, reversible", row.method), texts, page},
      none_of("properties of five that were measured otherwise"),
      {{different, 0, "hamflow verify, pendulum and henon-heiles"}});
  study.claim(
      {fmt::format("order_{}", row.method), fmt::format("{}: order", row.method), std::to_string(row.order), page},
      at_most(OrderMeasurement::tolerance, "of the slope of the error over four halvings of the step"),
      {{slope_off, 0, "slopes " + slopes}});
}

double evaluations(const PropertyRow& row) {
  double most = 0;
  for (const Measurement& one : row.on) most = std::max(most, one.cost.force);
  return most;
}

void properties(Study& study) {
  for (const Row& row : table) claim_row(study, row, "64");
  claim_row(study, {"rk4", {1, 0, 1, 0, 0}, 4}, "30, 41, 64");
  // The closed form of page 54 and the rounded one of the listing, page 73.
  const long double root = std::cbrt(4.0L), alpha = root / (2 * (root - 1)), beta = 1 / (1 - root);
  study.claim({"alpha", "alpha_0 of the triple composition", "1.35120719195966", "63, 73"},
              as_printed("1.35120719195966"), {{static_cast<double>(alpha), 0x1p-52, "closed form"}});
  study.claim({"beta", "beta_0 of the triple composition", "-1.70241438391932", "63, 73"},
              as_printed("-1.70241438391932"), {{static_cast<double>(beta), 0x1p-52, "closed form"}});
}

void variant(Study& study) {
  claim_row(study, {"verlet-dkd", {1, 1, 1, 1, 1}, 2}, "53");
  claim_row(study, {"stv4-dkd", {1, 1, 1, 1, 1}, 4}, "53");
  study.claim({"one", "the variant needs one force evaluation a step", "1"}, as_printed("1"),
              {{evaluations(measured("verlet-dkd")), 0.01, "evaluations per step of verlet-dkd"}});
  study.claim({"two", "Stoermer-Verlet, kicks first, requires two force evaluations a step", "2"}, as_printed("2"),
              {{evaluations(measured("verlet")), 0.01,
                "evaluations per step of verlet: the last force of a step is the first of the next"}},
              Grounds::identity);
}

void cost(Study& study) {
  study.claim({"stv4", "a step of StV4 requires 3 times 2 determinations of the forces", "6"}, as_printed("6"),
              {{evaluations(measured("stv4")), 0.01, "evaluations per step of stv4, none computed twice"}},
              Grounds::identity);
  study.claim({"variant", "three, with the variant of page 53", "3"}, as_printed("3"),
              {{evaluations(measured("stv4-dkd")), 0.01, "evaluations per step of stv4-dkd"}});
  const auto pairs = [](double n) { return 3 * n * n; };
  study.claim({"pairs_121", "3 N^4 distance forces a step of 121 particles", "45 000"},
              within(45000, 2500, "two figures, rounded to 5"), {{pairs(121), 0, "3 times 121^2"}});
  study.claim({"pairs_441", "3 N^4 distance forces a step of 441 particles", "600 000"},
              within(600000, 50000, "one figure"), {{pairs(441), 0, "3 times 441^2"}});
}

/// What symmetric compositions of symmetric steps of order 2 have to fulfil for order 6, sum of factors 1: sums of
/// third and of fifth powers, and of factor^3 (time of its middle)^2, vanish.   [HLW2006, V.3, with time from the
/// middle]
struct Residuals {
  double third = 0;
  double fifth = 0;
  double mixed = 0;
  double largest() const { return std::max({std::abs(third), std::abs(fifth), std::abs(mixed)}); }
};
/// @param outer the factors from the outermost one inwards; that in the middle makes the sum 1
Residuals residuals(const std::vector<double>& outer) {
  double middle = 1;
  for (const double factor : outer) middle -= 2 * factor;
  Residuals all{std::pow(middle, 3), std::pow(middle, 5), 0};
  double inner = middle / 2;  // time from the middle of the step to where the factor begins
  for (std::size_t i = outer.size(); i-- > 0;) {
    const double factor = outer[i], time = inner + factor / 2;
    all.third += 2 * std::pow(factor, 3);
    all.fifth += 2 * std::pow(factor, 5);
    all.mixed += 2 * std::pow(factor, 3) * time * time;
    inner += factor;
  }
  return all;
}

/// The least of the largest residual over a square, by a grid that closes in on its best point.
double least_residual(const Study& study, double radius) {
  double a = 0, b = 0, least = 1e300;
  for (int round = 0; round < 12; ++round) {
    const double middle_a = a, middle_b = b;
    const int points = round == 0 ? 1000 : 50;
    for (int i = -points; i <= points; ++i) {
      for (int k = -points; k <= points; ++k) {
        const double x = middle_a + radius * i / points, y = middle_b + radius * k / points;
        const double here = residuals({x, y}).largest();
        if (here < least) least = here, a = x, b = y;
      }
    }
    study.breathe();
    radius *= round == 0 ? 0.02 : 0.2;
  }
  return least;
}

/// The factors with sums 1, 0, 0 of powers 1, 3, 5: with b = r a and c = s a, s^3 = -2 (1 + r^3) and s^5 = -2 (1 +
/// r^5).
/// @return the least |mixed| of all
double mixed_where_powers_vanish() {
  std::vector<double> grid;
  for (int i = -40000; i <= 40000; ++i) grid.push_back(i * 1e-3 + 3.3e-7);
  const auto s = [](double r) { return -std::cbrt(2 * (1 + r * r * r)); };
  const std::vector<double> ratios =
      roots([&](double r) { return std::pow(s(r), 5) + 2 * (1 + std::pow(r, 5)); }, grid);
  double least = 1e300;
  for (const double r : ratios) {
    const double a = 1 / (2 + 2 * r + s(r));
    if (std::isfinite(a)) least = std::min(least, std::abs(residuals({a, r * a}).mixed));
  }
  return least;
}

void five_factors(Study& study) {
  const double least = std::min(least_residual(study, 3), least_residual(study, 30));
  study.claim(
      {"order_6", "conditions on alpha, beta, gamma make the symmetric composition of five steps one of order 6",
       "order 6"},
      at_most(1e-10, "residual of the order conditions that real factors leave"),
      {{least, least / 100, "least largest residual over all (alpha, beta) up to 30"},
       {mixed_where_powers_vanish(), 1e-9, "the third residual at every real zero of the first two"}},
      Grounds::ways);
  const double seven = residuals({0.7845136104775572638, 0.2355732133593581337, -1.1776799841788710069}).largest();
  study.claim({"seven", "further such compositions reach higher orders (with seven factors order 6)", "and so on"},
              at_most(1e-13, "rounding of powers of factors up to 1.4"),
              {{seven, 1e-15, "largest residual of the factors of yoshida6"}});
}

}  // namespace sonnleitner_methods

std::vector<Experiment> sonnleitner_methods_experiments() {
  using namespace sonnleitner_methods;
  return {{{"S-T64", sonnleitner, "64", "the properties of the methods"}, properties},
          {{"S-C53", sonnleitner, "53", "the variant of Stoermer-Verlet"}, variant},
          {{"S-C64", sonnleitner, "64", "five factors and order 6"}, five_factors},
          {{"S-C70", sonnleitner, "70", "force evaluations of a step"}, cost}};
}

}  // namespace hamflow::reproduction
