// [Sonnleitner2010]: statements of the text about flows, maps and paths, by page, each with an example that decides it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "../experiment.hpp"
#include "../scenarios.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow::reproduction {

namespace sonnleitner_theory {

using Matrix = std::array<std::array<double, 2>, 2>;
double determinant(const Matrix& m) { return m[0][0] * m[1][1] - m[0][1] * m[1][0]; }
Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 2; ++k) c[i][k] = a[i][0] * b[0][k] + a[i][1] * b[1][k];
  }
  return c;
}
double off_identity(const Matrix& m) {
  return std::max({std::abs(m[0][0] - 1), std::abs(m[1][1] - 1), std::abs(m[0][1]), std::abs(m[1][0])});
}

/// By elimination with pivots.
double determinant_of(std::vector<State<double>> rows) {
  double product = 1;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto pivot = std::max_element(rows.begin() + static_cast<std::ptrdiff_t>(k), rows.end(),
                                        [k](const auto& a, const auto& b) { return std::abs(a[k]) < std::abs(b[k]); });
    if (pivot != rows.begin() + static_cast<std::ptrdiff_t>(k)) std::swap(*pivot, rows[k]), product = -product;
    product *= rows[k][k];
    for (std::size_t i = k + 1; i < rows.size(); ++i) {
      const double factor = rows[i][k] / rows[k][k];
      for (std::size_t j = k; j < rows.size(); ++j) rows[i][j] -= factor * rows[k][j];
    }
  }
  return product;
}

/// Page 9: the content of M(t), of chosen pairs (q_i, p_i), is that of M(0), whatever the others do.
void selected_volume(Study& study) {
  const auto problem_entry = usual_problem("t-tube");
  const ProblemEntry& problem = *problem_entry;
  const Texts given{{"masses", "[1, 1]"}, {"eps", "0.6"}};
  const auto map = problem.step_map({.problem = "t-tube",
                                     .variant = {},
                                     .parameters = complete(problem.info, given),
                                     .start = {},
                                     .method = parse_method("stv4")},
                                    2);
  const State<double> start{0.3, 0.8, 0.5, -0.2};  // Q1, Q2, P1, P2
  State<double> z = start;
  std::vector<State<double>> tangents(4, State<double>(4));
  for (std::size_t i = 0; i < 4; ++i) tangents[i][i] = 1;
  map->advance_with_tangents(z, tangents, 1e-3, 1000);
  constexpr std::array<std::size_t, 2> chosen{0, 2};
  Matrix by_tangents{}, by_flow{};
  for (std::size_t k = 0; k < 2; ++k) {
    const long double h = 1e-4L;
    State<long double> more(start.begin(), start.end()), less = more;
    more[chosen[k]] += h, less[chosen[k]] -= h;
    more = map->flow(more, 1), less = map->flow(less, 1);
    for (std::size_t i = 0; i < 2; ++i) {
      by_tangents[i][k] = tangents[chosen[k]][chosen[i]];
      by_flow[i][k] = static_cast<double>((more[chosen[i]] - less[chosen[i]]) / (2 * h));
    }
  }
  study.claim(
      {"selected", "the volume of chosen positions and their momenta is conserved, whatever the other coordinates do",
       "mu(M(t)) = mu(M(0))"},
      within(1, 1e-3,
             "area of a small set of (Q1, P1) after the time 1 divided by that before, if Q2 and P2 begin equal"),
      {{determinant(by_tangents), 1e-8, "T-tube without walls, masses 1, eps = 0.6, tangents of stv4"},
       {determinant(by_flow), 1e-5, "divided differences of the exact flow"}},
      Grounds::ways);
  study.claim({"all", "the volume of all positions and momenta is conserved (Liouville)", "mu(M(t)) = mu(M(0))"},
              within(1, 1e-10, "the same volume ratio, for all four coordinates"),
              {{determinant_of(tangents), 1e-12, "determinant of the tangent map of stv4"}});
}

