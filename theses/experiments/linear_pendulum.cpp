// [Gross1999, Sect. 3.1]: the linear double pendulum, m = 0.25, l = 0.5, in absolute and in relative angles, against
// its modal solution q(t) = l1 A1 cos(w1 t) + l2 A2 cos(w2 t) with w^2 = (4 +- sqrt(13)) g/l, equations 3.64, 3.65.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "../experiment.hpp"
#include "../scenarios.hpp"
#include "../time_panels.hpp"
#include "../trajectories.hpp"
#include "hamflow/problems/double_pendulum_linear_absolute.hpp"
#include "hamflow/problems/double_pendulum_linear_relative.hpp"

namespace hamflow::reproduction {

namespace linear_pendulum {

const double root = std::sqrt(13.0);
const double w1 = std::sqrt((4 + root) * 9.81 / 0.5);
const double w2 = std::sqrt((4 - root) * 9.81 / 0.5);
constexpr double t_end = 5;

using Pair = std::array<double, 2>;
struct Motion {
  const char* name;
  bool absolute;
  const char* start;  // of the tables, number expressions
  Pair q0;
  int mode;  // 1, 2: an eigenform; 0: both
};

const std::array<Motion, 6> motions{{{"eigenform_1", true, "[\"1-sqrt(13)\", 6]", {1 - root, 6}, 1},
                                     {"eigenform_2", true, "[\"1+sqrt(13)\", 6]", {1 + root, 6}, 2},
                                     {"both", true, "[0.1, -0.01]", {0.1, -0.01}, 0},
                                     {"eigenform_1", false, "[-2, \"3+sqrt(13)\"]", {-2, 3 + root}, 1},
                                     {"eigenform_2", false, "[-2, \"3-sqrt(13)\"]", {-2, 3 - root}, 2},
                                     {"both", false, "[0.1, -0.11]", {0.1, -0.11}, 0}}};

using Square = Matrix<double, 2>;
/// M and C of equations 3.57, 3.59 and 3.92, 3.94.
std::array<Square, 2> mass_and_stiffness(bool absolute) {
  const Vector<double, 2> m{0.25, 0.25}, l{0.5, 0.5};
  if (absolute) {
    const DoublePendulumLinearAbsolute<> problem(m, l);
    return {problem.mass_matrix(), problem.stiffness_matrix()};
  }
  const DoublePendulumLinearRelative<> problem(m, l);
  return {problem.mass_matrix(), problem.stiffness_matrix()};
}
Square inverse(const Square& a) {
  const double d = a[0][0] * a[1][1] - a[0][1] * a[1][0];
  Square b{};
  b[0][0] = a[1][1] / d;
  b[1][1] = a[0][0] / d;
  b[0][1] = -a[0][1] / d;
  b[1][0] = -a[1][0] / d;
  return b;
}
Pair applied(const Square& a, const Pair& x) {
  return {a[0][0] * x[0] + a[0][1] * x[1], a[1][0] * x[0] + a[1][1] * x[1]};
}

/// y = q' = M^-1 p of every sample, equations 3.37 and 3.79.
std::array<std::vector<double>, 2> rates(bool absolute, const Trajectory& run) {
  const Square inverse_mass = inverse(mass_and_stiffness(absolute)[0]);
  std::array<std::vector<double>, 2> all;
  for (const auto& p : run.p) {
    const Pair y = applied(inverse_mass, {p[0], p[1]});
    for (std::size_t i = 0; i < 2; ++i) all[i].push_back(y[i]);
  }
  return all;
}

Pair eigenform(bool absolute, int mode) {
  const double sign = mode == 1 ? 1 : -1;
  if (absolute) return {(1 - sign * root) / 6, 1};
  return {1, -(3 + sign * root) / 2};  // of the angles q1, q2 - q1
}

/// A1, A2 of q0 = l1 A1 + l2 A2.
Pair amplitudes(bool absolute, const Pair& q0) {
  const Pair a = eigenform(absolute, 1), b = eigenform(absolute, 2);
  const double determinant = a[0] * b[1] - b[0] * a[1];
  return {(q0[0] * b[1] - b[0] * q0[1]) / determinant, (a[0] * q0[1] - q0[0] * a[1]) / determinant};
}

std::vector<std::vector<double>> modal(const Motion& motion, const std::vector<double>& t) {
  const Pair A = amplitudes(motion.absolute, motion.q0);
  const Pair a = eigenform(motion.absolute, 1), b = eigenform(motion.absolute, 2);
  std::vector<std::vector<double>> q(2);
  for (std::size_t i = 0; i < 2; ++i) {
    for (const double at : t) q[i].push_back(a[i] * A[0] * std::cos(w1 * at) + b[i] * A[1] * std::cos(w2 * at));
  }
  return q;
}

Trajectory run(Study& study, const Motion& motion, int refinement) {
  std::vector<std::string> sets =
      in_steps(fmt::format("0.01/{}", refinement), std::lround(t_end * 100) * refinement, refinement);
  sets.push_back(std::string("problem.angles=") + (motion.absolute ? "absolute" : "relative"));
  sets.push_back(fmt::format("problem.initial.q={}", motion.start));
  return study.run(refinement == 1 ? "figure" : "finer_" + std::to_string(refinement), scenario_of("linear_pendulum"),
                   sets);
}

double distance(const Trajectory& run, const Motion& motion) {
  const auto exact = modal(motion, run.t);
  double largest = 0;
  for (std::size_t k = 0; k < run.size(); ++k) {
    for (std::size_t i = 0; i < 2; ++i) largest = std::max(largest, std::abs(run.q[k][i] - exact[i][k]));
  }
  return largest;
}

/// How far the points (q_i, y_i) of an eigenform are from an ellipse with the half axes that they reach.
double off_ellipse(const Trajectory& run, const std::array<std::vector<double>, 2>& y) {
  double largest = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    // q^2/a^2 + y^2/b^2 = 1 is linear in 1/a^2, 1/b^2: least squares over all points.
    double qq = 0, qy = 0, yy = 0, q1 = 0, y1 = 0;
    double a = 0, b = 0;
    for (std::size_t k = 0; k < run.size(); ++k) {
      a = std::max(a, std::abs(run.q[k][i]));
      b = std::max(b, std::abs(y[i][k]));
    }
    for (std::size_t k = 0; k < run.size(); ++k) {
      const double u = std::pow(run.q[k][i] / a, 2), v = std::pow(y[i][k] / b, 2);
      qq += u * u;
      qy += u * v;
      yy += v * v;
      q1 += u;
      y1 += v;
    }
    const double determinant = qq * yy - qy * qy;
    const double u = (q1 * yy - y1 * qy) / determinant, v = (qq * y1 - qy * q1) / determinant;
    for (std::size_t k = 0; k < run.size(); ++k) {
      largest = std::max(largest, std::abs(u * std::pow(run.q[k][i] / a, 2) + v * std::pow(y[i][k] / b, 2) - 1));
    }
  }
  return largest;
}

/// The farthest dot from the exact line of its panel, over the width of that, wherever on the line it is at its time.
double off_line(const Motion& motion, const Trajectory& dots) {
  constexpr std::size_t finer = 10;
  constexpr double height = 0.42;  // of a panel over its width
  const double end = dots.t.back();
  std::vector<double> t(finer * (dots.size() - 1) + 1);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = end * static_cast<double>(i) / static_cast<double>(t.size() - 1);
  const auto exact = modal(motion, t);
  double largest = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    double most = 0;
    for (const double x : exact[k]) most = std::max(most, std::abs(x));
    const auto in_panel = [&](double time, double x) {
      return std::vector<double>{time / end, height * x / (2 * most)};
    };
    for (std::size_t i = 0; i < dots.size(); ++i) {
      const std::vector<double> dot = in_panel(dots.t[i], dots.q[i][k]);
      double nearest = 1;
      const std::size_t at = finer * i, reach = 20 * finer;  // no dot is twenty steps early or late
      for (std::size_t j = at > reach ? at - reach : 0; j + 1 < std::min(t.size(), at + reach); ++j) {
        nearest = std::min(
            nearest, distance_from_segment(dot, in_panel(t[j], exact[k][j]), in_panel(t[j + 1], exact[k][j + 1])));
      }
      largest = std::max(largest, nearest);
    }
  }
  return largest;
}

