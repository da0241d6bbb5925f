// Does the energy error drift, walk, or stay? Statistics of recorded energies, of one run or of an ensemble.
// [spec: methods, section 1]
#pragma once

#include <string_view>
#include <vector>

namespace hamflow {

/// `linear`: the mean increment is not 0, or the error grows faster than t^0.7. `random_walk`: like t^0.5, as rounding
/// errors without bias do (Brouwer's law).
enum class DriftClass { bounded, random_walk, linear };

constexpr std::string_view name(DriftClass drift) {
  switch (drift) {
    case DriftClass::bounded:
      return "bounded";
    case DriftClass::random_walk:
      return "random walk";
    case DriftClass::linear:
      return "linear";
  }
  return "unknown";
}

struct DriftStatistics {
  static constexpr double level = 1e-4;             // of the t-test
  static constexpr double linear_above = 0.7;       // growth exponents
  static constexpr double random_walk_above = 0.3;  //
  double p_value = 1;                               // of "the mean increment is 0", corrected for the number of starts
  double growth_exponent = 0;                       // of the RMS error over the starts, from dyadic windows of time
  DriftClass drift = DriftClass::bounded;
};

/// P(|T| >= |t|) for Student's t with a whole number of degrees of freedom.   [Abramowitz, Stegun, 26.7.3, 26.7.4]
double student_p_value(double t, int degrees_of_freedom);

/// The slope of a straight line through (x_i, y_i), least squares.
double fitted_slope(const std::vector<double>& x, const std::vector<double>& y);

/// @param energies for each start, H at the start and after each of at least 32 blocks of equal length. A series that
/// is shorter than the others, or not finite, is one that broke down: linear.
DriftStatistics classify_drift(const std::vector<std::vector<double>>& energies);

}  // namespace hamflow
