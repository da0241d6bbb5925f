// What simulations by splittings into Kepler motions tell in addition.
#pragma once

#include <memory>
#include <optional>
#include <type_traits>

#include "hamflow/detail/methods/close_encounter.hpp"
#include "hamflow/run/simulation.hpp"

namespace hamflow {

struct CloseEncounter {
  EncounterOfTwo bodies;
  double time = 0;  // at the end of the step in which it was seen
};

class PlanetarySteps {
 public:
  virtual ~PlanetarySteps() = default;
  /// The first encounter within 3 Hill radii; nullopt if there was none.
  virtual std::optional<CloseEncounter> first_encounter() const = 0;
  /// Whether energy and invariants are watched at every step, or only in states that look() shows.
  virtual bool watches_every_step() const = 0;

 protected:
  PlanetarySteps() = default;
  PlanetarySteps(const PlanetarySteps&) = default;
  PlanetarySteps& operator=(const PlanetarySteps&) = default;
};

/// A method that watches for encounters in its steps.
template <class M>
concept EncounterWatcher = requires(const M& method) {
  method.first_encounter().step;
};

/// The encounter that a method has seen in steps of a clock from its start on.
template <EncounterWatcher M, class Clock>
std::optional<CloseEncounter> encounter_of(const M& method, const Clock& clock) {
  const auto& found = method.first_encounter();
  if (found.step == 0) return {};
  return CloseEncounter{{found.one, found.other}, static_cast<double>(clock.time_after(found.step - clock.position()))};
}

struct NotPlanetary {};
/// The interface, if the method of a simulation watches for encounters.
template <bool watches>
using PlanetaryStepsIf = std::conditional_t<watches, PlanetarySteps, NotPlanetary>;

/// A simulation whose method watches for encounters.
template <class Base>
class PlanetarySimulation final : public Base, public PlanetarySteps {
 public:
  using Base::Base;
  std::optional<CloseEncounter> first_encounter() const override { return encounter_of(Base::method_, Base::clock_); }
  bool watches_every_step() const override { return true; }
  std::unique_ptr<Simulation> clone() const override { return std::make_unique<PlanetarySimulation>(*this); }
};

}  // namespace hamflow
