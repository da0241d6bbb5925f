// Finds the drift class of the energy error of one run or an ensemble from recorded energies: bounded, random walk or
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
  static constexpr double linear_above = 0.7;       // upper limits of the growth exponent of random walk,
  static constexpr double random_walk_above = 0.3;  // and of bounded
  // p-value of "the mean increment is 0", corrected for the number of starts
  double p_value = 1;
  // growth of the RMS error over the starts, from dyadic windows of time
  double growth_exponent = 0;
  std::optional<DriftClass> drift = DriftClass::bounded;  // nullopt: a run broke down, and the numbers are NaN
};

/// The energies of one run, one for each of consecutive blocks of equal length.
struct EnergySeries {
  // H - H0 in any unit, beginning with 0 for the start; their squares must not overflow
  std::vector<double> deviations;
  std::optional<double> periods{};  // periods seen of the slowest oscillation of q and p; nullopt: no turning point
  std::string counted = "periods";  // what `periods` counts, for messages
  bool steady = true;               // false: all turning points came before the range of the motion last doubled
  // a coordinate or momentum had turning points, but none since its range last doubled
  bool outgrown = false;
  // if the oscillations have ended: fraction of the run, at its end, without turning points
  double still = 0;
  // the method is symplectic with equal steps, so the energy has no drift [HLW2006, Thm. IX.8.1]
  bool symplectic = false;
  bool bounces = false;  // the run bounces off walls, where the energy makes a random walk
  bool copies = false;   // the method carries a copy of the state that may separate from the state
  // rounding error of one energy: the rounding unit times the largest scale during the run
  double rounding = 0;
  bool rounding_grows = false;  // the rounding error grows with a coordinate that keeps growing
  double roundings = 0;         // number of rounded operations (kicks, drifts)
  double scale = 1;             // size of the energy itself
};

/// Drift class of one run, with the statistics that decide it.
struct RunDrift {
  static constexpr int fewest_blocks = 32;
  static constexpr double sign_level = 1e-6;
  static constexpr double fewest_periods = 2;
  static constexpr double periods_to_be_told = 16;  // fewest periods for the classes random walk and bounded
  int blocks = 0;
  // periods seen of the slowest oscillation, including those of the energy; nullopt: no oscillation
  std::optional<double> periods;
  std::optional<DriftClass> drift;  // nullopt: undecided
  std::string reason;               // explains the class, or why it is undecided
  double p_value = 1;               // p-value of "the mean increment of a block is 0", t-test
  double sign_p_value = 1;          // p-value of "increments are as often positive as negative", sign test
  double growth_exponent = 0;       // growth of the RMS change with the lag
  double growth_uncertainty = 0;    // standard error of growth_exponent
  double mean_increment = 0;        // increment of the energy over a block
  double mean_increment_error = 0;  // standard error of mean_increment
  double trend_not_excluded = 0;    // largest steady drift over a block that the t-test does not exclude
};

/// Returns the value that |T| exceeds with this probability, where T follows Student's t distribution.
double student_quantile(double p_value, int degrees_of_freedom);

/// Returns P(|T| >= |t|) for Student's t distribution with at least one degree of freedom.   [AbramowitzStegun1964,
/// 26.7]
double student_p_value(double t, int degrees_of_freedom);

/// Returns the least-squares slope of a straight line through (x_i, y_i).
double fitted_slope(const std::vector<double>& x, const std::vector<double>& y);

/// Classifies an ensemble. @param energies for each start, H at the start and after each of at least 32 blocks of equal
/// length. A series that is shorter than the others or not finite belongs to a run that broke down, and makes the class
/// unknown.
DriftStatistics classify_drift(const std::vector<std::vector<double>>& energies);

/// Classifies one run. `linear`: a test rejects and the trend is significant. The sign test finds drifts that change
/// their rate (the energy of euler on a widening orbit), which a t-test misses. `random_walk`: exponent, correlation of
/// increments and size agree with summed rounding errors. `bounded`: there is neither a trend nor growth. The last two
/// classes need at least 16 periods. The class is undecided, with a reason, if the criteria contradict each other, and
/// for runs of fewer than 32 blocks or less than two periods.
///
/// The growth exponent is half of the slope of log S(m) over log m, where S(m) is the mean of (E_(i+m) - E_i)^2 over
/// all i (structure function). S grows like m for a random walk and like m^2 for a drift, and is constant for an
/// oscillation that the blocks do not resolve. For a resolved oscillation S first rises like m^2. Therefore lags m are
/// left out up to the first one at which the correlation of neighbouring increments, (S(2m) - 2 S(m))/(2 S(m)), is not
/// above 2 sqrt(m/B). The lags are weighted by the variance of ln S(m) for a walk of B increments, 2 (2 m^2 + 1)/(3 m
/// B).   [LoMacKinlay1988, for the variance ratio]
RunDrift classify_run(const EnergySeries& series);

}  // namespace hamflow
