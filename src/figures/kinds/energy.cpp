// H over time.
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

Page page(const FigureData& data) {
  Panel panel = over_time(data.t, data.energy);
  Extent range;
  range.include(data.energy);
  const double scale = std::max(scale_of(data), range.largest());
  // Below a thousandth of the scale the labels would differ in their last digits only: then the energy is shown as the
  // constant it is, and its error stands beside it as a number.
  if (range.high / scale - range.low / scale < 1e-3) {
    double worst = 0;
    for (const double e : relative_energy_error(data)) {
      if (std::isfinite(e)) worst = std::max(worst, std::abs(e));
    }
    const std::string divisor = scale_name(data);
    const double start = start_of(data.energy);
    if (std::isfinite(start)) {
      panel.note = fmt::format("max |{} − {}|{}{} = {}", energy_name, energy_start, divisor.empty() ? "" : "/", divisor,
                               short_number(worst));
    }
    constexpr double most = std::numeric_limits<double>::max();
    range.include(std::max(start - scale, -most));
    range.include(std::min(start + scale, most));
  }
  panel.y = fit_axis(range, padding, {6});
  panel.y_label = energy_name;
  return {data.title, {panel}};
}
}  // namespace energy

extern const FigureKind energy_figure{"energy", "the energy H over time", 4, never, energy::obstacle, energy::page};

}  // namespace hamflow::figures
