// The gas in double: what its pairs give comes from bulk forces (core/bulk_forces.hpp) for whoever asks, so that forces
// and energies have one definition of bits, whatever the method and the threads.
#pragma once

#include "gas_functions.hpp"
#include "hamflow/core/bulk_forces.hpp"

namespace hamflow {

/// @param plain the functions of the gas   @param skin of lists of neighbours
/// @return `plain` itself where phi is typed: bulk forces do not know it
std::shared_ptr<const Functions<double>> with_bulk_forces(const Gas<double>& gas,
                                                          std::shared_ptr<const Functions<double>> plain, double skin);

/// Whether functions are made of bulk forces.
bool has_bulk_forces(const Functions<double>& functions);
/// The same functions by another kernel, on so many threads. @param functions for which has_bulk_forces holds
std::shared_ptr<const Functions<double>> with_bulk_kernel(const std::shared_ptr<const Functions<double>>& functions,
                                                          BulkKernel kernel, std::size_t threads);

}  // namespace hamflow
