#include "figure_seen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "axis.hpp"
#include "figure_text.hpp"

namespace hamflow::reproduction {

namespace {
using namespace figures;

constexpr std::size_t most_told = 6;  // of a panel with more curves nobody keeps them apart by ear

/// As a hand on the figure would find it: a hundredth of the axis is nothing.
bool is_near(double a, double b, const Axis& axis) {
  return std::abs(axis.place(a) - axis.place(b)) < 0.01 * (axis.high - axis.low);
}

/// To what the axis resolves: three digits, fewer where these are beneath a hundredth of it.
std::string told(double x, const Axis& axis) {
  if (!axis.logarithmic && is_near(x, 0, axis)) return "0";
  const double resolved = axis.logarithmic ? 0 : std::abs(axis.high - axis.low) * std::pow(10.0, axis.exponent) / 300;
  const int digits = resolved > 0 ? static_cast<int>(std::ceil(std::log10(std::abs(x) / resolved))) : 3;
  // Rounded first: "1000", not "1e+03".
  return fmt::format("{:.10g}", std::stod(fmt::format("{:.{}g}", x, std::clamp(digits, 1, 10))));
}

std::string told(const Curve& curve, const Panel& panel) {
  Extent x, y;
  x.include(curve.x);
  y.include(curve.y);
  if (x.empty() || y.empty()) return {};
  const double x0 = curve.x.front(), y0 = curve.y.front(), x1 = curve.x.back(), y1 = curve.y.back();
  std::string text = is_near(y.low, y.high, panel.y)
                         ? "stays at y = " + told(y.low, panel.y)
                         : fmt::format("reaches from {} to {} in y", told(y.low, panel.y), told(y.high, panel.y));
  if (!std::isfinite(x0 + y0 + x1 + y1)) return text;
  if (is_near(x0, x1, panel.x) && is_near(y0, y1, panel.y)) {
    return is_near(x.low, x.high, panel.x) ? text : text + " and ends where it begins";
  }
  return text + fmt::format(", from ({}, {}) to ({}, {})", told(x0, panel.x), told(y0, panel.y), told(x1, panel.x),
                            told(y1, panel.y));
}

bool is_told(const Series& series) {
  return series.ink != Ink::fields && series.ink != Ink::level && series.ink != Ink::zero && series.curve.x.size() > 1;
}
}  // namespace

std::string seen_in(const Page& page) {
  std::string text;
  int number = 0;
  for (const Panel& panel : page.panels) {
    ++number;
    const std::string where = page.panels.size() > 1 ? fmt::format("In {} ", number) : std::string();
    std::size_t count = 0;
    for (const Series& series : panel.series) {
      if (!is_told(series) || ++count > most_told) continue;
      const std::string what = told(series.curve, panel);
      if (what.empty()) continue;
      const std::string who = series.name.empty() ? "the curve" : plain_text(series.name);
      text += (text.empty() ? "" : " ") + where + who + " " + what + ".";
    }
  }
  return text;
}

}  // namespace hamflow::reproduction
