// Each coordinate over time.
#include "../figure_kind.hpp"
#include "../panels.hpp"
#include "../text.hpp"

namespace hamflow::figures {

namespace {
std::string obstacle(const FigureData& data) {
  for (const std::vector<double>& q : data.q) {
    if (!finite_points(data.t, q).x.empty()) return "";
  }
  return no_samples("position");
}

Page page(const FigureData& data) {
  Page all{data.title, {}};
  for (std::size_t i = 0; i < data.q.size() && i < 4; ++i) {
    Extent range;
    range.include(data.q[i]);
    all.panels.push_back(over_time(data.t, data.q[i]));
    all.panels.back().y = fit_axis(range, padding, {5});
    all.panels.back().y_label = symbol(data.coordinates.at(i));
  }
  return all;
}
}  // namespace

extern const FigureKind time_figure{"time", "the first coordinates over time", 7, never, obstacle, page};

}  // namespace hamflow::figures
