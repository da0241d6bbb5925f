// Curves in the plane: exact orbits, level curves of a Hamiltonian, and samples reduced to what a page can show. NaN
// separates the branches of a curve.
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
  /// Ends the current branch.
  void lift();
};

/// Samples r(phi) for phi from `first` to `last`, except where r is not positive or above `largest_radius`. Points are
/// closer where the curve bends.
Curve sample_orbit(const std::function<double(double)>& r_of_phi, double first, double last, double largest_radius);

/// Returns the points of H(q, p) = level in a rectangle, for all branches, each point accurate to rounding. Points lie
/// on the edges of a fine grid, so that branches join at their turning points for any H.
Curve level_curve(const std::function<double(double, double)>& h, double level, const Extent& q, const Extent& p);

enum class Gaps { closed, kept };

/// Returns the samples whose two numbers are finite. The curve is closed over the other samples, or broken there.
Curve finite_points(std::span<const double> x, std::span<const double> y, Gaps gaps = Gaps::closed);
/// Sum of the chords.
double path_length(const Curve& curve);
/// Returns at most `limit` >= 2 points, evenly spaced in their order. If chords between them do not follow the path,
/// the place within each stretch varies: a fixed stride in step with a period would only show a few places of an orbit.
Curve thin_out(const Curve& curve, std::size_t limit);
/// Range of many samples of y over x: the smallest and largest in each column of the page that has any.
struct Band {
  std::vector<double> x;
  std::vector<double> low;
  std::vector<double> high;
};
Band envelope(const Curve& curve, std::size_t columns);
/// Returns whether chords between consecutive points follow a path, that is, whether most of them change direction only
/// a little.
bool follows_path(const Curve& curve);

}  // namespace hamflow::figures
