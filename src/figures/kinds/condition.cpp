// How well the Newton iteration of an implicit step is conditioned, over time: condition and determinant of the
// tangent, condition of M^-1, and iterations.   [Gross1999, figures 3.27, 3.28]
#include "../figure_kind.hpp"
#include "../panels.hpp"

namespace hamflow::figures {

namespace condition {
std::string refused(const FigureFacts& facts) {
  return facts.diagnostics ? "" : ", which needs method.diagnostics = true of an implicit method";
}

std::string obstacle(const FigureData& data) {
  for (const auto& column : data.diagnostics) {
    if (!finite_points(data.t, column.second).x.empty()) return "";
  }
  return no_samples("condition");
}

Page page(const FigureData& data) {
  const std::vector<std::pair<std::string, std::string>> labels{{"condition_tangent", "cond_∞({/:Italic K}_T)"},
                                                                {"determinant_tangent", "det({/:Italic K}_T)"},
                                                                {"condition_inverse_mass", "cond_∞({/:Italic M}^{−1})"},
                                                                {"iterations", "Newton iterations"}};
  Page all{data.title, {}};
  for (const auto& [name, label] : labels) {
    for (const auto& [column, values] : data.diagnostics) {
      if (column != name || finite_points(data.t, values).x.empty()) continue;
      Panel panel = over_time(data.t, values);
      Extent range;
      range.include(values);
      panel.y = fit_axis(range, padding, {5});
      panel.y_label = label;
      all.panels.push_back(panel);
    }
  }
  return all;
}
}  // namespace condition

extern const FigureKind condition_figure{
    "condition",
    "condition and iterations of the Newton steps over time, of an implicit method with diagnostics",
    5,
    condition::refused,
    condition::obstacle,
    condition::page};

}  // namespace hamflow::figures
