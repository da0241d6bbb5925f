#include "pair_distribution.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hamflow/figures/axis.hpp"

namespace hamflow::figures {

namespace {

using std::numbers::pi;
using Point = std::array<double, 3>;

/// Sorts particles into cells at least r_max wide. All particles within r_max of one are in its cell or a neighbouring
/// cell.
struct Cells {
  std::array<std::size_t, 3> count{1, 1, 1};
  std::vector<std::size_t> first;  // index in `points` of the first particle of each cell; one more entry at the end
  std::vector<Point> points;
  bool periodic;

  Cells(const std::vector<double>& q, std::size_t space, const std::vector<double>& edges, double r_max)
      : periodic(!edges.empty()) {
    const std::size_t particles = q.size() / space;
    std::array<Extent, 3> ends;
    points.assign(particles, Point{0, 0, 0});
    for (std::size_t i = 0; i < q.size(); ++i) {
      double x = q[i];
      if (periodic) x -= edges[i % space] * std::floor(x / edges[i % space]);
      points[i / space][i % space] = x;
      ends[i % space].include(x);
    }
    Point low{0, 0, 0};
    Point size{1, 1, 1};
    // With more cells than particles, most would be empty.
    const auto most = static_cast<double>(std::max<std::size_t>(
        1, static_cast<std::size_t>(std::pow(static_cast<double>(particles), 1.0 / static_cast<double>(space)))));
    for (std::size_t k = 0; k < space; ++k) {
      low[k] = periodic ? 0 : ends[k].low;
      size[k] = periodic ? edges[k] : ends[k].high - ends[k].low;
      count[k] = static_cast<std::size_t>(std::clamp(std::floor(size[k] / r_max), 1.0, most));
    }
    std::vector<std::size_t> cell_of(particles);
    first.assign(count[0] * count[1] * count[2] + 1, 0);
    for (std::size_t i = 0; i < particles; ++i) {
      std::size_t cell = 0;
      for (std::size_t k = 3; k-- > 0;) {
        const double share = size[k] > 0 ? (points[i][k] - low[k]) / size[k] : 0;
        const auto at = static_cast<std::size_t>(std::max(0.0, share * static_cast<double>(count[k])));
        cell = cell * count[k] + std::min(at, count[k] - 1);
      }
      cell_of[i] = cell;
      ++first[cell + 1];
    }
    for (std::size_t c = 1; c < first.size(); ++c) first[c] += first[c - 1];
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    std::vector<Point> sorted(particles);
    for (std::size_t i = 0; i < particles; ++i) sorted[next[cell_of[i]]++] = points[i];
    points = std::move(sorted);
  }

  /// Returns a cell and its neighbours in one direction, each once.
  std::vector<std::size_t> around(std::size_t at, std::size_t k) const {
    std::vector<std::size_t> all;
    for (int d = -1; d <= 1; ++d) {
      const auto there = static_cast<std::ptrdiff_t>(at) + d;
      const auto n = static_cast<std::ptrdiff_t>(count[k]);
      if (!periodic && (there < 0 || there >= n)) continue;
      const auto cell = static_cast<std::size_t>((there + n) % n);
      if (std::find(all.begin(), all.end(), cell) == all.end()) all.push_back(cell);
    }
    return all;
  }
};

double ball(double r, std::size_t space) { return space == 2 ? pi * r * r : 4 * pi / 3 * r * r * r; }

}  // namespace

std::vector<std::int64_t> pair_counts(const std::vector<double>& q, std::size_t space, const std::vector<double>& edges,
                                      double r_max, std::size_t bins) {
  std::vector<std::int64_t> found(bins, 0);
  const Cells cells(q, space, edges, r_max);
  const double most = r_max * r_max;
  const double per_length = static_cast<double>(bins) / r_max;
  Point whole{0, 0, 0};
  Point half{0, 0, 0};
  for (std::size_t k = 0; k < edges.size(); ++k) whole[k] = edges[k], half[k] = edges[k] / 2;
  const auto count_pairs = [&](std::size_t a, std::size_t b) {
    for (std::size_t i = cells.first[a]; i < cells.first[a + 1]; ++i) {
      const Point& p = cells.points[i];
      for (std::size_t j = a == b ? i + 1 : cells.first[b]; j < cells.first[b + 1]; ++j) {
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          double d = std::abs(p[k] - cells.points[j][k]);
          if (d > half[k]) d = std::abs(d - whole[k]);  // without a periodic box both are 0
          square += d * d;
        }
        if (!(square < most)) continue;
        ++found[std::min(static_cast<std::size_t>(std::sqrt(square) * per_length), bins - 1)];
      }
    }
  };
  for (std::size_t z = 0; z < cells.count[2]; ++z) {
    for (std::size_t y = 0; y < cells.count[1]; ++y) {
      for (std::size_t x = 0; x < cells.count[0]; ++x) {
        const auto number = [&](std::size_t i, std::size_t j, std::size_t k) {
          return (k * cells.count[1] + j) * cells.count[0] + i;
        };
        const std::size_t here = number(x, y, z);
        for (const std::size_t k : cells.around(z, 2)) {
          for (const std::size_t j : cells.around(y, 1)) {
            for (const std::size_t i : cells.around(x, 0)) {
              if (const std::size_t there = number(i, j, k); there >= here) count_pairs(here, there);
            }
          }
        }
      }
    }
  }
  return found;
}

double Region::volume() const {
  if (radius > 0) return ball(radius, space);
  double product = 1;
  for (const double edge : edges) product *= edge;
  return product;
}

double Region::shortest() const { return radius > 0 ? 2 * radius : *std::min_element(edges.begin(), edges.end()); }

/// Returns 1/V^2 times the integral, over all vectors of length up to r, of the volume that a region shares with itself
/// moved by the vector. In a box this volume is prod (a_k - |x_k|), for vectors shorter than the shortest edge.
double Region::share_within(double r) const {
  if (periodic) return ball(r, space) / volume();
  if (radius > 0) {
    const double u = r / (2 * radius);
    if (space == 3) return u * u * u * (8 - 9 * u + 2 * u * u * u);
    const double root = std::sqrt(std::max(0.0, 1 - u * u));
    return 2 / pi *
           (4 * u * u * std::acos(std::min(1.0, u)) + std::asin(std::min(1.0, u)) - u * root * (1 + 2 * u * u));
  }
  if (space == 2) {
    const double a = edges[0];
    const double b = edges[1];
    return (pi * a * b * r * r - 4.0 / 3 * (a + b) * r * r * r + r * r * r * r / 2) / (a * a * b * b);
  }
  const double a = edges[0];
  const double b = edges[1];
  const double c = edges[2];
  const double v = a * b * c;
  const double pairs = a * b + b * c + c * a;
  const double sum = a + b + c;
  return (4 * pi / 3 * v * r * r * r - pi / 2 * pairs * r * r * r * r + 8.0 / 15 * sum * std::pow(r, 5) -
          std::pow(r, 6) / 6) /
         (v * v);
}

Region region_of(const FigureParticles& of, const std::vector<double>& q) {
  Region region{of.container == "periodic", of.container == "circle" ? of.radius : 0, of.edges, of.space};
  if (region.radius > 0 || !region.edges.empty()) return region;
  std::vector<Extent> ends(of.space);
  for (std::size_t i = 0; i < q.size(); ++i) ends[i % of.space].include(q[i]);
  for (const Extent& end : ends) region.edges.push_back(std::max(end.high - end.low, 1e-300));
  return region;
}

}  // namespace hamflow::figures
