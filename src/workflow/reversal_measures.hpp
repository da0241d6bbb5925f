// What a reversal lost, in numbers: digits, and of bodies the errors in the measure of Sonnleitner2010, p. 72.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "hamflow/scenario/scenario.hpp"
#include "hamflow/verify/certificate.hpp"

namespace hamflow {

/// How many bodies, or particles, the state of a scenario has; 0 where it has none.
std::size_t bodies_in(const Scenario& scenario);

/// log10 of the relative distance over the rounding unit of the arithmetic, half of its epsilon; 0 where every digit
/// came back.
double digits_lost(const Reversal& reversal, const std::string& arithmetic);

/// {`position`, `momentum`: sqrt(sum |difference|^2)/N; `position_rms`, `momentum_rms`: sqrt(sum |difference|^2/N)},
/// over N bodies.
nlohmann::ordered_json return_error(const Reversal& reversal, std::size_t bodies);

}  // namespace hamflow
