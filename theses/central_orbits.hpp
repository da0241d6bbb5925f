// Orbits in the central potentials of [Gross1999, ch. 2], followed by two families of methods, and what they are:
// bounded or not, a conic or none, by their points alone.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "hamflow/core/vector.hpp"

namespace hamflow::reproduction {

enum class Field { kepler, hooke, linear, binomial };

/// A potential, a start in the plane, and what follows from it.
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

/// From the start on: through three extrema of r, or outwards until V_eff meets E no more.
struct OrbitPath {
  std::vector<double> t;
  std::vector<std::array<double, 2>> points;
  std::vector<double> rate;  // q.p, the sign of dr/dt
  int minima = 0;
  int maxima = 0;
  bool escaped = false;
  bool bounded() const { return minima > 0 && maxima > 0; }
};
/// dop853, tolerance 1e-13, in double.
OrbitPath orbit_path(const OrbitCase& orbit);
/// The modified midpoint rule extrapolated, tolerance 1e-17, in long double: another method in more digits.
OrbitPath orbit_path_confirmed(const OrbitCase& orbit);

enum class OrbitShape { ellipse, parabola, hyperbola, no_conic, unclear };
struct ConicFit {
  OrbitShape shape = OrbitShape::unclear;
  double misfit = 0;        // root mean square of a x^2 + b x y + c y^2 + d x + e y + f, coefficients of norm 1
  double discriminant = 0;  // b^2 - 4 a c of them
};
/// The conic nearest to the points of a path, in coordinates in which they scatter alike in all directions: affine maps
/// leave the kind of a conic.
ConicFit conic_through(const OrbitPath& path);

/// Uniform in [0, 1), and equal for equal arguments.
double drawn(std::uint64_t seed, std::uint64_t number);

}  // namespace hamflow::reproduction
