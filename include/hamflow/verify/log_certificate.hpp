// Finds the drift class of energies in the log of any program, from times and energies alone.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "hamflow/detail/verify/drift.hpp"

namespace hamflow {

/// Result for the energies of a log.
struct LogCertificate {
  // drift class, reason and growth exponent; increments are in units of the largest deviation
  RunDrift drift;
  std::optional<double> energy_level{};  // max |E - E0|/scale; nullopt: the scale is unknown
  std::optional<double> scale{};         // the given scale, or |E0|; nullopt: E0 is 0
  std::size_t samples = 0;
  /// nullopt: too few samples.
  std::optional<double> growth_exponent() const {
    return drift.blocks < RunDrift::fewest_blocks ? std::nullopt : std::optional<double>(drift.growth_exponent);
  }
};

/// Returns the index of the first time that is not larger than the one before; nullopt: the times increase strictly.
std::optional<std::size_t> first_time_that_does_not_rise(const std::vector<double>& t);

/// Judges a log by the rules of a run's certificate (classify_run). Because a log has no q and p, some rules differ:
///
/// - Only oscillations of the energy itself are seen, from block to block. A class needs at least two of them; the
///   classes bounded and random walk need 16.
/// - `linear` needs a rate that is the same in the four quarters of the log, up to noise and the change itself.
///   Otherwise the change may be a part of an oscillation slower than the log. If E or log |E| is a straight line,
///   possibly with independent noise, no oscillation is needed.
/// - `bounded` needs that the energy has no trend in any quarter.
/// - The rounding error is taken from four times the largest energy, because T and V are larger than their sum. Half of
///   the smallest difference of two energies replaces it if that is larger, as in a log with few digits. One rounding
///   between two samples is assumed.
///
/// Times need not be equidistant: the log is divided into blocks of equal duration, and each gives one sample. If a gap
/// is longer than half of the 32nd part of the log, the class is undecided.
///
/// @param scale the energy error is divided by it; default: |E0|, unless E0 is 0
/// @throws Error for different lengths, fewer than two samples, numbers that are not finite, times that do not increase
/// strictly, and a scale that is not positive
LogCertificate certify_log(const std::vector<double>& t, const std::vector<double>& energy,
                           std::optional<double> scale = {});

}  // namespace hamflow