void over_t(Study& study, const Motion& motion) {
  const Trajectory figure = run(study, motion, 1);
  const double size = std::max(std::abs(motion.q0[0]), std::abs(motion.q0[1]));
  claim_second_order(study,
                     {"order", "the numerical solution approaches the analytical one as dt becomes smaller",
                      "dots and line, of one dt"},
                     {distance(run(study, motion, 2), motion), distance(run(study, motion, 4), motion), 1e-11 * size});
  study.claim({"kept", "the energy of the numerical solution is constant", "constant"},
              at_most(1e-11, "rounding over the run, relative to the scale of the energy"),
              {{energy_error(figure) / figure.report.energy_scale, 64 * 0x1p-53,
                "largest |H - H0|/scale over every step of cg(1,5), dt = 0.01"}});
  const auto exact = modal(motion, figure.t);
  study.claim({"on_line", "with dt = 0.01 the dots of the numerical solution lie on the line of the analytical one",
               "dots on the line"},
              at_most(0.005, "distance from the line over the width of the panel: a dot is drawn no smaller"),
              {{off_line(motion, figure), 1e-4, fmt::format("angles, up to t = {:.3g}", figure.t.back())}});
  study.keep({"motion",
              {{"t", figure.t},
               {"q1", figure.coordinate(0)},
               {"q2", figure.coordinate(1)},
               {"exact_q1", exact[0]},
               {"exact_q2", exact[1]},
               {"energy", figure.energy}}});
  study.draw("figure", study.info().title + ": angles with dt = 0.01 (dots) and exact (line), and the energy, over t",
             {study.info().title,
              {over_time("{/:Italic q}_1", figure.t, figure.coordinate(0), exact[0]),
               over_time("{/:Italic q}_2", figure.t, figure.coordinate(1), exact[1]),
               over_time("{/:Italic E}", figure.t, figure.energy)}});
}

