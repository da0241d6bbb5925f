// [Gross1999, appendix D]: the questions of the task. Cartesian against polar coordinates on the two-body problems of
// chapter 2, and the stiff binomial potential, k = 1000 and 10^6.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../experiment.hpp"
#include "../scenarios.hpp"
#include "../sign_test.hpp"
#include "../time_panels.hpp"
#include "../trajectories.hpp"
#include "../two_body_programs.hpp"

namespace hamflow::reproduction {

namespace two_body_coordinates {

/// What a run came to; not a number where it ended early.
struct Row {
  bool done = false;
  double reached = 0;  // t
  double iterations = 0;
  double most = 0;
  double energy = 0;       // largest |H - H0| over the scale
  double angular = 0;      // largest |l - l0| over |l0|, at the samples
  double error = 0;        // distance in the plane from the reference
  double evaluations = 0;  // of the gradient and of second derivatives, a step
  std::string message;
};

std::array<double, 2> place(const std::vector<double>& q, bool polar) {
  if (!polar) return {q[0], q[1]};
  return {q[0] * std::cos(q[1]), q[0] * std::sin(q[1])};
}

double evaluations_a_step(const Frame& end) {
  const Effort& effort = end.effort;
  return static_cast<double>(effort.force + effort.gradient + effort.hessian) /
         static_cast<double>(std::max<std::int64_t>(end.step, 1));
}

/// @param scale of the energy: that of the Cartesian run, |T0| + |V0|
Row measured(const Trajectory& run, bool polar, double scale, const Trajectory* reference) {
  Row row{.done = run.report.status == "done",
          .reached = run.t.back(),
          .energy = run.report.energy.max_error / scale,
          .evaluations = evaluations_a_step(run.report.final),
          .message = run.report.message.substr(0, run.report.message.find(';'))};
  for (std::size_t k = 1; k < run.size(); ++k) {
    row.iterations += run.iterations[k] / static_cast<double>(run.size() - 1);
    row.most = std::max(row.most, run.iterations[k]);
    row.angular = std::max(row.angular, std::abs(run.invariants[k][0] / run.invariants[0][0] - 1));
    if (reference == nullptr || k >= reference->size()) continue;
    const auto a = place(run.q[k], polar), b = place(reference->q[k], false);
    row.error = std::max(row.error, std::hypot(a[0] - b[0], a[1] - b[1]));
  }
  return row;
}

/// Of a figure, in other coordinates.   @param sets PATH=VALUE
std::string scenario(const std::string& figure, const char* coordinates, std::vector<std::string> sets,
                     const std::string& dt, long steps) {
  for (std::string& one : in_steps(dt, steps)) sets.push_back(std::move(one));
  sets.push_back(std::string("problem.coordinates=") + coordinates);
  return scenario_of(figure, sets);
}
const std::vector<std::string> element{"method.diagnostics=true"};
const std::vector<std::string> with_tolerance{"method.diagnostics=true", "method.criterion=seed"};
const std::vector<std::string> exact{by_series};
const std::vector<std::string> all_points{"method.quadrature=auto"};

using two_body_programs::CentralPotential;
struct Orbit {
  const char* id;  // of its scenario
  long steps;
  CentralPotential potential;

  std::string figure() const { return id + 1; }
};
constexpr std::array<Orbit, 12> orbits{{{"G2.8", 250, {'k', 1}},
                                        {"G2.9", 250, {'k', 1}},
                                        {"G2.10", 200, {'k', 1}},
                                        {"G2.11", 200, {'k', 1}},
                                        {"G2.13", 200, {'h', -0.25}},
                                        {"G2.15", 200, {'h', -0.2}},
                                        {"G2.16", 200, {'h', 0}},
                                        {"G2.17", 100, {'h', 0.1}},
                                        {"G2.19", 200, {'l', 1}},
                                        {"G2.20", 400, {'l', 1}},
                                        {"G2.21", 200, {'l', -0.1}},
                                        {"G2.24", 200, {'b', 1}}}};

two_body_programs::ProgramRun by_appendix_a(const Orbit& orbit, const Trajectory& start, long steps) {
  const auto &q = start.q[0], &p = start.p[0];
  return two_body_programs::appendix_a(orbit.potential, {q[0], q[1]}, {p[0], p[1]}, steps);
}

/// Where the programs' tolerance is not reached when the orbits of the figures go on for so many steps of 0.1.
void tell_aborts(Study& study, const Orbit& orbit, const Trajectory& start, long steps, TextTable& table) {
  const double last = 0.1 * static_cast<double>(steps) - 0.05;
  const double program = by_appendix_a(orbit, start, steps).end;
  const double hamflow = study
                             .try_run(fmt::format("figure_{}_tolerance", orbit.figure()),
                                      scenario(orbit.id, "cartesian", with_tolerance, "0.1", steps))
                             .t.back();
  if (program > last && hamflow > last) return;
  table.rows.push_back({orbit.figure(), fmt::format("{:.3g}", program), fmt::format("{:.3g}", hamflow)});
}

/// The energy in polar coordinates, where the integrals of 1/r^2 and 1/r^3 are taken to rounding: by the thesis' own
/// equations, and by as many Gauss points as that takes. Largest errors over the scale of the energy.
struct PolarEnergy {
  double by_equations = 0, by_points = 0;

