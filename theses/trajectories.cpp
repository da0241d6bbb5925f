#include "trajectories.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "hamflow/core/error.hpp"

namespace hamflow::reproduction {

double largest_distance(const Trajectory& a, const Trajectory& b) {
  double largest = 0;
  std::size_t compared = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const double gap = a.t[i] - b.t[j];
    if (std::abs(gap) <= 1e-9 * std::max(1.0, std::abs(a.t[i]))) {
      for (std::size_t k = 0; k < a.q[i].size(); ++k) largest = std::max(largest, std::abs(a.q[i][k] - b.q[j][k]));
      ++compared;
      ++i;
      ++j;
    } else if (gap < 0) {
      ++i;
    } else {
      ++j;
    }
  }
  if (compared < 2) throw Error("two runs have no samples at the same times");
  return largest;
}

double distance_from_segment(const std::vector<double>& x, const std::vector<double>& a, const std::vector<double>& b) {
  const double u = b[0] - a[0], v = b[1] - a[1], squared = u * u + v * v;
  const double along = squared > 0 ? std::clamp(((x[0] - a[0]) * u + (x[1] - a[1]) * v) / squared, 0.0, 1.0) : 0;
  return std::hypot(x[0] - a[0] - along * u, x[1] - a[1] - along * v);
}

void claim_second_order(Study& study, const Study::Statement& statement, const Halving& halving) {
  if (halving.coarse <= halving.rounding && halving.fine <= halving.rounding) {
    study.claim(statement, at_most(halving.rounding, "rounding of the steps, which is the only error"),
                {{halving.coarse, 0, "largest distance"}});
    return;
  }
  study.claim(
      statement,
      within(4, 0.3, "the distance for dt divided by that for dt/2: linear elements have order 2, an error like dt^2"),
      {{halving.coarse / halving.fine, 4 * halving.rounding / halving.fine,
        fmt::format("distances {:.3g} and {:.3g}", halving.coarse, halving.fine)}});
}

std::vector<double> roots(const std::function<double(double)>& f, const std::vector<double>& grid) {
  std::vector<double> all;
  for (std::size_t i = 0; i + 1 < grid.size(); ++i) {
    double a = grid[i], b = grid[i + 1];
    const bool rises = f(a) < 0;
    if (rises == (f(b) < 0)) continue;
    for (int k = 0; k < 200 && b - a > 2 * std::numeric_limits<double>::epsilon() * std::abs(b); ++k) {
      const double middle = a + (b - a) / 2;
      ((f(middle) < 0) == rises ? a : b) = middle;
    }
    all.push_back(a + (b - a) / 2);
  }
  return all;
}

std::vector<double> geometric_grid(double a, double b, std::size_t count) {
  std::vector<double> grid;
  for (std::size_t i = 0; i < count; ++i) {
    grid.push_back(a * std::pow(b / a, static_cast<double>(i) / static_cast<double>(count - 1)));
  }
  return grid;
}

std::vector<double> extrema(const std::vector<double>& t, const std::vector<double>& x,
                            const std::vector<double>& rate) {
  std::vector<double> all;
  for (std::size_t i = 0; i + 1 < t.size(); ++i) {
    if ((rate[i] < 0) == (rate[i + 1] < 0)) continue;
    const double h = t[i + 1] - t[i];
    // The interpolant x(s) on [0, 1] has x' = rate h at both ends. Its derivative is a quadratic that changes its sign.
    const double d0 = rate[i] * h, d1 = rate[i + 1] * h, rise = x[i + 1] - x[i];
    const double a = d0 + d1 - 2 * rise, b = 3 * rise - 2 * d0 - d1;
    double low = 0, high = 1;
    for (int k = 0; k < 60; ++k) {
      const double s = (low + high) / 2;
      ((3 * a * s * s + 2 * b * s + d0 < 0) == (d0 < 0) ? low : high) = s;
    }
    const double s = (low + high) / 2;
    all.push_back(x[i] + s * (d0 + s * (b + s * a)));
  }
  return all;
}

double energy_error(const Trajectory& trajectory) { return trajectory.report.energy.max_error; }

}  // namespace hamflow::reproduction
