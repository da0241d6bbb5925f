// [Sonnleitner2010]: claims of the text and of the listings that need no long run, by page.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../experiment.hpp"
#include "../scenarios.hpp"
#include "../t_tube_runs.hpp"
#include "../time_panels.hpp"
#include "../trajectories.hpp"

namespace hamflow::reproduction {

namespace sonnleitner_texts {

/// Figure 1.2 and its example: H = p^2/2 - q, the problem free-fall with gravity -1.
Trajectory fall(Study& study, const std::string& name, double q, double p) {
  return study.run(name, scenario_of("free_fall"),
                   {fmt::format("problem.initial={{ q = [{:.17g}], p = [{:.17g}] }}", q, p)});
}

void reversible(Study& study) {
  const double q0 = 0.3, p0 = 0.7, T = 2;
  const Trajectory there = fall(study, "there", q0, p0);
  const double q = there.q.back()[0], p = there.p.back()[0];
  const Trajectory back = fall(study, "back", q, -p);
  const double rounding = 0x1p-53;
  study.claim(
      {"returns", "if the motion continues with its momentum negated, it reaches its start after 2 T", "(q0, -p0)"},
      at_most(1000 * 4 * rounding, "1000 additions of numbers up to 4"),
      {{std::max(std::abs(back.q.back()[0] - q0), std::abs(back.p.back()[0] + p0)), 0,
        "verlet on free-fall, which it solves exactly except for rounding"}});
  study.claim({"flow", "the motion is q0 + p0 T + T^2/2, p0 + T", "q0 + p0 T + T^2/2, p0 + T", "17"},
              at_most(1000 * 4 * rounding, "1000 additions of numbers up to 4"),
              {{std::max(std::abs(q - (q0 + p0 * T + T * T / 2)), std::abs(p - (p0 + T))), 0, "verlet"}});
  figures::Panel panel = phase_plane("{/:Italic q}", "{/:Italic p}", there.coordinate(0), there.momentum(0),
                                     back.coordinate(0), back.momentum(0));
  panel.series.front().name = "back";
  panel.series.back().name = "there";
  study.draw("figure", "Forward (dots) and back (line): both pass the same positions, with opposite momenta",
             {study.info().title, {panel}});
}

/// "In which state must the motion have been at -T to reach (q0, p0) after T?" The thesis answers Phi(T; q0, p0).
void past_state(Study& study) {
  const double q0 = 0.3, p0 = 0.7, T = 2;
  const auto flow = [](double q, double p, double t) { return std::pair{q + p * t + t * t / 2, p + t}; };
  const auto off = [&](double t) {
    const auto [r, s] = flow(q0, p0, t);
    const auto [q, p] = flow(r, s, T);
    return std::max(std::abs(q - q0), std::abs(p - p0));
  };
  study.claim({"past", "the motion that reaches (q0, p0) after T starts in the state that (q0, p0) reaches after T",
               "q0 + p0 T + T^2/2, p0 + T"},
              at_most(1e-12, "the flow over T leads from there to (q0, p0)"),
              {{off(T), 1e-14,
                fmt::format("distance, T = 2; from the state at -T it is {:.1g}. The equation below the answer, "
                            "Phi(-T; r, s) = (q0, p0), is solved correctly, but it answers another question",
                            off(-T))}},
              Grounds::identity);
}

/// f of V = q^-12 - 2 q^-6.
double force(double q) { return 12 * (std::pow(q, -13) - std::pow(q, -7)); }
double force_slope(double q) { return -156 * std::pow(q, -14) + 84 * std::pow(q, -8); }
double force_curvature(double q) { return 2184 * std::pow(q, -15) - 672 * std::pow(q, -9); }

/// p''' of the flow, page 55: f'' p^2 + f' f(q), printed twice with f(p).
void third_derivative(Study& study) {
  const double q = 1.2, p = 0.8;
  const auto at = [&](double h, const std::string& name) {
    const Trajectory run =
        study.run(name, scenario_of("lennard_jones", in_steps(fmt::format("{}", h), 1, 1, by_series)),
                  {fmt::format("problem.initial={{ q = [{}], p = [{}] }}", q, p)});
    return force_slope(run.q.back()[0]) * run.p.back()[0];  // p''
  };
  const double h = 1e-4;
  const double measured = (at(h, "after") - at(-h, "before")) / (2 * h);
  const double printed = force_curvature(q) * p * p + force_slope(q) * force(p);
  const double right = force_curvature(q) * p * p + force_slope(q) * force(q);
  study.claim(
      {"third", "the third derivative of the momentum along the flow is f'' p^2 + f' f(p)", "f'(q) f(p)"},
      at_most(1e-3, "relative difference from a divided difference of p'' = f' p along the motion"),
      {{std::abs(printed - measured) / std::abs(measured), 1e-5,
        fmt::format("with f(q) in place of f(p) it is {:.2g}", std::abs(right - measured) / std::abs(measured))}},
      Grounds::identity);
}

/// Page 24: p = G' (G'^T G')^-1 P. For one coordinate Q and two bodies at q = (Q, Q^2/2) with masses 1 and 5 momenta
/// are p = M G' Q', P = G'^T M G' Q'.
void generalised_momentum(Study& study) {
  const double m[] = {1, 5}, Q = 0.7, rate = 1.3;
  const double slope[] = {1, Q};  // G'
  double mass = 0, plain = 0;
  for (int i = 0; i < 2; ++i) mass += slope[i] * m[i] * slope[i], plain += slope[i] * slope[i];
  const double P = mass * rate;
  double printed_off = 0, right_off = 0, printed_energy = 0, energy = 0;
  for (int i = 0; i < 2; ++i) {
    const double p = m[i] * slope[i] * rate;
    printed_off = std::max(printed_off, std::abs(slope[i] / plain * P - p));
    right_off = std::max(right_off, std::abs(m[i] * slope[i] / mass * P - p));
    printed_energy += std::pow(slope[i] / plain * P, 2) / (2 * m[i]);
    energy += p * p / (2 * m[i]);
  }
  study.claim({"momentum", "momenta of generalised coordinates, p = G'(G'^T G')^-1 P", "without the masses"},
              at_most(1e-12, "p = M dq/dt and P = dL/dQ', by differentiation"),
              {{printed_off, 1e-15,
                fmt::format("masses 1 and 5, q = (Q, Q^2/2): off by {:.3g}; M G'(G'^T M G')^-1 P by {:.1g}",
                            printed_off, right_off)}},
              Grounds::identity);
  study.claim({"energy", "the transformed Hamiltonian is the energy", "H(G(Q), p)"},
              at_most(1e-12, "relative difference of the two kinetic energies"),
              {{std::abs(printed_energy / energy - 1), 1e-15, "the same example"}}, Grounds::identity);
  // The T-tube: Cartesian momenta of a state as the library has them, M G' (G'^T M G')^-1 P, against G' (G'^T G')^-1 P
  // with G = (Q1, 0, 0, Q2).
  const auto momenta_at = [&](const char* coordinates, const char* state, const char* method) {
    return study
        .run(coordinates, scenario_of("t_tube", in_steps("0.01", 0)),
             {fmt::format("problem.coordinates={}", coordinates), fmt::format("problem.initial={{ {} }}", state),
              fmt::format("method.name={}", method)})
        .p.front();
  };
  const std::vector<double> own = momenta_at("generalised", "q = [0.3, 0.8], v = [3, 2]", "stv4");
  const std::vector<double> freed = momenta_at("cartesian", "q = [0.3, 0, 0, 0.8], v = [3, 0, 0, 2]", "rattle");
  const double tube_slope[4][2] = {{1, 0}, {0, 0}, {0, 0}, {0, 1}};
  double tube_off = 0;
  for (int i = 0; i < 4; ++i) {
    double printed = 0;
    for (int k = 0; k < 2; ++k) {
      double square = 0;  // columns are orthogonal
      for (const auto& row : tube_slope) square += row[k] * row[k];
      printed += tube_slope[i][k] / square * own[static_cast<std::size_t>(k)];
    }
    tube_off = std::max(tube_off, std::abs(printed - freed[static_cast<std::size_t>(i)]));
  }
  study.claim(
      {"t_tube", "for the T-tube the formula gives p = P", "p = P", "27"},
      at_most(1e-12, "G' has orthonormal columns, each of one mass"),
      {{tube_off, 0, "largest difference from the momenta of the Cartesian system, masses 1 and 100, v = (3, 2)"}});
}

/// Page 27: the force on the heavy body at its soft walls has the power 2 left out, against pages 26 and 28.
void soft_force(Study& study) {
  const double x = 0.5, h = 1e-5;
  const auto V = [](double y) { return 0.5 / (1 - y * y); };
  const double force_of_V = -(V(x + h) - V(x - h)) / (2 * h);
  const double squared = -x / std::pow(1 - x * x, 2), plain = -x / (1 - x * x);
  study.claim(
      {"soft", "page 27 (freed system): the force of the soft wall on the heavy body is -x/(1 - x^2)", "-x/(1 - x^2)"},
      at_most(1e-6, "minus the derivative of 1/(2 (1 - x^2)), at x = 0.5"),
      {{std::abs(plain - force_of_V), std::numeric_limits<double>::infinity(),
        fmt::format(
            "-x/(1 - x^2)^2, as on pages 26 and 28, is off by {:.1g}; the available text is a transcription, which "
            "may have lost a power",
            std::abs(squared - force_of_V))}},
      Grounds::program, "a look at the printed page");
}

/// Page 102: "eps > 0: abstoszend" against page 26 and the force of page 105.
void sign_of_eps(Study& study) {
  const Trajectory run = study.run("attracting", scenario_of("t_tube", in_steps("0.01", 5, 5)),
                                   {"problem.eps=0.6", "problem.initial={ q = [0.5, 0.5], p = [0, 0] }"});
  const double before = std::hypot(0.5, 0.5), after = std::hypot(run.q.back()[0], run.q.back()[1]);
  // Each body goes by its own mass: r'' is the sum of Q_i F_i/(m_i r), of bodies at rest.
  const double F = -0.6 * 0.5 / std::pow(before, 3);
  const double change = (0.5 * F / 1 + 0.5 * F / 100) / before * 0.05 * 0.05 / 2;
  study.claim(
      {"sign", "eps > 0 repels (comment of the listing, page 102)", "eps > 0: repelling"},
      at_least(0, "change of the distance from rest; the force of page 105 and page 26 say that eps > 0 attracts"),
      {{after - before, 1e-12, "eps = 0.6, from rest, five steps"},
       {change, 1e-6, "r''t^2/2 of the printed force, page 105, masses 1 and 100, t = 0.05; without terms of t^4"}},
      Grounds::ways);
}

/// Page 107: the kinetic energy of the light body is computed as m p^2/2, on page 106 as p^2/(2 m).
void kinetic_energy_of_listing(Study& study) {
  const double m = 0.01, p = 1;
  study.claim(
      {"kinetic", "the listing's change of kinetic energy, massen(1)/2 p^2, is a change of kinetic energy",
       "1/2*massen(1)*p^2"},
      at_most(1e-12, "relative difference from p^2/(2 m) of page 106, for the masses and momenta of the listing"),
      {{std::abs(m * p * p / 2 / (p * p / (2 * m)) - 1), 1e-15,
        "m1 = 0.01, p1 = 1: it is 10^4 times too small; with m1 = 1, as in the table, both agree"}},
      Grounds::identity);
}

/// Page 85: the force of the pair changes P2 only a little, "by the conservation of momentum". The tubes take momentum.
void momentum_of_pair(Study& study) {
  const Trajectory run = study.run("pair", scenario_of("t_tube", in_steps("0.001", 200)),
                                   {"problem.initial={ q = [0.3, 0.5], p = [0, 0] }"});
  double impulse = 0;  // of both forces as printed on page 105, by the trapezoidal rule
  const auto forces = [&](std::size_t i) {
    return 0.6 * (run.q[i][0] + run.q[i][1]) / std::pow(std::hypot(run.q[i][0], run.q[i][1]), 3);
  };
  for (std::size_t i = 1; i < run.size(); ++i) impulse += (forces(i - 1) + forces(i)) / 2 * (run.t[i] - run.t[i - 1]);
  const double change1 = run.p.back()[0], change2 = run.p.back()[1];
  study.claim({"pair", "the force between the bodies keeps P1 + P2", "conservation of momentum"},
              at_most(1e-6, "|change of P1 + P2| from rest over the time 0.2, without a wall nearby"),
              {{std::abs(change1 + change2), 1e-10,
                fmt::format("eps = -0.6: P1 changes by {:.3g}, P2 by {:.3g}: each tube takes the other component",
                            change1, change2)},
               {std::abs(impulse), 1e-5, "integral of the printed forces"}},
              Grounds::ways);
}

/// Page 84: what the negated momentum keeps, and what the kept position loses.
void bounce_keeps_energy(Study& study) {
  TubeRun run{.eps = -0.6, .v1 = "6"};
  run.steps = 2000;
  run.record_every = 1;
  const Trajectory path = study.run("bounces", tube_scenario(run));
  double at_bounces = 0;
  int bounces = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (path.q[i] != path.q[i - 1]) continue;
    ++bounces;
    at_bounces = std::max(at_bounces, std::abs(path.energy[i] - path.energy[i - 1]));
  }
  study.claim({"kept", "negating the momentum at a wall keeps the Hamiltonian", "keeps it"},
              at_most(1e-13, "rounding of energies of size 68"),
              {{at_bounces, 0, fmt::format("largest change at {} bounces", bounces)}});
}

}  // namespace sonnleitner_texts

