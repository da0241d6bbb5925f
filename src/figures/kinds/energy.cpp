// Energy H over time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "../figure_kind.hpp"
#include "../panels.hpp"
#include "../text.hpp"

namespace hamflow::figures {

namespace energy {
std::string obstacle(const FigureData& data) {
  return finite_points(data.t, data.energy).x.empty() ? no_samples("energy") : "";
}

/// Returns a text such as "max |H - H0|/|H0| = 1.2e-9".
std::string worst_error(const FigureData& data) {
  double worst = 0;
  for (const double e : relative_energy_error(data)) {
    if (std::isfinite(e)) worst = std::max(worst, std::abs(e));
  }
  const std::string divisor = scale_name(data);
  return fmt::format("max |{} − {}{}|{}{} = {}", energy_name, energy_start, data.has_time ? energy_of_time : "",
                     divisor.empty() ? "" : "/", divisor, short_number(worst));
}

Page page(const Figure& figure) {
  Extent times;
  Extent range;
  double scale = 0;
  for (const FigureData& run : figure.runs) {
    times.include(run.t);
    range.include(run.energy);
    scale = std::max(scale, scale_of(run));
  }
  scale = std::max(scale, range.largest());
  Panel panel = panel_over(times, time_label(figure));
  for (std::size_t run = 0; run < figure.runs.size(); ++run) {
    add_over_time(panel, figure.runs[run].t, figure.runs[run].energy, series_of(figure, run));
  }
  // If the range is below a thousandth of the scale, labels would only differ in their last digits. Then the axis shows
  // the energy as constant, and a note gives its error.
  if (range.high / scale - range.low / scale < 1e-3) {
    const double start = start_of(figure.runs.front().energy);
    if (std::isfinite(start) && figure.runs.size() == 1) panel.note = worst_error(figure.runs.front());
    constexpr double most = std::numeric_limits<double>::max();
    range.include(std::max(start - scale, -most));
    range.include(std::min(start + scale, most));
  }
  panel.y = fit_axis(range, padding, {6});
  panel.y_label = in_unit(energy_name + (figure.runs.front().has_time ? energy_of_time : ""), units_of(figure).energy);
  return {figure.runs.front().title, {panel}};
}
}  // namespace energy

extern const FigureKind energy_figure{"energy",
                                      "the energy H over time; for H(q, p, t) minus the integral of dH/dt",
                                      5,
                                      without_energies,
                                      energy::obstacle,
                                      any_runs,
                                      no_columns,
                                      energy::page};

}  // namespace hamflow::figures
