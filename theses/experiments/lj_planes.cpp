// [Sonnleitner2010], figures 2.1 to 2.5: the Lennard-Jones oscillator in the phase plane, H = p^2/2 + 1/q^12 - 2/q^6
// from rest at q = 1.5. Levels of a modified H, Euler against EulerA, and the way back.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../experiment.hpp"
#include "../scenarios.hpp"
#include "../time_panels.hpp"
#include "../trajectories.hpp"

namespace hamflow::reproduction {

namespace lj_planes {

std::string scenario(const std::string& method, const std::string& dt, long steps, long every = 1) {
  return scenario_of("lennard_jones", in_steps(dt, steps, every, "method={ name = \"" + method + "\" }"));
}

/// u = q^-6, of which V = u^2 - 2 u, V' = -12 (u^2 - u)/q and V'' = (156 u^2 - 84 u)/q^2.
double modified_part(double q, double p) {
  const double u = std::pow(q, -6);
  const double V1 = -12 * (u * u - u) / q, V2 = (156 * u * u - 84 * u) / (q * q);
  return p * p * V2 / 12 - V1 * V1 / 24;
}

/// 2 times the integral of 1/sqrt(2 (E - V)) between the turning points, where E - V = (u_a - u)(u - u_b), by Gauss and
/// Chebyshev.
double period(int points) {
  const double u_b = std::pow(1.5, -6), u_a = 2 - u_b;
  const double a = std::pow(u_a, -1.0 / 6), b = 1.5;
  double sum = 0;
  for (int i = 0; i < points; ++i) {
    const double q = (a + b) / 2 - (b - a) / 2 * std::cos(std::numbers::pi * (i + 0.5) / points);
    const double u = std::pow(q, -6);
    sum += 1 / std::sqrt(2 * (u_a - u) * (u - u_b) / ((q - a) * (b - q)));
  }
  return 2 * sum * std::numbers::pi / points;
}

/// The largest departures of verlet's points from the level of H and from that of H + dt^2 H_3.
struct Levels {
  double of_h = 0;
  double of_modified = 0;
};
Levels departures(const Trajectory& run, double dt) {
  const auto modified = [&](std::size_t i) {
    return run.energy[i] + dt * dt * modified_part(run.q[i][0], run.p[i][0]);
  };
  Levels levels;
  for (std::size_t i = 0; i < run.size(); ++i) {
    levels.of_h = std::max(levels.of_h, std::abs(run.energy[i] - run.energy[0]));
    levels.of_modified = std::max(levels.of_modified, std::abs(modified(i) - modified(0)));
  }
  return levels;
}

/// The two levels in the plane, with a step so large that they can be told apart.
void draw_levels(Study& study) {
  const double dt = 0.04;
  const Trajectory run = study.run("plane", scenario("verlet", "0.04", 580, 1));
  const auto H = [](double q, double p) { return p * p / 2 + std::pow(q, -12) - 2 * std::pow(q, -6); };
  const auto modified = [&](double q, double p) { return H(q, p) + dt * dt * modified_part(q, p); };
  figures::Extent across, up;
  for (const double q : {0.8, 1.6}) across.include(q);
  for (const double p : {-1.6, 1.6}) up.include(p);
  const figures::Curve of_h = figures::level_curve(H, run.energy[0], across, up),
                       of_modified = figures::level_curve(modified, modified(1.5, 0), across, up);
  study.keep({"level_of_h", {{"q", of_h.x}, {"p", of_h.y}}});
  study.keep({"level_of_modified_h", {{"q", of_modified.x}, {"p", of_modified.y}}});
  study.keep({"plane", {{"t", run.t}, {"q", run.coordinate(0)}, {"p", run.momentum(0)}}});
  figures::Panel panel =
      phase_plane("{/:Italic q}", "{/:Italic p}", run.coordinate(0), run.momentum(0), of_h.x, of_h.y);
  panel.series.front().name = "level of {/:Italic H}";
  panel.series.insert(panel.series.begin() + 1, {figures::Ink::line,
                                                 "of {/:Italic H} + {/:Italic h}^2{/:Italic H}_3",
                                                 of_modified,
                                                 {.colour = "#000000", .dash = 2}});
  study.draw("plane",
             "The level of H through the start, that of H + dt^2 H_3 (dashed), and ten periods of verlet with dt = "
             "0.04 (dots)",
             {study.info().title, {panel}});
}

void neighbouring_levels(Study& study) {
  const Trajectory coarse = study.run("figure", scenario("verlet", "0.01/2", 466, 1));
  const Trajectory fine = study.run("finer", scenario("verlet", "0.01/4", 932, 1));
  const Trajectory late = study.run("late", scenario("verlet", "0.01/2", 466 * 200, 1));
  const Levels at_coarse = departures(coarse, 0.005), at_fine = departures(fine, 0.0025),
               at_late = departures(late, 0.005);
  study.claim({"modified", "the points of a symplectic method follow a level of a modified H", "a level of H-bar"},
              within(16, 1, "what H + dt^2 H_3 leaves is of order dt^4: halving dt divides it by 16"),
              {{at_coarse.of_modified / at_fine.of_modified, 0,
                fmt::format("largest departures {:.3g}, {:.3g} of verlet, dt = 0.005 and 0.0025", at_coarse.of_modified,
                            at_fine.of_modified)}});
  study.claim({"neighbouring", "H-bar differs from H by O(dt^r)", "O(dt^r), r = 2 for Stoermer-Verlet"},
              within(4, 0.3, "halving dt divides it by 4"),
              {{at_coarse.of_h / at_fine.of_h, 0,
                fmt::format("largest |H - H0| {:.3g} and {:.3g}", at_coarse.of_h, at_fine.of_h)}});
  study.claim(
      {"long", "they do so for a long time", "long"},
      at_most(1.05, "the departure over 200 periods divided by that of the first; the samples have other phases"),
      {{at_late.of_modified / at_coarse.of_modified, 0, "verlet, dt = 0.005"}});
  std::vector<double> modified;
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    modified.push_back(coarse.energy[i] + 0.005 * 0.005 * modified_part(coarse.q[i][0], coarse.p[i][0]));
  }
  study.keep({"levels", {{"t", coarse.t}, {"energy", coarse.energy}, {"modified_energy", modified}}});
  figures::Panel below = over_time("{/:Italic H} + {/:Italic h}^2{/:Italic H}_3", coarse.t, modified);
  figures::Panel above = over_time("{/:Italic H}", coarse.t, coarse.energy);
  below.y = above.y;  // one scale for what the two are to be compared in
  study.draw("figure", "H (above) and H + dt^2 H_3 (below) over one period of verlet with dt = 0.005, on one scale",
             {study.info().title, {above, below}});
  draw_levels(study);
}

/// The times at which p turns from positive to negative: each ends a period.
std::vector<double> ends_of_periods(const Trajectory& run) {
  std::vector<double> ends;
  for (std::size_t i = 1; i < run.size(); ++i) {
    const double before = run.p[i - 1][0], now = run.p[i][0];
    if (before > 0 && now <= 0) ends.push_back(run.t[i - 1] + (run.t[i] - run.t[i - 1]) * before / (before - now));
  }
  return ends;
}

/// 100 steps there, and 100 from where they end with the momentum turned.
void draw_way_back(Study& study, const std::string& method, const std::string& dt) {
  const Trajectory there = study.run("figure", scenario(method, dt, 100, 1));
  const Trajectory back = study.run(
      "back", scenario(method, dt, 100),
      {fmt::format("problem.initial={{ q = [{:.17g}], p = [{:.17g}] }}", there.q.back()[0], -there.p.back()[0])});
  const Trajectory exact = study.run("reference", scenario("taylor", "0.005", 466, 1));
  const auto plane = [](const char* name, const Trajectory& run) {
    return Curves{name, {{"t", run.t}, {"q", run.coordinate(0)}, {"p", run.momentum(0)}, {"energy", run.energy}}};
  };
  study.keep(plane("plane", there));
  study.keep(plane("way_back", back));
  figures::Panel panel = phase_plane("{/:Italic q}", "{/:Italic p}", there.coordinate(0), there.momentum(0),
                                     exact.coordinate(0), exact.momentum(0));
  panel.series.back().name = "there";
  panel.series.push_back({figures::Ink::fine_dots,
                          "back",
                          figures::finite_points(back.coordinate(0), back.momentum(0)),
                          {.colour = "#009e73"}});
  study.draw("figure",
             study.info().title +
                 ": steps forward, with p below 0, and back after the momentum was reversed (dots), exact (line)",
             {study.info().title, {panel}});
}

void draw_plane(Study& study, const Trajectory& run) {
  const Trajectory exact = study.run("reference", scenario("taylor", "0.005", 466, 1));
  study.keep({"plane", {{"t", run.t}, {"q", run.coordinate(0)}, {"p", run.momentum(0)}, {"energy", run.energy}}});
  study.draw("figure", study.info().title + ": steps (dots), exact (line)",
             {study.info().title,
              {phase_plane("{/:Italic q}", "{/:Italic p}", run.coordinate(0), run.momentum(0), exact.coordinate(0),
                           exact.momentum(0))}});
}

void claim_period(Study& study, const std::string& printed, double dt) {
  study.claim({"period", "the time of one circulation", printed + " sec"},
              within(std::stod(printed), dt, "a whole number of steps: to one step"),
              {{period(160), std::abs(period(160) - period(80)) + 1e-14, "quadrature"}});
}

void euler(Study& study) {
  claim_period(study, "2.325", 0.001);
  const Trajectory once = study.run("figure", scenario("euler", "0.001", 2325, 1));
  const Trajectory symplectic = study.run("symplectic", scenario("euler-a", "0.01", 233, 1));
  // From its start EulerA ends 0.0037 away, of which 0.0035 are that 233 steps are later than a period: the level tells
  // whether a curve closes, wherever on it the last step lies.
  const auto off_level = [](const Trajectory& run) { return std::abs(run.energy.back() - run.energy.front()); };
  study.claim({"open", "Euler's curve with dt = 0.001 does not close, EulerA's with dt = 0.01 does", "open"},
              at_least(10, "|H - H0| of Euler after one circulation over that of EulerA: a power of ten"),
              {{off_level(once) / off_level(symplectic), 1e-5,
                fmt::format("|H - H0| {:.3g} and {:.3g}", off_level(once), off_level(symplectic))}});
  const Trajectory longer = study.run("longer", scenario("euler", "0.001", 12000, 1));
  const std::vector<double> ends = ends_of_periods(longer);
  double before = longer.energy[0];
  int shrinking = 0;
  for (const double end : ends) {
    const double now = longer.energy[static_cast<std::size_t>(end / 0.001)];
    shrinking += now <= before;
    before = now;
  }
  study.claim({"spiral", "the curve runs outward in a spiral", "spiral"},
              none_of("circulations in which the energy did not grow"),
              {{static_cast<double>(shrinking), 0,
                fmt::format("{} circulations, energy {:.4g} to {:.4g}", ends.size(), longer.energy[0], before)}});
  draw_plane(study, once);
}

void euler_a(Study& study) {
  claim_period(study, "2.33", 0.01);
  const Trajectory once = study.run("figure", scenario("euler-a", "0.01", 233, 1));
  const Trajectory longer =
      study.run("longer", scenario("euler-a", "0.01", 233 * study.sized(1000L, 10000L, 100000L), 233));
  const double first = energy_error(once), late = energy_error(longer);
  study.claim(
      {"stays", "EulerA does not leave its curve, at longer times either", "does not leave it"},
      at_most(1.1, "largest |H - H0| of all periods divided by that of the first; the samples have other phases"),
      {{late / first, 0, fmt::format("{} periods, {:.4g} and {:.4g}", longer.report.final.step / 233, late, first)}});
  draw_plane(study, once);
}

/// Where 100 steps, a turn of the momentum and 100 steps lead, with the momentum with which they arrive.
struct Return {
  double q = 0;
  double p = 0;
};
Return there_and_back(const std::string& method, const std::string& arithmetic, double dt) {
  Request request;
  request.problem = "lennard-jones-oscillator";
  request.start.q = {"1.5"};
  request.start.p = {"0"};
  request.method = parse_method(method);
  request.dt = fmt::format("{:.17g}", dt);
  request.arithmetic = arithmetic;
  request.watch = false;
  request.record = false;
  const auto simulation = make_simulation(request);
  Outcome outcome = simulation->advance(100);
  simulation->negate_momenta();
  if (outcome == Outcome::done) outcome = simulation->advance(100);
  Frame frame;
  if (outcome != Outcome::done) return {std::nan(""), std::nan("")};
  simulation->look(frame);
  return {frame.q[0], frame.p[0]};
}

/// From the printed point.
double off_printed(const std::string& arithmetic, double dt) {
  const Return end = there_and_back("euler-a", arithmetic, dt);
  return std::max(std::abs(end.q - 1.3356), std::abs(end.p + 0.3426));
}

/// The dt in (0, 0.05] that comes nearest: a scan, then ever finer around the best.
double nearest_dt(const Study& study) {
  double best = 0, least = 1e9, low = 1e-5, high = 0.05;
  int points = study.sized(20000, 50000, 500000);
  for (int round = 0; round < 6; ++round) {
    const double spacing = (high - low) / points;
    for (int i = 0; i <= points; ++i) {
      const double dt = low + i * spacing, off = off_printed("double", dt);
      if (off < least) least = off, best = dt;
      if (i % 1000 == 0) study.breathe();
    }
    low = best - 2 * spacing;
    high = best + 2 * spacing;
    points = 100;
  }
  return best;
}

void way_back_of_euler_a(Study& study) {
  const double dt = nearest_dt(study);
  const Return end = there_and_back("euler-a", "double", dt);
  study.claim(
      {"return", "the state to which EulerA returns after 100 steps forward and 100 back", "(1.3356, -0.3426)"},
      at_most(0.5e-4 * (1 + 1e-6), "half a unit of the last digit printed, with the step size that comes nearest"),
      {{off_printed("double", dt), 1e-9,
        fmt::format("dt = {:.8f} leads to ({:.6f}, {:.6f}), in double", dt, end.q, end.p)},
       {off_printed("double-double", dt), 1e-9, "in double-double"}},
      Grounds::ways);
  const Return usual = there_and_back("euler-a", "double", 0.01);
  study.claim({"not_reversible", "EulerA does not return to its start", "not (1.5, -0)"},
              at_least(1e-6, "far above rounding"),
              {{std::hypot(usual.q - 1.5, usual.p), 1e-12,
                fmt::format("dt = 0.01 leads to ({:.4f}, {:.4f})", usual.q, usual.p)}});
  study.note(
      fmt::format("With dt = 0.01, the step of figure 2.3, EulerA returns to ({:.4f}, {:.4f}).", usual.q, usual.p));
  draw_way_back(study, "euler-a", fmt::format("{:.8f}", dt));
}

void way_back_of_stv4(Study& study) {
  double largest = 0;
  for (const double dt : {0.0005, 0.001, 0.005, 0.01, 0.02}) {
    const Return end = there_and_back("stv4", "double", dt);
    largest = std::max({largest, std::abs(end.q - 1.5), std::abs(end.p)});
  }
  const double rounding = 0x1p-53;
  // 200 steps, each of 9 additions that round q or p; the motion may spread each by the stretching of the orbit.
  study.claim({"return", "StV4 returns to its start up to machine precision", "(1.5, 0) to machine precision"},
              at_most(200 * 9 * 100 * rounding, "1800 roundings, each stretched by at most 100 along the orbit"),
              {{largest, 0, fmt::format("largest of five step sizes: {:.0f} units of rounding", largest / rounding)}});
  draw_way_back(study, "stv4", "0.01");
}

}  // namespace lj_planes

std::vector<Experiment> lj_planes_experiments() {
  using namespace lj_planes;
  return {{{"S2.1", sonnleitner, "37", "levels of neighbouring Hamiltonians, Lennard-Jones oscillator"},
           neighbouring_levels},
          {{"S2.2", sonnleitner, "38", "Lennard-Jones oscillator: Euler's method"}, euler},
          {{"S2.3", sonnleitner, "38", "Lennard-Jones oscillator: EulerA"}, euler_a},
          {{"S2.4", sonnleitner, "39", "the way back of EulerA"}, way_back_of_euler_a},
          {{"S2.5", sonnleitner, "40", "the way back of StV4"}, way_back_of_stv4}};
}

}  // namespace hamflow::reproduction
