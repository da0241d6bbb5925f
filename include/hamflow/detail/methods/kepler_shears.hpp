// A Kepler drift as a sequence of shears, for the lattice: drifts of the position at constant velocity and kicks by the
// attraction, in turn. Each is a bijection of the lattice; a Kepler drift rounded as a whole is none.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace hamflow {

/// The fractions of a time by which one part drifts and kicks, drift first: a splitting of order 8 for quadratic T.
struct KeplerShears {
  std::vector<double> drifts;  // one more than kicks; the first and the last are equal
  std::vector<double> kicks;
};
const KeplerShears& kepler_shears();

/// The number of equal parts of a drift of time t whose error is below the rounding of a double, in position and in
/// velocity, where it is largest: about the pericentre.
/// @param mu G times the mass of the centre
/// @param r, v, space of the body relative to the centre, in `space` dimensions
/// @returns nullopt if more than 4096 parts were needed: an orbit that comes too near to the centre for such a t
std::optional<std::size_t> kepler_shear_parts(double mu, const double* r, const double* v, std::size_t space, double t);

}  // namespace hamflow
