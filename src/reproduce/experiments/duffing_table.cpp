// [Gross1999, table 2.5]: the zeros of the phase curve of the Duffing oscillator, mu r'^2 = -k (r^2 - lambda +
// |lambda_inf|) (r^2 - lambda - |lambda_inf|), equation 2.184: they are where the motion turns. Random k, lambda,
// lambda_inf.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../central_orbits.hpp"
#include "../experiment.hpp"
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
  return study.run(name, fmt::format("[problem]\nname = \"duffing\"\nmass = {:.17g}\nk = {:.17g}\nlambda = {:.17g}\n"
                                     "initial = {{ q = [{:.17g}], p = [{:.17g}] }}\n\n[method]\nname = \"rkn8-s19\"\n\n"
                                     "[run]\ndt = {:.6g}\nsteps = {}\nrecord_every = 1\n",
                                     d.mass, d.k, d.lambda, q, p, 0.02 / rate, std::lround(50 * turns)));
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

void carry_out(Study& study) {
  const int draws = study.sized(8, 60, 600);
  int two = 0, three = 0, four = 0;
  for (int i = 0; i < draws; ++i) {
    const auto seed = static_cast<std::uint64_t>(977 * i);
    const auto begin = [&](const Draw& d) { return std::sqrt(d.lambda + d.lambda_inf); };
    const Draw a = draw(seed + 1, -0.9, 0.8);
    two += same(turns(run(study, fmt::format("two_{}", i), a, begin(a), 0, 80), a), {-1, 1}) ? 0 : 1;
    Draw b = draw(seed + 2, 1, 1);
    b.lambda = b.lambda_inf;
    const Trajectory separatrix = run(study, fmt::format("three_{}", i), b, begin(b), 0, 40);
    bool turned = false, arrived = false;
    for (std::size_t k = 1; k < separatrix.size() && !arrived; ++k) {
      turned = turned || separatrix.p[k][0] >= 0;
      arrived = separatrix.q[k][0] < 0.01 * begin(b);
    }
    three += arrived && !turned ? 0 : 1;
    const Draw c = draw(seed + 3, 1.25, 3);
    const double inner = std::sqrt((c.lambda - c.lambda_inf) / (c.lambda + c.lambda_inf));
    four += same(turns(run(study, fmt::format("four_{}", i), c, begin(c), 0, 80), c), {inner, 1}) ? 0 : 1;
  }
  const auto told = [&](int count, const char* how) {
    return std::vector<Measured>{
        {static_cast<double>(count), 0, fmt::format("of {} motions, rkn8-s19: {}", draws, how)}};
  };
  study.claim({"two", "lambda < |lambda_inf|: two zeros, +-sqrt(lambda + |lambda_inf|)", "2"},
              none_of("counter-examples"), told(two, "do not turn at both and only there"));
  study.claim({"three", "lambda = |lambda_inf|: three zeros, 0 and +-sqrt(2 |lambda_inf|)", "3"},
              none_of("counter-examples"), told(three, "turn before they have come near 0"));
  study.claim({"four", "lambda > |lambda_inf|: four zeros, +-sqrt(lambda +- |lambda_inf|)", "4"},
              none_of("counter-examples"), told(four, "do not turn at both of one side and only there"));

  // Tables 2.3 and 2.4 count k < 0 in; then lambda may be below -|lambda_inf|, and r^2 = lambda + |lambda_inf| < 0.
  const Draw d{1, -1, -2, 1};
  const double E = d.k / 2 * d.lambda_inf * d.lambda_inf;
  const auto square = [&](double r) {
    return -d.k * (r * r - d.lambda + d.lambda_inf) * (r * r - d.lambda - d.lambda_inf) / d.mass;
  };
  std::vector<double> grid;
  for (int i = -4000; i <= 4000; ++i) grid.push_back(i * 0.01 + 0.005);
  const Trajectory through =
      study.run("no_turn", fmt::format("[problem]\nname = \"duffing\"\nk = -1\nlambda = -2\ninitial = {{ q = [-3], p = "
                                       "[{:.17g}] }}\n\n[method]\nname = \"taylor\"\ntolerance = 1e-14\n\n[run]\ndt = "
                                       "0.01\nsteps = 150\nrecord_every = 1\n",
                                       std::sqrt(square(-3))));
  double found = 0;
  for (std::size_t i = 1; i < through.size(); ++i) found += (through.p[i][0] < 0) != (through.p[i - 1][0] < 0) ? 1 : 0;
  study.claim(
      {"two_negative", "lambda < |lambda_inf|: two zeros, also for k = -1, lambda = -2, E = -1/2", "2"},
      as_printed("2"),
      {{static_cast<double>(roots(square, grid).size()), 0,
        fmt::format("changes of sign of equation 2.184 for |r| < 40, E = {:g}", E)},
       {found, 0, fmt::format("turns of the motion from r = -3 to {:.4g}, Taylor series", through.q.back()[0])}},
      Grounds::ways);
}

}  // namespace duffing_table

std::vector<Experiment> duffing_table_experiments() {
  return {{{"T2.5", gross, "68", "phase curves of the Duffing oscillator"}, duffing_table::carry_out}};
}

}  // namespace hamflow::reproduction
