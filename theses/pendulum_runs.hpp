// The nonlinear double pendulum of [Gross1999, ch. 3]: m = 2, l = 3, g = 9.81, from rest at q = (0, pi/2), in
// absolute and in relative angles. Figures show the solution of the linear equations from the same start as lines.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "hamflow/problems/double_pendulum_nonlinear_absolute.hpp"
#include "hamflow/problems/double_pendulum_nonlinear_relative.hpp"
#include "scenarios.hpp"
#include "study.hpp"

namespace hamflow::reproduction {

inline constexpr double pendulum_energy_unit = 2 * 9.81 * 3;  // m g l
inline const Vector<double, 2> pendulum_masses{2, 2};
inline const Vector<double, 2> pendulum_lengths{3, 3};

/// @param method the table [method], as --set takes it; empty: cg(1,5)
inline Trajectory pendulum_run(Study& study, const std::string& name, bool absolute, const std::string& method = {},
                               const std::string& dt = "0.01", long steps = 2600, long every = 1) {
  std::vector<std::string> sets = in_steps(dt, steps, every, method);
  sets.push_back(std::string("problem.angles=") + (absolute ? "absolute" : "relative"));
  return study.run(name, scenario_of("nonlinear_pendulum"), sets);
}

/// The rates q' = M(q)^-1 p at every sample.
template <class Problem>
std::array<std::vector<double>, 2> pendulum_rates(const Problem& problem, const Trajectory& run) {
  std::array<std::vector<double>, 2> rates;
  for (std::size_t k = 0; k < run.size(); ++k) {
    const Vector<double, 2> q{run.q[k][0], run.q[k][1]};
    const auto inverse = problem.inverse_mass_matrix(q);
    for (std::size_t i = 0; i < 2; ++i) rates[i].push_back(inverse[i][0] * run.p[k][0] + inverse[i][1] * run.p[k][1]);
  }
  return rates;
}
inline std::array<std::vector<double>, 2> pendulum_rates(bool absolute, const Trajectory& run) {
  if (absolute)
    return pendulum_rates(DoublePendulumNonlinearAbsolute<>(pendulum_masses, pendulum_lengths), run);
  else
    return pendulum_rates(DoublePendulumNonlinearRelative<>(pendulum_masses, pendulum_lengths), run);
}

/// The linear solution q_i(t) = sum_k amplitude[i][k] cos(omega[k] t), equations 3.33, 3.64, 3.65, 3.71, 3.72.
struct LinearPendulum {
  std::array<double, 2> omega;
  std::array<std::array<double, 2>, 2> amplitude;

  double q(std::size_t i, double t) const {
    return amplitude[i][0] * std::cos(omega[0] * t) + amplitude[i][1] * std::cos(omega[1] * t);
  }
  double rate(std::size_t i, double t) const {
    return -amplitude[i][0] * omega[0] * std::sin(omega[0] * t) - amplitude[i][1] * omega[1] * std::sin(omega[1] * t);
  }
};
inline LinearPendulum linear_pendulum_of_start(bool absolute) {
  const double root = std::sqrt(13.0);
  LinearPendulum linear{{std::sqrt((4 + root) * 9.81 / 3), std::sqrt((4 - root) * 9.81 / 3)}, {}};
  // (0, pi/2) = l1 A1 + l2 A2 with l = ((1 -+ root)/6, 1).
  const double x1 = (1 - root) / 6, x2 = (1 + root) / 6, start = std::numbers::pi / 2;
  const double A1 = start * x2 / (x2 - x1), A2 = -start * x1 / (x2 - x1);
  linear.amplitude = {std::array<double, 2>{x1 * A1, x2 * A2}, {A1, A2}};
  if (!absolute) {
    for (std::size_t k = 0; k < 2; ++k) linear.amplitude[1][k] -= linear.amplitude[0][k];
  }
  return linear;
}

}  // namespace hamflow::reproduction
