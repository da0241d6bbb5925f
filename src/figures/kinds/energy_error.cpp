// (H - H0)/scale over time. If the error spans powers of ten, its size is drawn on a logarithmic axis.
#include <algorithm>
#include <cmath>

#include "../figure_kind.hpp"
#include "../panels.hpp"

namespace hamflow::figures {

namespace energy_error {
std::string obstacle(const FigureData& data) {
  if (finite_points(data.t, data.energy).x.empty()) return no_samples("energy");
  return std::isfinite(data.energy.front()) ? "" : "the energy of the first sample is not finite";
}

double largest(const std::vector<double>& error) {
  Extent range;
  range.include(error);
  return range.largest();
}

/// Returns whether a linear axis would show some of the data as 0: runs of different precision, or an error that grows
/// over powers of ten.
bool is_logarithmic(const std::vector<std::vector<double>>& errors) {
  constexpr double far = 100;
  Extent of_runs;
  for (const std::vector<double>& error : errors) of_runs.include_positive(std::vector<double>{largest(error)});
  if (of_runs.empty()) return false;
  if (of_runs.high > far * of_runs.low) return true;
  const std::vector<double>& one = errors.front();
  const auto quarter = static_cast<std::ptrdiff_t>(one.size() / 4);
  const double early = largest({one.begin(), one.begin() + quarter});
  return early > 0 && largest({one.end() - quarter, one.end()}) > 10 * far * early;
}

bool has_range(const FigureData& data) {
  return !data.least_difference.empty() && data.least_difference.size() == data.largest_difference.size();
}

/// Range of the relative error over the steps on both sides of a sample. One side alone may cover only half a period,
/// so that every second sample would show the half with small errors.
struct Range {
  double low = 0;
  double high = 0;
};
Range range_at(const FigureData& data, std::size_t k) {
  const std::size_t next = std::min(k + 1, data.t.size() - 1);
  const double scale = scale_of(data);
  return {std::min(data.least_difference[k], data.least_difference[next]) / scale,
          std::max(data.largest_difference[k], data.largest_difference[next]) / scale};
}

/// Returns the size of the error at each sample: the largest over the neighbouring steps, if it is known.
std::vector<double> sizes_of(const FigureData& data) {
  std::vector<double> all = relative_energy_error(data);
  for (std::size_t k = 0; k < all.size() && has_range(data); ++k) {
    const Range range = range_at(data, k);
    all[k] = std::max(std::abs(range.low), std::abs(range.high));
  }
  return all;
}

/// Draws the area between the smallest and largest error, because samples alone may beat with the motion in between.
void add_range(Panel& panel, const FigureData& data, Series how) {
  constexpr std::size_t page_columns = 400;
  Band band;
  for (std::size_t k = 0; k < data.t.size(); ++k) {
    const Range range = range_at(data, k);
    if (!std::isfinite(range.low) || !std::isfinite(range.high)) continue;
    band.x.push_back(data.t[k]);
    band.low.push_back(range.low);
    band.high.push_back(range.high);
  }
  if (band.x.size() > 2 * page_columns) {
    const Band below = envelope({band.x, band.low}, page_columns);
    band = {below.x, below.low, envelope({band.x, band.high}, page_columns).high};
  }
  how.ink = Ink::band;
  how.curve = {band.x, band.low};
  how.value = band.high;
  panel.series.push_back(how);
  if (data.t.size() > most_separate_dots) return;
  how.ink = Ink::dots;
  how.name.clear();
  how.value.clear();
  how.curve = finite_points(data.t, relative_energy_error(data));
  panel.series.push_back(how);
}

/// Draws the sizes; if there are many samples, the largest in each column of the page.
Series sizes(const std::vector<double>& t, const std::vector<double>& error, Series how) {
  constexpr std::size_t page_columns = 400;
  how.ink = Ink::line;
  Curve all;
  for (std::size_t k = 0; k < std::min(t.size(), error.size()); ++k) {
    if (error[k] != 0) all.add(t[k], std::abs(error[k]));
  }
  how.curve = finite_points(all.x, all.y, Gaps::kept);
  if (how.curve.x.size() > 4 * page_columns) {
    const Band band = envelope(how.curve, page_columns);
    how.curve = {band.x, band.high};
  }
  return how;
}

std::string label_of(const Figure& figure, bool logarithmic) {
  const FigureData& first = figure.runs.front();
  for (const FigureData& run : figure.runs) {
    if (scale_name(run) == scale_name(first)) continue;
    return logarithmic ? "|relative energy error|" : "relative energy error";
  }
  if (!logarithmic) return energy_error_label(first);
  const std::string divisor = scale_name(first);
  return "|" + energy_name + " − " + energy_start + (first.has_time ? energy_of_time : "") + "|" +
         (divisor.empty() ? "" : "/" + divisor);
}

/// A zero crossing of the error must not determine the axis. Therefore a line may leave the box below a tenth of the 5
/// % quantile of the sizes.
void fit_logarithmic(Panel& panel) {
  Extent range;
  for (const Series& series : panel.series) {
    std::vector<double> sorted = series.curve.y;
    std::erase_if(sorted, [](double x) { return !(x > 0) || !std::isfinite(x); });
    if (sorted.empty()) continue;
    std::sort(sorted.begin(), sorted.end());
    range.include(std::max(sorted.front(), 0.1 * sorted[sorted.size() / 20]));
    range.include(sorted.back());
  }
  panel.y = log_axis(range);
}

void fit_linear(Panel& panel, const Figure& figure, bool in_double) {
  Extent range;
  for (const FigureData& run : figure.runs) {
    range.include(relative_energy_error(run));
    if (!has_range(run)) continue;
    for (const auto* list : {&run.least_difference, &run.largest_difference}) {
      for (const double difference : *list) range.include(difference / scale_of(run));
    }
  }
  range.include(0);
  constexpr double rounding = 1e-15;
  const bool at_rounding = in_double && range.largest() < rounding;
  if (at_rounding) {  // single roundings must not look like a signal
    range.include(-rounding);
    range.include(rounding);
  }
  panel.y = fit_axis(range, at_rounding ? 0 : padding, {6});
  panel.series.insert(panel.series.begin(), {Ink::zero, "", {{panel.x.low, panel.x.high}, {0, 0}}});
  for (double& x : panel.series.front().curve.x) x *= std::pow(10.0, panel.x.exponent);
}

Page page(const Figure& figure) {
  std::vector<std::vector<double>> errors;
  Extent times;
  bool in_double = true;
  for (const FigureData& run : figure.runs) {
    errors.push_back(sizes_of(run));
    times.include(run.t);
    in_double = in_double && run.energy_difference.empty();
  }
  const bool logarithmic = is_logarithmic(errors);
  Panel panel = panel_over(times, time_label(figure));
  for (std::size_t run = 0; run < figure.runs.size(); ++run) {
    Series how = series_of(figure, run);
    if (!how.name.empty() && largest(errors[run]) == 0) how.name += " (0)";
    if (logarithmic) {
      panel.series.push_back(sizes(figure.runs[run].t, errors[run], how));
    } else if (has_range(figure.runs[run])) {
      add_range(panel, figure.runs[run], how);
    } else {
      add_over_time(panel, figure.runs[run].t, relative_energy_error(figure.runs[run]), how);
    }
  }
  panel.y_label = label_of(figure, logarithmic);
  if (logarithmic) {
    fit_logarithmic(panel);
    panel.aspect = 0.62;
  } else {
    fit_linear(panel, figure, in_double);
  }
  Page all{figure.runs.front().title, {panel}};
  if (std::any_of(figure.runs.begin(), figure.runs.end(), has_range)) {
    all.notes.emplace_back(logarithmic ? "largest error of all steps, not only of the samples"
                                       : "band: smallest to largest error of all steps, not only of the samples");
  }
  return all;
}
}  // namespace energy_error

extern const FigureKind energy_error_figure{
    "energy-error",
    "the relative error of the energy over time, (H - H0)/max(|H0|, |T0| + |V0|)",
    4,
    without_energies,
    energy_error::obstacle,
    any_runs,
    no_columns,
    energy_error::page};

}  // namespace hamflow::figures
