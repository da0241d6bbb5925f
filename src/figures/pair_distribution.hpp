// How far the particles of a gas are from each other.
#pragma once

#include <cstdint>
#include <vector>

#include "figure.hpp"

namespace hamflow::figures {

/// Pairs by their distance: bin k has those from k r_max/bins on, below (k + 1) r_max/bins. In a periodic box a pair is
/// as far apart as its nearest images. Found cell by cell, in a time that is proportional to the pairs within r_max.
/// @param q particle by particle   @param space 2 or 3   @param edges of a periodic box, with r_max at most half the
/// shortest; empty: none
std::vector<std::int64_t> pair_counts(const std::vector<double>& q, std::size_t space, const std::vector<double>& edges,
                                      double r_max, std::size_t bins);

/// What holds the particles, as far as their distances are concerned; of no container the box around them all.
struct Region {
  bool periodic = false;
  double radius = 0;            // of a circle or sphere; 0: a box
  std::vector<double> edges{};  // of a box
  std::size_t space = 2;

  double volume() const;
  double shortest() const;  // edge, or diameter
  /// The share of pairs of points, spread evenly over the region, that are at most r apart; r at most shortest() / 2 in
  /// a periodic box, else shortest().
  double share_within(double r) const;
};
Region region_of(const FigureParticles& of, const std::vector<double>& q);

}  // namespace hamflow::figures
