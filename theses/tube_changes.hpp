// Mean changes of the kinetic energies of the T-tube over ensembles of starts, and the expected distance of one further
// start from them, for the table of [Sonnleitner2010], pages 99 and 100.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tube_runs.hpp"

namespace hamflow::reproduction::t_tube_table {

/// The mean change over the starts of an ensemble. `moved` is how much the mean still changes in the second half of the
/// runs.
struct Change : Spread {
  double moved = 0;
};

struct Changes {
  Change first, second, both;
  int left_out = 0;
  double energy_error = 0;  // the largest of the runs that are not left out
};

inline constexpr double energy_of_heavy = 50;  // v2 = 1

/// The means of both kinetic energies over the first `blocks` blocks, minus their values at the start.
inline std::pair<double, double> mean_changes(const TubeWatch& one, std::size_t blocks) {
  const auto mean = [&](const std::vector<double>& x) { return spread_of({x.data(), x.data() + blocks}).mean; };
  return {mean(one.blocks) - one.start.v1 * one.start.v1 / 2, mean(one.heavy) - energy_of_heavy};
}

/// The changes are a few percent of H. A run with an energy error of this size is left out.
inline constexpr double most_energy_error = 0.03;

inline Changes changes_over(const std::vector<TubeWatch>& all, std::size_t blocks) {
  Changes changes;
  std::array<std::vector<double>, 3> halves, wholes;
  for (const TubeWatch& one : all) {
    if (one.blocks.size() < blocks || !(one.energy_error <= most_energy_error)) {
      ++changes.left_out;
      continue;
    }
    const auto add = [&](std::array<std::vector<double>, 3>& to, std::size_t of) {
      const auto [light, heavy] = mean_changes(one, of);
      to[0].push_back(light), to[1].push_back(heavy), to[2].push_back(light + heavy);
    };
    add(halves, blocks / 2), add(wholes, blocks);
    changes.energy_error = std::max(changes.energy_error, one.energy_error);
  }
  const auto change = [&](std::size_t i) {
    const Spread whole = spread_of(wholes[i]);
    return Change{whole, std::abs(whole.mean - spread_of(halves[i]).mean)};
  };
  changes.first = change(0), changes.second = change(1), changes.both = change(2);
  return changes;
}

/// The starts of an ensemble. The thesis starts at Q1 = 0.01. One ensemble has 64 starts within 1e-9 of it, as rounding
/// could change it. Such neighbours separate only if the motion is chaotic, so a second one has 64 starts within 1 %.
struct Starts {
  const char* name;
  const char* told;
  double from, width;  // the interval of Q1
};
inline constexpr Starts beside_start{"near", "within 1e-9 of q1 = 0.01", 0.01 - 5e-10, 1e-9};
inline constexpr Starts around_start{"grid", "on a grid of 1 % around it", 0.0099, 2e-4};

struct Ensembles {
  Changes near, grid;
  std::int64_t steps_of_near = 0, steps_of_grid = 0;

  /// The expected distance of one further start from either mean: 3 standard deviations of single starts plus twice
  /// `moved`, for the ensemble with the larger value. It is at least the distance of the two means, because neighbours
  /// within 1e-9 may stay together and then do not show how starts differ.
  double scatter(Change Changes::*of) const {
    const auto alone = [&](const Changes& one) { return 3 * (one.*of).deviation + 2 * (one.*of).moved; };
    return std::max({alone(near), alone(grid), std::abs((near.*of).mean - (grid.*of).mean)});
  }
  bool measured() const { return std::min(near.first.members, grid.first.members) > 1; }
  std::string told() const {
    return fmt::format("{} starts {}, {:g} steps: {:+.4f} and {:+.4f}; {} {}, {:g} steps: {:+.4f} and {:+.4f}; {}",
                       near.first.members, beside_start.told, static_cast<double>(steps_of_near), near.first.mean,
                       near.second.mean, grid.first.members, around_start.told, static_cast<double>(steps_of_grid),
                       grid.first.mean, grid.second.mean, left_out());
  }
  std::string left_out() const {
    const int left = near.left_out + grid.left_out;
    return fmt::format("{} of {} runs are left out, because their H is off by more than {:g} %", left,
                       left + near.first.members + grid.first.members, 100 * most_energy_error);
  }
};

/// Half a unit of the last printed digit of the table.
inline constexpr double half_a_unit = 5e-5;

/// The distance of a printed change from the nearer mean.
inline Measured distance_of(const std::string& printed, const Ensembles& changes, Change Changes::*of,
                            const char* body) {
  const double number = std::stod(printed);
  const double near = std::abs(number - (changes.near.*of).mean), grid = std::abs(number - (changes.grid.*of).mean);
  return {std::min(near, grid), changes.scatter(of),
          fmt::format("{} {}: {:.4g} and {:.4g} from the means of {}; +- for one other start", body, printed, near,
                      grid, changes.told())};
}

/// Adds to the uncertainty of a distance that was measured with another rule or step size than the thesis used: the
/// distance of the means from those with its rule and step size, and their scatter.
inline Measured by_another_way(Measured one, const Ensembles& changes, const Ensembles& usual, Change Changes::*of) {
  const double apart = std::abs((changes.near.*of).mean - (usual.near.*of).mean) + usual.scatter(of);
  one.uncertainty += apart;
  one.how += fmt::format("; +- {:.2g} for rule and step size", apart);
  return one;
}

/// Returns the number that exceeds its uncertainty by more than half a unit, or by the larger amount if both do. If
/// neither does, it returns the one with the larger upper bound.
inline Measured worse_of(const Measured& one, const Measured& two) {
  const double excess = std::max(one.value - one.uncertainty, two.value - two.uncertainty);
  if (excess > half_a_unit) return excess == one.value - one.uncertainty ? one : two;
  return one.value + one.uncertainty > two.value + two.uncertainty ? one : two;
}

}  // namespace hamflow::reproduction::t_tube_table
