// The drift class of energies in the log of any program. Only times and energies are known.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "hamflow/detail/verify/drift.hpp"

namespace hamflow {

/// The result for the energies of a log.
struct LogCertificate {
  RunDrift drift;                        // class, reason, growth exponent; increments in units of the largest deviation
  std::optional<double> energy_level{};  // max |E - E0|/scale; none: the scale is unknown
  std::optional<double> scale{};         // the given scale, or |E0|; none: E0 is 0
  std::size_t samples = 0;
  /// None: too few samples.
  std::optional<double> growth_exponent() const {
    return drift.blocks < RunDrift::fewest_blocks ? std::nullopt : std::optional<double>(drift.growth_exponent);
  }
};

/// The index of the first time that is not larger than the one before; nullopt: the times increase strictly.
std::optional<std::size_t> first_time_that_does_not_rise(const std::vector<double>& t);

/// Judges a log by the rules of a run's certificate (classify_run). A log has no q and p, therefore:
/// - only oscillations of the energy itself are seen, from block to block; a class needs at least two, the classes
/// bounded
///   and random walk need 16;
/// - `linear` needs a rate that is the same in the four quarters of the log, up to noise and the change itself;
/// otherwise
///   it may be a part of an oscillation slower than the log. A straight line of E or of log |E|, also beneath
///   independent noise, needs no oscillation. `bounded` needs that the energy has no direction in any quarter;
/// - the rounding is the one of four times the largest energy, because its parts are larger than the sum, or half of
/// the
///   smallest difference of two energies if that is larger, as in a log with few digits; one rounding is assumed
///   between two samples.
///
/// Times need not be equidistant: the log is divided into blocks of equal duration, each of which gives one sample. If
/// a gap is longer than half of the 32nd part of the log, the class is undecided.
///
/// @param scale by which the error is divided; without it |E0|, unless E0 is 0
/// @throws Error for different lengths, fewer than two samples, numbers that are not finite, times that do not increase
/// strictly, and a scale that is not positive
LogCertificate certify_log(const std::vector<double>& t, const std::vector<double>& energy,
                           std::optional<double> scale = {});

}  // namespace hamflow
