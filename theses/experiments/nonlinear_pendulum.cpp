// [Gross1999, Sect. 3.2]: figures 3.21, 3.22, 3.25, 3.26 and tables 3.3, 3.4: the nonlinear double pendulum beside the
// linear solution of the same start.
//
// The torus of the linear solution, projected onto (q_i, q_i'), is the sum of two ellipses with the half axes a_k,
// a_k omega_k. A point x lies inside its outer boundary where u.x <= h(u) for every direction u, with the support
// function h(u) = sum_k a_k sqrt(u_1^2 + omega_k^2 u_2^2). That is the most that "inside the torus" can mean.
#include <algorithm>

#include "../experiment.hpp"
#include "../pendulum_runs.hpp"
#include "../time_panels.hpp"
#include "../trajectories.hpp"
#include "hamflow/numerics/root.hpp"

namespace hamflow::reproduction {

namespace nonlinear_pendulum {

constexpr double pi = std::numbers::pi;

/// The projected torus of one angle.
class Torus {
 public:
  Torus(const LinearPendulum& linear, std::size_t i) : omega_(linear.omega) {
    for (std::size_t k = 0; k < 2; ++k) a_[k] = std::abs(linear.amplitude[i][k]);
    for (std::size_t n = 0; n < directions; ++n) table_[n] = direction(width * static_cast<double>(n));
  }

  /// By how much a point is outside: the largest u.x/h(u) - 1, negative inside, where far inside it may be less.
  /// u.x/h(u) has one maximum over half a turn.
  double excess(double q, double rate) const {
    // The ellipse with the sums of the half axes lies inside, since |x| + |y| >= |x + y|.
    const double norm = std::hypot(q / (a_[0] + a_[1]), rate / (a_[0] * omega_[0] + a_[1] * omega_[1]));
    if (norm < 0.97) return norm - 1;
    double most = -1;
    std::size_t best = 0;
    for (std::size_t n = 0; n < directions; ++n) {
      const double out = table_[n][0] * q + table_[n][1] * rate;
      if (out > most) {
        most = out;
        best = n;
      }
    }
    if (most < 0.98) return norm - 1;
    const double middle = width * static_cast<double>(best);
    double low = middle - width, high = middle + width;
    const auto out = [&](double angle) {
      const auto u = direction(angle);
      return u[0] * q + u[1] * rate;
    };
    for (int k = 0; k < 40; ++k) {
      const double a = low + (high - low) / 3, b = high - (high - low) / 3;
      (out(a) < out(b) ? low : high) = out(a) < out(b) ? a : b;
    }
    return std::max(most, out((low + high) / 2)) - 1;
  }

 private:
  static constexpr std::size_t directions = 64;
  static constexpr double width = 2 * pi / directions;

  /// u/h(u).
  std::array<double, 2> direction(double angle) const {
    const double u = std::cos(angle), v = std::sin(angle);
    double support = 0;
    for (std::size_t k = 0; k < 2; ++k) support += a_[k] * std::sqrt(u * u + omega_[k] * omega_[k] * v * v);
    return {u / support, v / support};
  }

