// The default iteration for the steps of large sparse systems.
#pragma once

#include "erased.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// With fewer unknowns Newton's matrix costs only a few evaluations.
inline constexpr std::size_t fewest_unknowns_by_fixed_points = 100;

/// The method with iteration = "fixed-point-or-newton" if no iteration is given, most second derivatives of H are 0 and
/// fixed points cost less; otherwise the method unchanged. Only the start and the step decide this, once per run, so
/// that all ways to run it make the same choice.
/// @param q, p the start   @param h the step size
MethodSpec with_cheaper_iteration(const MethodSpec& method, const ErasedFunctions<double>& functions,
                                  const Vector<double, dynamic>& q, const Vector<double, dynamic>& p, double h);

}  // namespace hamflow
