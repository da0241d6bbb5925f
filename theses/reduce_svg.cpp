#include "reduce_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

namespace hamflow::reproduction {

namespace svg_reduction {

constexpr double unseen = 0.05;  // a figure is some 300 units wide: a tenth of a pixel if it fills the page

constexpr double across = 2.25;  // the diameter of gnuplot's disc: radius 1, and a stroke of width 0.25

struct Point {
  double x, y;
};

/// The distance of a point from the segment from a to b.
double distance(Point z, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const double part = square > 0 ? std::clamp(((z.x - a.x) * dx + (z.y - a.y) * dy) / square, 0.0, 1.0) : 0.0;
  return std::hypot(z.x - a.x - part * dx, z.y - a.y - part * dy);
}

/// Simplifies a line to the points that it needs.   [DouglasPeucker1973]
std::vector<Point> needed(const std::vector<Point>& line) {
  std::vector<bool> stays(line.size(), false);
  stays.front() = stays.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    std::size_t farthest = first;
    double most = unseen;
    for (std::size_t k = first + 1; k < last; ++k) {
      const double d = distance(line[k], line[first], line[last]);
      if (d > most) most = d, farthest = k;
    }
    if (farthest == first) continue;
    stays[farthest] = true;
    open.emplace_back(first, farthest);
    open.emplace_back(farthest, last);
  }
  std::vector<Point> some;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (stays[k]) some.push_back(line[k]);
  }
  return some;
}

/// Rounds to gnuplot's unit of 1/100. Differences of these integers are exact, so that relative coordinates do not
/// accumulate rounding errors.
long hundredths(double x) { return std::lround(100 * x); }
std::string number(long of_hundredths) {
  const long whole = std::labs(of_hundredths);
  std::string text = of_hundredths < 0 ? "-" : "";
  if (whole >= 100 || whole % 100 == 0) text += std::to_string(whole / 100);
  if (whole % 100 != 0) {
    text += whole % 10 == 0 ? fmt::format(".{}", whole % 100 / 10) : fmt::format(".{:02}", whole % 100);
  }
  return text;
}
std::string pair_of(long dx, long dy) {
  const std::string second = number(dy);
  return number(dx) + (second[0] == '-' ? "" : " ") + second;
}

/// Reads a path of absolute lines, such as "M41.16,205.15 L45.16,205.15", with a flag for closed ones. Returns nullopt
/// if the path contains anything else.
std::optional<std::vector<std::pair<std::vector<Point>, bool>>> parse_lines(std::string_view d) {
  std::vector<std::pair<std::vector<Point>, bool>> lines;
  const std::string text(d);
  const char* at = text.c_str();
  while (*at != 0) {
    if (*at == ' ' || *at == '\n' || *at == '\t') {
      ++at;
      continue;
    }
    if (*at == 'Z' && !lines.empty()) {
      lines.back().second = true;
      ++at;
      continue;
    }
    if (*at != 'M' && *at != 'L') return {};
    if (*at == 'M') lines.emplace_back();
    if (lines.empty()) return {};
    char* end = nullptr;
    const double x = std::strtod(at + 1, &end);
    if (end == at + 1 || *end != ',') return {};
    at = end + 1;
    const double y = std::strtod(at, &end);
    if (end == at) return {};
    at = end;
    lines.back().first.push_back({x, y});
  }
  return lines;
}

std::string reduce_path(std::string_view d) {
  const auto lines = parse_lines(d);
  if (!lines) return std::string(d);
  std::string all;
  for (const auto& [line, closed] : *lines) {
    long x = hundredths(line[0].x), y = hundredths(line[0].y);
    all += "M" + pair_of(x, y);
    const std::vector<Point> some = needed(line);
    for (std::size_t k = 1; k < some.size(); ++k) {
      const long next_x = hundredths(some[k].x), next_y = hundredths(some[k].y);
      all += "l" + pair_of(next_x - x, next_y - y);
      x = next_x, y = next_y;
    }
    if (some.size() == 1) all += "h0";
    if (closed) all += "Z";
  }
  return all;
}

