// Pairs by distance, cell by cell, against a loop over all pairs; and how many there would be without any order.
#include "pair_distribution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace hamflow::figures {
namespace {

std::vector<std::int64_t> by_all_pairs(const std::vector<double>& q, std::size_t space,
                                       const std::vector<double>& edges, double r_max, std::size_t bins) {
  std::vector<std::int64_t> found(bins, 0);
  for (std::size_t i = 0; i < q.size(); i += space) {
    for (std::size_t j = 0; j < i; j += space) {
      double square = 0;
      for (std::size_t k = 0; k < space; ++k) {
        double d = q[i + k] - q[j + k];
        if (!edges.empty()) d -= edges[k] * std::round(d / edges[k]);
        square += d * d;
      }
      const auto bin = static_cast<std::size_t>(std::sqrt(square) * static_cast<double>(bins) / r_max);
      if (square < r_max * r_max) ++found[std::min(bin, bins - 1)];
    }
  }
  return found;
}

std::vector<double> random_points(std::size_t count, const std::vector<double>& edges, std::mt19937_64& random) {
  std::vector<double> q;
  for (std::size_t i = 0; i < count * edges.size(); ++i) {
    q.push_back((std::uniform_real_distribution<>(0, 1)(random) - 0.5) * edges[i % edges.size()]);
  }
  return q;
}

TEST(PairDistribution, CellsFindThePairsOfTheLoop) {
  std::mt19937_64 random(3);
  for (const std::vector<double>& edges : {std::vector<double>{2, 3}, {2, 3, 2.5}}) {
    for (const double r_max : {0.1, 0.31, 0.7, 1.0}) {
      for (const bool periodic : {false, true}) {
        std::vector<double> q = random_points(300, edges, random);
        // Positions are not folded: whole edges more are the same place. A multiple of a power of two moves no bit
        // here.
        for (std::size_t i = 0; periodic && i < q.size(); i += 7) q[i] += 2 * edges[i % edges.size()];
        const std::vector<double> box = periodic ? edges : std::vector<double>();
        const auto found = pair_counts(q, edges.size(), box, r_max, 1);
        // Rounding of a folded position decides for a pair at the very edge of a bin only: one bin has no edge inside.
        EXPECT_EQ(found, by_all_pairs(q, edges.size(), box, r_max, 1)) << r_max << periodic;
        std::int64_t sum = 0;
        for (const std::int64_t n : pair_counts(q, edges.size(), box, r_max, 20)) sum += n;
        EXPECT_EQ(sum, found[0]);
      }
    }
  }
}

TEST(PairDistribution, OfALatticeAreItsShells) {
  std::vector<double> q;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) q.insert(q.end(), {i - 2.5, j - 2.5});
  }
  // 36 particles with 4 neighbours each at 1, at sqrt(2) and at 2, 72 pairs each, and 8 at sqrt(5).
  EXPECT_EQ(pair_counts(q, 2, {6, 6}, 2.25, 9), (std::vector<std::int64_t>{0, 0, 0, 0, 72, 72, 0, 0, 216}));
}

TEST(PairDistribution, PointsWithoutOrderAreShared) {
  std::mt19937_64 random(4);
  constexpr double n = 3000;
  FigureParticles circle{.count = 3000, .space = 2, .container = "circle", .radius = 1.5};
  FigureParticles sphere{.count = 3000, .space = 3, .container = "circle", .radius = 1.5};
  FigureParticles flat{.count = 3000, .space = 2, .container = "box", .edges = {2, 3}};
  FigureParticles box{.count = 3000, .space = 3, .container = "box", .edges = {2, 3, 2.5}};
  FigureParticles periodic{.count = 3000, .space = 3, .container = "periodic", .edges = {2, 3, 2.5}};
  for (const FigureParticles& of : {circle, sphere, flat, box, periodic}) {
    std::vector<double> q;
    while (q.size() < of.count * of.space) {
      const std::vector<double> edges = of.radius > 0 ? std::vector<double>(of.space, 3.0) : of.edges;
      const std::vector<double> point = random_points(1, edges, random);
      double square = 0;
      for (const double x : point) square += x * x;
      if (of.radius == 0 || square < 1.5 * 1.5) q.insert(q.end(), point.begin(), point.end());
    }
    const Region region = region_of(of, q);
    for (const double part : {0.1, 0.3, 0.5}) {
      const double r = part * region.shortest();
      const auto found = pair_counts(q, of.space, region.periodic ? of.edges : std::vector<double>(), r, 1);
      const double share = region.share_within(r);
      // Pairs of independent points: the spread of their number is that of a count, and of how many neighbours a
      // particle has on the whole, at most 2 sqrt(share (1 - share)/n) of share. Five times it.
      const double pairs = n * (n - 1) / 2;
      const double spread = 5 * (std::sqrt(share / pairs) + 2 * share * std::sqrt((1 - share) / n));
      EXPECT_NEAR(static_cast<double>(found[0]) / pairs, share, spread) << of.container << of.space << " " << part;
    }
  }
  // Everything is within the diameter, and near a point there is no edge.
  EXPECT_NEAR((Region{false, 1.5, {}, 2}.share_within(3)), 1, 4 * 0x1p-52);
  EXPECT_NEAR((Region{false, 1.5, {}, 3}.share_within(3)), 1, 4 * 0x1p-52);
  const double small = 1e-3;
  EXPECT_NEAR(
      (Region{false, 1.5, {}, 2}.share_within(small)) / (std::numbers::pi * small * small / 2.25 / std::numbers::pi), 1,
      2 * small);
}

}  // namespace
}  // namespace hamflow::figures
