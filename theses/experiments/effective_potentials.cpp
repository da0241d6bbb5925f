// [Gross1999, figures 2.5, 2.14, 2.18, 2.23]: the effective potential V'(r) = V(r) + l^2/(2 mu r^2), equation 2.40. Its
// crossings with E are the turning points of the orbit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "../experiment.hpp"
#include "../scenarios.hpp"
#include "../trajectories.hpp"
#include "hamflow/figures/axis.hpp"
#include "hamflow/figures/panel_axes.hpp"

namespace hamflow::reproduction {

namespace effective_potentials {

constexpr double mu = 2;

struct Level {
  const char* name;
  std::string potential;
  double k;
  std::function<double(double)> V;
  double energy;
  double l;
  double start;   // r, inward bound
  double t_end;   // so that each turning point is passed
  int crossings;  // as drawn and told
};

/// The energy that only touches the effective potential.
struct Circle {
  std::string potential;
  double k;
  std::function<double(double)> V;
  double energy;
  double l;
  double radius;  // l^2/(mu k), equation 2.42
};

struct Case {
  const char* id;
  const char* page;
  const char* title;
  std::vector<Level> levels;  // those of one potential and one l side by side
  std::optional<Circle> circle{};
};

const std::vector<Case>& cases() {
  const auto kepler = [](double r) { return -1 / r; };
  const auto hooke = [](double k) { return [k](double r) { return -k * r * r / 2; }; };
  const auto linear = [](double k) { return [k](double r) { return k * r; }; };
  const auto binomial = [](double r) { return (r * r - 1) * (r * r - 1) / 2; };
  static const std::vector<Case> all{
      {"G2.5",
       "25",
       "effective potential of Kepler",
       {{"E above 0", "kepler", 1, kepler, 0.25, std::sqrt(3.0), 4, 20, 1},
        {"E below 0", "kepler", 1, kepler, -0.25, std::sqrt(3.0), 2, 40, 2}},
       Circle{"kepler", 1, kepler, -1.0 / 3, std::sqrt(3.0), 1.5}},
      {"G2.14",
       "52",
       "effective potential of Hooke",
       {{"k below 0", "hooke", -0.2, hooke(-0.2), 1, 3 * std::sqrt(0.4), 2, 20, 2},
        {"k = 0", "hooke", 0, hooke(0), 1, 4, 5, 20, 1},
        {"k above 0", "hooke", 0.1, hooke(0.1), 0.1, 2 * std::sqrt(1.2), 5, 20, 1}}},
      {"G2.18",
       "57",
       "effective potential of the linear potential",
       {{"k above 0", "linear", 1, linear(1), 3.25, 3, 2, 20, 2},
        {"k below 0", "linear", -0.1, linear(-0.1), -0.1, 2 * std::sqrt(0.4), 5, 30, 1}}},
      {"G2.23",
       "63",
       "effective potential of the binomial potential",
       {{"k above 0", "binomial", 1, binomial, 36, 12, 2, 10, 2}}}};
  return all;
}

double effective(const Level& level, double r) { return level.V(r) + level.l * level.l / (2 * mu * r * r); }

/// Where the energy meets the effective potential, inside of r = 0.001 to 1000.
std::vector<double> crossings_of(const Level& level) {
  return roots([&](double r) { return effective(level, r) - level.energy; }, geometric_grid(1e-3, 1e3, 4000));
}

/// From (r, 0), by a method of order 8.
template <class Of>
Trajectory orbit_from(Study& study, const std::string& name, const Of& of, double r, double p_r, double t_end) {
  std::vector<std::string> sets = in_steps("0.001", std::lround(t_end / 0.001));
  for (const std::string& one :
       {fmt::format("problem.potential={}", of.potential), fmt::format("problem.k={}", of.k),
        fmt::format("problem.initial={{ q = [{:.17g}, 0], p = [{:.17g}, {:.17g}] }}", r, p_r, of.l / r)}) {
    sets.push_back(one);
  }
  return study.run(name, scenario_of("central_motion"), sets);
}

/// The turning radii of an integrated orbit, increasing, each once.
std::vector<double> turning_radii(Study& study, const Level& level, std::size_t number) {
  const double p_r = -std::sqrt(2 * mu * (level.energy - effective(level, level.start)));
  const Trajectory run = orbit_from(study, "level_" + std::to_string(number), level, level.start, p_r, level.t_end);
  std::vector<double> r, rate;
  for (std::size_t i = 0; i < run.size(); ++i) {
    r.push_back(std::hypot(run.q[i][0], run.q[i][1]));
    rate.push_back((run.q[i][0] * run.p[i][0] + run.q[i][1] * run.p[i][1]) / (mu * r.back()));
  }
  std::vector<double> all = extrema(run.t, r, rate);
  std::sort(all.begin(), all.end());
  std::vector<double> once;
  for (const double x : all) {
    if (once.empty() || x - once.back() > 1e-6) once.push_back(x);
  }
  study.breathe();
  if (study.curves().empty()) study.keep({"radius", {{"t", run.t}, {"r", r}}});
  return once;
}

/// Near the energies: V' itself has no bounds.
figures::Curve curve_of(const Level& level) {
  figures::Curve curve;
  const double room = 2 * std::max(std::abs(level.energy), 0.3);
  for (const double r : geometric_grid(0.2, 3 * level.start, 600)) {
    if (std::abs(effective(level, r) - level.energy) < room) curve.add(r, effective(level, r));
  }
  return curve;
}

/// One curve for each potential and l, with all energies that are looked at on it; turning points are rings.
figures::Page page_of(const Case& c, Study& study) {
  figures::Panel panel;
  figures::Extent x, y;
  std::size_t shape = 0;
  constexpr const char* colours[] = {"#0072b2", "#d55e00", "#009e73"};
  figures::Curve turns, drawn;
  const auto add_level = [&](double energy) {
    panel.series.push_back({figures::Ink::level, "", {{drawn.x.front(), drawn.x.back()}, {energy, energy}}});
  };
  const Level* before = nullptr;
  for (const Level& level : c.levels) {
    if (before == nullptr || before->potential != level.potential || before->k != level.k || before->l != level.l) {
      drawn = curve_of(level);
      x.include(drawn.x);
      y.include(drawn.y);
      const std::string name = c.circle ? "{/:Italic V}'({/:Italic r})" : level.name;
      panel.series.push_back({figures::Ink::line, name, drawn, {.colour = colours[shape++ % 3]}});
      study.keep({fmt::format("effective_{}", shape), {{"r", drawn.x}, {"V_effective", drawn.y}}});
    }
    before = &level;
    add_level(level.energy);
    for (const double r : crossings_of(level)) turns.add(r, level.energy);
  }
  if (c.circle) {
    add_level(c.circle->energy);
    turns.add(c.circle->radius, c.circle->energy);
    y.include(c.circle->energy);
  }
  panel.series.push_back({figures::Ink::marks, "turning points", turns, {.colour = "#000000", .shape = 6}});
  panel.x = figures::fit_axis(x, 0.02, {7, 40});
  panel.y = figures::fit_axis(y, 0.06, {6});
  panel.x_label = "{/:Italic r}";
  panel.y_label = "{/:Italic V}'({/:Italic r}), {/:Italic E} dashed";
  return {c.title, {panel}};
}

/// An energy at the minimum leaves the radius no room.
void claim_circle(const Circle& circle, Study& study) {
  const Trajectory run = orbit_from(study, "circle", circle, circle.radius, 0, 20);
  double off = 0;
  for (const auto& q : run.q) off = std::max(off, std::abs(std::hypot(q[0], q[1]) - circle.radius));
  study.claim({"circle",
               "with the energy of the minimum of the effective potential of Kepler the orbit is a circle of radius "
               "l^2/(mu a), "
               "where a is the constant of the potential, k of V = -k/r",
               "a circle, r0 = l^2/(mu a)", "26"},
              at_most(1e-10, "rounding over 20000 steps"),
              {{off, 0,
                fmt::format("largest |r - {:.3g}| up to t = 20 (rkn8-s19), E = {:.6g}", circle.radius,
                            run.report.energy.initial)}});
}

void carry_out(const Case& c, Study& study) {
  for (std::size_t n = 0; n < c.levels.size(); ++n) {
    const Level& level = c.levels[n];
    const std::vector<double> crossings = crossings_of(level);
    study.claim(
        {"crossings_" + std::to_string(n + 1),
         fmt::format("for {} the energy meets the {} {}", level.name, c.title, level.crossings == 1 ? "once" : "twice"),
         std::to_string(level.crossings)},
        as_printed(std::to_string(level.crossings)),
        {{static_cast<double>(crossings.size()), 0, "changes of sign between r = 0.001 and 1000"}});
    const std::vector<double> radii = turning_radii(study, level, n + 1);
    double gap = crossings.size() == radii.size() ? 0 : std::nan("");
    for (std::size_t i = 0; i < std::min(crossings.size(), radii.size()); ++i) {
      gap = std::max(gap, std::abs(crossings[i] - radii[i]));
    }
    study.claim(
        {"turning_points_" + std::to_string(n + 1),
         fmt::format("for {} the orbit turns where the energy meets the {}", level.name, c.title), "at the crossings"},
        at_most(1e-10, "cubic pieces of samples at dt = 0.001"),
        {{gap, 0, "largest distance of a crossing and a turning point of the orbit (rkn8-s19)"}});
  }
  if (c.circle) claim_circle(*c.circle, study);
  study.draw("figure", std::string(c.title) + " (lines), energies (dashed) and turning points (rings)",
             page_of(c, study));
}

}  // namespace effective_potentials

std::vector<Experiment> effective_potentials_experiments() {
  std::vector<Experiment> all;
  for (const auto& c : effective_potentials::cases()) {
    all.push_back({{c.id, gross, c.page, c.title}, [&c](Study& study) { effective_potentials::carry_out(c, study); }});
  }
  return all;
}

}  // namespace hamflow::reproduction
