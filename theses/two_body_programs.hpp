// The two programs of [Gross1999, ch. 2] for a mass 2 in a central potential, with five Gauss points and dt = 0.1. The
// program of appendix A uses Cartesian coordinates. Equations 2.98 to 2.102 use polar ones, with the integrals of 1/r^2
// and 1/r^3 in closed form; appendix B lists them for l = 0.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow::reproduction::two_body_programs {

inline constexpr double mass = 2, dt = 0.1, tolerance = 1e-13;
inline constexpr int most_iterations = 15;

struct CentralPotential {
  char field;  // first letter of kepler, hooke, linear, or binomial with lambda = 1
  double k;

  double V(double r) const {
    switch (field) {
      case 'k':
        return -k / r;
      case 'h':
        return -k * r * r / 2;
      case 'l':
        return k * r;
      default:
        return k / 2 * (r * r - 1) * (r * r - 1);
    }
  }
  /// Returns V' and V''.
  std::array<double, 2> derivatives(double r) const {
    switch (field) {
      case 'k':
        return {k / (r * r), -2 * k / (r * r * r)};
      case 'h':
        return {-k * r, -k};
      case 'l':
        return {k, 0};
      default:
        return {2 * k * r * (r * r - 1), 2 * k * (r * r - 1) + 4 * k * r * r};
    }
  }
};

struct ProgramRun {
  double end = 0;           // the time reached; a step with more than 15 iterations ends the program
  int most = 0;             // the largest number of iterations of a step
  double energy_error = 0;  // largest |H - H0|; only for equations 2.98 to 2.102
};

/// The program of appendix A, with the same order of sums, initial guess of Newton's method and stopping rule
/// |R| <= 1e-13.
inline ProgramRun appendix_a(const CentralPotential& potential, std::array<double, 2> q, std::array<double, 2> p,
                             long steps) {
  constexpr double factor = 2 * mass / dt;
  const auto& rule = gauss_rule<double>(5);
  ProgramRun run;
  for (long step = 0; step < steps; ++step) {
    std::array<double, 2> next = q, residual{};
    for (int iteration = 0;; ++iteration) {
      std::array<double, 2> sum{};
      double k11 = 0, k12 = 0, k22 = 0;
      for (std::size_t i = 0; i < 5; ++i) {
        const double b = rule.c[i], a = 1 - b;
        const double x = q[0] * a + next[0] * b, y = q[1] * a + next[1] * b, r = std::sqrt(x * x + y * y);
        const auto [first, second] = potential.derivatives(r);
        const double term1 = first / r, term2 = (second - term1) / (r * r), w = rule.b[i];
        sum[0] += x * term1 * w;
        sum[1] += y * term1 * w;
        k11 += (term1 + term2 * x * x) * b * w;
        k12 += term2 * x * y * b * w;
        k22 += (term1 + term2 * y * y) * b * w;
      }
      for (std::size_t j = 0; j < 2; ++j) residual[j] = factor * (next[j] - q[j]) - 2 * p[j] + dt * sum[j];
      if (std::hypot(residual[0], residual[1]) <= tolerance) {
        run.most = std::max(run.most, iteration);
        break;
      }
      if (iteration == most_iterations) return run;
      k11 = factor + dt * k11;
      k22 = factor + dt * k22;
      k12 *= dt;
      const double determinant = k11 * k22 - k12 * k12;
      next[0] -= (k22 * residual[0] - k12 * residual[1]) / determinant;
      next[1] -= (k11 * residual[1] - k12 * residual[0]) / determinant;
    }
    for (std::size_t j = 0; j < 2; ++j) p[j] = factor * (next[j] - q[j]) - p[j];
    q = next;
    run.end = dt * static_cast<double>(step + 1);
  }
  return run;
}

/// Equations 2.98 to 2.104 from a Cartesian start, without the angle, on which the others do not depend.
inline ProgramRun in_polar_coordinates(const CentralPotential& potential, const std::array<double, 2>& q,
                                       const std::array<double, 2>& p, long steps) {
  constexpr double first = dt / mass, second = dt * dt / (2 * mass);
  const auto& rule = gauss_rule<double>(5);
  double r = std::hypot(q[0], q[1]), momentum = (q[0] * p[0] + q[1] * p[1]) / r;
  const double l = q[0] * p[1] - q[1] * p[0];
  const auto energy = [&] { return (momentum * momentum + l * l / (r * r)) / (2 * mass) + potential.V(r); };
  const double start = energy();
  ProgramRun run;
  for (long step = 0; step < steps; ++step) {
    double next = r;
    for (int iteration = 0;; ++iteration) {
      double mean = 0, slope = 0;
      for (std::size_t i = 0; i < 5; ++i) {
        const auto [of_V, of_force] = potential.derivatives(r * (1 - rule.c[i]) + next * rule.c[i]);
        mean += of_V * rule.b[i];
        slope += of_force * rule.c[i] * rule.b[i];
      }
      const double turn = first * l / (r * next);
      const double residual = next - r - first * momentum - (r + next) / 4 * turn * turn + second * mean;
      if (std::abs(residual) <= tolerance) {
        run.most = std::max(run.most, iteration);
        break;
      }
      if (iteration == most_iterations) return run;
      next -= residual / (1 + turn * turn / 4 * (2 * r / next + 1) + second * slope);
    }
    momentum = 2 / first * (next - r) - momentum;
    r = next;
    run.energy_error = std::max(run.energy_error, std::abs(energy() - start));
    run.end = dt * static_cast<double>(step + 1);
  }
  return run;
}

}  // namespace hamflow::reproduction::two_body_programs
