// Private to hamflow_verify.
#pragma once

#include "hamflow/verify/measure.hpp"

namespace hamflow {

/// Fills jacobian, symplectic, weakly_reversible, symmetric and reversible.
void measure_structure(const StepMap& map, const Region& region, Measurement& found);

}  // namespace hamflow