/// How near w1/w2 turns come to whole ones within so many turns.
double nearest_common_period(int turns) {
  double nearest = 0.5;
  for (int k = 1; k <= turns; ++k) {
    const double x = k * w1 / w2;
    nearest = std::min(nearest, std::abs(x - std::round(x)));
  }
  return nearest;
}

void in_phase_planes(Study& study, const Motion& motion) {
  const Trajectory figure = run(study, motion, 1);
  const auto y = rates(motion.absolute, figure);
  if (motion.mode == 0) {
    study.claim(
        {"open", "the phase curves are open: they do not close within 1000 turns of the second mode", "offen"},
        at_least(1e-6, "part of a turn: w1/w2 = sqrt((29 + 8 sqrt(13))/3) is not a ratio of whole numbers up to 1000"),
        {{nearest_common_period(1000), 1e-12, "nearest k w1/w2 to a whole number, k up to 1000"}});
  } else {
    study.claim(
        {"ellipses",
         fmt::format("the phase curves of the {} eigenform are closed: ellipses",
                     motion.mode == 1 ? "first" : "second"),
         "Ellipse"},
        at_most(1e-10, "rounding over 500 steps: an element keeps the energy of each mode of a linear problem"),
        {{off_ellipse(figure, y), 0, "largest deviation of points (q, dq/dt) from an ellipse, cg(1,5), dt = 0.01"}});
  }
  study.keep({"planes",
              {{"t", figure.t},
               {"q1", figure.coordinate(0)},
               {"q2", figure.coordinate(1)},
               {"rate1", y[0]},
               {"rate2", y[1]}}});
  study.draw("figure", study.info().title + ": the phase planes (q, dq/dt) of both angles",
             {study.info().title,
              {phase_plane("{/:Italic q}_1", "d{/:Italic q}_1/d{/:Italic t}", figure.coordinate(0), y[0], {}, {}),
               phase_plane("{/:Italic q}_2", "d{/:Italic q}_2/d{/:Italic t}", figure.coordinate(1), y[1], {}, {})}});
}