  std::array<double, 2> omega_;
  std::array<double, 2> a_{};
  std::array<std::array<double, 2>, directions> table_{};
};

/// After the start, which lies on the boundary: there both cosines are 1.
constexpr double after_start = 0.2;

struct Outermost {
  double excess = -1;
  double t = 0;
  std::size_t coordinate = 0;
  double share = 0;  // of the samples that lie outside
};
Outermost outermost(bool absolute, const Trajectory& run) {
  const LinearPendulum linear = linear_pendulum_of_start(absolute);
  const std::array<Torus, 2> torus{Torus(linear, 0), Torus(linear, 1)};
  const auto rates = pendulum_rates(absolute, run);
  Outermost most;
  for (std::size_t k = 0; k < run.size(); ++k) {
    if (run.t[k] < after_start) continue;
    bool outside = false;
    for (std::size_t i = 0; i < 2; ++i) {
      const double by = torus[i].excess(run.q[k][i], rates[i][k]);
      outside = outside || by > 0;
      if (by > most.excess) most = {by, run.t[k], i, most.share};
    }
    most.share += outside ? 1 : 0;
  }
  most.share /= static_cast<double>(run.size());
  return most;
}

/// How often the curve comes as near to the torus from inside, after the start: samples that follow each other are one
/// touch.
int touches(bool absolute, const Trajectory& run, double nearness) {
  const LinearPendulum linear = linear_pendulum_of_start(absolute);
  const std::array<Torus, 2> torus{Torus(linear, 0), Torus(linear, 1)};
  const auto rates = pendulum_rates(absolute, run);
  int count = 0;
  std::array<bool, 2> was_near{true, true};
  for (std::size_t k = 0; k < run.size(); ++k) {
    for (std::size_t i = 0; i < 2; ++i) {
      const bool is_near = torus[i].excess(run.q[k][i], rates[i][k]) > -nearness;
      if (is_near && !was_near[i]) ++count;
      was_near[i] = is_near;
    }
  }
  return count;
}

/// The torus, by elements of length 0.01 and by another method. The uncertainty is what both differ by and what lies
/// between samples: the faster mode turns by less than 5 radians a second, so that the largest of a cosine is missed by
/// less than (5 * 0.005)^2/2.
void claim_torus(Study& study, bool absolute, const char* name, const std::string& statement, const Trajectory& element,
                 const Trajectory& other, const char* method) {
  const Outermost a = outermost(absolute, element), b = outermost(absolute, other);
  constexpr double between = 3.2e-4;
  const auto told = [&](const Outermost& most, const char* how, double uncertainty) {
    return Measured{most.excess, uncertainty,
                    fmt::format("{}: q{} at t = {:.6g}; {:.3g} of the samples are outside", how, most.coordinate + 1,
                                most.t, most.share)};
  };
  study.claim({name, statement, "zu jedem Zeitpunkt innerhalb"},
              at_most(1e-3,
                      "part of the distance from the centre by which the curve is outside; touching is allowed, and "
                      "1e-3 is less than the width of a line in the figure"),
              {told(a, "cg(1,5), dt = 0.01", std::abs(a.excess - b.excess) + between), told(b, method, between)},
              Grounds::ways, "samples at shorter distances");
}

/// What a touch is the text does not say: from the width of a line to that of a dot.
void claim_touches(Study& study, bool absolute, const Trajectory& figure) {
  constexpr double line = 1e-3, dot = 0.01;
  const double fewest = touches(absolute, figure, line), most = touches(absolute, figure, dot);
  study.claim(
      {"touches",
       absolute ? "from time to time the nonlinear phase curves touch the torus of the linear solution from inside"
                : "the nonlinear phase curves touch the torus of the linear solution from inside",
       absolute ? "von Zeit zu Zeit" : "Berührung an der Innenseite"},
      at_least(absolute ? 2 : 1, "touches up to t = 26, after the start, which lies on the torus"),
      {{(fewest + most) / 2, (most - fewest) / 2,
        fmt::format("{:g} within {:g} of the distance from the centre, a line of the figure; {:g} within {:g}, a "
                    "dot; cg(1,5), dt = 0.01",
                    fewest, line, most, dot)}},
      Grounds::program, "how near the curves have to come for the text to call it a touch");
}

void in_phase_planes(Study& study, bool absolute) {
  const Trajectory figure = pendulum_run(study, "figure", absolute);
  const std::string inside = fmt::format(
      "in {} angles the nonlinear phase curves stay inside the torus of the linear "
      "solution up to t = ",
      absolute ? "absolute" : "relative");
  claim_torus(study, absolute, "torus", inside + "26", figure, pendulum_run(study, "reference", absolute, by_series),
              "Taylor series, tolerance 1e-15");
  claim_torus(study, absolute, "torus_longer", inside + "2600",
              pendulum_run(study, "longer", absolute, "", "0.01", 260000),
              pendulum_run(study, "longer_other", absolute, "method={ name = \"gauss\", stages = 3 }", "0.01", 260000),
              "gauss(3), dt = 0.01");
  claim_touches(study, absolute, figure);
  const LinearPendulum linear = linear_pendulum_of_start(absolute);
  const auto rates = pendulum_rates(absolute, figure);
  figures::Page page{study.info().title, {}};
  for (std::size_t i = 0; i < 2; ++i) {
    std::vector<double> q, rate;
    for (const double t : figure.t) {
      q.push_back(linear.q(i, t));
      rate.push_back(linear.rate(i, t));
    }
    const std::string of = fmt::format("{{/:Italic q}}_{}", i + 1);
    figures::Panel panel = phase_plane(of, "d" + of + "/d{/:Italic t}", figure.coordinate(i), rates[i], q, rate);
    panel.series.front().name = "linear";
    page.panels.push_back(std::move(panel));
  }
  study.keep({"planes",
              {{"t", figure.t},
               {"q1", figure.coordinate(0)},
               {"q2", figure.coordinate(1)},
               {"rate1", rates[0]},
               {"rate2", rates[1]}}});
  study.draw("figure", study.info().title + ": phase planes with dt = 0.01 (dots) and of the linear solution (lines)",
             std::move(page));
}

/// Angles of both rods with the vertical.
double largest_angle(bool absolute, const Trajectory& run) {
  double largest = 0;
  for (const auto& q : run.q) {
    largest = std::max({largest, std::abs(q[0]), std::abs(absolute ? q[1] : q[0] + q[1])});
  }
  return largest;
}

void claim_turn_over(Study& study, bool absolute, const Trajectory& figure) {
  // V <= E gives 3 (1 - cos q1) + (1 - cos q2) <= 1, whatever the motion: |q2| <= pi/2, cos q1 >= 2/3.
  study.claim({"no_turn_over", "no rod turns over: the motion is a pure pendulum motion", "reine Pendelbewegung"},
              at_most(pi, "a rod that turns over passes the angle pi"),
              {{largest_angle(absolute, figure), 1e-3, "largest angle of a rod up to t = 26, cg(1,5), dt = 0.01"},
               {pi / 2, 0, "bound by the energy at all times, 1 - cos q2 <= E/(m g l) = 1"}},
              Grounds::ways);
  const DoublePendulumNonlinearAbsolute<> problem(pendulum_masses, pendulum_lengths);
  const auto torque = [&](double angle) {
    Vector<double, 2> dq{}, dp{};
    problem.gradient(Vector<double, 2>{0, angle}, Vector<double, 2>{0, 0}, dq, dp);
    return dq[1];
  };
  if (absolute) {
    study.claim({"upright", "a rod that turns over would show in an angle beyond 2 pi", "2 pi"},
                within(2 * pi, 1e-9, "angle at which the rod stands upright"),
                {{bracketed_root(torque, 1, 5, torque(1), torque(5)), 1e-14,
                  "the first angle beyond 0 without torque: the largest V"}},
                Grounds::identity);
  }
}

/// q'.M q'/2 + q.C q/2 of the linear solution, as appendix C has it: in units of m l^2 and m g l.
std::vector<double> linear_energy(bool absolute, const LinearPendulum& linear, const std::vector<double>& times) {
  std::vector<double> all;
  for (const double t : times) {
    const double q1 = linear.q(0, t), q2 = linear.q(1, t), y1 = linear.rate(0, t), y2 = linear.rate(1, t);
    const double kinetic = absolute ? 5 * y1 * y1 + 4 * y1 * y2 + y2 * y2 : 10 * y1 * y1 + 6 * y1 * y2 + y2 * y2;
    const double potential = absolute ? 3 * q1 * q1 + q2 * q2 : 4 * q1 * q1 + 2 * q1 * q2 + q2 * q2;
    all.push_back(18 * kinetic / 2 + pendulum_energy_unit * potential / 2);
  }
  return all;
}

void over_t(Study& study, bool absolute) {
  const Trajectory figure = pendulum_run(study, "figure", absolute);
  const double rest = -4 * pendulum_energy_unit;
  const double rounding = 64 * 0x1p-53 * figure.report.energy_scale;
  const double above = figure.report.energy.initial - rest;
  study.claim({"energy", "the energy of the motion above rest is E = m g l", "m g l", "116"},
              within(1, 1e-12, "E/(m g l), to rounding"),
              {{above / pendulum_energy_unit, rounding / pendulum_energy_unit, "H of the start less H at rest"}});
  study.claim({"kept", "the energy of the computed motion is constant", "constant"},
              at_most(1e-11 * figure.report.energy_scale, "rounding over the run"),
              {{energy_error(figure), rounding, "largest |H - H0| over every step of cg(1,5), dt = 0.01"}});
  claim_turn_over(study, absolute, figure);
  const LinearPendulum linear = linear_pendulum_of_start(absolute);
  if (absolute) {
    study.claim(
        {"linear_energy", "the energy of the linear solution is larger than that of the motion", "größer", "117"},
        at_least(1, "E of the linear solution divided by m g l; the motion has 1"),
        {{linear_energy(absolute, linear, {0})[0] / pendulum_energy_unit, 1e-12, "at the start, of its own M and C"},
         {pi * pi / 8, 1e-15, "C22 q2^2/2 = m g l pi^2/8 at the start"}},
        Grounds::identity);
  }
  const auto apart_from_linear = [&](const Trajectory& run) {
    double apart = 0;
    for (std::size_t k = 0; k < run.size(); ++k) {
      for (std::size_t i = 0; i < 2; ++i) apart = std::max(apart, std::abs(linear.q(i, run.t[k]) - run.q[k][i]));
    }
    return apart;
  };
  const Trajectory series = pendulum_run(study, "reference", absolute, by_series);
  // A difference changes by less than 10 a second: the rates of both are below 5.
  study.claim({"near", "the angles always stay near those of the linear solution", "immer in der Nähe"},
              at_most(pi / 2,
                      "largest difference of an angle up to t = 26, compared with the amplitude pi/2 of the start; a "
                      "difference as large as this is not near"),
              {{apart_from_linear(figure), 0.05, "cg(1,5), dt = 0.01"},
               {apart_from_linear(series), 0.05, "Taylor series, tolerance 1e-15"}});
  std::array<std::vector<double>, 2> line;
  for (std::size_t i = 0; i < 2; ++i) {
    for (const double t : figure.t) line[i].push_back(linear.q(i, t));
  }
  if (!absolute) {
    const Trajectory other = pendulum_run(study, "absolute", true);
    double gap = 0;
    for (std::size_t k = 0; k < figure.size(); ++k) {
      gap = std::max(
          {gap, std::abs(figure.q[k][0] - other.q[k][0]), std::abs(figure.q[k][0] + figure.q[k][1] - other.q[k][1])});
    }
    study.claim({"same_motion", "the motion in relative angles is the same as in absolute angles", "bestätigt"},
                at_most(1e-9,
                        "the element commutes with linear changes of coordinates: rounding, 1e-13 a step, "
                        "over 2600 steps that separate neighbours by less than 1e4"),
                {{gap, 0, "largest difference of an angle after conversion, at every step"}});
  }
  const std::vector<double> of_linear = linear_energy(absolute, linear, figure.t);
  study.keep({"motion",
              {{"t", figure.t},
               {"q1", figure.coordinate(0)},
               {"q2", figure.coordinate(1)},
               {"linear_q1", line[0]},
               {"linear_q2", line[1]},
               {"energy", figure.energy},
               {"linear_energy", of_linear}}});
  figures::Page page{study.info().title, {}};
  for (std::size_t i = 0; i < 2; ++i) {
    page.panels.push_back(over_time(fmt::format("{{/:Italic q}}_{}", i + 1), figure.t, figure.coordinate(i), line[i]));
    page.panels.back().series.front().name = "linear";
  }
  std::vector<double> energy;
  for (const double H : figure.energy) energy.push_back(H - rest);
  page.panels.push_back(over_time("{/:Italic E} (linear)", figure.t, of_linear));
  page.panels.back().series.front().mark.colour = page.panels.front().series.front().mark.colour;
  page.panels.push_back(over_time("{/:Italic E}", figure.t, energy));
  study.draw(
      "figure",
      study.info().title +
          ": angles with dt = 0.01 (dots), linear solution (lines), energy of the linear solution, energy above rest",
      std::move(page));
}

void start(Study& study, bool absolute) {
  const Vector<double, 2> of_table_3_3{0, pi / 2}, of_table_3_4{0, pi / 2}, rest{0, 0}, none{0, 0};
  const Vector<double, 2>& q = absolute ? of_table_3_3 : of_table_3_4;
  const DoublePendulumNonlinearAbsolute<> in_absolute(pendulum_masses, pendulum_lengths);
  const DoublePendulumNonlinearRelative<> in_relative(pendulum_masses, pendulum_lengths);
  const double E = absolute ? in_absolute.energy(q, none) - in_absolute.energy(rest, none)
                            : in_relative.energy(q, none) - in_relative.energy(rest, none);
  study.claim(
      {"energy", fmt::format("the start of table {} has the energy E = m g l above rest", absolute ? "3.3" : "3.4"),
       "m g l", "116"},
      within(1, 1e-14, "rounding of E/(m g l)"),
      {{E / pendulum_energy_unit, 4 * 0x1p-53, "H of the start less H at rest"}});
  if (absolute) return;
  study.claim(
      {"same_start", "the relative angle of table 3.4 is the absolute one of table 3.3, since the upper rod hangs down",
       "identisch"},
      at_most(0, "q2 - q1 of table 3.3 less q2 of table 3.4"),
      {{(of_table_3_3[1] - of_table_3_3[0]) - of_table_3_4[1], 0, "of the tables"}}, Grounds::identity);
}

}  // namespace nonlinear_pendulum

std::vector<Experiment> nonlinear_pendulum_experiments() {
  using namespace nonlinear_pendulum;
  return {{{"T3.3", gross, "115", "start of the nonlinear double pendulum, absolute angles"},
           [](Study& study) { start(study, true); }},
          {{"T3.4", gross, "121", "start of the nonlinear double pendulum, relative angles"},
           [](Study& study) { start(study, false); }},
          {{"G3.21", gross, "116", "nonlinear double pendulum, absolute angles"},
           [](Study& study) { over_t(study, true); }},
          {{"G3.22", gross, "117", "nonlinear double pendulum, absolute angles, phase planes"},
           [](Study& study) { in_phase_planes(study, true); }},
          {{"G3.25", gross, "122", "nonlinear double pendulum, relative angles"},
           [](Study& study) { over_t(study, false); }},
          {{"G3.26", gross, "123", "nonlinear double pendulum, relative angles, phase planes"},
           [](Study& study) { in_phase_planes(study, false); }}};
}

}  // namespace hamflow::reproduction
