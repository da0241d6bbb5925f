// Phase planes: each coordinate and its momentum, with the level curve of H where there is one degree of freedom.
#include <cmath>

#include "../curves.hpp"
#include "../figure_kind.hpp"
#include "../panels.hpp"
#include "../text.hpp"

namespace hamflow::figures {

namespace phase {
constexpr std::size_t most_planes = 12;  // on one page

std::string refused(const FigureFacts& facts) {
  if (facts.degrees_of_freedom <= most_planes) return "";
  return for_degrees(facts) + ", of which at most " + std::to_string(most_planes) + " fit on a page";
}

std::string obstacle(const FigureData& data) {
  if (data.q.empty() || data.p.size() != data.q.size()) return "a phase plane needs a momentum for every coordinate";
  for (std::size_t i = 0; i < data.q.size(); ++i) {
    if (finite_points(data.q[i], data.p[i]).x.empty()) return no_samples("position and momentum");
  }
  return "";
}

Panel phase_panel(const FigureData& data, std::size_t i, std::size_t columns) {
  const Curve track = finite_points(data.q[i], data.p[i]);
  Extent q;
  Extent p;
  q.include(track.x);
  p.include(track.y);
  Panel panel;
  panel.x = fit_axis(q, padding, columns == 1 ? TickRoom{7, 40} : TickRoom{5, 18});
  panel.y = fit_axis(p, padding, {columns == 1 ? 7U : 5U});
  panel.x_label = symbol(data.coordinates[i]);
  panel.y_label = momentum_symbol(data.coordinates[i]);
  panel.aspect = columns == 1 ? 0.7 : 1;
  const bool exact = data.hamiltonian_1d && data.q.size() == 1 && std::isfinite(start_of(data.energy));
  if (!exact) {
    panel.series.push_back(samples(track));
    return panel;
  }
  const auto raw = [](const Axis& axis) {
    const double unit_half = std::pow(10.0, axis.exponent / 2);
    const double unit_rest = std::pow(10.0, axis.exponent - axis.exponent / 2);
    return Extent{axis.low * unit_half * unit_rest, axis.high * unit_half * unit_rest};
  };
  const double level = data.energy.empty() ? data.hamiltonian_1d(track.x[0], track.y[0]) : data.energy[0];
  panel.series.push_back({Ink::exact, "exact, " + energy_name + " = " + energy_start,
                          level_curve(data.hamiltonian_1d, level, raw(panel.x), raw(panel.y))});
  panel.series.push_back({Ink::dots, "numeric", dots_on_line(track, panel)});
  return panel;
}

Page page(const FigureData& data) {
  Page all;
  all.title = data.title;
  all.columns = data.q.size() == 1 ? 1 : 2;
  for (std::size_t i = 0; i < data.q.size(); ++i) all.panels.push_back(phase_panel(data, i, all.columns));
  return all;
}
}  // namespace phase

extern const FigureKind phase_figure{
    "phase", "the phase plane (q, p) of each coordinate", 2, phase::refused, phase::obstacle, phase::page};

}  // namespace hamflow::figures
