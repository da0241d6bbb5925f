#include "figure_text.hpp"

#include <fmt/format.h>

#include "curves.hpp"

namespace hamflow::reproduction {

namespace {
const char* kind_of_mark(figures::Ink ink) {
  using figures::Ink;
  switch (ink) {
    case Ink::exact:
    case Ink::line:
    case Ink::path:
    case Ink::zero:
      return "a line";
    case Ink::level:
      return "a dashed line";
    case Ink::marked:
      return "a line through marks";
    case Ink::band:
      return "a band";
    case Ink::fields:
      return "coloured fields";
    default:
      return "dots";
  }
}

std::string range_of(const char* name, const figures::Axis& axis) {
  const auto number = [&](double x) {
    return axis.logarithmic ? fmt::format("10^{:.3g}", x) : fmt::format("{:.3g}", x);
  };
  const std::string unit = axis.exponent == 0 ? "" : fmt::format(", in 10^{}", axis.exponent);
  return fmt::format("{} from {} to {}{}", name, number(axis.low), number(axis.high), unit);
}
}  // namespace

std::string plain_text(const std::string& enhanced) {
  std::string text;
  for (std::size_t i = 0; i < enhanced.size(); ++i) {
    const char c = enhanced[i];
    if (c == '{') {
      if (enhanced[i + 1] == '/') {  // a font, up to the blank behind its name
        i = std::min(enhanced.find(' ', i), enhanced.size());
      }
    } else if (c != '}' && c != '_') {
      text += c;
    }
  }
  return text;
}

std::string in_words(const figures::Page& page) {
  std::string text = page.panels.size() > 1 ? fmt::format("{} panels.", page.panels.size()) : "";
  int number = 0;
  for (const figures::Panel& panel : page.panels) {
    ++number;
    text += (text.empty() ? "" : " ") + (page.panels.size() > 1 ? fmt::format("{}: ", number) : std::string());
    const std::string up = plain_text(panel.y_label), across = plain_text(panel.x_label);
    text += (up.empty() ? "a curve" : up) + (across.empty() ? "" : " over " + across);
    text += ", " + range_of("x", panel.x) + ", " + range_of("y", panel.y);
    std::string drawn;
    for (const figures::Series& series : panel.series) {
      if (series.name.empty() && panel.series.size() > 1) continue;
      drawn += (drawn.empty() ? "; " : ", ") + (series.name.empty() ? "drawn as " : plain_text(series.name) + ": ") +
               kind_of_mark(series.ink);
    }
    text += drawn + ".";
  }
  return text;
}

}  // namespace hamflow::reproduction
