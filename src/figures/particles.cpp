#include "particles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "figure_kind.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/number.hpp"
#include "panels.hpp"
#include "text.hpp"

namespace hamflow::figures {

namespace {
constexpr std::uint64_t seed = 1738;  // arbitrary but fixed, so that every figure shows the same particles
}

namespace {
std::size_t sample_nearest_to(const FigureData& data, double t) {
  const auto nearest = std::min_element(data.t.begin(), data.t.end(),
                                        [&](double a, double b) { return std::abs(a - t) < std::abs(b - t); });
  return static_cast<std::size_t>(nearest - data.t.begin());
}
}  // namespace

MissingSample missing_sample_at(const FigureData& data, double t) {
  const double nearest = data.t[sample_nearest_to(data, t)];
  // n dt and a typed time are rounded, so they are compared as scenarios do (run.record).
  if (std::abs(nearest - t) <= 4 * 0x1p-52 * std::abs(t)) return {};
  const auto [first, last] = std::minmax({data.t.front(), data.t.back()});
  const std::string samples = "the " + std::to_string(data.t.size()) + " samples from " + shortest(first) + " to " +
                              shortest(last) + "; the nearest is at " + shortest(nearest);
  return {.samples = samples, .is_beyond = t < first || t > last};
}

std::vector<std::size_t> samples_at(const FigureData& data, const std::vector<double>& times) {
  std::vector<std::size_t> all;
  for (const double t : times) all.push_back(sample_nearest_to(data, t));
  return all;
}

std::vector<std::size_t> some_of(std::size_t count, std::size_t most) {
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < std::min(count, most); ++k) {
    if (count <= most) {
      all.push_back(k);
      continue;
    }
    const std::size_t begin = k * count / most;
    const std::size_t length = (k + 1) * count / most - begin;
    all.push_back(begin + static_cast<std::size_t>(counter_bits(seed, k) % length));
  }
  return all;
}

std::string part_note(std::size_t drawn, std::size_t count) {
  return drawn == count ? "" : std::to_string(drawn) + " of " + std::to_string(count) + " particles are drawn";
}

std::vector<double> folded(std::vector<double> positions, const FigureParticles& of) {
  if (of.container != "periodic") return positions;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double edge = of.edges.at(i % of.space);
    positions[i] -= edge * std::floor(positions[i] / edge + 0.5);
  }
  return positions;
}

Curve outline(const FigureParticles& of, Plane plane) {
  Curve curve;
  if (of.container == "circle") {
    constexpr int corners = 240;
    for (int k = 0; k <= corners; ++k) {
      const double angle = 2 * std::numbers::pi * k / corners;
      curve.add(of.radius * std::cos(angle), of.radius * std::sin(angle));
    }
  } else if (!of.edges.empty()) {
    const double x = of.edges.at(plane.first) / 2;
    const double y = of.edges.at(plane.second) / 2;
    for (const auto& [sx, sy] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}}) curve.add(sx * x, sy * y);
  }
  return curve;
}

std::string time_text(double t) { return "{/:Italic t} = " + short_value(t); }

std::string no_places(const FigureData& data) {
  if (data.t.empty()) return no_samples("position");
  const auto finite = [&](std::size_t sample) {
    const std::vector<double> q = data.particles.positions(sample);
    return std::any_of(q.begin(), q.end(), [](double x) { return std::isfinite(x); });
  };
  return finite(0) || finite(data.t.size() - 1) ? "" : no_samples("position");
}

std::vector<std::string> axes_of_particles(const FigureData& data) { return axes_of_space(data.particles.space); }

}  // namespace hamflow::figures