std::vector<Experiment> sonnleitner_texts_experiments() {
  using namespace sonnleitner_texts;
  return {{{"S1.2", sonnleitner, "19", "reversibility: a fall there and back"}, reversible},
          {{"S-C17", sonnleitner, "17", "the state in the past"}, past_state},
          {{"S-C24", sonnleitner, "24", "momenta of generalised coordinates"}, generalised_momentum},
          {{"S-C27", sonnleitner, "27", "force of the soft wall"}, soft_force},
          {{"S-C55", sonnleitner, "55", "the third derivative of the flow"}, third_derivative},
          {{"S-C83", sonnleitner, "83", "energy at a wall"}, bounce_keeps_energy},
          {{"S-C85", sonnleitner, "85", "order of the momenta, and their sum"},
           [](Study& study) {
             study.nothing_to_test("momenta",
                                   "m1 < m2 and kinEnKx < kinEnKy imply |P1| < |P2| by the definition of kinetic "
                                   "energy, P^2 = 2 m K: no run can contradict it");
             momentum_of_pair(study);
           }},
          {{"S-C102", sonnleitner, "102", "sign of eps in the listing"}, sign_of_eps},
          {{"S-C107", sonnleitner, "107", "kinetic energy in the listing"}, kinetic_energy_of_listing}};
}

}  // namespace hamflow::reproduction
