#include "figure.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "gnuplot.hpp"
#include "hamflow/core/error.hpp"
#include "pages.hpp"

namespace hamflow {

namespace {
using figures::Format;
using figures::Page;

struct Kind {
  const char* name;
  Page (*page)(const FigureData&);
  std::string (*obstacle)(const FigureData&);  // empty if there is none
};

std::string count(std::size_t n) { return n == 1 ? "1 degree of freedom" : fmt::format("{} degrees of freedom", n); }

bool both_finite(const std::vector<double>& x, const std::vector<double>& y) {
  return !figures::finite_points(x, y).x.empty();
}

std::string no_samples(const char* of) { return fmt::format("there is no sample with a finite {}", of); }

/// Lists that belong together have to be equally long.
std::string inconsistency(const FigureData& data) {
  if (data.space == 0 && data.coordinates.size() != data.q.size()) {
    return fmt::format("there are {} names of coordinates for {}", data.coordinates.size(), count(data.q.size()));
  }
  const auto differs = [&](const std::vector<double>& x) { return x.size() != data.t.size(); };
  if (std::any_of(data.q.begin(), data.q.end(), differs)) return "q and t have different numbers of samples";
  if (std::any_of(data.p.begin(), data.p.end(), differs)) return "p and t have different numbers of samples";
  if (!data.energy.empty() && differs(data.energy)) return "energy and t have different numbers of samples";
  if (data.curve_x.size() != data.curve_y.size()) return "the exact curve has more numbers on one axis than the other";
  return "";
}

std::string orbit_obstacle(const FigureData& data) {
  if (data.space >= 2) return both_finite(data.q[0], data.q[1]) ? "" : no_samples("position");
  if (data.q.size() != 2)
    return fmt::format("an orbit needs 2 degrees of freedom, and these data have {}", data.q.size());
  return figures::orbit_track(data).x.empty() ? no_samples("position") : "";
}

std::string energy_obstacle(const FigureData& data) {
  return both_finite(data.t, data.energy) ? "" : no_samples("energy");
}

std::string energy_error_obstacle(const FigureData& data) {
  if (!both_finite(data.t, data.energy)) return no_samples("energy");
  return std::isfinite(data.energy.front()) ? "" : "the energy of the first sample, to compare with, is not finite";
}

std::string phase_obstacle(const FigureData& data) {
  if (data.q.empty() || data.p.size() != data.q.size()) return "a phase plane needs a momentum for every coordinate";
  if (data.q.size() > figures::most_planes) {
    return fmt::format("phase planes are drawn for at most {} degrees of freedom, and these data have {}",
                       figures::most_planes, data.q.size());
  }
  for (std::size_t i = 0; i < data.q.size(); ++i) {
    if (!both_finite(data.q[i], data.p[i])) return no_samples("position and momentum");
  }
  return "";
}

std::string condition_obstacle(const FigureData& data) {
  if (data.diagnostics.empty()) {
    return "the run has no diagnostics; they are recorded with method.diagnostics = true of an implicit method";
  }
  for (const auto& column : data.diagnostics) {
    if (both_finite(data.t, column.second)) return "";
  }
  return no_samples("condition");
}

std::string section_obstacle(const FigureData& data) {
  if (data.q.size() < 2) return "a section is a plane of points with 2 degrees of freedom or more";
  if (data.section_coordinate.empty()) return "the run has no section; one is recorded with run.section";
  return both_finite(data.section_q, data.section_p) ? "" : "the section has no points";
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> list{{"orbit", figures::orbit_page, orbit_obstacle},
                                      {"energy", figures::energy_page, energy_obstacle},
                                      {"energy-error", figures::energy_error_page, energy_error_obstacle},
                                      {"phase", figures::phase_page, phase_obstacle},
                                      {"condition", figures::condition_page, condition_obstacle},
                                      {"section", figures::section_page, section_obstacle}};
  return list;
}

const Kind* find_kind(const std::string& name) {
  const auto found = std::find_if(kinds().begin(), kinds().end(), [&](const Kind& kind) { return kind.name == name; });
  return found == kinds().end() ? nullptr : &*found;
}

std::string obstacle(const FigureData& data, const Kind& kind) {
  const std::string wrong = inconsistency(data);
  return wrong.empty() ? kind.obstacle(data) : wrong;
}

Format format_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".svg") return Format::svg;
  if (extension == ".pdf") return Format::pdf;
  if (extension == ".png") return Format::png;
  throw Error(fmt::format("{}: a figure is written as .svg, .pdf or .png, found {}", file.string(),
                          extension.empty() ? "no extension" : "\"" + extension + "\""));
}
}  // namespace

std::vector<std::string> figure_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kinds()) names.emplace_back(kind.name);
  return names;
}

std::string why_not(const FigureData& data, const std::string& kind) {
  const Kind* wanted = find_kind(kind);
  if (!wanted) return fmt::format("there is no figure \"{}\"; allowed: {}", kind, fmt::join(figure_kinds(), ", "));
  const std::string reason = obstacle(data, *wanted);
  if (reason.empty()) return "";
  std::vector<std::string> possible;
  for (const Kind& other : kinds()) {
    if (obstacle(data, other).empty()) possible.emplace_back(other.name);
  }
  if (possible.empty()) return fmt::format("{}: {}; no other figure can be drawn from them either", kind, reason);
  return fmt::format("{}: {}; what can be drawn: {}", kind, reason, fmt::join(possible, ", "));
}

void write_figure(const FigureData& data, const std::string& kind, const std::filesystem::path& file) {
  const Kind* wanted = find_kind(kind);
  const std::string reason = why_not(data, kind);
  if (!wanted) throw Error(reason);
  const Format format = format_of(file);
  if (!reason.empty()) throw Error(reason);
  if (format != Format::svg) figures::require_font();
  const std::string script = figures::gnuplot_script(wanted->page(data), format);
  figures::write_whole(file, figures::finished(figures::run_gnuplot(script), format, data.title));
}

}  // namespace hamflow
