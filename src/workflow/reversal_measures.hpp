// Measures what a reversal has lost: digits, and for bodies the return error of [Sonnleitner2010, p. 72].
#pragma once

#include "hamflow/scenario/scenario.hpp"
#include "hamflow/verify/certificate.hpp"
#include "hamflow/workflow/reverse.hpp"

namespace hamflow {

/// Returns the number of bodies or particles in the state of a scenario; 0 if it has none.
std::size_t bodies_in(const Scenario& scenario);

/// Returns log10 of the relative distance divided by the rounding unit of the arithmetic (half of its epsilon); 0 if no
/// digit was lost.
double digits_lost(const Reversal& reversal, const std::string& arithmetic);

BodyReversalError return_error(const Reversal& reversal, std::size_t bodies);

}  // namespace hamflow