/// Page 15: weakly reversible and symmetric <=> reversible. Psi(t), the exact flow over t of p^2/2 + k q^2/2 with
/// k = 1 + t fixed, is reversible for each t, as the flow of any H that is even in p is.
void equivalence(Study& study) {
  const auto psi = [](double t) {
    const double w = std::sqrt(1 + t), c = std::cos(w * t), s = std::sin(w * t);
    return Matrix{{{c, s / w}, {-w * s, c}}};
  };
  const Matrix turn{{{1, 0}, {0, -1}}};
  const double t = 0.5;
  const Matrix there = product(turn, psi(t));
  const double reversible = off_identity(product(there, there));
  const double symmetric = off_identity(product(psi(-t), psi(t)));
  const Matrix back = product(turn, product(psi(-t), turn));
  double weakly = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 2; ++k) weakly = std::max(weakly, std::abs(back[i][k] - psi(t)[i][k]));
  }
  const std::string example =
      "Psi(t) is the flow of p^2/2 + k q^2/2 over the time t, with k = 1 + t fixed for each t; t = 0.5";
  study.claim(
      {"reversible", "a map that is time-reversible is symmetric and weakly reversible", "<="},
      at_most(1e-12, "|Psi(-t) Psi(t) - id| of a map with S Psi(t) S Psi(t) = id"),
      {{symmetric, 1e-15,
        fmt::format("{}: |S Psi S Psi - id| = {:.1g}, |S Psi(-t) S - Psi(t)| = {:.2g}", example, reversible, weakly)}},
      Grounds::identity);
}

/// How far a run ends from where it should.
double off(const Trajectory& run, double x, double y) { return std::hypot(run.q.back()[0] - x, run.q.back()[1] - y); }
/// Page 30: only with phi(r) = r^0, r^1, r^2 is there an analytic solution.
void solvable(Study& study) {
  // Kepler, mu = k = 1, from the pericentre of an ellipse: a = 2, e = 1/2, by Kepler's equation.
  const double a = 2, e = 0.5, T = 2, n = std::pow(a, -1.5);
  double E = n * T;
  for (int i = 0; i < 50; ++i) E -= (E - e * std::sin(E) - n * T) / (1 - e * std::cos(E));
  const Trajectory kepler = study.run("kepler", scenario_of("kepler_ellipse"));
  const double of_kepler = off(kepler, a * (std::cos(E) - e), a * std::sqrt(1 - e * e) * std::sin(E));
  // phi = r^-2: r^2 is a polynomial of t, and the angle an arctangent.
  const double u = 0.3, v = 0.7, b = 2 * u, c = u * u + v * v + 2;
  const double r = std::sqrt(1 + b * T + c * T * T), root = std::sqrt(4 * c - b * b);
  const double angle = v * 2 / root * (std::atan((2 * c * T + b) / root) - std::atan(b / root));
  const Trajectory inverse = study.run("inverse_square", scenario_of("inverse_square"));
  const double of_inverse = off(inverse, r * std::cos(angle), r * std::sin(angle));
  study.claim({"solvable", "only motions with pair potentials phi(r) = r^0, r^1, r^2 have an analytic solution",
               "phi(r) = r^0, r^1, r^2"},
              at_least(1e-9, "distance of a closed form from the motion, of other potentials"),
              {{of_kepler, 1e-12, "phi = -1/r: Kepler's ellipse, t = 2, against taylor"},
               {of_inverse, 1e-12, "phi = 1/r^2: r^2 = 1 + 0.6 t + 2.58 t^2, against taylor"}},
              Grounds::identity);
}

