#include "hamflow/detail/methods/kepler_shears.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/methods/splittings/rkn8_s19.hpp"
#include "hamflow/orbits/kepler_drift.hpp"

namespace hamflow {
namespace {

constexpr std::size_t most_parts = 4096;
constexpr double rounding = 0x1p-53;

KeplerShears shears_of(const SplittingTable& table) {
  KeplerShears shears;
  const std::vector<double> coefficients = sequence_of<double>(table).coefficients;
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    (i % 2 == 0 ? shears.drifts : shears.kicks).push_back(coefficients[i]);
  }
  return shears;
}

template <class R>
using Plane = Vector<R, 2>;

/// Moves a body over a time t in `parts` equal parts.
void shear(Plane<DoubleDouble>& r, Plane<DoubleDouble>& v, const DoubleDouble& mu, double t, std::size_t parts) {
  static const SplittingSequence<DoubleDouble> sequence = sequence_of<DoubleDouble>(splittings::rkn8_s19);
  const DoubleDouble part = DoubleDouble(t) / DoubleDouble(static_cast<double>(parts));
  for (std::size_t count = 0; count < parts; ++count) {
    for (std::size_t i = 0; i < sequence.coefficients.size(); ++i) {
      const DoubleDouble by = part * sequence.coefficients[i];
      if (i % 2 == 0) {
        for (std::size_t k = 0; k < 2; ++k) r[k] += by * v[k];
      } else {
        const DoubleDouble square = r[0] * r[0] + r[1] * r[1];
        const DoubleDouble factor = by * mu / (square * sqrt(square));
        for (std::size_t k = 0; k < 2; ++k) v[k] -= factor * r[k];
      }
    }
  }
}

double largest(const Plane<DoubleDouble>& a) { return std::max(std::fabs(double(a[0])), std::fabs(double(a[1]))); }
double largest_difference(const Plane<DoubleDouble>& a, const Plane<DoubleDouble>& b) {
  return largest({a[0] - b[0], a[1] - b[1]});
}

}  // namespace

const KeplerShears& kepler_shears() {
  static const KeplerShears all = shears_of(splittings::rkn8_s19);
  return all;
}

std::optional<std::size_t> kepler_shear_parts(double mu, const double* r, const double* v, std::size_t space,
                                              double t) {
  double distance = 0;
  double speed = 0;
  double area_rate = 0;
  for (std::size_t i = 0; i < space; ++i) {
    distance += r[i] * r[i];
    speed += v[i] * v[i];
    for (std::size_t k = i + 1; k < space; ++k) {
      const double part = r[i] * v[k] - r[k] * v[i];
      area_rate += part * part;
    }
  }
  const double beta = 2 * mu / std::sqrt(distance) - speed;
  // e^2 = 1 - beta l^2/mu^2, and the distance at the pericentre is l^2/(mu (1 + e)).   [Danby1988, Sect. 6.9]
  const double e = std::sqrt(std::max(0.0, 1 - area_rate * beta / (mu * mu)));
  const double pericentre = area_rate / (mu * (1 + e));
  if (!(0 < pericentre) || !std::isfinite(pericentre)) return {};

  // A drift from a quarter of t before the pericentre until a quarter after it has half of its way on either side.
  const Plane<DoubleDouble> at{DoubleDouble(pericentre), DoubleDouble(0)};
  const Plane<DoubleDouble> with{DoubleDouble(0), DoubleDouble(std::sqrt(area_rate) / pericentre)};
  const DoubleDouble attraction(mu);
  Plane<DoubleDouble> start_r = at, start_v = with, end_r = at, end_v = with;
  if (advance_on_conic(start_r, start_v, attraction, DoubleDouble(-t / 2)) != Outcome::done) return {};
  if (advance_on_conic(end_r, end_v, attraction, DoubleDouble(t / 2)) != Outcome::done) return {};
  for (std::size_t parts = 1; parts <= most_parts;) {
    Plane<DoubleDouble> moved_r = start_r, moved_v = start_v;
    shear(moved_r, moved_v, attraction, t, parts);
    const double error = std::max(largest_difference(moved_r, end_r) / largest(end_r),
                                  largest_difference(moved_v, end_v) / largest(end_v));
    if (error <= rounding) return parts;
    // The error falls with the eighth power of the number of parts. The next try is a tenth below the number that this
    // predicts, so that the smallest one that does is found.
    const double factor = std::isfinite(error) ? std::clamp(0.9 * pow(error / rounding, 0.125), 1.0, 2.0) : 2.0;
    parts = std::max(parts + 1, static_cast<std::size_t>(static_cast<double>(parts) * factor));
  }
  return {};
}

}  // namespace hamflow
