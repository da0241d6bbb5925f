// The drift class of energies that any program has recorded: times and energies are all that is known.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "hamflow/detail/verify/drift.hpp"

namespace hamflow {

/// What the energies of a log show.
struct LogCertificate {
  RunDrift drift;                        // class, reason, growth exponent; increments in units of the largest deviation
  std::optional<double> energy_level{};  // max |E - E0|/scale; none: the scale is unknown
  std::optional<double> scale{};         // that was given, or |E0|; none: E0 is 0
  std::size_t samples = 0;
  /// None: too few samples.
  std::optional<double> growth_exponent() const {
    return drift.blocks < RunDrift::fewest_blocks ? std::nullopt : std::optional<double>(drift.growth_exponent);
  }
};

/// The first time that is not above the one before it; none: the times rise strictly.
std::optional<std::size_t> first_time_that_does_not_rise(const std::vector<double>& t);

/// Judges a log by the rules of a run's certificate (classify_run). A log has no q and p, so that
/// - oscillations are those of the energy itself, seen from block to block: at least two have to be seen for a class,
///   16 for a bounded error or a random walk;
/// - `linear` needs a rate that is steady over the four quarters of the log, but for what noise and the change itself
///   explain: else it may be a part of an oscillation slower than the log. A straight line, of E or of log |E|, and one
///   beneath independent noise, needs no oscillation. `bounded` needs quarters in which the energy goes neither way;
/// - rounding is that of four times the largest energy, since its parts are larger, or half of the smallest difference
///   of two energies where that is more, as in a log with few digits; of the steps between samples one is assumed to
///   round.
///
/// Times need not be equidistant: the log is cut into blocks of equal duration, of which each gives one of its samples.
/// Where a gap is longer than half of the 32nd part of the log the class is undecided.
///
/// @param scale that the level is a part of; without it |E0|, as far as E0 is not 0
/// @throws Error for different lengths, fewer than two samples, numbers that are not finite, times that do not rise
/// strictly, and a scale that is not positive
LogCertificate certify_log(const std::vector<double>& t, const std::vector<double>& energy,
                           std::optional<double> scale = {});

}  // namespace hamflow