/// The path between two bounces, off the origin.
Trajectory flight(Study& study, const std::string& name, const std::string& masses) {
  return study.run(name, scenario_of("t_tube", in_steps("0.001", 900, 10)),
                   {"problem.masses=" + masses, "problem.initial={ q = [-0.5, 0.6], v = [1, 0.5] }"});
}
/// Largest change of Q1 Q2' - Q2 Q1', of its start: none under a central force.
double change_of_area_rate(const Trajectory& run, double m1, double m2) {
  const auto rate = [&](std::size_t i) { return run.q[i][0] * run.p[i][1] / m2 - run.q[i][1] * run.p[i][0] / m1; };
  double largest = 0;
  for (std::size_t i = 0; i < run.size(); ++i) largest = std::max(largest, std::abs(rate(i) / rate(0) - 1));
  return largest;
}
/// How far 1/r is from the conic A + B cos phi + C sin phi through the first, the middle and the last place: the path
/// of a body about a fixed centre with 1/r^2, however strong it is and however fast the body.
double off_conic(const Trajectory& run) {
  const auto row = [&](std::size_t i) {
    const double r = std::hypot(run.q[i][0], run.q[i][1]);
    return State<double>{1, run.q[i][0] / r, run.q[i][1] / r, 1 / r};
  };
  const std::array<State<double>, 3> at{row(0), row(run.size() / 2), row(run.size() - 1)};
  const auto with = [&](std::size_t replaced) {  // Cramer
    std::vector<State<double>> rows;
    for (const State<double>& one : at) {
      rows.push_back({one[0], one[1], one[2]});
      if (replaced < 3) rows.back()[replaced] = one[3];
    }
    return determinant_of(rows);
  };
  const double all = with(3);
  const std::array<double, 3> conic{with(0) / all, with(1) / all, with(2) / all};
  double largest = 0;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const State<double> one = row(i);
    const double fitted = conic[0] + conic[1] * one[1] + conic[2] * one[2];
    largest = std::max(largest, std::abs(fitted / one[3] - 1));
  }
  return largest;
}

/// Page 94: (Q1(t), Q2(t)) is exactly the path of one body about a fixed source of the force.
void billiard(Study& study) {
  const Trajectory table = flight(study, "path", "[1, 100]"), equal = flight(study, "equal_masses", "[1, 1]");
  study.claim(
      {"one_body",
       "(Q1, Q2) is exactly the path of a single body on a table with a fixed source of the force at the origin",
       "exactly"},
      at_most(1e-6, "relative departure from Kepler's laws for a fixed centre"),
      {{change_of_area_rate(table, 1, 100), 1e-9,
        fmt::format("change of Q1 Q2' - Q2 Q1' between two bounces, masses 1 and 100; with equal masses {:.1g}",
                    change_of_area_rate(equal, 1, 1))},
       {off_conic(table), 1e-9,
        fmt::format("1/r from a conic with its focus at the origin, any speed and strength; with equal masses "
                    "{:.1g}",
                    off_conic(equal))}},
      Grounds::ways);
}

/// The share of n^4 equal cells of [-1, 1] x [0.1, 2.1] x [-X, X] x [-Y, Y] that H = E may meet: of a cell of Q1, Q2,
/// P1 the energy leaves P2 an interval, and its mirror image.
double share_met(double eps, double X, double Y, int n) {
  const double E = 50 - eps / 1.1;
  std::int64_t met = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double left = -1 + 2.0 * i / n, right = left + 2.0 / n, low = 0.1 + 2.0 * j / n, high = low + 2.0 / n;
      const double nearest = left <= 0 && right >= 0 ? 0 : std::min(std::abs(left), std::abs(right));
      const double r_least = std::hypot(nearest, low),
                   r_most = std::hypot(std::max(std::abs(left), std::abs(right)), high);
      const double V_least = std::min(-eps / r_least, -eps / r_most), V_most = std::max(-eps / r_least, -eps / r_most);
      for (int k = 0; k < n; ++k) {
        const double p_low = -X + 2 * X * k / n, p_high = p_low + 2 * X / n;
        const double p_least = p_low <= 0 && p_high >= 0 ? 0 : std::min(std::abs(p_low), std::abs(p_high));
        const double p_most = std::max(std::abs(p_low), std::abs(p_high));
        const double least = std::sqrt(std::max(0.0, 200 * (E - V_most - p_most * p_most / 2)));
        const double most = std::sqrt(std::max(0.0, 200 * (E - V_least - p_least * p_least / 2)));
        for (int l = 0; l < n; ++l) {
          const double a = -Y + 2 * Y * l / n, b = a + 2 * Y / n;
          met += (a <= most && b >= least) || (a <= -least && b >= -most);
        }
      }
    }
  }
  return static_cast<double>(met) / std::pow(n, 4);
}

