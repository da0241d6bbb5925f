// What several experiments ask of trajectories.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study.hpp"

namespace hamflow::reproduction {

/// The largest difference of a coordinate at the samples that both have at the same times.
/// @throws Error where they have none
double largest_distance(const Trajectory& a, const Trajectory& b);

/// Of a point of the plane from the segment from a to b.
double distance_from_segment(const std::vector<double>& x, const std::vector<double>& a, const std::vector<double>& b);

/// The distance from a reference for a step length and half of it.
struct Halving {
  double coarse = 0;
  double fine = 0;
  double rounding = 0;  // below it distances mean nothing
};
/// distance(dt)/distance(dt/2) = 4 +- 0.3 for order 2; or both distances are rounding.
void claim_second_order(Study& study, const Study::Statement& statement, const Halving& halving);

/// Where f changes its sign, between neighbours of `grid`, to rounding.
std::vector<double> roots(const std::function<double(double)>& f, const std::vector<double>& grid);
/// From a to b, in equal ratios.
std::vector<double> geometric_grid(double a, double b, std::size_t count);

/// The extrema of a quantity with its rate at the samples, where the rate changes its sign: those of cubic Hermite
/// pieces, whose error is h^4/384 times the fourth derivative.
std::vector<double> extrema(const std::vector<double>& t, const std::vector<double>& x,
                            const std::vector<double>& rate);

/// max |H - H0| over every step, as the run has watched it.
double energy_error(const Trajectory& trajectory);

}  // namespace hamflow::reproduction
