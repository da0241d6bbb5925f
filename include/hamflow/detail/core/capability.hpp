// The capabilities of a problem: the concepts of core/concepts.hpp as flags.
#pragma once

#include "hamflow/core/constraints.hpp"
#include "hamflow/detail/core/point_masses.hpp"
#include "hamflow/detail/core/radial_forces.hpp"

namespace hamflow {

enum class Capability : unsigned {
  smooth = 0,             // gradient and Hessian of H; every problem of the catalogue has them
  separable = 1,          // H = T(p) + V(q)
  quadratic_kinetic = 2,  // T quadratic with constant mass matrix
  cyclic = 4,             // the last coordinate is cyclic
  charge = 8,             // a charge in a uniform magnetic field
  radial = 16,            // forces along the lines between bodies or to a centre
  constrained = 32,       // constraints g(q) = 0
  gravitating = 64        // bodies that attract each other as points
};
constexpr Capability operator|(Capability a, Capability b) {
  return static_cast<Capability>(static_cast<unsigned>(a) | static_cast<unsigned>(b));
}
/// Whether `offered` has all flags of `wanted`.
constexpr bool includes(Capability offered, Capability wanted) { return (offered | wanted) == offered; }

template <class P>
constexpr Capability capabilities_of() {
  Capability all = Capability::smooth;
  if constexpr (Separable<P>) all = all | Capability::separable;
  if constexpr (QuadraticKinetic<P>) all = all | Capability::quadratic_kinetic;
  if constexpr (Cyclic<P>) all = all | Capability::cyclic;
  if constexpr (ChargeInField<P>) all = all | Capability::charge;
  if constexpr (RadialForces<P>) all = all | Capability::radial;
  if constexpr (Constrained<P>) all = all | Capability::constrained;
  if constexpr (GravitatingBodies<P>) all = all | Capability::gravitating;
  return all;
}

}  // namespace hamflow
