#include <algorithm>
#include <cmath>
#include <numbers>

#include "figure.hpp"
#include "hamflow/figures/curves.hpp"

namespace hamflow::figures {

namespace {

struct OrbitPoint {
  double x = 0;
  double y = 0;
};

class OrbitSampler {
 public:
  OrbitSampler(const std::function<double(double)>& r_of_phi, double largest_radius)
      : r_of_phi_(r_of_phi), largest_radius_(largest_radius) {}

  Curve sample(double first, double last) {
    const double turns = (last - first) / (2 * std::numbers::pi);
    const int pieces = 16 + static_cast<int>(96 * turns);
    double left = first;
    if (visible(left)) add(left);
    for (int i = 1; i <= pieces; ++i) {
      const double right = first + (last - first) * i / pieces;
      join(left, right);
      left = right;
    }
    return std::move(curve_);
  }

 private:
  bool visible(double phi) const {
    const double r = r_of_phi_(phi);
    return r > 0 && r <= largest_radius_;  // false for NaN
  }
  OrbitPoint at(double phi) const {
    const double r = r_of_phi_(phi);
    return {r * std::cos(phi), r * std::sin(phi)};
  }
  void add(double phi) {
    const OrbitPoint z = at(phi);
    curve_.add(z.x, z.y);
  }
  /// Returns the last visible angle between a visible and an invisible one.
  double horizon(double inside, double outside) const {
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (inside + outside);
      (visible(middle) ? inside : outside) = middle;
    }
    return inside;
  }
  /// Continues from `left`, which is already drawn if it is visible.
  void join(double left, double right) {
    const bool starts = visible(left);
    const bool ends = visible(right);
    if (starts && ends) {
      refine(left, right, 12);
    } else if (starts) {
      refine(left, horizon(left, right), 12);
      curve_.lift();
    } else if (ends) {
      const double begin = horizon(right, left);
      add(begin);
      refine(begin, right, 12);
    }
  }
  void refine(double left, double right, int depth) {
    const double middle = 0.5 * (left + right);
    if (depth > 0 && visible(middle)) {
      const OrbitPoint a = at(left);
      const OrbitPoint b = at(right);
      const OrbitPoint m = at(middle);
      const double sag = std::hypot(m.x - 0.5 * (a.x + b.x), m.y - 0.5 * (a.y + b.y));
      if (sag > 1e-4 * largest_radius_) {
        refine(left, middle, depth - 1);
        refine(middle, right, depth - 1);
        return;
      }
    }
    add(right);
  }

  const std::function<double(double)>& r_of_phi_;
  double largest_radius_;
  Curve curve_;
};

}  // namespace

Curve sample_orbit(const std::function<double(double)>& r_of_phi, double first, double last, double largest_radius) {
  return OrbitSampler(r_of_phi, largest_radius).sample(first, last);
}

}  // namespace hamflow::figures

namespace hamflow {

namespace {
/// Returns the angle at each sample, continued over the branch cut.
std::vector<double> continued_angles(const figures::Curve& track) {
  std::vector<double> phi;
  for (std::size_t k = 0; k < track.x.size(); ++k) {
    const double here = std::atan2(track.y[k], track.x[k]);
    phi.push_back(k == 0 ? here : phi.back() + std::remainder(here - phi.back(), 2 * std::numbers::pi));
  }
  return phi;
}

/// Returns whether r(phi) is an orbit that closes after one turn.
bool closes(const std::function<double(double)>& r_of_phi, double from) {
  for (int i = 0; i < 360; ++i) {
    const double phi = from + i * std::numbers::pi / 180;
    const double r = r_of_phi(phi);
    if (!(r > 0) || !(std::abs(r_of_phi(phi + 2 * std::numbers::pi) - r) <= 1e-9 * r)) return false;
  }
  return true;
}

/// Returns whether a curve stays within the rectangle of the data, with a small margin.
bool stays_inside(const figures::Curve& curve, const figures::Curve& track) {
  const auto fits = [](const std::vector<double>& inner, const std::vector<double>& outer) {
    figures::Extent data;
    data.include(outer);
    const double slack = 0.05 * (data.high - data.low);
    return std::all_of(inner.begin(), inner.end(),
                       [&](double v) { return v >= data.low - slack && v <= data.high + slack; });
  };
  return fits(curve.x, track.x) && fits(curve.y, track.y);
}
}  // namespace

void sample_polar_curve(const std::function<double(double)>& r_of_phi, FigureData& data) {
  data.curve_x.clear();
  data.curve_y.clear();
  const figures::Curve track = figures::orbit_track(data);
  if (!r_of_phi || track.x.empty()) return;
  const std::vector<double> phi = continued_angles(track);
  const auto [least, most] = std::minmax_element(phi.begin(), phi.end());
  const double turn = 2 * std::numbers::pi;
  double largest = 0;
  for (std::size_t k = 0; k < track.x.size(); ++k) largest = std::max(largest, std::hypot(track.x[k], track.y[k]));

  figures::Curve curve;
  if (closes(r_of_phi, *least)) {
    double reach = largest;
    for (int i = 0; i < 360; ++i) reach = std::max(reach, r_of_phi(*least + i * std::numbers::pi / 180));
    curve = figures::sample_orbit(r_of_phi, *least, *least + turn, 1.01 * reach);
    if (*most - *least < turn && !stays_inside(curve, track)) curve = {};
  }
  if (curve.x.empty()) {
    constexpr double most_turns = 60;  // turns of a rosette; more would be a grey disc
    curve = figures::sample_orbit(r_of_phi, *least, std::min(*most, *least + most_turns * turn), 1.01 * largest);
  }
  data.curve_x = std::move(curve.x);
  data.curve_y = std::move(curve.y);
}

}  // namespace hamflow
