// The Sun, the eight planets and Pluto.   [Chambers1999]
#pragma once

#include "hamflow/detail/problems/solar_bodies.hpp"

namespace hamflow {

template <class R = double>
class WholeSolarSystem : public SolarSystemOf<R, all_solar_bodies> {
 public:
  using SolarSystemOf<R, all_solar_bodies>::SolarSystemOf;

  static ProblemInfo info() {
    return WholeSolarSystem::info_of_set("Chambers1999, JD 2451000.5", 1, 20, 2);  // Mercury takes 88 days
  }
};

}  // namespace hamflow
