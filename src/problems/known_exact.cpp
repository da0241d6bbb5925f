#include "known_exact.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace hamflow {

namespace {

constexpr std::size_t points = 5;

/// States after starts and times that differ by 2^-58, relative. All of q increase and all of p decrease by the same
/// factor, so that a line through the centre remains one.
std::optional<std::array<LongState, points>> neighbours_of(const LongMotion& motion, const LongState& start,
                                                           long double t) {
  std::array<LongState, points> all;
  for (std::size_t k = 0; k < points; ++k) {
    const long double change = static_cast<long double>(k) * 0x1p-58L;
    LongState z = start;
    for (std::size_t i = 0; i < z.size(); ++i) z[i] += (i < z.size() / 2 ? change : -change) * z[i];
    auto end = motion(z, t * (1 + change));
    if (!end) return std::nullopt;
    for (const long double x : *end) {
      if (!std::isfinite(x)) return std::nullopt;
    }
    all[k] = std::move(*end);
  }
  return all;
}

/// The standard deviation of the noise in such values, from their third differences.
long double noise_of(std::array<long double, points> values) {
  constexpr std::size_t order = 3;
  for (std::size_t k = 0; k < order; ++k) {
    for (std::size_t i = 0; i + 1 + k < points; ++i) values[i] = values[i + 1] - values[i];
  }
  long double sum = 0;
  for (std::size_t i = 0; i + order < points; ++i) sum += values[i] * values[i];
  return std::sqrt(sum / ((points - order) * 20));  // a third difference has 20 times the variance of a value
}

}  // namespace

std::optional<LongState> exact_state_if_accurate(const LongMotion& motion, const LongState& start, long double t,
                                                 const std::vector<bool>& is_angle) {
  constexpr long double epsilon = std::numeric_limits<double>::epsilon();
  constexpr long double turn = 2 * std::numbers::pi_v<long double>;
  const auto near = neighbours_of(motion, start, t);
  if (!near) return std::nullopt;
  const LongState& end = near->front();
  const std::size_t n = end.size() / 2;
  const auto angle = [&](std::size_t i) { return i < is_angle.size() && is_angle[i]; };
  std::array<long double, 2> size{};  // of the coordinates, of the momenta
  for (std::size_t i = 0; i < 2 * n; ++i) {
    if (!angle(i)) size[i / n] = std::fmax(size[i / n], std::fabs(end[i]));
  }
  for (std::size_t i = 0; i < 2 * n; ++i) {
    std::array<long double, points> values{};
    for (std::size_t k = 0; k < points; ++k) {
      const long double change = (*near)[k][i] - end[i];
      values[k] = angle(i) ? std::remainder(change, turn) : change;
    }
    const long double of_a_rounding = std::fabs(values[points - 1]) / (points - 1) / 0x1p-58L * epsilon;
    const long double rounding = epsilon * (angle(i) ? std::fabs(end[i]) : size[i / n]);
    if (!(4 * noise_of(values) <= rounding / 4 + of_a_rounding / 16)) return std::nullopt;
  }
  return end;
}

}  // namespace hamflow
