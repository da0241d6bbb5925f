// By which iteration the steps of a large sparse system are solved where nobody says.
#pragma once

#include "erased.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Below them Newton's matrix costs no more than a few evaluations.
inline constexpr std::size_t fewest_unknowns_by_fixed_points = 100;

/// The method with iteration = "fixed-point-or-newton" where nothing is said of the iteration, H has few second
/// derivatives that are not 0, and fixed points cost less; else as it is. It is decided by the start and the step
/// alone, once a run, so that all roads of a run take the same.
/// @param q, p the start   @param h the step length
MethodSpec with_cheaper_iteration(const MethodSpec& method, const ErasedFunctions<double>& functions,
                                  const Vector<double, dynamic>& q, const Vector<double, dynamic>& p, double h);

}  // namespace hamflow
