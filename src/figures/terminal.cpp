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

/// SVG counts pixels, 96 to the inch.
double font_size(Format format, double points) { return format == Format::svg ? points * 4 / 3 : points; }
}  // namespace

Format format_of(const std::filesystem::path& file) {
  const std::string wrong = refused_figure_file(file);
  if (!wrong.empty()) throw Error(wrong);
  return *known_format(file);
}

std::string terminal(Format format, double width, double height, double text_points) {
  const auto pixels = [](double mm, int scale) { return static_cast<int>(std::lround(mm * 96 / 25.4 * scale)); };
  const double size = font_size(format, text_points);
  switch (format) {
    case Format::svg:
      return fmt::format(
          "set terminal svg size {},{} fixed enhanced font 'DejaVu Sans,{:.4g}' linewidth 1.3333 background 'white'\n",
          pixels(width, 1), pixels(height, 1), size);
    case Format::pdf:
      return fmt::format(
          "set terminal pdfcairo size {:.4f}cm,{:.4f}cm enhanced font 'DejaVu Sans,{}' fontscale 0.75 linewidth 2\n",
          width / 10, height / 10, size);
    case Format::png:
      break;
  }
  return fmt::format(
      "set terminal pngcairo size {},{} enhanced font 'DejaVu Sans,{}' fontscale 2 linewidth 2.6667 pointscale 2.6\n",
      pixels(width, 2), pixels(height, 2), size);
}

std::string font(Format format, double points) { return fmt::format("font ',{:.4g}'", font_size(format, points)); }

}  // namespace hamflow::figures

namespace hamflow {

std::string refused_figure_file(const std::filesystem::path& file) {
  if (figures::known_format(file)) return {};
  return fmt::format("found '{}'; allowed a file .svg, .pdf or .png", file.string());
}

}  // namespace hamflow