/// Both amplitudes of equation 3.85 or 3.115 against q0 = l1 A1 + l2 A2.
void claim_amplitudes(Study& study, const Motion& motion, const Pair& printed, const char* texts, const char* page,
                      const char* equation) {
  const Pair a = eigenform(motion.absolute, 1), b = eigenform(motion.absolute, 2);
  const Pair right = amplitudes(motion.absolute, motion.q0);
  double off = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    off = std::max(off, std::abs(a[i] * printed[0] + b[i] * printed[1] - motion.q0[i]));
  }
  study.claim({"amplitudes", fmt::format("the amplitudes A1 and A2 of equation {} are those of its start", equation),
               texts, page},
              at_most(1e-9, "l1 A1 + l2 A2 has to give the start q0, to the digits printed"),
              {{off, 1e-10,
                fmt::format("largest component of l1 A1 + l2 A2 - q0; the right amplitudes are {:.12g}, {:.12g}",
                            right[0], right[1])}},
              Grounds::identity);
}

/// Whether two starts, in absolute and in relative angles, are one motion.
void claim_identical(Study& study, std::size_t row) {
  const Pair absolute = motions[row].q0, relative = motions[row + 3].q0;
  const Pair converted{absolute[0], absolute[1] - absolute[0]};
  const double off = std::max(std::abs(converted[0] - relative[0]), std::abs(converted[1] - relative[1]));
  study.claim({"identical_" + std::to_string(row + 1),
               fmt::format("row {0} of table 3.1 and row {0} of table 3.2 describe the same motion", row + 1),
               "identische Pendelbewegungen"},
              at_most(1e-12, "the relative angles are q1 and q2 - q1, if q1 and q2 are the absolute angles"),
              {{off, 1e-14,
                fmt::format("largest difference; the start of table 3.1 is ({:.6g}, {:.6g}) in relative angles",
                            converted[0], converted[1])}},
              Grounds::identity);
}

/// Equation 3.47 and its tangent 3.50, |R| <= 1e-13: the most iterations that a step of the figures takes.
int iterations_of_newton(const Motion& motion) {
  constexpr double h = 0.01, tolerance = 1e-13;
  const auto [mass, stiffness] = mass_and_stiffness(motion.absolute);
  const Square inverse_mass = inverse(mass);
  Square tangent{};
  const auto product = [&, &stiffness = stiffness](const Pair& p) {
    return applied(stiffness, applied(inverse_mass, p));
  };
  for (std::size_t j = 0; j < 2; ++j) {
    const Pair column = product({j == 0 ? 1.0 : 0.0, j == 1 ? 1.0 : 0.0});
    for (std::size_t i = 0; i < 2; ++i) tangent[i][j] = (i == j ? 1 : 0) + h * h / 4 * column[i];
  }
  const Square solved = inverse(tangent);
  Pair q = motion.q0, p{0, 0};
  int most = 0;
  for (long step = 0; step < std::lround(t_end / h); ++step) {
    Pair next = p;
    for (int iteration = 0; iteration < 15; ++iteration) {
      const Pair pull = applied(stiffness, q), both = product({p[0] + next[0], p[1] + next[1]});
      Pair residual{};
      for (std::size_t i = 0; i < 2; ++i) residual[i] = next[i] - p[i] + h * pull[i] + h * h / 4 * both[i];
      if (std::hypot(residual[0], residual[1]) <= tolerance) break;
      const Pair correction = applied(solved, residual);
      for (std::size_t i = 0; i < 2; ++i) next[i] -= correction[i];
      most = std::max(most, iteration + 1);
    }
    const Pair mean = applied(inverse_mass, {(p[0] + next[0]) / 2, (p[1] + next[1]) / 2});
    for (std::size_t i = 0; i < 2; ++i) q[i] += h * mean[i];
    p = next;
  }
  return most;
}

