#include "draw_style.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "text.hpp"

namespace hamflow::figures {

namespace {
constexpr std::array<const char*, 8> colours{"#1f4e8c", "#d55e00", "#009e73", "#b0489c",
                                             "#e69f00", "#56b4e9", "#6b3d1e", "#4d4d4d"};

/// Returns the colour with its opacity as gnuplot accepts it: "#aarrggbb", where ff is transparent.
std::string colour_with_opacity(const Series& series) {
  const std::string colour = colour_of(series);
  if (series.opacity >= 1) return colour;
  return fmt::format("#{:02x}{}", static_cast<int>(std::lround(255 * (1 - series.opacity))), colour.substr(1));
}

/// Returns the drawing style for a plot command. Dark dots over a lighter line also differ in brightness.
std::string drawn(const Series& series) {
  const std::string colour = colour_with_opacity(series);
  const auto line = [&](double width) {
    return fmt::format("with lines linewidth {} linecolor rgb '{}' dashtype {}", width, colour, series.mark.dash);
  };
  const auto points = [&](double size) {
    return fmt::format("with points pointtype 7 pointsize {} linewidth 0.1 linecolor rgb '{}'", size, colour);
  };
  switch (series.ink) {
    case Ink::exact:
    case Ink::line:
      return line(0.6);
    case Ink::path:
      return line(series.name.empty() ? 0.3 : 0.45);  // colours of a legend need some width
    case Ink::zero:
      return line(0.4);
    case Ink::place:
      return points(0.5);
    case Ink::dots:
      return points(0.3);
    case Ink::fine_dots:
      return points(series.curve.x.size() > 2000 ? 0.1 : 0.2);
    case Ink::centre:
      return fmt::format("with points pointtype 1 pointsize 0.6 linewidth 0.7 linecolor rgb '{}'", colour);
    case Ink::level:
      return fmt::format("with lines linewidth 0.6 linecolor rgb '{}' dashtype 2", colour);
    case Ink::marked:
      return fmt::format("with linespoints linecolor rgb '{}' dashtype {} linewidth 0.6 pointtype {} pointsize 0.4",
                         colour, series.mark.dash, series.mark.shape);
    case Ink::marks:
      return fmt::format("with points linecolor rgb '{}' linewidth 0.6 pointtype {} pointsize 0.5", colour,
                         series.mark.shape);
    case Ink::bars:
      return fmt::format("with yerrorbars linecolor rgb '{}' linewidth 0.5 pointtype {} pointsize 0.3", colour,
                         series.mark.shape);
    case Ink::band:
    case Ink::fields:
      break;
  }
  return line(0.3);
}
}  // namespace

std::string colour_of(std::size_t place) { return colours[place % colours.size()]; }

Mark mark_of(std::size_t place) {
  constexpr std::array<int, 3> dashes{1, 2, 4};
  return {.colour = colour_of(place), .dash = dashes[place / colours.size() % dashes.size()]};
}

std::string colour_of(const Series& series) {
  if (!series.mark.colour.empty()) return series.mark.colour;
  switch (series.ink) {
    case Ink::exact:
      return "#8c8c8c";
    case Ink::zero:
      return "#b0b0b0";
    case Ink::centre:
      return "#333333";
    case Ink::level:
      return "#aaaaaa";
    default:
      return colours[0];
  }
}

std::vector<std::string> data_lines(const Panel& panel, const Series& series) {
  std::vector<std::string> lines;
  const Curve& curve = series.curve;
  if (series.ink == Ink::fields) {
    for (std::size_t i = 0; i + 1 < curve.x.size(); i += 2) {
      const double z = panel.z.place(series.value[i / 2]);
      if (!std::isfinite(z)) continue;
      const double left = panel.x.place(curve.x[i]);
      const double low = panel.y.place(curve.y[i]);
      lines.push_back(fmt::format("{0:.9g} {1:.9g} {0:.9g} {2:.9g} {1:.9g} {3:.9g} {4:.6g}", left, low,
                                  panel.x.place(curve.x[i + 1]), panel.y.place(curve.y[i + 1]), z));
    }
    return lines;
  }
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double x = panel.x.place(curve.x[i]);
    const double y = panel.y.place(curve.y[i]);
    const double upper = series.ink == Ink::band ? panel.y.place(series.value[i]) : 0;
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(upper)) {
      lines.emplace_back();
    } else if (series.ink == Ink::bars) {
      lines.push_back(fmt::format("{:.12g} {:.12g} {:.12g} {:.12g}", x, y, panel.y.place(curve.y[i] - series.value[i]),
                                  panel.y.place(curve.y[i] + series.value[i])));
    } else if (series.ink == Ink::band) {
      lines.push_back(fmt::format("{:.12g} {:.12g} {:.12g}", x, y, upper));
    } else {
      lines.push_back(fmt::format("{:.12g} {:.12g}", x, y));
    }
  }
  return lines;
}

std::vector<std::string> styles(const Series& series) {
  const std::string name = series.name.empty() ? " notitle" : " title " + quoted(series.name);
  const std::string colour = colour_of(series);
  if (series.ink == Ink::fields) {
    return {"1:2:3:4:5:6:7 with boxxyerror fillcolor palette fillstyle solid 1 noborder" + name};
  }
  if (series.ink == Ink::band) {  // the edges keep an area without height visible
    const std::string edge = "with lines linewidth 0.4 linecolor rgb '" + colour + "'";
    return {"1:2:3 with filledcurves fillstyle solid 1 noborder fillcolor rgb '#a0" + colour.substr(1) + "' notitle",
            "1:2 " + edge + " notitle", "1:3 " + edge + name};
  }
  if (!series.name.empty() && (series.ink == Ink::fine_dots || series.ink == Ink::path || series.ink == Ink::place)) {
    // A legend cannot show the colour of such a fine line or dot, so it is drawn larger there.
    const std::string larger = series.ink == Ink::path
                                   ? "lines linewidth 1 dashtype " + std::to_string(series.mark.dash)
                                   : std::string("points pointtype 7 pointsize 0.5");
    return {"1:2 " + drawn(series) + " notitle, NaN with " + larger + " linecolor rgb '" + colour + "'" + name};
  }
  return {(series.ink == Ink::bars ? "1:2:3:4 " : "1:2 ") + drawn(series) + name};
}

}  // namespace hamflow::figures
