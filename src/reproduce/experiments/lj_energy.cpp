// [Sonnleitner2010], figures 2.6 and 2.7: the energy of the Lennard-Jones oscillator over one period, by Runge-Kutta,
// Stoermer-Verlet and StV4. The thesis gives no step length; the claims are measured for six.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "../experiment.hpp"
#include "../time_panels.hpp"
#include "../trajectories.hpp"

namespace hamflow::reproduction {

namespace lj_energy {

constexpr double period = 2.3245037536196;  // experiment S2.2
constexpr std::array<const char*, 6> step_lengths{"0.01", "0.005", "0.0025", "0.002", "0.001", "0.0005"};

Trajectory one_period(Study& study, const std::string& method, const std::string& dt,
                      const std::string& arithmetic = "double", const std::string& name = "") {
  const long steps = std::lround(period / std::stod(dt));
  return study.run(
      !name.empty() ? name : method + "_" + dt + (arithmetic == "double" ? "" : "_" + arithmetic),
      fmt::format("[problem]\nname = \"lennard-jones-oscillator\"\ninitial = {{ q = [\"1.5\"], p = [0] }}\n\n[method]\n"
                  "name = \"{}\"\n\n[run]\ndt = \"{}\"\nsteps = {}\nrecord_every = 1\narithmetic = \"{}\"\n",
                  method, dt, steps, arithmetic));
}

double final_error(const Trajectory& run) { return run.report.energy.final - run.report.energy.initial; }

/// By how much final_error is off in double-double: both energies are told as doubles.
constexpr double told = 2 * 0x1p-55;
/// What a run in double may be off: some 27 roundings a step, of 3 kicks and drifts, of numbers up to 4 = u^2 at the
/// inner turning point.
double rounding_of(const Trajectory& run) { return 27.0 * 4 * 0x1p-53 * static_cast<double>(run.report.final.step); }

/// By how much H leaves its value (the line), which three digits of H itself would not show.
figures::Page energy_page(const Study& study, const Trajectory& run) {
  std::vector<double> error;
  for (const double energy : run.energy) error.push_back(energy - run.energy[0]);
  return {study.info().title,
          {over_time("{/:Italic H} - {/:Italic H}_0", run.t, error, std::vector<double>(run.size(), 0))}};
}

void runge_kutta(Study& study) {
  const Trajectory figure = one_period(study, "rk4", "0.01", "double", "figure");
  const double rounding = 64 * 0x1p-53;
  study.claim({"energy", "the energy of the start", "-0.167875643"}, as_printed("-0.167875643"),
              {{figure.report.energy.initial, rounding, "H of the start"}});
  study.claim({"energy_cut", "the digits of the energy, cut off rather than rounded", "-0.167875643"},
              within(-0.1678756435, 0.5e-9 * (1 + 1e-6), "the digits printed begin the number"),
              {{figure.report.energy.initial, rounding, "H of the start"}});
  for (const char* dt : step_lengths) {
    const Trajectory run = one_period(study, "rk4", dt, "double-double");
    study.claim({fmt::format("no_return_{}", dt),
                 fmt::format("Runge-Kutta's energy does not return to its value, dt = {}", dt), "does not return"},
                at_least(1e-13, "above what rounding leaves in double"),
                {{std::abs(final_error(run)), told, "|H - H0| after one period, in double-double"}});
  }
  study.keep({"energy", {{"t", figure.t}, {"energy", figure.energy}}});
  study.draw("figure", "Energy over one period of Runge-Kutta with dt = 0.01 (dots), less that of the start (line)",
             energy_page(study, figure));
}

/// "1/1000" names a power of ten: half a power up or down.
Rule a_thousandth() {
  return {"ratio within half a power of ten of 1/1000", std::pow(10.0, -3.5), std::pow(10.0, -2.5)};
}

void verlet(Study& study) {
  for (const char* dt : step_lengths) {
    // In double Runge-Kutta's error at the end is near rounding where dt is small: these are errors of the methods.
    const std::string digits = "double-double";
    const Trajectory rk4 = one_period(study, "rk4", dt, digits), verlet = one_period(study, "verlet", dt, digits);
    const double of_rk4 = std::abs(final_error(rk4)), of_verlet = std::abs(final_error(verlet));
    study.claim(
        {fmt::format("final_{}", dt),
         fmt::format("the error of Stoermer-Verlet is 1/1000 of Runge-Kutta's: at the end, dt = {}", dt), "1/1000"},
        a_thousandth(),
        {{of_verlet / of_rk4, (1 + of_verlet / of_rk4) * told / of_rk4,
          fmt::format("{:.3g} over {:.3g}, in double-double", of_verlet, of_rk4)}});
    const double verlet_largest = energy_error(verlet), rk4_largest = energy_error(rk4);
    study.claim(
        {fmt::format("largest_{}", dt),
         fmt::format("the error of Stoermer-Verlet is 1/1000 of Runge-Kutta's: the largest, dt = {}", dt), "1/1000"},
        a_thousandth(),
        {{verlet_largest / rk4_largest, (1 + verlet_largest / rk4_largest) * told / rk4_largest,
          fmt::format("{:.3g} over {:.3g}, in double-double", verlet_largest, rk4_largest)}});
    const Trajectory stv4 = one_period(study, "stv4", dt);
    study.claim({fmt::format("stv4_final_{}", dt),
                 fmt::format("StV4's error is machine precision: at the end, dt = {}", dt), "-3.747e-15"},
                at_most(3.747e-14, "the size printed, ten times of it: rounding differs from program to program"),
                {{std::abs(final_error(stv4)), 0, "|H - H0| after one period"}});
    const Trajectory longer = one_period(study, "stv4", dt, "double-double");
    study.claim({fmt::format("stv4_largest_{}", dt),
                 fmt::format("StV4's error is machine precision: the largest, dt = {}", dt), "-3.747e-15"},
                at_most(3.747e-14, "the size printed, ten times of it"),
                {{energy_error(stv4), rounding_of(stv4), "largest |H - H0| over the period, in double"},
                 {energy_error(longer), told, "in double-double"}},
                Grounds::ways);
  }
  const Trajectory figure = one_period(study, "verlet", "0.01", "double", "figure");
  study.claim({"returns", "Stoermer-Verlet's energy returns (almost) to its value", "almost"},
              at_most(0.01, "what is left at the end over the largest error within the period"),
              {{std::abs(final_error(figure)) / energy_error(figure), 0, "dt = 0.01"}});
  study.keep({"energy", {{"t", figure.t}, {"energy", figure.energy}}});
  study.draw("figure", "Energy over one period of Stoermer-Verlet with dt = 0.01 (dots), less that of the start (line)",
             energy_page(study, figure));
}

void no_method_conserves(Study& study) {
  const auto error = [&](const std::string& arithmetic) {
    const Trajectory run = study.run(
        arithmetic == "double" ? "double" : "long",
        fmt::format("[problem]\nname = \"lennard-jones-oscillator\"\ninitial = {{ q = [\"1.5\"], p = [0] }}\n\n"
                    "[method]\nname = \"cg(3)\"\n\n[run]\ndt = \"0.01\"\nsteps = 2325\nrecord_every = 25\narithmetic = "
                    "\"{}\"\n",
                    arithmetic));
    return energy_error(run);
  };
  study.claim({"conserves", "no numerical method can keep the energy constant in time", "none can"},
              at_least(1e-12, "an error of the method would not vanish with the unit of rounding"),
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
