#include "parameter_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "gnuplot.hpp"
#include "hamflow/core/error.hpp"
#include "text.hpp"
#include "work_precision.hpp"

namespace hamflow {

namespace {
using namespace figures;

struct Range {
  double least = INFINITY;
  double most = -INFINITY;
  void include(double x) {
    if (!std::isfinite(x)) return;
    least = std::min(least, x);
    most = std::max(most, x);
  }
};

Range range_of(const std::vector<double>& values) {
  Range range;
  for (const double x : values) range.include(x);
  return range;
}

std::string terminal(Format format) {
  switch (format) {
    case Format::svg:
      return "set terminal svg size 900,720 enhanced font 'DejaVu Sans,14' background rgb 'white'\n";
    case Format::pdf:
      return "set terminal pdfcairo size 18cm,14.4cm enhanced font 'DejaVu Sans,11'\n";
    case Format::png:
      break;
  }
  return "set terminal pngcairo size 1200,960 enhanced font 'DejaVu Sans,16' background rgb 'white'\n";
}

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.9g}", x) : "NaN"; }

std::string script_of(const ParameterMap& map, Format format) {
  const Range values = range_of(map.value);
  const bool logarithmic = values.least > 0 && values.most > 100 * values.least;
  std::string text = terminal(format);
  const auto line = [&]<class... Ts>(fmt::format_string<Ts...> pattern, Ts&&... parts) {
    fmt::format_to(std::back_inserter(text), pattern, std::forward<Ts>(parts)...);
    text += '\n';
  };
  line("set title {}", quoted(escaped(map.title)));
  line("set xlabel {}\nset tics out nomirror\nunset key", quoted(escaped(map.x_name)));
  text += "$data << EOD\n";
  for (std::size_t i = 0; i < map.x.size(); ++i) {
    if (map.y_name.empty()) {
      line("{} {}", number(map.x[i]), number(map.value[i]));
    } else {
      line("{} {} {}", number(map.x[i]), number(map.y[i]), number(map.value[i]));
    }
  }
  text += "EOD\n";
  if (map.y_name.empty()) {
    line("set ylabel {}", quoted(escaped(map.value_name)));
    if (logarithmic) line("set logscale y");
    line("plot $data using 1:2 with linespoints linecolor rgb '#0072b2' pointtype 7 pointsize 0.3");
    return text;
  }
  const Range x = range_of(map.x);
  const Range y = range_of(map.y);
  line("set ylabel {}\nset cblabel {}", quoted(escaped(map.y_name)), quoted(escaped(map.value_name)));
  if (logarithmic) line("set logscale cb");
  // Light is little: from pale yellow to dark blue, readable in grey too.
  line("set palette defined (0 '#ffffd9', 0.3 '#7fcdbb', 0.6 '#1d91c0', 1 '#081d58')");
  line("set xrange [{}:{}]\nset yrange [{}:{}]", number(x.least), number(x.most), number(y.least), number(y.most));
  line("plot $data using 1:2:3 with image pixels");
  return text;
}
}  // namespace

void write_parameter_map(const ParameterMap& data, const std::filesystem::path& file) {
  const std::string refused = refused_figure_file(file);
  if (!refused.empty()) throw Error(refused);
  const Range values = range_of(data.value);
  if (!(values.least <= values.most))
    throw Error("there is nothing to draw: " + data.value_name + " has no finite value");
  const std::string extension = file.extension().string();
  const Format format = extension == ".pdf" ? Format::pdf : extension == ".png" ? Format::png : Format::svg;
  if (format != Format::svg) require_font();
  write_whole(file, finished(run_gnuplot(script_of(data, format)), format, data.title));
}

}  // namespace hamflow
