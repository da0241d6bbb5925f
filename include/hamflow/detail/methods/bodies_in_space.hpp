// Positions and velocities of bodies in the coordinates of a planetary splitting, and what a step adds to them.
#pragma once

#include <cstddef>

#include "hamflow/core/vector.hpp"
#include "hamflow/detail/methods/close_encounter.hpp"
#include "hamflow/orbits/kepler_drift.hpp"

namespace hamflow {

/// A step adds to r and v, and to their increments since the state was made, which every arithmetic adds in its own
/// way.
template <class R>
struct BodiesInSpace {
  using Space = Vector<R, 3>;
  PooledList<Space> r;
  PooledList<Space> v;
  PooledList<Space> added_r;
  PooledList<Space> added_v;

  void add(std::size_t i, const KeplerIncrements<R, 3>& by) {
    for (std::size_t k = 0; k < 3; ++k) {
      r[i][k] += by.position[k];
      added_r[i][k] += by.position[k];
      r[i][k] += by.position_rest[k];
      added_r[i][k] += by.position_rest[k];
      v[i][k] += by.velocity[k];
      added_v[i][k] += by.velocity[k];
      v[i][k] += by.velocity_rest[k];
      added_v[i][k] += by.velocity_rest[k];
    }
  }
};

}  // namespace hamflow
