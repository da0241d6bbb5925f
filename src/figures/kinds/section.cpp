// Points of a Poincare section, in the plane of a coordinate and its momentum.
#include <algorithm>

#include "../figure_kind.hpp"
#include "../panels.hpp"
#include "../text.hpp"
#include "hamflow/figures/curves.hpp"

namespace hamflow::figures {

namespace section {
std::string refused(const FigureFacts& facts) {
  if (facts.degrees_of_freedom == 1 && !facts.stroboscopic) {
    return for_degrees(facts) + ", where a section needs 2 or more, or an expression of t alone";
  }
  return facts.section ? "" : ", which needs run.section, e.g. { coordinate = \"q1\" }";
}

std::string obstacle(const FigureData& data) {
  return finite_points(data.section_q, data.section_p).x.empty() ? "the section has no points" : "";
}

std::string apart(const Figure& figure) {
  const FigureData& first = figure.runs.front();
  for (const FigureData& run : figure.runs) {
    if (run.section_text == first.section_text && run.section_coordinate == first.section_coordinate) continue;
    return first.label + " and " + run.label + " have different sections; allowed runs with the same section";
  }
  return {};
}

Page page(const Figure& figure) {
  constexpr std::size_t most_points = 20000;
  constexpr std::size_t most_together = 100000;
  const std::size_t each = std::clamp<std::size_t>(most_together / figure.runs.size(), 100, most_points);
  const FigureData& one = figure.runs.front();
  Extent q;
  Extent p;
  Panel panel;
  for (std::size_t run = 0; run < figure.runs.size(); ++run) {
    Series points = series_of(figure, run);
    points.ink = Ink::fine_dots;
    points.curve = thin_out(finite_points(figure.runs[run].section_q, figure.runs[run].section_p), each);
    q.include(points.curve.x);
    p.include(points.curve.y);
    panel.series.push_back(std::move(points));
  }
  panel.x = fit_axis(q, padding, {7, 40});
  panel.y = fit_axis(p, padding, {7});
  panel.x_label = in_unit(symbol(one.section_coordinate), units_of(figure).q);
  panel.y_label = in_unit(symbol(one.section_momentum), units_of(figure).p);
  panel.aspect = 0.8;
  Page all{one.title, {panel}};
  if (!one.section_text.empty()) all.notes.push_back(one.section_text);
  return all;
}
}  // namespace section

extern const FigureKind section_figure{"section",
                                       "the points of a Poincare section, for a run with run.section and 2 or more "
                                       "degrees of freedom, or a section in time",
                                       7,
                                       section::refused,
                                       section::obstacle,
                                       section::apart,
                                       no_columns,
                                       section::page};

}  // namespace hamflow::figures
