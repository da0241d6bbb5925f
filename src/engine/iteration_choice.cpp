#include "iteration_choice.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/methods/averages.hpp"
#include "large_steps.hpp"
#include "methods/newton_family.hpp"

namespace hamflow {

namespace {

/// The linearised motion near a state: z' = J H'' z for small differences z.
struct LinearMotion {
  std::vector<std::vector<std::pair<std::size_t, double>>>
      rows{};  // sizes of the entries of J H'' other than 0, row by row
  std::size_t entries = 0;
};

LinearMotion linear_motion(const ErasedFunctions<double>& functions, const Vector<double, dynamic>& q,
                           const Vector<double, dynamic>& p) {
  constexpr Capability natural = Capability::separable | Capability::quadratic_kinetic;
  const std::size_t n = q.size();
  Matrix<double, dynamic> qq(n);
  Matrix<double, dynamic> qp(n);
  Matrix<double, dynamic> pp(n);
  if (includes(functions.capability, natural)) {  // as Newton would need them
    Vector<double, dynamic> force(n);
    functions.plain->force_and_hessian(q, force, qq);
    pp = inverse_mass_matrix(functions.as<natural>());
  } else {
    functions.plain->hessian(q, p, qq, qp, pp);
  }
  LinearMotion motion;
  motion.rows.resize(2 * n);
  const auto add = [&](std::size_t row, std::size_t column, double x) {
    if (x == 0) return;
    motion.rows[row].emplace_back(column, std::abs(x));
    ++motion.entries;
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      add(i, j, qp[j][i]);
      add(i, n + j, pp[i][j]);
      add(n + i, j, qq[i][j]);
      add(n + i, n + j, qp[i][j]);
    }
  }
  return motion;
}

/// An upper bound of the largest rate of the motion: the spectral radius of the sizes of the entries, which does not
/// depend on units. It uses squares of the matrix, because for q' = p/m, p' = -k q the powers of the matrix alternate.
double largest_rate(const LinearMotion& motion) {
  constexpr int products = 40;
  std::vector<double> x(motion.rows.size(), 1.0);
  const auto multiplied = [&](const std::vector<double>& from) {
    std::vector<double> to(from.size(), 0.0);
    for (std::size_t i = 0; i < to.size(); ++i) {
      for (const auto& [j, size] : motion.rows[i]) to[i] += size * from[j];
    }
    return to;
  };
  const auto length = [](const std::vector<double>& of) {
    double sum = 0;
    for (const double each : of) sum += each;
    return sum;
  };
  double square = 0;
  for (int k = 0; k < products; ++k) {
    std::vector<double> next = multiplied(multiplied(x));
    const double grown = length(next);
    if (!(grown > 0) || !std::isfinite(grown)) return grown;
    square = grown / length(x);
    for (double& each : next) each /= grown;
    x = std::move(next);
  }
  return std::sqrt(square);
}

bool is_said(const Texts& options) {
  return options.contains(families::iteration_option) || options.contains(families::max_iterations_option) ||
         options.contains(diagnostics_option);
}

}  // namespace

MethodSpec with_cheaper_iteration(const MethodSpec& method, const ErasedFunctions<double>& functions,
                                  const Vector<double, dynamic>& q, const Vector<double, dynamic>& p, double h) {
  const std::size_t count = unknowns_of_step(method, q.size());
  // itoh-abe evaluates H for each coordinate, so that one more evaluation costs as much as a matrix.
  if (count < fewest_unknowns_by_fixed_points || count > most_dense_unknowns || is_said(method.options) ||
      method.name == "itoh-abe") {
    return method;
  }
  const LinearMotion motion = linear_motion(functions, q, p);
  const auto entries = static_cast<double>(motion.entries);
  const auto numbers = static_cast<double>(2 * q.size());
  if (entries > numbers * numbers / 8) return method;
  // The ratio of successive corrections is at most half of the step times the rate.
  const double left = std::abs(h) * largest_rate(motion) / 2;
  if (!(left < 0.5)) return method;
  // Costs in operations, from measured times of rings and chains: a fixed-point step evaluates first derivatives many
  // times, a Newton step fills and solves a matrix two or three times.
  constexpr double points = 8;
  const bool natural = includes(functions.capability, Capability::separable | Capability::quadratic_kinetic);
  const double unknowns = static_cast<double>(count) * (natural ? 1 : 2);
  const double corrections = 2 + 30 / -std::log(std::max(left, 1e-4));
  const double by_fixed_points = corrections * (40 * points * entries + 100 * unknowns);
  const double by_newton = 2.5 * unknowns * unknowns * (2 * unknowns / 3 + 8 * points);
  if (!(by_fixed_points < by_newton)) return method;
  MethodSpec chosen = method;
  chosen.options[families::iteration_option] = "fixed-point-or-newton";
  return chosen;
}

}  // namespace hamflow
