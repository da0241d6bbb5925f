#include "figure_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "hamflow/figures/axis.hpp"

namespace hamflow::reproduction {

namespace {
/// Removes the marks of gnuplot's enhanced text: "{/:Italic p}_1" becomes "p1".
std::string plain_text(const std::string& enhanced) {
  std::string text;
  for (std::size_t i = 0; i < enhanced.size(); ++i) {
    const char c = enhanced[i];
    if (c == '{') {
      if (enhanced[i + 1] == '/') {  // the name of a font, which ends with a blank
        i = std::min(enhanced.find(' ', i), enhanced.size());
      }
    } else if (c != '}' && c != '_') {
      text += c;
    }
  }
  return text;
}

using namespace figures;

constexpr std::size_t most_described_curves = 6;  // a listener cannot tell more curves of one panel apart

/// Whether two values look equal in the figure: they differ by less than a hundredth of the axis.
bool is_near(double a, double b, const Axis& axis) {
  return std::abs(axis.place(a) - axis.place(b)) < 0.01 * (axis.high - axis.low);
}

/// Writes a value with as many digits as a 300th of the axis resolves; on a logarithmic axis with three digits.
std::string told(double x, const Axis& axis) {
  if (!axis.logarithmic && is_near(x, 0, axis)) return "0";
  const double resolved = axis.logarithmic ? 0 : std::abs(axis.high - axis.low) * std::pow(10.0, axis.exponent) / 300;
  const int digits = resolved > 0 ? static_cast<int>(std::ceil(std::log10(std::abs(x) / resolved))) : 3;
  // Rounding before the last format gives "1000" instead of "1e+03".
  return fmt::format("{:.10g}", std::stod(fmt::format("{:.{}g}", x, std::clamp(digits, 1, 10))));
}

/// Whether the verb is plural: "turning points reach", but "a curve reaches".
bool is_plural(const std::string& name) { return name.size() > 2 && name.back() == 's'; }

std::string told(const Curve& curve, const Panel& panel, const std::string& who) {
  Extent x, y;
  x.include(curve.x);
  y.include(curve.y);
  if (x.empty() || y.empty()) return {};
  const double x0 = curve.x.front(), y0 = curve.y.front(), x1 = curve.x.back(), y1 = curve.y.back();
  const bool many = is_plural(who);
  std::string text =
      who + (is_near(y.low, y.high, panel.y) ? (many ? " stay at y = " : " stays at y = ") + told(y.low, panel.y)
                                             : fmt::format(" {} from {} to {} in y", many ? "reach" : "reaches",
                                                           told(y.low, panel.y), told(y.high, panel.y)));
  if (!std::isfinite(x0 + y0 + x1 + y1)) return text;
  if (is_near(x0, x1, panel.x) && is_near(y0, y1, panel.y)) {
    if (is_near(x.low, x.high, panel.x)) return text;
    return text + (many ? " and end where they begin" : " and ends where it begins");
  }
  return text + fmt::format(", from ({}, {}) to ({}, {})", told(x0, panel.x), told(y0, panel.y), told(x1, panel.x),
                            told(y1, panel.y));
}

bool is_told(const Series& series) {
  return series.ink != Ink::fields && series.ink != Ink::level && series.ink != Ink::zero && series.curve.x.size() > 1;
}

const char* kind_of(const Series& series) {
  constexpr int ring = 6;
  switch (series.ink) {
    case Ink::exact:
    case Ink::line:
    case Ink::path:
    case Ink::zero:
      return series.mark.dash == 1 ? "a line" : "a dashed line";
    case Ink::level:
      return "a dashed line";
    case Ink::marked:
      return "a line through marks";
    case Ink::band:
      return "a band";
    case Ink::fields:
      return "coloured fields";
    case Ink::marks:
      return series.mark.shape == ring ? "rings" : "dots";
    default:
      return "dots";
  }
}

/// Describes the range of an axis. Logarithmic axes store logarithms; the text shows the values.
std::string described_range(const char* name, const Axis& axis) {
  const auto number = [&](double x) { return fmt::format("{:.3g}", axis.logarithmic ? std::pow(10.0, x) : x); };
  const std::string unit = axis.exponent == 0 ? "" : fmt::format(", in 10^{}", axis.exponent);
  return fmt::format("{} from {} to {}{}{}", name, number(axis.low), number(axis.high), unit,
                     axis.logarithmic ? ", logarithmic" : "");
}

/// Names V' "effective potential V'", because a listener easily misses the prime.
std::string label_of(const std::string& enhanced) {
  std::string label = plain_text(enhanced);
  if (const std::size_t prime = label.find("V'"); prime != label.npos) label.insert(prime, "effective potential ");
  return label;
}

/// Capitalises the first word and adds a full stop. Names of methods and symbols of formulas keep their case.
std::string as_sentence(std::string text) {
  std::size_t letters = 0;
  while (letters < text.size() && text[letters] >= 'a' && text[letters] <= 'z') ++letters;
  if (letters > 2 && text[letters] == ' ') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text + ".";
}
}  // namespace

std::string describe_curves(const Page& page) {
  std::string text;
  int number = 0;
  for (const Panel& panel : page.panels) {
    ++number;
    const std::string where = page.panels.size() > 1 ? fmt::format("In {} ", number) : std::string();
    const auto unnamed = std::count_if(panel.series.begin(), panel.series.end(),
                                       [](const Series& one) { return is_told(one) && one.name.empty(); });
    std::size_t count = 0;
    int nameless = 0;
    for (const Series& series : panel.series) {
      if (!is_told(series) || ++count > most_described_curves) continue;
      const std::string who = !series.name.empty() ? plain_text(series.name)
                              : unnamed > 1        ? fmt::format("curve {}", ++nameless)
                                                   : "the curve";
      const std::string what = told(series.curve, panel, who);
      if (!what.empty()) text += (text.empty() ? "" : " ") + as_sentence(where + what);
    }
  }
  return text;
}

std::string words_of(const Page& page) {
  std::string text = page.panels.size() > 1 ? fmt::format("{} panels.", page.panels.size()) : "";
  int number = 0;
  for (const Panel& panel : page.panels) {
    ++number;
    text += (text.empty() ? "" : " ") + (page.panels.size() > 1 ? fmt::format("{}: ", number) : std::string());
    const std::string up = label_of(panel.y_label), across = label_of(panel.x_label);
    text += (up.empty() ? "a curve" : up) + (across.empty() ? "" : " over " + across);
    text += ", " + described_range("x", panel.x) + ", " + described_range("y", panel.y);
    std::string drawn;
    for (const Series& series : panel.series) {
      if (series.name.empty() && panel.series.size() > 1) continue;
      drawn += (drawn.empty() ? "; " : ", ") + (series.name.empty() ? "drawn as " : plain_text(series.name) + ": ") +
               kind_of(series);
    }
    text += drawn + ".";
  }
  const std::string seen = describe_curves(page);
  return text + (seen.empty() ? "" : " " + seen);
}

}  // namespace hamflow::reproduction
