// Distances between the particles of a gas.
#pragma once

#include <cstdint>
#include <vector>

#include "figure.hpp"

namespace hamflow::figures {

/// Counts pairs by distance: bin k contains distances from k r_max/bins to (k + 1) r_max/bins. In a periodic box the
/// distance of a pair is that of its nearest images. The time is proportional to the number of pairs within r_max.
/// @param q positions, particle by particle   @param space 2 or 3   @param edges edges of a periodic box, with r_max at
/// most half the shortest; empty: no box
std::vector<std::int64_t> pair_counts(const std::vector<double>& q, std::size_t space, const std::vector<double>& edges,
                                      double r_max, std::size_t bins);

/// The volume that contains the particles. Without a container it is the smallest box around them.
struct Region {
  bool periodic = false;
  double radius = 0;            // radius of a circle or sphere; 0: a box
  std::vector<double> edges{};  // edges of a box
  std::size_t space = 2;

  double volume() const;
  double shortest() const;  // shortest edge, or diameter
  /// Returns the fraction of pairs of points, spread evenly over the region, whose distance is at most r. r is at most
  /// shortest() / 2 in a periodic box, otherwise shortest().
  double share_within(double r) const;
};
Region region_of(const FigureParticles& of, const std::vector<double>& q);

}  // namespace hamflow::figures
