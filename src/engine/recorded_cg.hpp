// cg(1) in double on a problem behind virtual calls with few coordinates, its equations recorded.
#pragma once

#include "erased.hpp"
#include "hamflow/detail/methods/cg_options.hpp"

namespace hamflow {

/// Null if the problem has too many coordinates.
/// @param request determines whether steps vary
std::unique_ptr<Simulation> simulate_recorded_element(const ErasedRun<double>& run, const Request& request,
                                                      const CgOptions& options);

}  // namespace hamflow