/// The share of 4.5 x 100.3 in which some place of the T-tube leaves the energy E to the momenta: -eps/r goes from r =
/// 0.1 to the corner (1, 2.1).
double share_of_momenta(double E, double eps) {
  const double nearest = -eps / 0.1, farthest = -eps / std::hypot(1, 2.1);
  const double least = std::min(nearest, farthest), most = std::max(nearest, farthest);
  constexpr int n = 1000;
  int met = 0;
  for (int k = 0; k < n; ++k) {
    for (int l = 0; l < n; ++l) {
      const double p1 = 4.5 * (k + 0.5) / n, p2 = 100.3 * (l + 0.5) / n, V = E - p1 * p1 / 2 - p2 * p2 / 200;
      met += V >= least && V <= most;
    }
  }
  return static_cast<double>(met) / (n * n);
}

/// Page 87: late points of phase space (almost) fill a range of four dimensions; page 90: on curves that are run
/// through periodically; page 91: the momenta of the transient fill a rectangle.
void filled(Study& study) {
  const double coarse = share_met(0.6, 4.29, 100, 10), fine = share_met(0.6, 4.29, 100, 40);
  study.claim(
      {"filled",
       "late points fill a four-dimensional range of phase space (87), on curves that the motion passes "
       "periodically (90)",
       "(almost) completely filled; discrete, periodic curves", "87, 90"},
      at_least(0.5, "share of the range that the energy allows, P1 within 4.29 and P2 within 100: at least half"),
      {{coarse, 0, "among 10^4 equal cells, those that the surface H = E meets, Sim+0.6I"},
       {fine, 0, "among 40^4 cells: the share keeps falling, and a closed curve fills nothing"}},
      Grounds::identity);
  double share = 0;
  for (const double eps : {-0.6, 0.6}) {
    for (const double v1 : {0.0, 1.0}) share = std::max(share, share_of_momenta(50 + v1 * v1 / 2 - eps / 1.1, eps));
  }
  study.claim(
      {"dense_momenta", "the momenta of the transient densely fill the rectangle 4.5 x 100.3 (3.5b)", "densely", "91"},
      at_least(0.99, "share of the rectangle that the energy allows"),
      {{share, 0.002, "v = (0, 1) and (1, 1), eps = 0.6 and -0.6: the largest"}}, Grounds::identity);
  study.note(
      "P2 changes its sign only at a bounce. If a plot joins its points by lines, they cross the rectangle there.");
}

}  // namespace sonnleitner_theory

std::vector<Experiment> sonnleitner_theory_experiments() {
  using namespace sonnleitner_theory;
  return {{{"S-C9", sonnleitner, "9", "volumes of chosen coordinates"}, selected_volume},
          {{"S-C15", sonnleitner, "15", "reversible against symmetric"}, equivalence},
          {{"S-C30", sonnleitner, "30", "potentials with an analytic solution"}, solvable},
          {{"S-C87", sonnleitner, "87, 90, 91", "T-tube: what a motion fills"}, filled},
          {{"S-C90", sonnleitner, "94", "T-tube: the path as that of one body"}, billiard}};
}

}  // namespace hamflow::reproduction
