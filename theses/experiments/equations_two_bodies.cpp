// [Gross1999, chapters 1 and 2]: equations whose printed form is put against the motion, against dual numbers or
// against a quadrature. The number of each claim is by how much the printed form is off; the right one is told beside
// it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../experiment.hpp"
#include "../scenarios.hpp"
#include "../trajectories.hpp"
#include "hamflow/numerics/quadrature.hpp"
#include "hamflow/numerics/root.hpp"

namespace hamflow::reproduction {

namespace equations_two_bodies {

constexpr double pi = std::numbers::pi;

/// Figure 2.9: mu = 2, k = 1, r from 1 to 3.
Trajectory ellipse(Study& study) {
  return study.run("ellipse", scenario_of("G2.9"), in_steps("0.05", 400, 1, by_series));
}

constexpr double limit = 1e-9;  // of a printed form that is right: rounding and quadrature
/// A largest value along the ellipse lies within half a step of 0.025 of a sample. Those that are looked for have
/// second derivatives of at most 0.009: what samples miss is less than 0.009 * 0.025^2/2.
constexpr double between_samples = 3e-6;

/// A claim that a printed form is right: how far it is off, and how far the right one is.
void claim(Study& study, const char* name, const char* page, const std::string& statement, const std::string& printed,
           double off, const std::string& right, double right_off, double uncertainty = limit) {
  study.claim(
      {name, statement, printed, page}, at_most(limit, "the equation holds to rounding and quadrature"),
      {{off, uncertainty, fmt::format("largest deviation of the printed form; of {}: {:.2g}", right, right_off)}},
      Grounds::identity);
}

void of_motion(Study& study) {
  const Trajectory run = ellipse(study);
  constexpr double mu = 2, k = 1, m1 = 3, m2 = 6;  // m1 m2/(m1 + m2) = 2
  const double l = run.q[0][0] * run.p[0][1] - run.q[0][1] * run.p[0][0], E = run.energy[0];
  double energy_off = 0, energy_right = 0;
  std::array<double, 4> rate_off{};
  for (std::size_t i = 0; i < run.size(); ++i) {
    const double r = std::hypot(run.q[i][0], run.q[i][1]);
    const double T = (run.p[i][0] * run.p[i][0] + run.p[i][1] * run.p[i][1]) / (2 * mu);
    energy_off = std::max(energy_off, std::abs(T + k / r - (k / 1.0 + l * l / (2 * mu))));
    energy_right = std::max(energy_right, std::abs(T - k / r - E));
    const double rate = (run.q[i][0] * run.p[i][0] + run.q[i][1] * run.p[i][1]) / (mu * r);
    const std::array<double, 4> masses{m1, m2, m1 + m2, mu};
    for (std::size_t j = 0; j < 4; ++j) {
      const double radicand = std::max(0.0, 2 / masses[j] * (E + k / r - l * l / (2 * mu * r * r)));
      rate_off[j] = std::max(rate_off[j], std::abs(radicand - rate * rate));
    }
  }
  claim(study, "2.53", "28", "by equation 2.53 H = p^2/(2 mu) - V is the energy, which is constant", "- V(q)",
        energy_off, "+ V", energy_right, between_samples);
  claim(study, "2.25", "21",
        "equation 2.25, and with it 2.27, 2.28 and 2.29, is r'^2 = 2/m (E - V - l^2/(2 mu r^2)): chapter 2 has no mass "
        "m, which is read as m1, m2 or m1 + m2",
        "2/m", *std::min_element(rate_off.begin(), rate_off.begin() + 3), "mu (m is a slip)", rate_off[3],
        between_samples);
  study.note(
      "Equation 2.25 is tested on the ellipse of figure 2.9, mu = 2, with m1 = 3 and m2 = 6. The deviation above is "
      "the "
      "smallest of the three readings: 1/36, for m = m1.");
  // The circle of figure 2.8 at phi = 90 degrees: l = 2, r = 2.
  const std::array<double, 2> printed{-1, 0}, p{-1, 0}, p_dot{0, -0.25};
  claim(study, "2.126", "41", "by equation 2.126 the time derivative of p on a circle is l/r (-sin, cos)",
        "p with a dot", std::hypot(printed[0] - p_dot[0], printed[1] - p_dot[1]), "p itself",
        std::hypot(printed[0] - p[0], printed[1] - p[1]));
  const double V = 2 * 1, of_l = 1 * 9 * 2 * 2.0 * 2 / 4;  // k = 2, mu = 2, r from 1 to 3: l^2 of 2.164
  const double right = V + of_l / (2 * mu * 1);
  claim(study, "2.165", "60", "equation 2.165 is E = k (r1 + r2) - r1 r2/(r1 + r2), tried for k = 2 and r from 1 to 3",
        "without k", std::abs(2 * 4 - 3.0 / 4 - right), "k r1 r2/(r1 + r2)", std::abs(2 * 4 - 2 * 3.0 / 4 - right));
}

void of_integrals(Study& study) {
  // From pericentre to apocentre of the Hooke ellipse of figure 2.15, w = 1/r^2 from 1/9 to 1: gamma = -1.
  const double w1 = 1.0 / 9, w2 = 1;
  double sum = 0;
  constexpr int points = 64;
  for (int i = 0; i < points; ++i) sum += pi / points;  // 1/sqrt((w - w1)(w2 - w)), by Gauss and Chebyshev
  claim(study, "2.36", "24",
        "by equation 2.36, dphi = dw/sqrt(...), a Hooke ellipse takes a quarter turn from pericentre to apocentre",
        "without 1/2", std::abs(sum - pi / 2), "half of it, as equation 2.139 has", std::abs(sum / 2 - pi / 2));
  const double gamma = -1, beta = w1 + w2, alpha = -w1 * w2, from = 0.3, to = 0.6;
  const auto F = [&](double u) {
    return std::acos(-(2 * gamma * u + beta) / std::sqrt(beta * beta - 4 * gamma * alpha)) / std::sqrt(-gamma);
  };
  const Integral integral =
      integrate([&](long double u) { return 1 / std::sqrt(gamma * u * u + beta * u + alpha); }, from, to);
  const double exact = static_cast<double>(integral.value);
  claim(study, "2.109", "38", "equations 2.109 and 2.140 are the integral of 1/sqrt(gamma u^2 + beta u + alpha)",
        "+arccos(-(2 gamma u + beta)/sqrt(...))", std::abs(F(to) - F(from) - exact), "minus that",
        std::abs(F(from) - F(to) - exact));
  // (2.143) of figure 2.15: p = l^2/(mu E) = 9/5, eps = 4/5.
  const auto r = [](double angle) { return std::sqrt(1.8 / (1 + 0.8 * std::cos(angle))); };
  claim(study, "2.147", "50", "above equation 2.147 the apocentre is at 2 phi = phi'' + 2 pi", "2 pi",
        std::abs(r(2 * pi) - 3), "pi", std::abs(r(pi) - 3));
  // Remark 2.9: with -eps for eps, cos(2 phi) becomes cos(2 (phi + pi/2)).
  const auto orbit = [](double eps, double phi) { return std::sqrt(1.8 / (1 + eps * std::cos(2 * phi))); };
  double half_turn = 0, quarter_turn = 0;
  for (int i = 0; i < 64; ++i) {
    const double phi = pi * i / 32;
    half_turn = std::max(half_turn, std::abs(orbit(-0.8, phi) - orbit(0.8, phi - pi)));
    quarter_turn = std::max(quarter_turn, std::abs(orbit(-0.8, phi) - orbit(0.8, phi - pi / 2)));
  }
  claim(study, "remark_2.9", "50",
        "by remark 2.9 a negative eps turns the Hooke orbit, equation 2.143, by 180 degrees, tried on figure 2.15",
        "180 degrees", half_turn, "90 degrees", quarter_turn);
  // M^-1 of polar coordinates at r = 2, p = (1, 3), mu = 2: both readings of the first line of 2.91.
  const double by_p = 3 / (2 * 4.0), by_q = -9 / (2 * 8.0), force = -9 / (2 * 8.0);
  claim(study, "2.91", "34", "the first line of equation 2.91 has dT/dq as the derivative with respect to p",
        "with respect to p", std::hypot(1 / 2.0 - force, by_p), "with respect to q", std::abs(by_q - force));
}

/// H along an element of figure 2.9: equation 1.54 has to be about H, not about its derivative.
void of_element(Study& study) {
  const Trajectory run = study.run("element", scenario_of("G2.9"), in_steps("0.1", 8));
  const auto slope = [&](std::size_t at) {
    const auto &a = run.q[7], &b = run.q[8], &q = run.q[at], &p = run.p[at];
    const double r = std::hypot(q[0], q[1]);
    double sum = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      sum += q[i] / (r * r * r) * (b[i] - a[i]) + p[i] / 2 * (run.p[8][i] - run.p[7][i]);
    }
    return sum;
  };
  claim(study, "1.54", "11",
        "by equation 1.54 dH/d(alpha) is the same at both ends of an element of an autonomous system", "[dH/d(alpha)]",
        std::abs(slope(8) - slope(7)), "H", std::abs(run.energy[8] - run.energy[7]));
}

/// The angle of a radial period in V = r, mu = 2, from r = 1 to b: equation 2.43 by Gauss and Chebyshev, and its time.
std::array<double, 2> radial_period(double b) {
  const double square = 2 * 2 * b * b / (1 + b);  // l^2, equation 2.164
  const double E = 1 + b - b / (1 + b);
  constexpr int points = 80;
  double angle = 0, time = 0;
  for (int i = 0; i < points; ++i) {
    const double r = (1 + b) / 2 - (b - 1) / 2 * std::cos(pi * (i + 0.5) / points);
    const double rest = (E - r - square / (4 * r * r)) / ((r - 1) * (b - r));
    time += 2 / std::sqrt(rest) * pi / points;
    angle += 2 * std::sqrt(square) / 2 / (r * r) / std::sqrt(rest) * pi / points;
  }
  return {angle, time};
}

void of_closed_orbit(Study& study) {
  const auto off = [](double b) { return radial_period(b)[0] - 10 * pi / 9; };
  const double b = bracketed_root(off, 1.5, 8, off(1.5), off(8));
  const auto [angle, time] = radial_period(b);
  const auto run = [&, &time = time](const char* name, const std::string& method) {
    std::vector<std::string> sets = in_steps(fmt::format("{:.17g}/400", time), 3600, 1, method);
    sets.push_back(fmt::format("problem.orbit.r_aph={:.17g}", b));
    return study.run(name, scenario_of("G2.20"), sets);
  };
  const Trajectory series = run("closed", by_series), other = run("closed_other", "method={ name = \"rkn8-s19\" }");
  const auto returned = [](const Trajectory& t) {
    return std::hypot(t.q.back()[0] - t.q.front()[0], t.q.back()[1] - t.q.front()[1]);
  };
  study.claim(
      {"not_all_closed", "the bounded orbits of the linear potential are not all closed",
       "gesamten begrenzten Bahnen nicht geschlossen", "56"},
      at_least(0.01,
               "change of the angle of a radial period from one orbit to another, in radians. If it changes, all "
               "orbits are open except those of special pairs (E, l)"),
      {{std::abs(radial_period(1.5)[0] - radial_period(8)[0]), 1e-9, "r from 1 to 1.5 and from 1 to 8"}});
  study.claim({"closed_exceptions", "the linear potential also has special pairs (E, l) with a closed orbit",
               "mit Ausnahme spezieller Paare (E,l)", "26"},
              at_most(1e-6, "the distance at which the orbit of r from 1 to b returns after nine radial periods"),
              {{returned(series), 1e-9,
                fmt::format("b = {:.15g}, Taylor series; the angle of a radial period is 2 pi 5/9 to {:.1g}", b,
                            std::abs(angle - 10 * pi / 9))},
               {returned(other), 1e-9, "rkn8-s19"}});
  const auto after_a_turn = [](const Trajectory& t) {
    double turned = 0;
    for (std::size_t i = 1; i < t.size(); ++i) {
      const auto &p = t.q[i - 1], &q = t.q[i];
      const double step = std::atan2(p[0] * q[1] - p[1] * q[0], p[0] * q[0] + p[1] * q[1]);
      if (turned + step >= 2 * pi) {
        const double share = (2 * pi - turned) / step;
        return (1 - share) * std::hypot(p[0], p[1]) + share * std::hypot(q[0], q[1]);
      }
      turned += step;
    }
    return std::nan("");
  };
  study.claim({"2.37", "an orbit is closed only if r(phi) = r(phi + 2 pi), equation 2.37", "notwendig", "24"},
              at_most(1e-3, "r after the first turn of that closed orbit less r at its start, linear between samples"),
              {{after_a_turn(series) - 1, 1e-3, "Taylor series"}, {after_a_turn(other) - 1, 1e-3, "rkn8-s19"}},
              Grounds::ways);
}

}  // namespace equations_two_bodies

std::vector<Experiment> equations_two_bodies_experiments() {
  return {{{"G-E2", gross, "11-61", "equations of chapters 1 and 2"}, [](Study& study) {
             equations_two_bodies::of_motion(study);
             equations_two_bodies::of_integrals(study);
             equations_two_bodies::of_element(study);
             equations_two_bodies::of_closed_orbit(study);
           }}};
}

}  // namespace hamflow::reproduction
