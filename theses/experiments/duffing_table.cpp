// [Gross1999, table 2.5]: the zeros of the phase curve of the Duffing oscillator, mu r'^2 = -k (r^2 - lambda +
// |lambda_inf|) (r^2 - lambda - |lambda_inf|), equation 2.184: they are where the motion turns. Random k, lambda,
// lambda_inf.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../central_orbits.hpp"
#include "../experiment.hpp"
#include "../scenarios.hpp"
#include "../trajectories.hpp"

namespace hamflow::reproduction {

namespace duffing_table {

struct Draw {
  double mass, k, lambda, lambda_inf;
};

/// The ratio lambda/|lambda_inf| lies between a and b.
Draw draw(std::uint64_t seed, double a, double b) {
  const auto power = [&](std::uint64_t n) { return std::pow(10, drawn(seed, n) - 0.5); };
  const double lambda_inf = 4 * power(0);
  return {power(1), power(2), lambda_inf * (a + (b - a) * drawn(seed, 3)), lambda_inf};
}

Trajectory run(Study& study, const std::string& name, const Draw& d, double q, double p, double turns) {
  const double rate =
      std::sqrt((6 * std::abs(d.lambda + d.lambda_inf) + 2 * std::abs(d.lambda)) * std::abs(d.k) / d.mass);
  std::vector<std::string> sets = in_steps(fmt::format("{:.6g}", 0.02 / rate), std::lround(50 * turns));
  for (const auto& [key, value] : {std::pair{"mass", d.mass}, {"k", d.k}, {"lambda", d.lambda}}) {
    sets.push_back(fmt::format("problem.{}={:.17g}", key, value));
  }
  sets.push_back(fmt::format("problem.initial={{ q = [{:.17g}], p = [{:.17g}] }}", q, p));
  return study.run(name, scenario_of("duffing_motion"), sets);
}

/// Where the motion turns, each place once, in units of the outermost.
std::vector<double> turns(const Trajectory& run, const Draw& d) {
  std::vector<double> rate;
  for (const auto& p : run.p) rate.push_back(p[0] / d.mass);
  std::vector<double> all = extrema(run.t, run.coordinate(0), rate);
  std::sort(all.begin(), all.end());
  std::vector<double> once;
  const double size = std::sqrt(d.lambda + d.lambda_inf);
  for (const double x : all) {
    if (once.empty() || x / size - once.back() > 1e-5) once.push_back(x / size);
  }
  return once;
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::abs(a[i] - b[i]) > 1e-6) return false;
  }
  return true;
}

/// Whether the motion from rest at r0 comes to r = 0 as to a zero of the phase curve: never beyond it, and slower and
/// slower, by 2.184 with lambda = |lambda_inf| as r'/r = -w sqrt(1 - (r/r0)^2), w^2 = 2 k lambda/mu. Where r = 0 is no
/// zero, r' is not 0 there, and r'/r grows without bound. Followed down to r0/1000.
bool approaches_zero(const Trajectory& run, const Draw& d) {
  const double r0 = run.q[0][0], w = std::sqrt(2 * d.k * d.lambda / d.mass);
  for (std::size_t i = 1; i < run.size(); ++i) {
    const double r = run.q[i][0], rate = run.p[i][0] / d.mass;
    if (r <= 0 || std::abs(rate / (w * r) + std::sqrt(std::max(0.0, 1 - r * r / (r0 * r0)))) > 1e-4) return false;
    if (r < 1e-3 * r0) return true;
  }
  return false;
}

/// Different real roots of 2.184: of r^2 = lambda + |lambda_inf| and of r^2 = lambda - |lambda_inf|.
int zeros(const Draw& d) {
  const auto of_square = [](double square) { return square > 0 ? 2 : square < 0 ? 0 : 1; };
  return of_square(d.lambda + d.lambda_inf) + of_square(d.lambda - d.lambda_inf);
}

void carry_out(Study& study) {
  const int draws = study.sized(8, 60, 600);
  int two = 0, three = 0, four = 0, not_three_roots = 0, told_apart = 0;
  for (int i = 0; i < draws; ++i) {
    const auto seed = static_cast<std::uint64_t>(977 * i);
    const auto begin = [&](const Draw& d) { return std::sqrt(d.lambda + d.lambda_inf); };
    const Draw a = draw(seed + 1, -0.9, 0.8);
    two += same(turns(run(study, fmt::format("two_{}", i), a, begin(a), 0, 80), a), {-1, 1}) ? 0 : 1;
    Draw b = draw(seed + 2, 1, 1);
    b.lambda = b.lambda_inf;
    three += approaches_zero(run(study, fmt::format("three_{}", i), b, begin(b), 0, 40), b) ? 0 : 1;
    not_three_roots += zeros(b) == 3 ? 0 : 1;
    b.lambda = b.lambda_inf / 2;
    told_apart += approaches_zero(run(study, fmt::format("half_{}", i), b, begin(b), 0, 40), b) ? 0 : 1;
    const Draw c = draw(seed + 3, 1.25, 3);
    const double inner = std::sqrt((c.lambda - c.lambda_inf) / (c.lambda + c.lambda_inf));
    four += same(turns(run(study, fmt::format("four_{}", i), c, begin(c), 0, 80), c), {inner, 1}) ? 0 : 1;
  }
  const auto told = [&](int count, const std::string& how) {
    return Measured{static_cast<double>(count), 0, fmt::format("of {} motions, rkn8-s19: {}", draws, how)};
  };
  study.claim({"two", "for lambda < |lambda_inf| the phase curve has two zeros, +-sqrt(lambda + |lambda_inf|)", "2"},
              none_of("counter-examples"), {told(two, "do not turn at both zeros, and only there")});
  study.claim(
      {"three", "for lambda = |lambda_inf| the phase curve has three zeros, 0 and +-sqrt(2 |lambda_inf|)", "3"},
      none_of("counter-examples"),
      {told(three, fmt::format("do not come from r0 to r0/1000 as to a zero, r'/r = -w sqrt(1 - (r/r0)^2); with "
                               "lambda = |lambda_inf|/2, where r = 0 is no zero, {} do not",
                               told_apart)),
       {static_cast<double>(not_three_roots), 0, "of their equations 2.184 do not have three different roots"}});
  study.claim({"four", "for lambda > |lambda_inf| the phase curve has four zeros, +-sqrt(lambda +- |lambda_inf|)", "4"},
              none_of("counter-examples"), {told(four, "do not turn at both zeros of one side, and only there")});
  study.note(fmt::format(
      "The table is taken for k > 0: its section is about oscillations (\"weil die Bewegung eine Schwingung ist\"), "
      "and "
      "equation 2.215 has a root of mu/k. Then lambda > -|lambda_inf| follows. For k < 0, which table 2.4 includes, "
      "lambda may be smaller, and r never turns: {} zeros for k = -1, lambda = -2, |lambda_inf| = 1.",
      zeros({1, -1, -2, 1})));
}

}  // namespace duffing_table

std::vector<Experiment> duffing_table_experiments() {
  return {{{"T2.5", gross, "68", "phase curves of the Duffing oscillator"}, duffing_table::carry_out}};
}

}  // namespace hamflow::reproduction