  /// @return that of the equations
  double look(Study& study, const Orbit& orbit, const Trajectory& start) {
    const auto &q = start.q[0], &p = start.p[0];
    const double scale = start.report.energy_scale;
    const double one =
        two_body_programs::in_polar_coordinates(orbit.potential, {q[0], q[1]}, {p[0], p[1]}, orbit.steps).energy_error /
        scale;
    const Trajectory run = study.run(fmt::format("figure_{}_polar_auto", orbit.figure()),
                                     scenario(orbit.id, "polar", all_points, "0.1", orbit.steps));
    by_equations = std::max(by_equations, one);
    by_points = std::max(by_points, energy_error(run) / scale);
    return one;
  }
};

void compare(Study& study) {
  std::vector<double> figure, columns[9];
  double lost_polar = 0, lost_cartesian = 0, energy = 0, most_polar = 0, most_cartesian = 0;
  PolarEnergy polar_energy;
  Majority better, fewer;
  int aborted = 0, of_linear = 0;
  double of_linear_here = 0;
  std::string which;
  TextTable table{
      "coordinates",
      "Cartesian; polar coordinates, both by cg(1,5), dt = 0.1: five Gauss points for all integrals. The last "
      "column is of equations 2.98 to 2.102, which take those of 1/r^2 and 1/r^3 in closed form",
      {"figure", "iterations a step", "evaluations of derivatives a step", "largest distance from the exact orbit",
       "energy error", "angular momentum lost", "energy error, equations 2.98 to 2.102"},
      {}};
  TextTable later{
      "tolerance",
      "The time at which no step reaches the programs' tolerance |R| <= 1e-13 any more, when the runs of the "
      "figures go on to t = 100; for those that are not named it is reached throughout",
      {"figure", "program of appendix A, statement by statement", "hamflow, criterion = \"seed\""},
      {}};
  const auto both = [](const char* form, double cartesian, double polar) {
    return fmt::format(fmt::runtime(form), cartesian) + "; " + fmt::format(fmt::runtime(form), polar);
  };
  for (const Orbit& orbit : orbits) {
    const std::string name = "figure_" + orbit.figure();
    const auto run = [&](const char* end, const char* coordinates, const std::vector<std::string>& method) {
      return study.try_run(name + end, scenario(orbit.id, coordinates, method, "0.1", orbit.steps));
    };
    const Trajectory reference = run("_reference", "cartesian", exact);
    const double scale = reference.report.energy_scale;
    const Row cartesian = measured(run("_cartesian", "cartesian", element), false, scale, &reference);
    const Row polar = measured(run("_polar", "polar", element), true, scale, &reference);
    const double by_equations = polar_energy.look(study, orbit, reference);
    const auto program = by_appendix_a(orbit, reference, orbit.steps);
    if (program.end < 0.1 * static_cast<double>(orbit.steps) - 0.05) {
      ++aborted;
      which += fmt::format("{}{} at t = {:.3g}", which.empty() ? "" : ", ", orbit.figure(), program.end);
    }
    if (orbit.potential.field == 'h') {
      of_linear = std::max(of_linear, program.most);
      of_linear_here = std::max(of_linear_here, cartesian.most);
    }
    tell_aborts(study, orbit, reference, 1000, later);
    figure.push_back(std::stod(orbit.figure().substr(2)));  // 2.10 is not 2.1
    const std::array<double, 9> values{cartesian.iterations, polar.iterations, cartesian.error,
                                       polar.error,          cartesian.energy, polar.energy,
                                       cartesian.angular,    polar.angular,    by_equations};
    for (std::size_t i = 0; i < 9; ++i) columns[i].push_back(values[i]);
    lost_polar = std::max(lost_polar, polar.angular);
    lost_cartesian = std::max(lost_cartesian, cartesian.angular);
    energy = std::max(energy, cartesian.energy);
    most_polar = std::max(most_polar, polar.most);
    most_cartesian = std::max(most_cartesian, cartesian.most);
    better.count(polar.error, cartesian.error);
    fewer.count(polar.iterations, cartesian.iterations);
    table.rows.push_back({orbit.figure(), both("{:.3g}", cartesian.iterations, polar.iterations),
                          both("{:.3g}", cartesian.evaluations, polar.evaluations),
                          both("{:.2g}", cartesian.error, polar.error), both("{:.1g}", cartesian.energy, polar.energy),
                          both("{:.2g}", cartesian.angular, polar.angular), fmt::format("{:.1g}", by_equations)});
  }
  study.table(std::move(table));
  study.table(std::move(later));
  study.claim({"angular_polar", "in polar coordinates the element keeps the angular momentum p_phi, equation 2.97",
               "p2 - p1 = 0", "35"},
              at_most(1e-15, "one equation has no other term: at most rounding"),
              {{lost_polar, 0, "largest relative loss over the twelve orbits"}});
  study.nothing_to_test(
      "angular_cartesian",
      fmt::format("Whether the element keeps the angular momentum in Cartesian coordinates is not said "
                  "(equation 2.22, page 20, is of the motion itself). It does not: cg(1,5) with dt = "
                  "0.1 loses {:.2g} of it at most over the twelve orbits, in polar coordinates {:.1g}",
                  lost_cartesian, lost_polar));
  study.claim({"energy_cartesian", "in Cartesian coordinates the element keeps the energy", "constant", "10"},
              at_most(1e-11, "rounding over the runs, relative to |T0| + |V0|"),
              {{energy, 1e-14, "largest over the twelve orbits, cg(1,5), dt = 0.1"}});
  study.claim({"energy_polar", "in polar coordinates the element keeps the energy", "constant", "10"},
              at_most(1e-11, "rounding and Newton's tolerance over the runs, relative to |T0| + |V0|"),
              {{polar_energy.by_equations, 1e-14,
                "largest over the twelve orbits, dt = 0.1, equations 2.98 to 2.102: closed integrals of 1/r^2 and "
                "1/r^3, five Gauss points for dV/dr, |R| <= 1e-13"},
               {polar_energy.by_points, 1e-14, "the same with cg(1,auto), as many Gauss points as rounding needs"}});
  study.claim({"accuracy",
               "the reduced description, in polar coordinates, has numerical advantages (asked by the task): the "
               "computed orbit is nearer to the exact one",
               "advantages?", "164"},
              better.rule("the twelve orbits nearer to the exact one at the same time in polar coordinates"),
              {better.measured("cg(1,5) in both coordinates, dt = 0.1")}, Grounds::program,
              "more orbits than the twelve of the figures");
  study.claim({"tolerance", "Newton's method reaches |R| <= 1e-13 in all steps of the twelve figures", "10^-13", "30"},
              none_of("figures whose run aborts"),
              {{static_cast<double>(aborted), 0,
                fmt::format("the program of appendix A, statement by statement, dt = 0.1; aborts: {}",
                            which.empty() ? "none" : which)}});
  study.claim(
      {"linear_once", "Newton's method solves a linear system of equations in a single iteration",
       "nur ein Iterationsschritt", "83"},
      at_most(1, "iterations of a step: a second one would have a residual above 1e-13 to correct"),
      {{static_cast<double>(of_linear), 0,
        fmt::format("largest over all steps of figures 2.13, 2.15, 2.16 and 2.17, whose forces are linear: the program "
                    "of appendix A, dt = 0.1; hamflow, which goes on to the rounding level, takes up to {:g}",
                    of_linear_here)}});
  study.note(
      fmt::format("To iterate in one variable (page 37) is less work in each iteration. Of the twelve orbits {} take "
                  "fewer iterations a step in polar coordinates and {} more; at most {:g}, in Cartesian ones {:g}.",
                  fewer.with, fewer.against, most_polar, most_cartesian));
  study.keep({"comparison",
              {{"number_of_figure_in_chapter_2", figure},
               {"iterations_cartesian", columns[0]},
               {"iterations_polar", columns[1]},
               {"error_cartesian", columns[2]},
               {"error_polar", columns[3]},
               {"energy_cartesian", columns[4]},
               {"energy_polar", columns[5]},
               {"angular_cartesian", columns[6]},
               {"angular_polar", columns[7]},
               {"energy_polar_closed_integrals", columns[8]}}});
}

void stiff(Study& study) {
  std::vector<double> of_k, of_dt, of_polar, reached, iterations, energies, angular;
  double kept = 0, lost = 0, lost_cartesian = 0, ended = 0;
  TextTable table{
      "stiff",
      "cg(1,5), 1000 steps, r from 1 to 1.1; in polar coordinates five Gauss points for 1/r^2 and 1/r^3, too",
      {"k", "dt", "dt over the radial period", "coordinates", "Newton", "iterations a step",
       "evaluations of derivatives a step", "energy error", "angular momentum lost", "tolerance 1e-13"},
      {}};
  for (const char* k : {"1000", "1e6"}) {
    const double period = 1 / std::sqrt(2 * std::stod(k));  // of V'' = 4 k at r = 1 with mu = 2: 2 pi times this
    for (const char* dt : {"0.1", "0.01", "0.001"}) {
      for (const char* coordinates : {"cartesian", "polar"}) {
        study.breathe();
        const bool polar = coordinates == std::string("polar");
        const auto of_method = [&](const std::vector<std::string>& method) {
          std::vector<std::string> sets{fmt::format("problem.k={}", k), "problem.orbit.r_aph=1.1"};
          sets.insert(sets.end(), method.begin(), method.end());
          return scenario("G2.24", coordinates, sets, dt, 1000);
        };
        const std::string name = fmt::format("k_{}_dt_{}_{}", k, dt, coordinates);
        const Trajectory run = study.try_run(name, of_method(element));
        const Trajectory seed = study.try_run(name + "_tolerance", of_method(with_tolerance));
        const Row row = measured(run, polar, run.report.energy_scale, nullptr);
        if (!polar && seed.report.status != "done" && std::stod(k) > 1e5) ++ended;
        if (run.size() > 1) kept = std::max(kept, row.energy);
        (polar ? lost : lost_cartesian) = std::max(polar ? lost : lost_cartesian, row.angular);
        of_k.push_back(std::stod(k));
        of_dt.push_back(std::stod(dt));
        of_polar.push_back(polar ? 1 : 0);
        reached.push_back(row.reached);
        iterations.push_back(row.iterations);
        energies.push_back(row.energy);
        angular.push_back(row.angular);
        table.rows.push_back(
            {k, dt, fmt::format("{:.3g}", std::stod(dt) / (6.283185 * period)), coordinates,
             row.done ? "converges" : fmt::format("ends at t = {:.4g}: {}", row.reached, row.message),
             fmt::format("{:.3g}, at most {:g}", row.iterations, row.most), fmt::format("{:.3g}", row.evaluations),
             fmt::format("{:.1g}", row.energy), fmt::format("{:.2g}", row.angular),
             seed.report.status == "done" ? std::string("reached") : fmt::format("ends at t = {:.4g}", seed.t.back())});
      }
    }
  }
  study.table(std::move(table));
  study.nothing_to_test("results", "announced for k = 1000 and 10^6; the thesis prints no result of them");
  study.claim(
      {"energy", "the element keeps the energy in a potential however stiff, as long as Newton's method converges",
       "constant", "10"},
      at_most(1e-10, "rounding over 1000 steps, relative to the scale of the energy"),
      {{kept, 1e-14, "largest over both k, three dt, both coordinates, r from 1 to 1.1"}});
  study.claim(
      {"angular_polar", "in polar coordinates the element keeps the angular momentum p_phi in a stiff potential",
       "p2 - p1 = 0", "35"},
      at_most(1e-15, "one equation has no other term"),
      {{lost, 0, fmt::format("largest relative loss; in Cartesian coordinates {:.3g}", lost_cartesian)}});
  study.claim(
      {"tolerance", "for k = 10^6 of the task Newton's method reaches the tolerance of the programs", "10^-13", "30"},
      none_of("runs that end before their last step"),
      {{ended, 0, "of three dt, Cartesian coordinates, as the programs are written"}});
  study.keep({"runs",
              {{"k", of_k},
               {"dt", of_dt},
               {"polar", of_polar},
               {"t_reached", reached},
               {"iterations", iterations},
               {"energy_error", energies},
               {"angular_momentum_error", angular}}});
}

}  // namespace two_body_coordinates

std::vector<Experiment> two_body_coordinates_experiments() {
  return {{{"C-polar", gross, "37, 164", "Cartesian against polar coordinates"}, two_body_coordinates::compare},
          {{"G-D", gross, "164", "the stiff binomial potential, k = 1000 and 10^6"}, two_body_coordinates::stiff}};
}

}  // namespace hamflow::reproduction
