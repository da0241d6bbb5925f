// Curves in the plane: the exact orbit, the level curve of a Hamiltonian, and samples thinned to what paper can show.
// NaN separates the branches of a curve.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "hamflow/figures/axis.hpp"

namespace hamflow::figures {

struct Curve {
  std::vector<double> x;
  std::vector<double> y;

  void add(double x_value, double y_value);
  /// Ends the present branch.
  void lift();
};

/// r(phi) for phi from `first` to `last`, left out where it is not positive or beyond `largest_radius`. Points lie
/// closer where the curve bends.
Curve sample_orbit(const std::function<double(double)>& r_of_phi, double first, double last, double largest_radius);

/// The points of H(q, p) = level in a rectangle, all branches, each point to rounding. Found on the edges of a fine
/// grid, so that branches join at their turning points, whatever the shape of H in p.
Curve level_curve(const std::function<double(double, double)>& h, double level, const Extent& q, const Extent& p);

enum class Gaps { closed, kept };

/// The samples in which both numbers are finite; a line over them can be broken where others were.
Curve finite_points(std::span<const double> x, std::span<const double> y, Gaps gaps = Gaps::closed);
/// The sum of the chords.
double path_length(const Curve& curve);
/// At most `limit` >= 2 points, evenly spaced in their order. Where their chords lose the path, the place within each
/// stretch varies: a fixed stride in step with a period would show a few places of an orbit and hide the rest.
Curve thin_out(const Curve& curve, std::size_t limit);
/// What many samples of y over x range over: least and largest of each column of the page, where there are any.
struct Band {
  std::vector<double> x;
  std::vector<double> low;
  std::vector<double> high;
};
Band envelope(const Curve& curve, std::size_t columns);
/// Whether chords between consecutive points follow a path: whether most of them turn only a little.
bool follows_path(const Curve& curve);

}  // namespace hamflow::figures
