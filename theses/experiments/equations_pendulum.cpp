// [Gross1999, chapter 3]: equations put against dual numbers or against the library's derivatives. The number of each
// claim is by how much the printed form is off; the right one is told beside it.
#include <algorithm>

#include "../experiment.hpp"
#include "../pendulum_runs.hpp"
#include "hamflow/core/dual.hpp"

namespace hamflow::reproduction {

namespace equations_pendulum {

using Pair = Vector<double, 2>;

void claim(Study& study, const char* name, const char* page, const std::string& statement, const std::string& printed,
           double off, const std::string& how) {
  study.claim({name, statement, printed, page}, at_most(1e-12, "the equation holds to rounding"),
              {{off, 1e-15, "largest deviation of the printed form" + how}}, Grounds::identity);
}

double form(double f11, double f12, double f22, const Pair& p) {
  return f11 * p[0] * p[0] + 2 * f12 * p[0] * p[1] + f22 * p[1] * p[1];
}

/// dT/dq2 and d^2T/dq2^2 of both sets of angles as printed, against the library; m = 2, l = 3.
void of_derivatives(Study& study) {
  const DoublePendulumNonlinearAbsolute<> absolute(pendulum_masses, pendulum_lengths);
  const DoublePendulumNonlinearRelative<> relative(pendulum_masses, pendulum_lengths);
  constexpr double unit = 18;  // m l^2
  double first_absolute = 0, second_absolute = 0, first_relative = 0, second_relative = 0;
  for (int n = 0; n < 40; ++n) {
    const Pair q{0.37 * n, 1 + 0.71 * n}, p{3 * std::sin(1.3 * n), 2 * std::cos(0.9 * n)};
    Pair dq{}, dp{}, v{};
    Matrix<double, 2> qq{}, qp{}, pp{};
    const auto printed = [&](double angle, bool is_absolute) {
      const double c = std::cos(angle), s = std::sin(angle), D = 1 / (5 - 4 * c * c), c4 = c * c * c * c;
      const double D2 = D * D * s / unit, D3 = D * D * D / unit, square = s * s - c * c;
      const double F = 16 * c4 + 48 * s * s * c * c + 20 * square;
      if (is_absolute) {
        const double G = -c * (16 * c4 + 32 * c * c * s * s + 120 * s * s - 25);
        return Pair{D2 * form(-4 * c, 4 * c * c + 5, -20 * c, p), D3 * form(F, G, 5 * F, p)};
      }
      const double F2 = 32 * c4 * c + 96 * c4 + 64 * s * s * c * c * c + 288 * s * s * c * c + 240 * s * s * c -
                        50 * c + 120 * square;
      const double G = -(16 * c4 * c + 16 * c4 + 32 * s * s * c * c * c + 48 * s * s * c * c) -
                       (120 * s * s * c - 25 * c + 20 * square);
      return Pair{-D2 * form(4 * c, -4 * c - (4 * c * c + 5), 8 * c * c + 24 * c + 10, p), D3 * form(F, G, F2, p)};
    };
    const auto compare = [&](const auto& problem, double angle, bool is_absolute, double& first, double& second) {
      // What V adds is the gradient and the Hessian at p = 0.
      const Pair rest{0, 0};
      Pair dV{};
      Matrix<double, 2> VV{};
      problem.gradient(q, p, dq, dp);
      problem.gradient(q, rest, dV, v);
      problem.hessian(q, p, qq, qp, pp);
      problem.hessian(q, rest, VV, qp, pp);
      const std::size_t i = is_absolute ? 0 : 1;
      const Pair there = printed(angle, is_absolute);
      first = std::max(first, std::abs(there[0] - (dq[i] - dV[i])));
      second = std::max(second, std::abs(there[1] - (qq[i][i] - VV[i][i])));
    };
    compare(absolute, q[0] - q[1], true, first_absolute, second_absolute);
    compare(relative, q[1], false, first_relative, second_relative);
  }
  // Sums of terms of size 1000 over m l^2 = 18: their rounding is above that of one number.
  const auto of = [&](const char* name, const char* page, const char* equation, const char* order, double off) {
    study.claim({name, fmt::format("equations {} are the {} of T", equation, order), "as printed", page},
                at_most(1e-11, "rounding of sums of some twenty terms"),
                {{off, 1e-13, "largest difference from the library's, at 40 states"}}, Grounds::identity);
  };
  of("3.156", "113", "3.155 with 3.156", "first derivatives", first_absolute);
  of("3.164", "114", "3.163 to 3.165", "second derivatives", second_absolute);
  of("3.181", "119", "3.180 with 3.181", "first derivatives", first_relative);
  of("3.188", "120", "3.187 to 3.190", "second derivatives", second_relative);
}

/// Remark 3.2: rods with inertia turn by their angles with the vertical, of which q2 is none in relative angles.
void of_inertia(Study& study) {
  constexpr double theta1 = 0.02, theta2 = 0.03;
  for (const bool absolute : {true, false}) {
    double off = 0, right = 0;
    for (int n = 0; n < 40; ++n) {
      const double y1 = std::sin(1.3 * n + 0.4), y2 = std::cos(0.9 * n), second = absolute ? y2 : y1 + y2;
      const double T = (theta1 * y1 * y1 + theta2 * second * second) / 2;
      const double coupling = absolute ? 0 : theta2;
      off = std::max(off, std::abs((theta1 * y1 * y1 + theta2 * y2 * y2) / 2 - T));
      right = std::max(right,
                       std::abs(((theta1 + coupling) * y1 * y1 + 2 * coupling * y1 * y2 + theta2 * y2 * y2) / 2 - T));
    }
    claim(study, absolute ? "remark_3.2_absolute" : "remark_3.2_relative", "79",
          fmt::format("in {} angles the mass matrix of the physical double pendulum is M + diag(theta1, theta2)",
                      absolute ? "absolute" : "relative"),
          "M_p = M + diag(theta1, theta2)", off,
          absolute
              ? std::string(": kinetic energy of rotation for theta = (0.02, 0.03)")
              : fmt::format(": kinetic energy of rotation for theta = (0.02, 0.03); of M + [theta1 + theta2, theta2; "
                            "theta2, theta2]: {:.2g}",
                            right));
  }
}

void of_phase_space(Study& study) {
  const double root = std::sqrt(13.0), omega = std::sqrt((4 + root) * 9.81 / 0.5);
  const Pair q0{1 - root, 6};
  double off = 0, right = 0;
  for (int n = 0; n <= 20; ++n) {
    using D = Dual<double, 1>;
    const double t = 0.05 * n;
    const double rate = (cos(D::variable(t, 0) * omega) * q0[1]).slope[0];
    off = std::max(off, std::abs(-q0[1] * omega * std::cos(omega * t) - rate));
    right = std::max(right, std::abs(-q0[1] * omega * std::sin(omega * t) - rate));
  }
  claim(study, "after_3.81", "91", "the time derivative of equation 3.77 is -q0 w1 cos(w1 t)", "cos", off,
        fmt::format(", by dual numbers up to t = 1; of sin: {:.2g}", right));
  // E = q.C q/2 + y.M y/2 with M = [5, 2; 2, 1], C = [3, 0; 0, 1] g/l, in units of m l^2. On the q1-axis of this
  // surface 3.82 has to be 1 as well.
  const double g = 9.81 / 0.5;
  const double E = g / 2 * (3 * q0[0] * q0[0] + q0[1] * q0[1]);
  const double square = 2 * E / (3 * g);  // of q1, with q2 = y = 0
  claim(study, "3.82", "91", "the ellipsoid 3.82 is the surface of all states of the energy of the first eigenform",
        "pi_0", std::abs(square / (q0[0] * q0[0] + q0[1] * q0[1]) - 1),
        ": left side of 3.82 less 1 at a state (q1, 0, 0, 0) of that energy; it holds on the eigenform alone");
  study.claim({"caption_3.18", "the caption of figure 3.18 names the start of table 3.2", "(0.1, -0.01)", "105"},
              at_most(5e-3, "two printed numbers, each to two decimals"),
              {{std::abs(-0.01 - (-0.11)), 0, "the caption says -0.01, the table -0.11"}}, Grounds::identity);
}

}  // namespace equations_pendulum

std::vector<Experiment> equations_pendulum_experiments() {
  return {{{"G-E3", gross, "79-120", "equations of chapter 3"}, [](Study& study) {
             equations_pendulum::of_inertia(study);
             equations_pendulum::of_phase_space(study);
             equations_pendulum::of_derivatives(study);
           }}};
}

}  // namespace hamflow::reproduction
