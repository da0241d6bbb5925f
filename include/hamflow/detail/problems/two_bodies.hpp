// Two bodies in space with a force along r = r2 - r1: the centre of mass moves uniformly, and r as a particle of the
// reduced mass mu = m1 m2/(m1 + m2) in the plane L.r = 0 through the start.   [Gross1999, (2.1)-(2.20)]
//     x1 = X - (m2/M) r,   x2 = X + (m1/M) r.                                                          (2.5), (2.6)
#pragma once

#include "hamflow/core/math.hpp"
#include "hamflow/core/problem_info.hpp"

namespace hamflow {

struct Body {
  double mass = 0;
  Vector<double, 3> position{};
  Vector<double, 3> velocity{};
};

/// The plane of the relative motion, and the motion of the centre of mass.
class TwoBodies {
 public:
  TwoBodies(const Body& first, const Body& second) : mass_{first.mass, second.mass} {
    const double total = first.mass + second.mass;
    Vector<double, 3> r{};
    Vector<double, 3> v{};
    for (std::size_t k = 0; k < 3; ++k) {
      centre_[k] = (first.mass * first.position[k] + second.mass * second.position[k]) / total;
      drift_[k] = (first.mass * first.velocity[k] + second.mass * second.velocity[k]) / total;
      r[k] = second.position[k] - first.position[k];
      v[k] = second.velocity[k] - first.velocity[k];
    }
    const double distance = length(r);
    for (std::size_t k = 0; k < 3; ++k) along_[k] = r[k] / distance;
    const double radial = dot(v, along_);
    for (std::size_t k = 0; k < 3; ++k) across_[k] = v[k] - radial * along_[k];
    const double transverse = length(across_);
    if (transverse > 1e-14 * length(v)) {
      for (std::size_t k = 0; k < 3; ++k) across_[k] /= transverse;
    } else {
      across_ = any_perpendicular(along_);  // a motion on a line lies in every plane through it
    }
    const double mu = reduced_mass();
    start_ = {{distance, 0.0}, {mu * radial, mu * dot(v, across_)}};
  }

  double reduced_mass() const { return mass_[0] * mass_[1] / (mass_[0] + mass_[1]); }
  /// The planar start: on the x-axis, counter-clockwise.
  const Start<double, 2>& start() const { return start_; }

  /// The bodies at time t, when the relative motion is at (q, p) in the plane.
  std::pair<Body, Body> at(double t, const Vector<double, 2>& q, const Vector<double, 2>& p) const {
    const double total = mass_[0] + mass_[1];
    Body first{mass_[0], {}, {}};
    Body second{mass_[1], {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const double r = q[0] * along_[k] + q[1] * across_[k];
      const double v = (p[0] * along_[k] + p[1] * across_[k]) / reduced_mass();
      const double centre = centre_[k] + drift_[k] * t;
      first.position[k] = centre - mass_[1] / total * r;
      second.position[k] = centre + mass_[0] / total * r;
      first.velocity[k] = drift_[k] - mass_[1] / total * v;
      second.velocity[k] = drift_[k] + mass_[0] / total * v;
    }
    return {first, second};
  }

 private:
  static double dot(const Vector<double, 3>& a, const Vector<double, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  static double length(const Vector<double, 3>& a) { return sqrt(dot(a, a)); }
  static Vector<double, 3> any_perpendicular(const Vector<double, 3>& a) {
    std::size_t least = 0;  // the axis that is farthest from a
    for (std::size_t k = 1; k < 3; ++k) least = abs(a[k]) < abs(a[least]) ? k : least;
    Vector<double, 3> b{};
    b[least] = 1;
    const double along = dot(a, b);
    for (std::size_t k = 0; k < 3; ++k) b[k] -= along * a[k];
    const double size = length(b);
    for (double& x : b) x /= size;
    return b;
  }

  double mass_[2];
  Vector<double, 3> centre_{};
  Vector<double, 3> drift_{};
  Vector<double, 3> along_{};
  Vector<double, 3> across_{};
  Start<double, 2> start_{};
};

}  // namespace hamflow
