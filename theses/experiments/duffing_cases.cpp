// [Gross1999, figures 2.26 to 2.28]: the three cases of the Duffing oscillator, V = k/2 (r^2 - lambda)^2, from rest at
// r0 = 4 with mu = 2. With |lambda_inf| = sqrt(2 E/k), equation 2.182, the outer zero is r0^2 = lambda + |lambda_inf|.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "../experiment.hpp"
#include "../scenarios.hpp"
#include "../time_panels.hpp"
#include "../trajectories.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/figures/axis.hpp"
#include "hamflow/figures/panel_axes.hpp"
#include "hamflow/problems/duffing.hpp"

namespace hamflow::reproduction {

namespace duffing_cases {

constexpr double mu = 2;

struct Case {
  const char* id;
  const char* page;
  const char* title;
  double k;
  const char* lambda;  // as printed
  const char* energy;
  const char* page_of_energy;
  const char* formula;        // of the zeros
  std::vector<double> zeros;  // where the motion turns
};
constexpr double t_end = 10;

const std::vector<Case>& cases() {
  const char *const first = "+-sqrt(lambda + |lambda_inf|)", *const third = "sqrt(lambda +- |lambda_inf|)";
  static const std::vector<Case> all{
      {"G2.26", "70", "Duffing oscillator, case 1: through the origin", 1, "7", "40.5", "71", first, {-4, 4}},
      {"G2.27", "72", "Duffing oscillator, case 2: the separatrix", 1, "8", "32", "73", "", {}},
      {"G2.28", "75", "Duffing oscillator, case 3: on one side", 2, "12", "16", "75", third, {std::sqrt(8.0), 4}}};
  return all;
}

/// cg(1,5) with dt = 0.02/refinement, sampled every 0.02.
Trajectory element(Study& study, const Case& c, int refinement) {
  const long steps = std::lround(t_end / 0.02) * refinement;
  return study.run(refinement == 1 ? "figure" : "finer_" + std::to_string(refinement), scenario_of(c.id),
                   in_steps(fmt::format("0.02/{}", refinement), steps, refinement));
}

/// The places where the orbit turns, each once: those of a run of order 8 with small steps.
std::vector<double> turning_points(Study& study, const Case& c) {
  const Trajectory run = study.run("turning_points", scenario_of(c.id),
                                   in_steps("0.001", std::lround(t_end / 0.001), 1, "method={ name = \"rkn8-s19\" }"));
  std::vector<double> rate;
  for (const auto& p : run.p) rate.push_back(p[0] / 2);
  std::vector<double> all = extrema(run.t, run.coordinate(0), rate);
  std::sort(all.begin(), all.end());
  std::vector<double> once;
  for (const double x : all) {
    if (once.empty() || x - once.back() > 1e-6) once.push_back(x);
  }
  return once;
}

/// How long |r| stays below a bound up to the end, next to the exact separatrix r = r0/cosh(sqrt(2 k lambda/mu) t),
/// which comes to r = 0 in infinite time.
void claim_dwelling(Study& study, const Trajectory& figure) {
  constexpr double near = 0.1, dt = 0.02;
  double arrival = 0, dwelling = 0;
  for (std::size_t i = 1; i < figure.size(); ++i) {
    const bool inside = std::abs(figure.q[i][0]) < near;
    if (arrival == 0 && inside) arrival = figure.t[i];
    if (arrival > 0 && inside && dwelling == 0) dwelling = figure.t.back() - arrival;
    if (arrival > 0 && !inside) {
      dwelling = figure.t[i] - arrival;
      break;
    }
  }
  const double of_exact = figure.t.back() - std::acosh(4 / near) / std::sqrt(8.0);
  study.claim(
      {"dwelling", "the computed motion stays near r = 0 as long as the exact separatrix, which never leaves it",
       "relativ lange Verweildauer", "73"},
      within(1, 0.05, "the time with |r| < 0.1 over that of the exact separatrix, up to the same end"),
      {{dwelling / of_exact, dt / of_exact,
        fmt::format("{:.4g} over {:.4g}, up to t = {:g}; in case 1, figure 2.26, a passage of |r| < 0.1 takes {:g}",
                    dwelling, of_exact, figure.t.back(), 2 * near / 4)}});
  double distance = 0;
  for (std::size_t i = 0; i < figure.size() && figure.t[i] <= 1; ++i) {
    distance = std::max(distance, std::abs(figure.q[i][0] - 4 / std::cosh(std::sqrt(8.0) * figure.t[i])));
  }
  study.note(
      fmt::format("Up to t = 1 the dots are at most {:.2g} from the exact separatrix 4/cosh(sqrt(8) t).", distance));
}

/// The exact motion at the times of a run, by elliptic functions: of x and of its rate.
std::array<std::vector<double>, 2> exact_motion(const Case& c, const Trajectory& run) {
  const double lambda = std::stod(c.lambda);
  const Duffing<> problem(mu, -2 * c.k * lambda, 2 * c.k, c.k * lambda * lambda / 2);
  std::array<std::vector<double>, 2> motion;
  for (const double t : run.t) {
    const auto state = problem.exact({run.q[0][0]}, {run.p[0][0]}, t);
    if (!state) throw Error("no exact motion of the Duffing oscillator at t = " + std::to_string(t));
    motion[0].push_back(static_cast<double>(state->q[0]));
    motion[1].push_back(static_cast<double>(state->p[0]) / mu);
  }
  return motion;
}

/// E over t and V over r share their axes, whose range is that of the program's listing.
figures::Panel energy_panel(const Case& c, const Trajectory& run) {
  const double lambda = std::stod(c.lambda);
  figures::Panel panel =
      over_time("{/:Italic E}, {/:Italic V}", run.t, run.energy, std::vector<double>(run.size(), std::stod(c.energy)));
  figures::Curve potential;
  for (int i = 0; i <= 400; ++i) {
    const double r = t_end * i / 400, V = c.k / 2 * (r * r - lambda) * (r * r - lambda);
    if (V <= 90) potential.add(r, V);
  }
  panel.series.push_back({figures::Ink::level, "{/:Italic V}({/:Italic r})", potential});
  figures::Extent range;
  range.include(-10);
  range.include(90);
  panel.y = figures::fit_axis(range, 0, {6});
  panel.x_label = "{/:Italic t}, {/:Italic r}";
  return panel;
}

/// Iterations of Newton's method over r, as the program of the thesis shows them.
figures::Panel iterations_panel(const Trajectory& run) {
  const std::vector<double> r = run.coordinate(0);
  figures::Panel panel = phase_plane("{/:Italic r}", "iterations", {r.begin() + 1, r.end()},
                                     {run.iterations.begin() + 1, run.iterations.end()}, {}, {});
  figures::Extent across, up;
  for (const double x : {-4.2, 4.2}) across.include(x);
  for (const double x : {0.0, 3.5}) up.include(x);
  panel.x = figures::fit_axis(across, 0, {7, 40});
  panel.y = figures::fit_axis(up, 0, {6});
  panel.aspect = 0.42;
  return panel;
}

/// The orbit on its straight line, and the phase plane of the angle, which stays what it was at the start.
std::array<figures::Panel, 2> orbit_and_angle(const Trajectory& run) {
  constexpr double phi = std::numbers::pi / 4;
  figures::Panel orbit;
  figures::Curve path;
  for (const auto& q : run.q) path.add(q[0] * std::cos(phi), q[0] * std::sin(phi));
  figures::Extent range;
  for (const double x : {-4.0, 4.0}) range.include(x);
  figures::fit_equal_axes(orbit, range, range);
  orbit.x_label = "{/:Italic x}";
  orbit.y_label = "{/:Italic y}";
  orbit.series.push_back({figures::Ink::line, "", path});
  figures::Panel angle;
  figures::Extent across, up;
  for (const double x : {0.0, 1.5}) across.include(x);
  for (const double x : {-1.0, 1.0}) up.include(x);
  angle.x = figures::fit_axis(across, 0, {7, 40});
  angle.y = figures::fit_axis(up, 0, {6});
  angle.x_label = "{/:Italic φ}";
  angle.y_label = "d{/:Italic φ}/d{/:Italic t}";
  angle.aspect = 0.7;
  angle.series.push_back({figures::Ink::dots, "", {{phi}, {0}}});
  return {orbit, angle};
}

void carry_out(const Case& c, Study& study) {
  const Trajectory figure = element(study, c, 1);
  const double scale = figure.report.energy_scale;
  const double energy = figure.report.energy.initial;
  const double rounding = 64 * 0x1p-53 * scale;
  const std::string of = std::string(c.id).substr(1);
  const std::string decimals =
      "half a unit of the second decimal; a number printed without decimals allows anything near it";
  study.claim(
      {"energy", fmt::format("the motion of figure {} has the energy {}", of, c.energy), c.energy, c.page_of_energy},
      within(std::stod(c.energy), 0.005, decimals), {{energy, rounding, "H of the start"}});
  double furthest = 0;
  for (const auto& q : figure.q) furthest = std::max(furthest, q[0]);
  study.claim({"lambda", fmt::format("the potential of figure {} has lambda = {}", of, c.lambda), c.lambda},
              within(std::stod(c.lambda), 0.005, decimals),
              {{furthest * furthest - std::sqrt(2 * energy / c.k), 1e-12, "r0^2 - sqrt(2 E/k) of the run"}});
  study.claim({"kept", "the energy of the computed motion is constant", "constant"},
              at_most(1e-11 * scale, "1e-11 of the scale of the energy"),
              {{energy_error(figure), rounding, "largest |H - H0| over every step of cg(1,5), dt = 0.02"}});
  const double most = *std::max_element(figure.iterations.begin() + 1, figure.iterations.end());
  study.claim(
      {"iterations",
       "Newton's method takes at most three iterations a step: the axis of iterations in appendix B ends at 3.5",
       "axis([-4.2 4.2 0 3.5])", "139"},
      at_most(3, "counted over every step"), {{most, 0, "cg(1,5), dt = 0.02"}});
  if (!c.zeros.empty()) {
    const std::vector<double> found = turning_points(study, c);
    double gap = found.size() == c.zeros.size() ? 0 : std::nan("");
    for (std::size_t i = 0; i < std::min(found.size(), c.zeros.size()); ++i) {
      gap = std::max(gap, std::abs(found[i] - c.zeros[i]));
    }
    study.claim(
        {"zeros",
         fmt::format("the motion turns at the zeros of its phase curve, r = {:.4g} and {:.4g}", c.zeros[0], c.zeros[1]),
         c.formula},
        at_most(1e-9, "cubic pieces of samples at dt = 0.001"), {{gap, 0, "largest distance, rkn8-s19"}});
    const Trajectory exact =
        study.run("reference", scenario_of(c.id), in_steps("0.02", std::lround(t_end / 0.02), 1, by_series));
    claim_second_order(
        study,
        {"order", "the computed motion approaches the exact one as dt becomes smaller", "phase curve, of one dt"},
        {largest_distance(element(study, c, 4), exact), largest_distance(element(study, c, 8), exact),
         1e-11 * furthest});
  } else {
    claim_dwelling(study, figure);
  }
  std::vector<double> speed;
  for (const auto& p : figure.p) speed.push_back(p[0] / 2);
  const auto [exact_r, exact_rate] = exact_motion(c, figure);
  study.keep({"motion",
              {{"t", figure.t},
               {"r", figure.coordinate(0)},
               {"rate", speed},
               {"energy", figure.energy},
               {"exact_r", exact_r},
               {"exact_rate", exact_rate},
               {"iterations", {figure.iterations.begin() + 1, figure.iterations.end()}}}});
  const auto [orbit, angle] = orbit_and_angle(figure);
  study.draw(
      "figure",
      fmt::format(
          "{}: r over t, energy over t with V over r (dashed), phase curves of r and of the angle, a point, the orbit, "
          "iterations over r; steps of dt = 0.02 (dots) and exact (line)",
          c.title),
      {c.title,
       {over_time("{/:Italic r}", figure.t, figure.coordinate(0), exact_r), energy_panel(c, figure),
        phase_plane("{/:Italic r}", "d{/:Italic r}/d{/:Italic t}", figure.coordinate(0), speed, exact_r, exact_rate),
        angle, orbit, iterations_panel(figure)},
       2,
       figures::two_columns});
}

}  // namespace duffing_cases

std::vector<Experiment> duffing_cases_experiments() {
  std::vector<Experiment> all;
  for (const auto& c : duffing_cases::cases()) {
    all.push_back({{c.id, gross, c.page, c.title}, [&c](Study& study) { duffing_cases::carry_out(c, study); }});
  }
  return all;
}

}  // namespace hamflow::reproduction
