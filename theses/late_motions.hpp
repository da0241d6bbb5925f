// Late motions of the T-tube, those that are regular after a long transient: by their largest exponents, and by how far
// neighbours part.
#pragma once

#include <cstdint>
#include <string>

#include "study.hpp"
#include "tube_watch.hpp"

namespace hamflow::reproduction {

/// Largest Lyapunov exponents over T and 4 T time units from the end of a run. Of a regular motion neighbours part like
/// t, so that they fall like log T/T; three times that is allowed for the shear. A chaotic one has 50 times that.
struct Exponents {
  double shorter = 0, longer = 0, time = 0;
  bool regular() const {
    return std::abs(shorter) <= 3 * std::log(time) / time && std::abs(longer) <= 3 * std::log(4 * time) / (4 * time);
  }
};

/// Over so many steps, and four times as many: infinite where the motion ends, which a soft wall may do. In double,
/// since tangents of the lattice are none.
Exponents exponents_from(Study& study, const TubeSet& set, const TubeWatch& seen, const std::string& name,
                         std::int64_t steps);

/// Of located bounces each costs a hundred steps, for tangents go through it in more digits.
std::int64_t steps_in_true_flow(const Study& study);

/// Whether the late motions are regular with the listing's rule, and whether the true flow has them.
void claim_late_motions(Study& study);

}  // namespace hamflow::reproduction
