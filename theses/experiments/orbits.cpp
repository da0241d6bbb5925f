// [Gross1999, figures 2.8 to 2.24]: orbits in central potentials with cg(1,5), cartesian coordinates, mu = 2, dt = 0.1.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../experiment.hpp"
#include "../panels_of_orbit.hpp"
#include "../scenarios.hpp"
#include "../trajectories.hpp"

namespace hamflow::reproduction {

namespace orbits {

struct Case {
  const char* id;
  const char* page;
  const char* title;
  const char* energy;  // as printed
  const char* page_of_energy;
  double t_end;
  std::function<double(double)> V;
  bool has_line = true;  // the thesis draws the analytical solution beside the dots
  bool open = false;     // said never to close
};

const std::vector<Case>& cases() {
  const auto kepler = [](double r) { return -1 / r; };
  const auto hooke = [](double k) { return [k](double r) { return -k * r * r / 2; }; };
  const auto linear = [](double k) { return [k](double r) { return k * r; }; };
  static const std::vector<Case> all{
      {"G2.8", "42", "Kepler potential, circle", "-0.25", "42", 25, kepler},
      {"G2.9", "44", "Kepler potential, ellipse", "-0.25", "43", 25, kepler},
      {"G2.10", "45", "Kepler potential, parabola", "0", "44", 20, kepler},
      {"G2.11", "46", "Kepler potential, hyperbola", "0.25", "47", 20, kepler},
      {"G2.13", "51", "Hooke potential, circle", "1", "51", 20, hooke(-0.25)},
      {"G2.15", "53", "Hooke potential, ellipse", "1", "53", 20, hooke(-0.2)},
      {"G2.16", "54", "Hooke potential, straight line", "1", "54", 20, hooke(0)},
      {"G2.17", "55", "Hooke potential, hyperbola", "0.1", "55", 10, hooke(0.1)},
      {"G2.19", "58", "linear potential, circle", "3", "59", 20, linear(1), false},
      {"G2.20", "59", "linear potential, bounded orbit", "3.25", "61", 40, linear(1), false, true},
      {"G2.21", "60", "linear potential, unbounded orbit", "-0.1", "60", 20, linear(-0.1), false},
      {"G2.24", "64", "binomial potential, bounded orbit, k = lambda = 1", "", "", 20,
       [](double r) { return (r * r - 1) * (r * r - 1) / 2; }, false}};
  return all;
}

/// Samples of the exact orbit to one of the dots.
constexpr int refined_line = 10;

/// cg(1,5) with dt = 0.1/refinement, sampled every 0.1.
Trajectory with_step(Study& study, const Case& c, int refinement) {
  const int steps = static_cast<int>(std::lround(c.t_end * 10)) * refinement;
  return study.run(refinement == 1 ? "figure" : "finer_" + std::to_string(refinement), scenario_of(c.id),
                   in_steps(fmt::format("0.1/{}", refinement), steps, refinement));
}

/// 2 l/mu times the integral of 1/(r^2 rdot) from one turning point to the other, equation 2.43, by Gauss and
/// Chebyshev: with r = (r1 + r2)/2 - (r2 - r1)/2 cos(x) the integrand is smooth and periodic, so that the sums converge
/// faster than any power.
double apsidal_angle(const Case& c, double r1, double r2, double l, double energy, int points) {
  constexpr double mu = 2;
  double sum = 0;
  for (int i = 0; i < points; ++i) {
    const double x = std::numbers::pi * (i + 0.5) / points;
    const double r = (r1 + r2) / 2 - (r2 - r1) / 2 * std::cos(x);
    // (r - r1)(r2 - r) = ((r2 - r1)/2)^2 sin(x)^2 is taken out of the radicand.
    const double radicand = 2 / mu * (energy - c.V(r) - l * l / (2 * mu * r * r));
    sum += 1 / (r * r * std::sqrt(radicand / ((r - r1) * (r2 - r))));
  }
  return 2 * l / mu * sum * std::numbers::pi / points;
}

/// How near to a closed orbit the angle comes within so many radial periods.
double nearest_return(double angle, int periods) {
  double nearest = std::numbers::pi;
  for (int k = 1; k <= periods; ++k)
    nearest = std::min(nearest, std::abs(std::remainder(k * angle, 2 * std::numbers::pi)));
  return nearest;
}

void claim_open(Study& study, const Case& c, const Trajectory& run) {
  const double l = run.q[0][0] * run.p[0][1] - run.q[0][1] * run.p[0][0];
  const double angle = apsidal_angle(c, 1, 3, l, run.energy[0], 40);
  const double coarser = apsidal_angle(c, 1, 3, l, run.energy[0], 30);
  constexpr int periods = 1000;
  study.claim({"open", "the orbit does not close within 1000 radial periods", "offen"},
              at_least(1e-6,
                       "radians; if an orbit closes, a later pericentre has the direction of the first, angle 0; the "
                       "quadrature has errors of 1e-11"),
              {{nearest_return(angle, periods), periods * (std::abs(angle - coarser) + 1e-14),
                fmt::format("smallest angle between the first pericentre and one of the next 1000, which follow each "
                            "other by {:.12f}, equation 2.43 by quadrature",
                            angle)}});
}

/// Whether the dots lie on the line as it is drawn, wherever on it they are at their time. A chord of the line is off
/// by an eighth of a second difference of its samples.
void claim_on_line(Study& study, const Trajectory& figure, const Trajectory& line, double size) {
  double largest = 0, sagitta = 0;
  for (const auto& dot : figure.q) {
    double nearest = std::hypot(dot[0] - line.q[0][0], dot[1] - line.q[0][1]);
    for (std::size_t i = 1; i < line.size(); ++i) {
      nearest = std::min(nearest, distance_from_segment(dot, line.q[i - 1], line.q[i]));
    }
    largest = std::max(largest, nearest);
  }
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const auto &a = line.q[i - 1], &b = line.q[i], &c = line.q[i + 1];
    sagitta = std::max(sagitta, std::hypot(a[0] - 2 * b[0] + c[0], a[1] - 2 * b[1] + c[1]) / 8);
  }
  study.claim({"on_line", "with dt = 0.1 the dots lie on the line of the exact orbit", "dots on the line"},
              at_most(0.01, "distance from the line over the largest coordinate: a dot is drawn no smaller"),
              {{largest / size, sagitta / size + 1e-14,
                fmt::format("the farthest dot is {:.2g} from the line, whose chords are at most {:.1g} off the orbit",
                            largest, sagitta)}});
}

/// The chapter prints energies to two decimals (-0.25, 3.25): half a unit of "1" would allow every orbit near it.
void claim_energy(Study& study, const Case& c, const Trajectory& figure, double rounding) {
  const double value = std::stod(c.energy);
  const std::string id = c.id;
  study.claim({"energy", fmt::format("the orbit of figure {} has the energy {}", id.substr(1), c.energy), c.energy,
               c.page_of_energy},
              within(value, 0.005, "half a unit of the second decimal, to which the chapter prints energies"),
              {{figure.report.energy.initial, rounding, "H of the start"}});
  if (value != 0) return;
  study.claim({"zero", "the parabola has the energy E = 0 exactly, by table 2.1", "E = 0", "39"},
              within(0, 1e-13, "rounding of a sum of T and V, each of size 1/2"),
              {{figure.report.energy.initial, rounding, "H of the start"}});
}

void carry_out(const Case& c, Study& study) {
  const Trajectory figure = with_step(study, c, 1);
  const Trajectory coarse = with_step(study, c, 4);
  const Trajectory fine = with_step(study, c, 8);
  const int samples = static_cast<int>(std::lround(c.t_end * 10));
  const Trajectory exact = study.run("reference", scenario_of(c.id), in_steps("0.1", samples, 1, by_series));
  const double scale = figure.report.energy_scale;
  const double rounding = 64 * 0x1p-53;
  if (*c.energy != '\0') {
    claim_energy(study, c, figure, rounding * scale);
  } else {
    study.note(fmt::format("E = {:.10g}; the figure prints no number.", figure.report.energy.initial));
  }
  study.claim({"kept", "the energy of the computed orbit is constant", "constant"},
              at_most(1e-11, "rounding over the run, of energies of size 1"),
              {{energy_error(figure), rounding * scale, "largest |H - H0| over every step of cg(1,5), dt = 0.1"}});
  double size = 0;
  for (const auto& q : exact.q) size = std::max({size, std::abs(q[0]), std::abs(q[1])});
  claim_second_order(study,
                     {"order", "the dots approach the exact orbit as dt becomes smaller",
                      c.has_line ? "dots and line, of one dt" : "dots, of one dt"},
                     {largest_distance(coarse, exact), largest_distance(fine, exact), 1e-11 * size});
  // Dots may be early or late: the line goes on beyond the last of them.
  const int samples_of_line = refined_line * samples * 11 / 10;
  const Trajectory line = study.run("line", scenario_of(c.id),
                                    in_steps(fmt::format("0.1/{}", refined_line), samples_of_line, 1, by_series));
  if (c.has_line) {
    claim_on_line(study, figure, line, size);
  } else {
    study.note("The thesis draws dots alone here: it gives no analytical solution for this potential (pages 24, 57).");
  }
  if (c.open) claim_open(study, c, figure);
  double lost = 0;
  for (const auto& invariant : figure.invariants) {
    lost = std::max(lost, std::abs(invariant[0] - figure.invariants[0][0]));
  }
  study.note(
      fmt::format("At dt = 0.1 the dots are at most {:.2g} from the exact orbit at the same time. The angular "
                  "momentum, which the thesis does not mention here, is kept to {:.2g} of {:.4g}.",
                  largest_distance(figure, exact), lost, figure.invariants[0][0]));
  study.keep({"orbit",
              {{"t", figure.t},
               {"x", figure.coordinate(0)},
               {"y", figure.coordinate(1)},
               {"energy", figure.energy},
               {"exact_x", exact.coordinate(0)},
               {"exact_y", exact.coordinate(1)}}});
  study.draw(
      "figure",
      fmt::format("Orbit with dt = 0.1 (dots) and exact (line{}); energy E over t (dots, exact: line) and effective "
                  "potential over r (dashed). {}",
                  c.has_line ? "" : ", not in the thesis", study.info().title),
      orbit_page(study.info().title, figure, line, c.V, 2));
}

}  // namespace orbits

std::vector<Experiment> orbits_experiments() {
  std::vector<Experiment> all;
  for (const orbits::Case& c : orbits::cases()) {
    all.push_back({{c.id, gross, c.page, c.title}, [&c](Study& study) { orbits::carry_out(c, study); }});
  }
  return all;
}

}  // namespace hamflow::reproduction
