// The points of a Poincare section, in the plane of a coordinate and its momentum.
#include "../curves.hpp"
#include "../figure_kind.hpp"
#include "../panels.hpp"
#include "../text.hpp"

namespace hamflow::figures {

namespace section {
std::string refused(const FigureFacts& facts) {
  if (facts.degrees_of_freedom == 1) return for_degrees(facts) + ", where a section needs 2 or more";
  return facts.section ? "" : ", which needs run.section, e.g. { coordinate = \"q1\" }";
}

std::string obstacle(const FigureData& data) {
  return finite_points(data.section_q, data.section_p).x.empty() ? "the section has no points" : "";
}

Page page(const FigureData& data) {
  constexpr std::size_t most_points = 20000;
  const Curve points = finite_points(data.section_q, data.section_p);
  Extent q;
  Extent p;
  q.include(points.x);
  p.include(points.y);
  Panel panel;
  panel.x = fit_axis(q, padding, {7, 40});
  panel.y = fit_axis(p, padding, {7});
  panel.x_label = symbol(data.section_coordinate);
  panel.y_label = momentum_symbol(data.section_coordinate);
  panel.aspect = 0.8;
  panel.series.push_back({Ink::fine_dots, "", thin_out(points, most_points)});
  return {data.title, {panel}};
}
}  // namespace section

extern const FigureKind section_figure{
    "section",
    "the points of a Poincare section, of a run with run.section and 2 or more degrees of freedom",
    6,
    section::refused,
    section::obstacle,
    section::page};

}  // namespace hamflow::figures
