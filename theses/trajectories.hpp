// Measurements on trajectories that several experiments use.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study.hpp"

namespace hamflow::reproduction {

/// Returns the largest difference of a coordinate, over the samples that both trajectories have at the same times.
/// @throws Error if they have no sample in common
double largest_distance(const Trajectory& a, const Trajectory& b);

/// Returns the distance of a point of the plane from the segment from a to b.
double distance_from_segment(const std::vector<double>& x, const std::vector<double>& a, const std::vector<double>& b);

/// The distances from a reference solution with step size dt and dt/2.
struct Halving {
  double coarse = 0;
  double fine = 0;
  double rounding = 0;  // smaller distances are only rounding
};
/// Claims order 2: distance(dt)/distance(dt/2) = 4 +- 0.3, or both distances are rounding.
void claim_second_order(Study& study, const Study::Statement& statement, const Halving& halving);

/// Returns the points where f changes its sign between neighbours of `grid`, exact up to rounding.
std::vector<double> roots(const std::function<double(double)>& f, const std::vector<double>& grid);
/// Returns `count` points from a to b with a constant ratio.
std::vector<double> geometric_grid(double a, double b, std::size_t count);

/// Returns the extrema of a quantity from its values x and rates at times t. Where the rate changes its sign, it takes
/// the extremum of the cubic Hermite interpolant, whose error is h^4/384 times the fourth derivative.
std::vector<double> extrema(const std::vector<double>& t, const std::vector<double>& x,
                            const std::vector<double>& rate);

/// Returns max |H - H0| over all steps, from the report of the run.
double energy_error(const Trajectory& trajectory);

}  // namespace hamflow::reproduction
