// Does the energy error drift, walk, or stay? Statistics of recorded energies, of one run or of an ensemble.
// Why these statistics is explained in docs/design/certificates.md.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hamflow {

/// `linear`: the mean increment is not 0, or the error grows faster than t^0.7. `random_walk`: like t^0.5, as rounding
/// errors without bias do (Brouwer's law [Brouwer1937]).
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
  std::optional<DriftClass> drift = DriftClass::bounded;  // none: a run broke down, and no number is one
};

/// The energy of one run, once in each of consecutive blocks of equal length.
struct EnergySeries {
  std::vector<double> deviations;   // H - H0 in a unit of the caller's, the start (0) first; squares must not overflow
  std::optional<double> periods{};  // of the slowest oscillation of q and p that was seen; none: nothing turned back
  bool steady = true;               // false: only what the motion has outgrown since has turned back
  bool outgrown = false;            // one of q and p has turned back, but not since its range doubled last
  double still = 0;         // the last part of the run in which nothing turned back, where oscillations are over
  bool symplectic = false;  // with equal steps: its energy has no drift over any run [HLW2006, Thm. IX.8.1]
  bool bounces = false;     // off walls that its energy walks at
  bool copies = false;      // the method carries a copy of the state, from which the state may part
  double rounding = 0;      // of one energy: the rounding unit times its scale, at the end of the run where it is more
  bool rounding_grows = false;  // with a coordinate that keeps growing
  double roundings = 0;         // how many rounded actions were taken, of which each may leave one
  double scale = 1;             // of the energy itself
};

/// What is concluded of it.
struct RunDrift {
  static constexpr int fewest_blocks = 32;
  static constexpr double sign_level = 1e-6;
  static constexpr double fewest_periods = 2;
  static constexpr double periods_to_be_told = 16;  // of a random walk, or of a bounded error
  int blocks = 0;
  std::optional<double> periods;    // of the slowest oscillation seen, of the energy too; none was seen
  std::optional<DriftClass> drift;  // none: undecided, for the reason given
  std::string reason;               // for the class, or for having none
  double p_value = 1;               // of "the mean increment of a block is 0", t-test
  double sign_p_value = 1;          // of "an increment is as often up as down": a drift that slows down or speeds up
  double growth_exponent = 0;       // of the RMS change over a lag
  double growth_uncertainty = 0;    // its standard error
  double mean_increment = 0;        // of the energy, over a block
  double mean_increment_error = 0;  // its standard error
  double trend_not_excluded = 0;    // over a block: no steady drift above it is compatible with the t-test
};

/// The t that |T| exceeds with this probability.
double student_quantile(double p_value, int degrees_of_freedom);

/// P(|T| >= |t|) for Student's t with a whole number of degrees of freedom, from 1.   [AbramowitzStegun1964, 26.7]
double student_p_value(double t, int degrees_of_freedom);

/// The slope of a straight line through (x_i, y_i), least squares.
double fitted_slope(const std::vector<double>& x, const std::vector<double>& y);

/// @param energies for each start, H at the start and after each of at least 32 blocks of equal length. A series that
/// is shorter than the others, or not finite, is one that broke down: what the energy of whole runs does is not known.
DriftStatistics classify_drift(const std::vector<std::vector<double>>& energies);

/// `linear`: one of the tests rejects and the trend stands out. The sign test is for drifts that change their speed
/// (the energy of euler on an orbit that widens), which a t-test cannot see. `random_walk`: the exponent, the whiteness
/// of the increments and the size are those of summed rounding errors. `bounded`: neither trend nor growth. Both over
/// at least 16 periods. None, with the reason, wherever these do not agree, and for runs of fewer than 32 blocks or
/// less than two periods.
///
/// The growth exponent is the slope of log S(m) over log m, halved, where S(m) is the mean of (E_(i+m) - E_i)^2 over
/// all i (structure function): m for a walk, m^2 for a drift, constant for an oscillation that the blocks do not
/// resolve. One that they do resolve rises like m^2 before it turns: lags below the first at which (S(2m) - 2 S(m))/(2
/// S(m)), the correlation of neighbouring increments, is no longer above 2 sqrt(m/B) are left out. For a walk of B
/// increments ln S(m) has the variance 2 (2 m^2 + 1)/(3 m B), by which the lags are weighted.   [LoMacKinlay1988,
/// for the variance ratio]
RunDrift classify_run(const EnergySeries& series);

}  // namespace hamflow
