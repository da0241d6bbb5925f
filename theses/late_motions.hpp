// Motions of the T-tube that are regular after a long transient ("late motions"). Lyapunov exponents and the distance
// of neighbouring trajectories show whether they are.
#pragma once

#include <cstdint>
#include <string>

#include "study.hpp"
#include "tube_runs.hpp"

namespace hamflow::reproduction {

/// The largest Lyapunov exponents over T and 4 T time units from the end of a run. Neighbours of a regular motion
/// separate linearly, so its exponents are near log T/T. The limit is three times that, because shear adds to it.
/// Chaotic motions have 50 times that.
struct Exponents {
  double shorter = 0, longer = 0, time = 0;
  bool regular() const {
    return std::abs(shorter) <= 3 * std::log(time) / time && std::abs(longer) <= 3 * std::log(4 * time) / (4 * time);
  }
};

/// Measures the exponents over `steps` and 4 `steps` steps. An exponent is infinite if the run fails, for example at a
/// soft wall. The arithmetic is double, because the lattice has no tangent vectors.
Exponents exponents_from(Study& study, const TubeSet& set, const TubeWatch& seen, const std::string& name,
                         std::int64_t steps);

/// The number of steps with located bounces. It is smaller, because a located bounce costs as much as a hundred steps:
/// tangent vectors pass it with more digits.
std::int64_t steps_in_true_flow(const Study& study);

/// Claims that the late motions are regular with the rule of the listing, and that the true flow has them, too.
void claim_late_motions(Study& study);

}  // namespace hamflow::reproduction
