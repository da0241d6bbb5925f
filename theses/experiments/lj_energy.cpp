// [Sonnleitner2010], figures 2.6 and 2.7: the energy of the Lennard-Jones oscillator over one period, by Runge-Kutta,
// Stoermer-Verlet and StV4. The thesis gives no step size: each of its sentences is judged where one of six comes
// nearest to it, and a table has them all.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "../experiment.hpp"
#include "../scenarios.hpp"
#include "../time_panels.hpp"
#include "../trajectories.hpp"
#include "hamflow/verify/long_number.hpp"

namespace hamflow::reproduction {

namespace lj_energy {

constexpr double period = 2.3245037536196;  // experiment S2.2
constexpr std::array<const char*, 6> step_lengths{"0.01", "0.005", "0.0025", "0.002", "0.001", "0.0005"};

Trajectory one_period(Study& study, const std::string& method, const std::string& dt,
                      const std::string& arithmetic = "double", const std::string& name = "") {
  const long steps = std::lround(period / std::stod(dt));
  return study.run(!name.empty() ? name : method + "_" + dt + (arithmetic == "double" ? "" : "_" + arithmetic),
                   scenario_of("lennard_jones", in_steps(dt, steps, 1, "method.name=" + method)),
                   {"run.arithmetic=" + arithmetic});
}

/// |H - H0| after one period, in all digits of the run: as doubles both would be equal below 1e-17.
double final_error(const Trajectory& run) {
  const Frame& end = run.report.final;
  if (end.digits.energy.empty()) return std::abs(run.report.energy.final - run.report.energy.initial);
  return largest_difference({end.digits.energy}, {end.digits.initial_energy});
}

constexpr double unit_of_double = 0x1p-53, unit_of_double_double = 0x1p-104;
/// What rounding may do: some 27 roundings a step, of 3 kicks and drifts, of numbers up to 4 = u^2 at the inner turning
/// point.
double rounding_of(const Trajectory& run, double unit) {
  return 27.0 * 4 * unit * static_cast<double>(run.report.final.step);
}

/// What became of the energy with one step size: errors of the methods, which double would hide beneath rounding.
struct Errors {
  std::string dt;
  double rk4_final, rk4_largest, verlet_final, verlet_largest, stv4_final, stv4_largest;
  double rounding;                      // of each of them
  double double_final, double_largest;  // of StV4 in double, as the thesis computes
  double double_rounding;               // of the largest one
  double final_ratio() const { return verlet_final / rk4_final; }
  double largest_ratio() const { return verlet_largest / rk4_largest; }
  /// Of a ratio of two of them, each told as a double.
  double off(double ratio, double over) const { return (1 + ratio) * rounding / over + 4 * unit_of_double * ratio; }
};

std::vector<Errors> all_errors(Study& study) {
  std::vector<Errors> all;
  for (const char* dt : step_lengths) {
    const std::string digits = "double-double";
    const Trajectory rk4 = one_period(study, "rk4", dt, digits), verlet = one_period(study, "verlet", dt, digits),
                     stv4 = one_period(study, "stv4", dt, digits), in_double = one_period(study, "stv4", dt);
    all.push_back({dt, final_error(rk4), energy_error(rk4), final_error(verlet), energy_error(verlet),
                   final_error(stv4), energy_error(stv4), rounding_of(stv4, unit_of_double_double),
                   final_error(in_double), energy_error(in_double), rounding_of(in_double, unit_of_double)});
  }
  return all;
}

/// The step size with which a number comes nearest to the printed one, as their ratio goes.
const Errors& nearest(const std::vector<Errors>& all, double printed, const std::function<double(const Errors&)>& of) {
  const auto away = [&](const Errors& one) { return std::abs(std::log(of(one) / printed)); };
  return *std::min_element(all.begin(), all.end(), [&](const Errors& a, const Errors& b) { return away(a) < away(b); });
}

/// By how much H leaves its value (the line), which three digits of H itself would not show.
figures::Panel energy_panel(const std::string& of, const Trajectory& run) {
  std::vector<double> error;
  for (const double energy : run.energy) error.push_back(energy - run.energy[0]);
  return over_time("{/:Italic H} - {/:Italic H}_0" + of, run.t, error, std::vector<double>(run.size(), 0));
}

void runge_kutta(Study& study) {
  const Trajectory figure = one_period(study, "rk4", "0.01", "double", "figure");
  const double rounding = 64 * unit_of_double;
  study.claim({"energy", "the energy of the start", "-0.167875643"},
              within(-0.1678756435, 0.5e-9 * (1 + 1e-6), "the printed digits are cut, not rounded"),
              {{figure.report.energy.initial, rounding, "H of the start"}});
  double least = 1e300, off = 0;
  std::string with, list;
  for (const char* dt : step_lengths) {
    const Trajectory run = one_period(study, "rk4", dt, "double-double");
    const double error = final_error(run);
    list += fmt::format("{}{:.3g} with dt = {}", list.empty() ? "" : ", ", error, dt);
    if (error < least) least = error, off = rounding_of(run, unit_of_double_double), with = dt;
  }
  study.claim({"no_return", "Runge-Kutta's energy does not return to its value after a period", "does not return"},
              at_least(1e-13, "above what rounding leaves in double"),
              {{least, off, "|H - H0| in double-double, the smallest of six step sizes, dt = " + with}});
  study.note("Runge-Kutta's |H - H0| after a period: " + list + ".");
  study.keep({"energy", {{"t", figure.t}, {"energy", figure.energy}}});
  study.draw("figure",
             "Energy of Runge-Kutta minus its value at the start, over one period with dt = 0.01 (dots); the line is 0",
             {study.info().title, {energy_panel("", figure)}});
}

void claim_thousandth(Study& study, const std::vector<Errors>& all) {
  // "1/1000" names a power of ten: half a power up or down.
  const Rule rule{"ratio within half a power of ten of 1/1000", std::pow(10.0, -3.5), std::pow(10.0, -2.5)};
  const Errors& end = nearest(all, 1e-3, &Errors::final_ratio);
  study.claim(
      {"final",
       "the error of Stoermer-Verlet at the end of the period is 1/1000 of Runge-Kutta's, with a step size "
       "from 0.01 to 0.0005",
       "1/1000"},
      rule,
      {{end.final_ratio(), end.off(end.final_ratio(), end.rk4_final),
        fmt::format("dt = {}, the nearest of six: {:.3g} over {:.3g}", end.dt, end.verlet_final, end.rk4_final)}});
  const Errors& within_it = nearest(all, 1e-3, &Errors::largest_ratio);
  study.claim({"largest",
               "the largest error of Stoermer-Verlet in the period is 1/1000 of Runge-Kutta's, with a step size "
               "from 0.01 to 0.0005",
               "1/1000"},
              rule,
              {{within_it.largest_ratio(), within_it.off(within_it.largest_ratio(), within_it.rk4_largest),
                fmt::format("dt = {}, the nearest of six: {:.3g} over {:.3g}", within_it.dt, within_it.verlet_largest,
                            within_it.rk4_largest)}});
}

void claim_precision(Study& study, const std::vector<Errors>& all) {
  constexpr double printed = 3.747e-15;
  const double limit = 10 * printed;
  const Errors& end = nearest(all, printed, [](const Errors& one) { return std::max(one.double_final, 1e-18); });
  study.claim({"stv4_final", "StV4's error at the end of the period is machine precision", "-3.747e-15"},
              at_most(limit, "ten times the printed size: rounding differs from program to program"),
              {{end.double_final, 64 * unit_of_double, "|H - H0| in double, nearest with dt = " + end.dt}});
  const Errors& least = *std::min_element(
      all.begin(), all.end(), [](const Errors& a, const Errors& b) { return a.stv4_largest < b.stv4_largest; });
  study.claim(
      {"stv4_largest", "StV4's error is machine precision all through the period, with a step size from 0.01 to 0.0005",
       "machine precision"},
      at_most(limit, "ten times the printed size"),
      {{least.double_largest, least.double_rounding,
        "largest |H - H0| in double, the smallest of six, with dt = " + least.dt},
       {least.stv4_largest, least.rounding + 2 * unit_of_double * least.stv4_largest, "in double-double"}},
      Grounds::ways);
  study.note(
      fmt::format("The printed -3.747e-15 has a sign, as the error at the end has; a largest absolute error has "
                  "none. StV4's largest error falls with dt^4, and would be of that size with dt = {:.1g}.",
                  std::stod(least.dt) * std::pow(printed / least.stv4_largest, 0.25)));
}

void verlet(Study& study) {
  const std::vector<Errors> all = all_errors(study);
  claim_thousandth(study, all);
  claim_precision(study, all);
  double left = 0, off = 0;
  TextTable table{
      "errors",
      "|H - H0| after one period and the largest within it, in double-double, and StV4's at the end in double",
      {"dt", "Runge-Kutta, end", "Verlet, end", "ratio", "Runge-Kutta, largest", "Verlet, largest", "ratio",
       "StV4, end", "in double", "StV4, largest"},
      {}};
  for (const Errors& one : all) {
    if (one.verlet_final / one.verlet_largest > left) {
      left = one.verlet_final / one.verlet_largest, off = one.off(left, one.verlet_largest);
    }
    std::vector<std::string> row{one.dt};
    for (const double number : {one.rk4_final, one.verlet_final, one.final_ratio(), one.rk4_largest, one.verlet_largest,
                                one.largest_ratio()}) {
      row.push_back(fmt::format("{:.3g}", number));
    }
    row.push_back(one.stv4_final > one.rounding ? fmt::format("{:.3g}", one.stv4_final)
                                                : fmt::format("below {:.1g}", one.rounding));
    row.push_back(fmt::format("{:.3g}", one.double_final));
    row.push_back(fmt::format("{:.3g}", one.stv4_largest));
    table.rows.push_back(std::move(row));
  }
  study.claim({"returns", "Stoermer-Verlet's energy returns (almost) to its value", "almost"},
              at_most(0.01, "error at the end divided by the largest error within the period"),
              {{left, off, "the largest of six step sizes"}});
  study.table(std::move(table));
  const Trajectory figure = one_period(study, "verlet", "0.01", "double", "figure"),
                   stv4 = one_period(study, "stv4", "0.01");
  study.keep({"energy", {{"t", figure.t}, {"energy", figure.energy}, {"energy_of_stv4", stv4.energy}}});
  study.draw(
      "figure",
      "Energy minus its value at the start, over one period of Stoermer-Verlet (above) and of StV4 (below) with dt = "
      "0.01 (dots); the line is 0",
      {study.info().title, {energy_panel(", Verlet", figure), energy_panel(", StV4", stv4)}});
}

void no_method_conserves(Study& study) {
  const auto error = [&](const std::string& arithmetic) {
    const Trajectory run = study.run(arithmetic == "double" ? "double" : "long",
                                     scenario_of("lennard_jones", in_steps("0.01", 2325, 25, "method.name=cg(3)")),
                                     {"run.arithmetic=" + arithmetic});
    return energy_error(run);
  };
  study.claim({"conserves", "no numerical method can keep the energy constant in time", "none can"},
              at_least(1e-12, "an error of the method would not decrease with the unit of rounding"),
              {{error("double"), 1e-16, "cg(3), dt = 0.01, ten periods, largest |H - H0| in double"},
               {error("double-double"), 1e-30, "in double-double"}},
              Grounds::ways);
}

}  // namespace lj_energy

std::vector<Experiment> lj_energy_experiments() {
  using namespace lj_energy;
  return {{{"S2.6", sonnleitner, "41", "Lennard-Jones oscillator: energy of Runge-Kutta"}, runge_kutta},
          {{"S2.7", sonnleitner, "42", "Lennard-Jones oscillator: energy of Stoermer-Verlet and StV4"}, verlet},
          {{"S-C41", sonnleitner, "41", "that no method conserves the energy"}, no_method_conserves}};
}

}  // namespace hamflow::reproduction
