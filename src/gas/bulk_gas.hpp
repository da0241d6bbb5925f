// The gas in double, with all pairs computed in one call (core/bulk_forces.hpp) and the container added afterwards.
#pragma once

#include <optional>

#include "gas_functions.hpp"
#include "hamflow/core/bulk_forces.hpp"

namespace hamflow {

/// The pairs of a gas as a BulkPairSystem; empty if phi is typed.
std::optional<BulkPairSystem> bulk_pair_system(const Gas<double>& gas, double skin);

/// The functions of a gas, using bulk forces if these know the pair law and there are many particles.
/// @param threads number of threads; does not change a bit
ErasedFunctions<double> with_bulk_forces(ErasedFunctions<double> functions, const Gas<double>& gas, double skin,
                                         std::size_t threads);

}  // namespace hamflow
