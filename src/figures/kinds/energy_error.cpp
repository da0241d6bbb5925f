// (H - H0)/scale over time.
#include <cmath>

#include "../figure_kind.hpp"
#include "../panels.hpp"

namespace hamflow::figures {

namespace energy_error {
std::string obstacle(const FigureData& data) {
  if (finite_points(data.t, data.energy).x.empty()) return no_samples("energy");
  return std::isfinite(data.energy.front()) ? "" : "the energy of the first sample, to compare with, is not finite";
}

Page page(const FigureData& data) {
  const std::vector<double> error = relative_energy_error(data);
  Panel panel = over_time(data.t, error);
  Extent range;
  range.include(error);
  range.include(0);
  constexpr double rounding = 1e-15;
  const bool at_rounding = range.largest() < rounding;
  if (at_rounding) {  // single roundings must not look like a signal
    range.include(-rounding);
    range.include(rounding);
  }
  panel.y = fit_axis(range, at_rounding ? 0 : padding, {6});
  const std::string divisor = scale_name(data);
  const std::string difference = energy_name + " − " + energy_start;
  panel.y_label = divisor.empty() ? difference : "(" + difference + ")/" + divisor;
  Extent times;
  times.include(data.t);
  panel.series.insert(panel.series.begin(), {Ink::zero, "", {{times.low, times.high}, {0, 0}}});
  return {data.title, {panel}};
}
}  // namespace energy_error

extern const FigureKind energy_error_figure{
    "energy-error",
    "the relative error of the energy over time, (H - H0)/max(|H0|, |T0| + |V0|)",
    3,
    never,
    energy_error::obstacle,
    energy_error::page};

}  // namespace hamflow::figures