void starts(Study& study, bool absolute) {
  for (std::size_t row = 0; row < 2; ++row) {
    const Motion& motion = motions[row + (absolute ? 0 : 3)];
    const Pair A = amplitudes(absolute, motion.q0);
    study.claim({"eigenform_" + std::to_string(row + 1),
                 fmt::format("row {} of table {} is the {} eigenform alone", row + 1, absolute ? "3.1" : "3.2",
                             row == 0 ? "first" : "second"),
                 "Eigenform"},
                at_most(1e-13, "rounding of the amplitudes"),
                {{std::abs(A[motion.mode == 1 ? 1 : 0] / A[motion.mode == 1 ? 0 : 1]), 0,
                  "amplitude of the other eigenform divided by that of this one"}});
  }
  int most = 0;
  for (const Motion& motion : motions) {
    if (motion.absolute == absolute) most = std::max(most, iterations_of_newton(motion));
  }
  study.claim({"newton_once",
               fmt::format("Newton's method takes one iteration a step for the linear double pendulum in {} angles",
                           absolute ? "absolute" : "relative"),
               "nur ein Iterationsschritt", "83"},
              at_most(1, "counted over every step of three figures"),
              {{static_cast<double>(most), 0, "equations 3.47 and 3.50, |R| <= 1e-13, dt = 0.01, up to t = 5"}});
  if (absolute) return;
  for (std::size_t row = 0; row < 3; ++row) claim_identical(study, row);
}

}  // namespace linear_pendulum

std::vector<Experiment> linear_pendulum_experiments() {
  using namespace linear_pendulum;
  std::vector<Experiment> all{{{"T3.1", gross, "88", "starts of the linear double pendulum, absolute angles"},
                               [](Study& study) { starts(study, true); }},
                              {{"T3.2", gross, "98", "starts of the linear double pendulum, relative angles"},
                               [](Study& study) { starts(study, false); }}};
  struct Pages {
    const char* over_t;
    const char* planes;
    const char* page;
    const char* page_of_planes;
  };
  constexpr std::array<Pages, 6> pages{{{"G3.4", "G3.6", "89", "91"},
                                        {"G3.7", "G3.8", "92", "93"},
                                        {"G3.9", "G3.10", "94", "95"},
                                        {"G3.13", "G3.14", "100", "101"},
                                        {"G3.15", "G3.16", "102", "103"},
                                        {"G3.17", "G3.18", "104", "105"}}};
  for (std::size_t i = 0; i < pages.size(); ++i) {
    const Motion& motion = motions[i];
    const std::string what =
        fmt::format("linear double pendulum, {} angles, {}", motion.absolute ? "absolute" : "relative",
                    motion.mode == 0   ? "a small start"
                    : motion.mode == 1 ? "first eigenform"
                                       : "second eigenform");
    all.push_back({{pages[i].over_t, gross, pages[i].page, what}, [&motion](Study& study) {
                     over_t(study, motion);
                     if (motion.mode != 0) return;
                     if (motion.absolute) {
                       claim_amplitudes(study, motion, {-0.8959177992, 0.7959177992}, "-0.8959177992, +0.7959177992",
                                        "94", "3.85");
                     } else {
                       claim_amplitudes(study, motion, {0.03890599608, 0.06109400392}, "0.03890599608, 0.06109400392",
                                        "104", "3.115");
                       study.claim(
                           {"caption", "the caption of figure 3.17 names the start of table 3.2", "(0.1, -0.01)"},
                           at_most(5e-3, "two printed numbers, each to two decimals"),
                           {{std::abs(-0.01 - (-0.11)), 0, "the caption says -0.01, the table -0.11"}},
                           Grounds::identity);
                     }
                   }});
    all.push_back({{pages[i].planes, gross, pages[i].page_of_planes, what + ", phase planes"},
                   [&motion](Study& study) { in_phase_planes(study, motion); }});
  }
  return all;
}

}  // namespace hamflow::reproduction