/// A disc of gnuplot, with its place, size and colour.
struct Disc {
  Point at;
  std::string scale, colour;
};

std::string_view between(std::string_view text, std::string_view before, std::string_view after) {
  const std::size_t begin = text.find(before);
  if (begin == text.npos) return {};
  const std::size_t from = begin + before.size(), end = text.find(after, from);
  return end == text.npos ? std::string_view{} : text.substr(from, end - from);
}

std::optional<Disc> disc_in(std::string_view element) {
  if (element.find("<use xlink:href='#gpPt6' transform='translate(") == element.npos) return {};
  const std::string place(between(element, "translate(", ")"));
  char* end = nullptr;
  const double x = std::strtod(place.c_str(), &end);
  if (*end != ',') return {};
  return Disc{{x, std::strtod(end + 1, nullptr)},
              std::string(between(element, "scale(", ")")),
              std::string(between(element, "color='", "'"))};
}

/// Draws discs as the round ends of lines of length 0.
std::string path_of(const std::vector<Disc>& discs) {
  std::string all = fmt::format("<path fill='none' stroke-linecap='round' stroke='{}' stroke-width='{:g}' d='",
                                discs[0].colour, across * std::strtod(discs[0].scale.c_str(), nullptr));
  std::set<std::pair<long, long>> there;
  long x = 0, y = 0;
  for (const Disc& disc : discs) {
    const long next_x = hundredths(disc.at.x), next_y = hundredths(disc.at.y);
    if (!there.emplace(next_x / 10, next_y / 10).second) continue;
    all += (there.size() == 1 ? "M" : "m") + pair_of(next_x - x, next_y - y) + "h0";
    x = next_x, y = next_y;
  }
  return all + "'/>\n";
}

/// Removes definitions of symbols that are not used.
std::string remove_unused_symbols(const std::string& svg) {
  std::string all;
  for (std::size_t at = 0; at < svg.size();) {
    const std::size_t end = std::min(svg.find('\n', at), svg.size() - 1) + 1;
    const std::string line = svg.substr(at, end - at);
    const std::string id(between(line, "id='gp", "'"));
    const bool is_symbol =
        !id.empty() && line.find("/>") != line.npos && line.find("transform='translate") == line.npos;
    if (!is_symbol || svg.find("'#gp" + id + "'") != svg.npos) all += line;
    at = end;
  }
  return all;
}

}  // namespace svg_reduction

std::string reduce_svg(const std::string& svg) {
  using namespace svg_reduction;
  std::string all;
  std::vector<Disc> discs;
  const auto put_discs = [&] {
    if (!discs.empty()) all += path_of(discs);
    discs.clear();
  };
  for (std::size_t at = 0; at < svg.size();) {
    const std::size_t end = std::min(svg.find('\n', at), svg.size() - 1) + 1;
    std::string line = svg.substr(at, end - at);
    at = end;
    const auto disc = disc_in(line);
    const bool alone = disc && line.find('<') == line.rfind('<');
    if (alone && (discs.empty() || (disc->scale == discs[0].scale && disc->colour == discs[0].colour))) {
      discs.push_back(*disc);
      continue;
    }
    put_discs();
    if (alone) {
      discs.push_back(*disc);
      continue;
    }
    // A path may extend over several lines of the file.
    const std::size_t d = line.find(" d='M");
    while (d != line.npos && line.find('\'', d + 4) == line.npos && at < svg.size()) {
      const std::size_t next = std::min(svg.find('\n', at), svg.size() - 1) + 1;
      line += svg.substr(at, next - at);
      at = next;
    }
    if (d != line.npos && line.find('\'', d + 4) != line.npos) {
      const std::size_t close = line.find('\'', d + 4);
      line.replace(d + 4, close - d - 4, reduce_path(std::string_view(line).substr(d + 4, close - d - 4)));
    }
    all += line;
  }
  put_discs();
  // Symbols refer to each other, so a removed one can make another unused.
  return remove_unused_symbols(remove_unused_symbols(remove_unused_symbols(all)));
}

}  // namespace hamflow::reproduction
