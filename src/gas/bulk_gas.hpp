// The gas in double with its pairs computed all at once (core/bulk_forces.hpp), and its container added after them.
#pragma once

#include <optional>

#include "gas_functions.hpp"
#include "hamflow/core/bulk_forces.hpp"

namespace hamflow {

/// What the pairs of a gas are for the engine; nothing where phi is typed.
std::optional<BulkPairSystem> bulk_pair_system(const Gas<double>& gas, double skin);

/// The functions of a gas with those of the engine, where it knows the pairs and they are many.
/// @param threads that compute them; they change no bit
ErasedFunctions<double> with_bulk_forces(ErasedFunctions<double> functions, const Gas<double>& gas, double skin,
                                         std::size_t threads);

}  // namespace hamflow
