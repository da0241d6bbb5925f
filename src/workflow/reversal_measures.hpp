// What a reversal lost, in numbers: digits, and of bodies the errors in the measure of Sonnleitner2010, p. 72.
#pragma once

#include "hamflow/scenario/scenario.hpp"
#include "hamflow/verify/certificate.hpp"
#include "hamflow/workflow/reverse.hpp"

namespace hamflow {

/// How many bodies, or particles, the state of a scenario has; 0 where it has none.
std::size_t bodies_in(const Scenario& scenario);

/// log10 of the relative distance over the rounding unit of the arithmetic, half of its epsilon; 0 where every digit
/// came back.
double digits_lost(const Reversal& reversal, const std::string& arithmetic);

ReturnError return_error(const Reversal& reversal, std::size_t bodies);

}  // namespace hamflow
