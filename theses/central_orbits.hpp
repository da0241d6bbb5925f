// Orbits in the central potentials of [Gross1999, ch. 2], integrated with two families of methods, and their
// classification from points alone: bounded or not, and which conic if any.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "hamflow/core/vector.hpp"

namespace hamflow::reproduction {

enum class Field { kepler, hooke, linear, binomial };

/// A central potential and a start in the plane.
struct OrbitCase {
  Field field = Field::kepler;
  double mass = 1;
  double k = 1;
  double lambda = 0;
  Vector<double, 2> q{};
  Vector<double, 2> p{};

  double angular_momentum() const { return q[0] * p[1] - q[1] * p[0]; }
  double V(double r) const;
  double effective(double r) const;  // V + l^2/(2 mu r^2)
  double energy() const;
  std::string told() const;
};

/// A path from the start. It ends after three extrema of r, or once r grows and V_eff(r) = E has no solution further
/// out.
struct OrbitPath {
  std::vector<double> t;
  std::vector<std::array<double, 2>> points;
  std::vector<double> rate;  // q.p, which has the sign of dr/dt
  int minima = 0;
  int maxima = 0;
  bool escaped = false;
  bool bounded() const { return minima > 0 && maxima > 0; }
};
/// Integrates with dop853, tolerance 1e-13, in double.
OrbitPath orbit_path(const OrbitCase& orbit);
/// Integrates with the extrapolated midpoint rule, tolerance 1e-17, in long double: another method with more digits,
/// which confirms orbit_path().
OrbitPath orbit_path_confirmed(const OrbitCase& orbit);

enum class OrbitShape { ellipse, parabola, hyperbola, no_conic, unclear };
struct ConicFit {
  OrbitShape shape = OrbitShape::unclear;
  double misfit = 0;        // root mean square of a x^2 + b x y + c y^2 + d x + e y + f; (a, b, c, d, e, f) has norm 1
  double discriminant = 0;  // b^2 - 4 a c
};
/// Fits a conic to the points of a path. An affine map first gives the points the same spread in all directions; it
/// does not change the kind of a conic.
ConicFit conic_through(const OrbitPath& path);

/// Returns a random number, uniform in [0, 1). Equal arguments give equal numbers.
double drawn(std::uint64_t seed, std::uint64_t number);

}  // namespace hamflow::reproduction
