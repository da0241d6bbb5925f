#include "gas_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenarios.hpp"

namespace hamflow::reproduction {

double GasRun::scale_number() const {
  if (scale == "listing") return (particles() - 1) / 2.0;
  if (scale == "per-side") return start == "corner" ? side - 1 : (side - 1) / 2.0;
  return std::stod(scale);
}

std::string name_of(const GasRun& run) {
  return fmt::format("{}_{}_{}_{}_e{}_{}_{}_{}", run.particles(), run.start, run.scale, run.dt, run.exponent, run.steps,
                     run.arithmetic, run.seed);
}

std::string gas_scenario(const GasRun& run) {
  std::vector<std::string> sets =
      in_steps(run.dt, run.steps, run.record_every > 0 ? run.record_every : std::max<std::int64_t>(run.steps, 1));
  for (const std::string& one :
       {fmt::format("problem.particles_per_side={}", run.side), fmt::format("problem.start={}", run.start),
        "problem.scale=" + run.scale, fmt::format("problem.container.exponent={}", run.exponent),
        "run.arithmetic=" + run.arithmetic}) {
    sets.push_back(one);
  }
  if (run.start == "lattice") sets.push_back(fmt::format("problem.seed={}", run.seed));
  return scenario_of("gas", sets);
}

Return there_and_back(Study& study, const GasRun& run) {
  const ReversalReport report = study.reverse(name_of(run), gas_scenario(run));
  const ReversalSummary& found = report.summary;
  Return all;
  all.done = report.status == "done";
  all.message = report.message;
  all.start = report.reversal.start;
  all.turn = report.reversal.turn;
  all.end = report.reversal.end;
  all.pair_evaluations = static_cast<double>(found.bodies.value().pair_evaluations.value());
  if (all.done) {
    all.position = found.bodies->error.value().position;
    all.momentum = found.bodies->error.value().momentum;
    all.digits_lost = found.digits_lost.value();
    all.bit_exact = found.bit_exact.value();
  } else {
    all.failed_at = found.error.value().step;
  }
  return all;
}

double digits_of(Study& study, const std::string& arithmetic) {
  const auto moved_by = [&](int halvings) {
    const Trajectory run =
        study.run(fmt::format("one_and_{}_{}", halvings, arithmetic), scenario_of("one_and_less"),
                  {fmt::format("problem.initial.p=[\"2^(-{})\"]", halvings), "run.arithmetic=" + arithmetic});
    const StateAtTime& end = run.report.summary.final;
    return end.digits.q.empty() ? shortest(end.q.at(0)) : end.digits.q.at(0);
  };
  int moves = 0, stays = 1000;
  const auto where_it_stays = moved_by(stays);
  while (stays - moves > 1) {
    const int middle = (moves + stays) / 2;
    (moved_by(middle) == where_it_stays ? stays : moves) = middle;
  }
  return moves * std::log10(2.0);
}

double farthest(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i + 1 < a.size(); i += 2) {
    const double r = std::hypot(a[i] - b[i], a[i + 1] - b[i + 1]);
    most = r <= most ? most : r;  // NaN counts as the largest distance
    if (std::isnan(r)) return r;
  }
  return most;
}

figures::Panel places(const std::string& x_label, const std::string& y_label, const std::vector<Places>& all) {
  using namespace figures;
  Extent across, up;
  Panel panel;
  for (const Places& some : all) {
    std::vector<double> x, y;
    for (std::size_t i = 0; i + 1 < some.xy.size(); i += 2) x.push_back(some.xy[i]), y.push_back(some.xy[i + 1]);
    across.include(x);
    up.include(y);
    panel.series.push_back({Ink::marks, some.name, finite_points(x, y), {.colour = some.colour, .shape = some.shape}});
  }
  panel.x_label = x_label;
  panel.y_label = y_label;
  fit_equal_axes(panel, across, up);
  return panel;
}

}  // namespace hamflow::reproduction
