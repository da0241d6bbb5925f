// Classifies the energy error of one run or an ensemble by statistics of recorded energies: bounded, random walk,
// linear. docs/design/certificates.md explains why these statistics are used.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hamflow {

/// `linear`: the mean increment is not 0, or the error grows faster than t^0.7. `random_walk`: the error grows like
/// t^0.5, as unbiased rounding errors do (Brouwer's law [Brouwer1937]).
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
  static constexpr double level = 1e-4;             // significance level of the t-test
  static constexpr double linear_above = 0.7;       // limits of the growth exponent
  static constexpr double random_walk_above = 0.3;  //
  double p_value = 1;                               // of "the mean increment is 0", corrected for the number of starts
  double growth_exponent = 0;                       // of the RMS error over the starts, from dyadic windows of time
  std::optional<DriftClass> drift = DriftClass::bounded;  // none: a run broke down, and the numbers are NaN
};

/// The energy of one run, once in each of consecutive blocks of equal length.
struct EnergySeries {
  std::vector<double> deviations;   // H - H0 in any unit, the start (0) first; squares must not overflow
  std::optional<double> periods{};  // periods seen of the slowest oscillation of q and p; none: no turning point
  bool steady = true;               // false: turning points only occurred before the range of the motion doubled
  bool outgrown = false;            // a coordinate or momentum had turning points, but none since its range doubled
  double still = 0;                 // if oscillations have ended: the final fraction of the run without turning points
  bool symplectic = false;          // symplectic with equal steps: the energy has no drift [HLW2006, Thm. IX.8.1]
  bool bounces = false;             // bounces off walls at which the energy makes a random walk
  bool copies = false;              // the method carries a copy of the state, from which the state may separate
  double rounding = 0;          // rounding error of one energy: unit of rounding times the largest scale during the run
  bool rounding_grows = false;  // the rounding grows with a coordinate that keeps growing
  double roundings = 0;         // number of rounded operations (kicks, drifts)
  double scale = 1;             // size of the energy itself
};

/// The drift class of one run, with the statistics behind it.
struct RunDrift {
  static constexpr int fewest_blocks = 32;
  static constexpr double sign_level = 1e-6;
  static constexpr double fewest_periods = 2;
  static constexpr double periods_to_be_told = 16;  // needed for the classes random walk and bounded
  int blocks = 0;
  std::optional<double> periods;    // periods of the slowest oscillation, also of the energy; none: no oscillation
  std::optional<DriftClass> drift;  // none: undecided
  std::string reason;               // for the class, or for being undecided
  double p_value = 1;               // of "the mean increment of a block is 0", t-test
  double sign_p_value = 1;          // of "increments are as often positive as negative", sign test
  double growth_exponent = 0;       // of the RMS change over a lag
  double growth_uncertainty = 0;    // its standard error
  double mean_increment = 0;        // of the energy, over a block
  double mean_increment_error = 0;  // its standard error
  double trend_not_excluded = 0;    // largest steady drift over a block that the t-test does not exclude
};

/// The value that |T| exceeds with this probability, for Student's t.
double student_quantile(double p_value, int degrees_of_freedom);

/// P(|T| >= |t|) for Student's t with a whole number of degrees of freedom, from 1.   [AbramowitzStegun1964, 26.7]
double student_p_value(double t, int degrees_of_freedom);

/// The slope of a straight line through (x_i, y_i), least squares.
double fitted_slope(const std::vector<double>& x, const std::vector<double>& y);

/// @param energies for each start, H at the start and after each of at least 32 blocks of equal length. A series that
/// is shorter than the others or not finite belongs to a run that broke down; then the class is unknown.
DriftStatistics classify_drift(const std::vector<std::vector<double>>& energies);

/// Classifies one run. `linear`: a test rejects and the trend is significant. The sign test finds drifts that change
/// their speed (the energy of euler on a widening orbit), which a t-test cannot see. `random_walk`: exponent,
/// correlation of increments and size are those of summed rounding errors. `bounded`: there is neither a trend nor
/// growth. The last two need at least 16 periods. The class is undecided, with a reason, if these criteria do not
/// agree, and for runs of fewer than 32 blocks or less than two periods.
///
/// The growth exponent is the slope of log S(m) over log m, halved, where S(m) is the mean of (E_(i+m) - E_i)^2 over
/// all i (structure function). S grows like m for a walk and like m^2 for a drift, and is constant for an oscillation
/// that the blocks do not resolve. For a resolved oscillation S rises like m^2 at first; so the lags m are left out up
/// to the first at which the correlation of neighbouring increments, (S(2m) - 2 S(m))/(2 S(m)), is not above 2
/// sqrt(m/B). The lags are weighted by the variance of ln S(m) for a walk of B increments, 2 (2 m^2 + 1)/(3 m B).
/// [LoMacKinlay1988, for the variance ratio]
RunDrift classify_run(const EnergySeries& series);

}  // namespace hamflow
