#include "two_to_one.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "hamflow/core/counter_random.hpp"
#include "tube_runs.hpp"

namespace hamflow::reproduction {

double two_to_one_share(const Study& study, double eps, double energy, double h, int samples, int seed) {
  const auto map = free_tube_step({.eps = eps});
  double layers = 0, parts = 0;
  std::uint64_t draw = 0;
  const auto uniform = [&] { return (1 + counter_uniform(static_cast<std::uint64_t>(seed), draw++)) / 2; };
  for (int k = 0; k < samples; ++k) {
    const std::size_t i = uniform() < 0.5 ? 0 : 1;
    const int side = uniform() < 0.5 ? -1 : 1;
    const double wall = i == 0 ? side : 1.1 + side, along = -1 + 2 * uniform() + (i == 0 ? 1.1 : 0);
    const double q1 = i == 0 ? wall : along, q2 = i == 0 ? along : wall;
    const double kinetic = energy + eps / std::hypot(q1, q2);
    const double angle = 2 * std::numbers::pi * uniform();
    if (!(kinetic > 0)) continue;
    State<double> z{q1, q2, std::sqrt(2 * kinetic) * std::cos(angle), std::sqrt(200 * kinetic) * std::sin(angle)};
    z[2 + i] = side * std::abs(z[2 + i]);
    // The distance from the wall at which a step just leaves the domain: a step h, or for `image` a step -h from R z.
    const auto layer = [&](bool image) {
      double low = 0, high = 3 * h * std::abs(z[2 + i]) / (i == 0 ? 1 : 100) + h * h * std::abs(eps) / 0.01;
      for (int bisection = 0; bisection < 60; ++bisection) {
        const double middle = (low + high) / 2;
        State<double> y = z;
        y[i] -= side * middle;
        if (image) y[2 + i] = -y[2 + i];
        map->advance(y, image ? -h : h, 1);
        ((y[i] - wall) * side > 0 ? low : high) = middle;
      }
      return low;
    };
    const double forward = layer(false), part = std::max(0.0, forward - layer(true));
    layers += forward;
    parts += part;
    if (k % 200 == 0) study.breathe();
  }
  return parts / layers;
}

namespace {
/// An independent implementation of a step of stv4 in long double, for the pair of states.
struct LongState {
  long double q[2], p[2];
};
LongState step_in_long_double(LongState z, long double h, long double eps) {
  const long double outer = 1 / (2 - std::cbrt(2.0L)), mass[2] = {1, 100};
  for (const long double factor : {outer, 1 - 2 * outer, outer}) {
    const auto kick = [&](long double time) {
      const long double r = std::hypot(z.q[0], z.q[1]);
      for (int i = 0; i < 2; ++i) z.p[i] -= time * eps * z.q[i] / (r * r * r);
    };
    kick(factor * h / 2);
    for (int i = 0; i < 2; ++i) z.q[i] += factor * h * z.p[i] / mass[i];
    kick(factor * h / 2);
  }
  return z;
}
bool is_inside(const LongState& z) { return std::abs(z.q[0]) <= 1 && std::abs(z.q[1] - 1.1L) <= 1; }
}  // namespace

Measured explicit_pair() {
  constexpr long double h = 0.01L, eps = 0.6L;
  const LongState rejected{{0.1L, 0.109013340127122L}, {-5, -90}};
  LongState image = rejected;
  image.p[1] = -image.p[1];
  const LongState other = step_in_long_double(image, -h, eps), back = step_in_long_double(other, h, eps);
  const long double apart = std::hypot(std::hypot(back.q[0] - image.q[0], back.q[1] - image.q[1]),
                                       std::hypot(back.p[0] - image.p[0], back.p[1] - image.p[1]));
  const bool is_pair = !is_inside(step_in_long_double(rejected, h, eps)) && is_inside(other) && is_inside(back) &&
                       apart < 1e3L * std::numeric_limits<long double>::epsilon();
  return {
      is_pair ? 1.0 : 0.0, 0,
      fmt::format("a pair of states in long double: q = (0.1, 0.109013340127122), p = (-5, -90) is rejected; a step "
                  "from q = ({:.10f}, {:.10f}), p = ({:.10f}, {:.10f}) leads to its image, up to {:.0e}",
                  static_cast<double>(other.q[0]), static_cast<double>(other.q[1]), static_cast<double>(other.p[0]),
                  static_cast<double>(other.p[1]), static_cast<double>(apart))};
}

}  // namespace hamflow::reproduction
