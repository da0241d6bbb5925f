// The Sun with the inner planets' mass, and Jupiter to Pluto.   [HLW2006, Sect. I.2.4]
#pragma once

#include "hamflow/detail/problems/solar_bodies.hpp"

namespace hamflow {

template <class R = double>
class SolarSystem : public SolarSystemOf<R, outer_solar_bodies> {
 public:
  using SolarSystemOf<R, outer_solar_bodies>::SolarSystemOf;

  static ProblemInfo info() {
    ProblemInfo all = SolarSystem::info_of_set("HLW2006, Sect. I.2.4", 50, 1000, 20);
    all.example.steps = 80000;  // 17 revolutions of Pluto
    all.default_choices = {SolarBodies::key};
    return all;
  }
};

}  // namespace hamflow
