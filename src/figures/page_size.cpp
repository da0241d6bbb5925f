#include "page_size.hpp"

#include <fmt/format.h>

#include <cmath>

#include "hamflow/core/error.hpp"
#include "hamflow/core/number.hpp"
#include "terminal.hpp"

namespace hamflow {

std::string read_page_size(const std::string& text, figures::PageOptions& page) {
  const std::string wrong = "found '" + text +
                            "'; allowed WIDTHxHEIGHT in centimetres, such as 8.5x6, or with a unit, 85x60mm, "
                            "3.35x2.4in; each side from 2 cm to 100 cm";
  double unit = 10;
  std::string numbers = text;
  for (const auto& [name, mm] : {std::pair{"cm", 10.0}, {"mm", 1.0}, {"in", 25.4}}) {
    if (!text.ends_with(name)) continue;
    unit = mm;
    numbers = text.substr(0, text.size() - 2);
  }
  const std::size_t cross = numbers.find('x');
  if (cross == std::string::npos) return wrong;
  try {
    page.width = unit * evaluate_number<double>(numbers.substr(0, cross));
    page.height = unit * evaluate_number<double>(numbers.substr(cross + 1));
  } catch (const Error&) {
    return wrong;
  }
  const auto fits = [](double mm) { return mm >= 20 && mm <= 1000; };  // false for NaN
  return fits(page.width) && fits(page.height) ? "" : wrong;
}

std::string refused_dpi(int dpi, const std::filesystem::path& file, const figures::PageOptions& page) {
  constexpr double most_pixels = 1e8;
  if (dpi == 0) return "";
  if (!refused_figure_file(file).empty() || figures::format_of(file) != figures::Format::png) {
    return fmt::format("found {} dots per inch for '{}'; allowed with a file .png, the others have no pixels", dpi,
                       file.string());
  }
  const double pixels = std::pow(dpi / 25.4, 2) * std::max(page.width, figures::two_columns) *
                        std::max(page.height, figures::two_columns);
  if (pixels <= most_pixels) return "";
  return fmt::format("found {} dots per inch, {:.0g} pixels; allowed up to {:.0g} pixels", dpi, pixels, most_pixels);
}

}  // namespace hamflow
