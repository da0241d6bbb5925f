// Conditioning of the Newton iteration of an implicit step over time: condition and determinant of the Jacobian,
// condition of M^-1, and iterations.   [Gross1999, figures 3.27, 3.28]
#include <algorithm>

#include "../figure_kind.hpp"
#include "../panels.hpp"

namespace hamflow::figures {

namespace condition {
std::string refused(const FigureFacts& facts) {
  return facts.diagnostics ? "" : ", which needs an implicit method with method.diagnostics = true";
}

std::string obstacle(const FigureData& data) {
  for (const auto& column : data.diagnostics) {
    if (!finite_points(data.t, column.second).x.empty()) return "";
  }
  return no_samples("condition");
}

std::string apart(const Figure& figure) {
  for (const FigureData& run : figure.runs) {
    const std::string reason = obstacle(run);
    if (!reason.empty()) return "of " + run.label + " " + reason;
  }
  return {};
}

Page page(const Figure& figure) {
  const std::vector<std::pair<std::string, std::string>> labels{{"condition_tangent", "cond_∞({/:Italic K}_T)"},
                                                                {"determinant_tangent", "det({/:Italic K}_T)"},
                                                                {"condition_inverse_mass", "cond_∞({/:Italic M}^{−1})"},
                                                                {"iterations", "Newton iterations"}};
  Page all{figure.runs.front().title, {}};
  Extent times;
  for (const FigureData& run : figure.runs) times.include(run.t);
  for (const auto& [name, label] : labels) {
    Panel panel = panel_over(times, time_label(figure));
    Extent range;
    for (std::size_t run = 0; run < figure.runs.size(); ++run) {
      for (const auto& [column, values] : figure.runs[run].diagnostics) {
        if (column != name || finite_points(figure.runs[run].t, values).x.empty()) continue;
        Series how = series_of(figure, run);
        if (!all.panels.empty()) how.name.clear();
        add_over_time(panel, figure.runs[run].t, values, how);
        range.include(values);
      }
    }
    if (panel.series.empty()) continue;
    panel.y = fit_axis(range, padding, {5});
    // iterations are whole numbers
    if (name == "iterations" && panel.y.exponent == 0) panel.y.step = std::max(panel.y.step, 1.0);
    panel.y_label = label;
    all.panels.push_back(panel);
  }
  return all;
}
}  // namespace condition

extern const FigureKind condition_figure{
    "condition",
    "condition and iterations of Newton's method over time, for an implicit method with diagnostics",
    6,
    condition::refused,
    condition::obstacle,
    condition::apart,
    no_columns,
    condition::page};

}  // namespace hamflow::figures
