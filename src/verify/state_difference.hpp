// Differences of states and energies, computed from decimal texts with more digits than double.
#pragma once

#include <string>
#include <vector>

#include "hamflow/detail/verify/magnitude.hpp"
#include "hamflow/run/simulation.hpp"

namespace hamflow {

/// Returns q, then p, with all digits. For a simulation in double these are the exact decimals of its numbers.
std::vector<std::string> state_digits(const Frame& frame);
/// Returns the exact decimal value of a double, to 45 digits, which every arithmetic of the catalogue reads.
std::string exact_digits(double x);

/// Returns max_i |a_i - b_i|/sizes_i, computed with `digits` digits.
Magnitude largest_difference(const std::vector<std::string>& a, const std::vector<std::string>& b,
                             const std::vector<double>& sizes, int digits);
/// Returns |a - b|/scale.
Magnitude relative_difference(const std::string& a, const std::string& b, double scale, int digits);

}  // namespace hamflow
