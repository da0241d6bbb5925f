// [Gross1999, appendix B]: the program of the Duffing oscillator, statement by statement. Its first call of the
// residual in each step has lambda and k in each other's place; the calls of the iteration have not.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../experiment.hpp"
#include "hamflow/numerics/gauss_legendre.hpp"

namespace hamflow::reproduction {

namespace duffing_listing {

constexpr double mass = 2, r0 = 4;
struct Case {
  const char* figure;
  double k, lambda;
  double t_end;
};
constexpr Case cases[] = {{"2.26", 1, 7, 10}, {"2.27", 1, 8, 3}, {"2.28", 2, 12, 10}};

struct Correction {
  double residual;
  double tangent;
};
/// Equations 2.189, 2.190.
Correction resinum(double k, double lambda, double q1, double p1, double q2, double dt) {
  const auto& rule = gauss_rule<double>(5);
  double residual = 0, tangent = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    const double q = q1 * (1 - rule.c[i]) + q2 * rule.c[i];
    residual += 2 * k * q * (q * q - lambda) * rule.b[i];
    tangent += (2 * k * (q * q - lambda) + 4 * k * q * q) * rule.c[i] * rule.b[i];
  }
  const double half = dt / mass * dt / 2;
  return {q2 - q1 - dt / mass * p1 + half * residual, 1 + half * tangent};
}

struct Motion {
  std::vector<double> r;
  int most = 0;
  int total = 0;
  double energy_error = 0;
  bool converged = true;
};
Motion motion(const Case& c, bool swapped, double dt) {
  Motion all;
  const auto V = [&](double r) { return c.k / 2 * (r * r - c.lambda) * (r * r - c.lambda); };
  const double E = V(r0);
  double q = r0, p = 0;
  for (int step = 0; step < std::lround(c.t_end / dt) && all.converged; ++step) {
    double next = q;
    Correction now = swapped ? resinum(c.lambda, c.k, q, p, next, dt) : resinum(c.k, c.lambda, q, p, next, dt);
    int iteration = 0;
    while (std::abs(now.residual) > 1e-13) {
      if (++iteration > 15) {
        all.converged = false;
        break;
      }
      next -= now.residual / now.tangent;
      now = resinum(c.k, c.lambda, q, p, next, dt);
    }
    p = 2 * mass / dt * (next - q) - p;
    q = next;
    all.most = std::max(all.most, iteration);
    all.total += iteration;
    all.energy_error = std::max(all.energy_error, std::abs(p * p / (2 * mass) + V(q) - E));
    all.r.push_back(q);
  }
  return all;
}

const char* const calls =
    "resinum(intr,dt,mass,lambda,k,Q1,P1,Q2) before the iteration, resinum(intr,dt,mass,k,lambda,Q1,P1,Q2) in it; "
    "heading: resinum(ir,dt,mass,k,lambda,Q1,P1,Q2)";
const char* const pages_of_calls = "136, 137, 139";

void carry_out(Study& study) {
  for (const Case& c : cases) {
    const std::string of = fmt::format("figure {}: ", c.figure);
    double fewest = 1e9, apart = 0, more_energy = 0, more_iterations = 0;
    std::string counts;
    for (const double dt : {0.1, 0.05, 0.02, 0.01}) {  // the text names no dt for these figures
      const Motion printed = motion(c, true, dt), right = motion(c, false, dt);
      if (printed.converged) fewest = std::min(fewest, static_cast<double>(printed.most));
      counts += fmt::format("{}dt = {:g}: at most {}, {:.3g} on average, with the arguments in order {} and {:.3g}",
                            counts.empty() ? "" : "; ", dt, printed.most,
                            printed.total / static_cast<double>(printed.r.size()), right.most,
                            right.total / static_cast<double>(right.r.size()));
      for (std::size_t i = 0; i < std::min(printed.r.size(), right.r.size()); ++i) {
        apart = std::max(apart, std::abs(printed.r[i] - right.r[i]));
      }
      const double steps_printed = static_cast<double>(printed.r.size()), steps = static_cast<double>(right.r.size());
      more_energy = std::max(more_energy, printed.energy_error / right.energy_error);
      more_iterations = std::max(more_iterations, printed.total / steps_printed / (right.total / steps));
      study.note(
          fmt::format("Figure {}, dt = {:g}: |H - H0| at most {:.2g} as printed, {:.2g} with the arguments in "
                      "order.",
                      c.figure, dt, printed.energy_error, right.energy_error));
    }
    const auto claim = [&](const char* name, const std::string& statement, const char* printed, const char* page,
                           const Rule& rule, double value, const std::string& how) {
      study.claim({name + std::string(c.figure), of + statement, printed, page}, rule, {{value, 0, how}});
    };
    claim("iterations_printed_",
          "the program of appendix B as printed takes at most three iterations a step, with some dt: its axis of "
          "iterations ends at 3.5",
          "axis([-4.2 4.2 0 3.5])", "139",
          at_most(3, "counted over every step; the best of four dt, because the text names none"), fewest, counts);
    claim("same_root_",
          "although the residual is first called as printed, with lambda and k exchanged, the iteration finds the "
          "root of equation 2.189",
          calls, pages_of_calls,
          at_most(1e-6, "two roots to 1e-13 at each step; their difference grows where the motion is unstable"), apart,
          "largest difference of r from that with both calls in the order of the function's heading");
    claim("order_costs_no_energy_",
          "if the residual is first called as printed, with lambda and k exchanged, the energy error is no larger than "
          "with the order of the function's heading",
          calls, pages_of_calls, at_most(2, "ratio of the two largest |H - H0|, which are at rounding level"),
          more_energy, "the largest of four dt");
    claim("order_costs_no_iterations_",
          "if the residual is first called as printed, with lambda and k exchanged, Newton's method takes no more "
          "iterations than with the order of the function's heading",
          calls, pages_of_calls, at_most(1, "ratio of the two mean numbers of iterations per step"), more_iterations,
          "the largest of four dt");
  }
}

}  // namespace duffing_listing

std::vector<Experiment> duffing_listing_experiments() {
  return {{{"G-B", gross, "135-141", "the program of appendix B, both orders of its arguments"},
           duffing_listing::carry_out}};
}

}  // namespace hamflow::reproduction
