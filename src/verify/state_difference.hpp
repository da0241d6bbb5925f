// Differences of states and energies that are known with more digits than double, by their decimal texts.
#pragma once

#include <string>
#include <vector>

#include "hamflow/detail/verify/magnitude.hpp"
#include "hamflow/run/simulation.hpp"

namespace hamflow {

/// q, then p, with all digits: of a simulation in double the exact decimals of its numbers.
std::vector<std::string> state_digits(const Frame& frame);
/// A double as the decimal that it is, to 45 digits: any arithmetic of the catalogue reads it back.
std::string exact_digits(double x);

/// max_i |a_i - b_i|/sizes_i, formed with so many digits.
Magnitude largest_difference(const std::vector<std::string>& a, const std::vector<std::string>& b,
                             const std::vector<double>& sizes, int digits);
/// |a - b|/scale.
Magnitude relative_difference(const std::string& a, const std::string& b, double scale, int digits);

}  // namespace hamflow
