#include "terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "hamflow/core/error.hpp"

namespace hamflow::figures {

namespace {
std::optional<Format> known_format(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".svg") return Format::svg;
  if (extension == ".pdf") return Format::pdf;
  if (extension == ".png") return Format::png;
  return std::nullopt;
}

/// SVG counts in pixels, 96 per inch.
double font_size(Format format, double points) { return format == Format::svg ? points * 4 / 3 : points; }
}  // namespace

Format format_of(const std::filesystem::path& file) {
  const std::string wrong = refused_figure_file(file);
  if (!wrong.empty()) throw Error(wrong);
  return *known_format(file);
}

std::string terminal(Format format, double width, double height, double text_points, int dpi) {
  const auto pixels = [](double mm, double per_inch) { return std::lround(mm * per_inch / 25.4); };
  const double size = font_size(format, text_points);
  switch (format) {
    case Format::svg:
      return fmt::format(
          "set terminal svg size {},{} fixed enhanced font 'DejaVu Sans,{:.4g}' linewidth 1.3333 background 'white'\n",
          pixels(width, 96), pixels(height, 96), size);
    case Format::pdf:
      return fmt::format(
          "set terminal pdfcairo size {:.4f}cm,{:.4f}cm enhanced font 'DejaVu Sans,{}' fontscale 0.75 linewidth 2\n",
          width / 10, height / 10, size);
    case Format::png:
      break;
  }
  const double scale = dpi / 96.0;
  return fmt::format(
      "set terminal pngcairo size {},{} enhanced font 'DejaVu Sans,{}' fontscale {:.6g} linewidth {:.6g} "
      "pointscale {:.6g}\n",
      pixels(width, dpi), pixels(height, dpi), size, scale, 1.3333 * scale, 1.3 * scale);
}

std::string font(Format format, double points) { return fmt::format("font ',{:.4g}'", font_size(format, points)); }

}  // namespace hamflow::figures

namespace hamflow {

std::string refused_figure_file(const std::filesystem::path& file) {
  if (figures::known_format(file)) return {};
  return fmt::format("found '{}'; allowed a file .svg, .pdf or .png", file.string());
}

}  // namespace hamflow
