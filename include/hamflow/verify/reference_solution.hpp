// **A reference solution** with a stated uncertainty: the state at the end that errors are measured against.
// A closed form where there is one in the digits needed; else two integrations of different kinds, a Taylor series and
// the extrapolated midpoint rule (verify/extrapolated_midpoint.hpp), both in the next more digits. What they differ by
// is the evidence: nothing smaller is claimed.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/detail/run/step_map.hpp"
#include "hamflow/detail/verify/magnitude.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

struct ReferenceSolution {
  std::string kind;  // "closed form", "integration"
  std::string description;
  State<double> end;                // q, then p
  std::vector<std::string> digits;  // the same with all digits
  State<double> sizes;              // of each number: that of its group along the motion (state_units.hpp); 1 for 0
  Magnitude uncertainty;            // of the number that is most uncertain beside its size
};

/// The arithmetic in which the reference of a run in `arithmetic` is integrated: double-double for all that have no
/// more digits than double, mp with more digits for the others.
std::string reference_arithmetic(const std::string& arithmetic);
/// The decimal digits of the numbers of a run: 16 of double.
int digits_of(const std::string& arithmetic);

/// Integrates piece by piece, so that one can show how far it is, and stop.
class ReferenceRun {
 public:
  /// Of the request problem, start and arithmetic count. Methods start from numbers that are rounded to the run's
  /// arithmetic: in double the reference starts from these very numbers; beyond, and where a problem has numbers of its
  /// own, from those of the scenario with more digits.
  /// @param t_end the time at the end, a number expression   @param steps of the finest run: they decide how many
  /// pieces there are
  /// @throws Error where the problem has no method to follow it
  ReferenceRun(const Request& request, const std::string& t_end, std::int64_t steps);
  ~ReferenceRun();
  ReferenceRun(const ReferenceRun&) = delete;
  ReferenceRun& operator=(const ReferenceRun&) = delete;

  /// One piece more. @param goes_on asked a few times a second within a piece that takes long: false stops it where it
  /// is, and nothing goes on from there   @throws Error when the motion cannot be followed to the end
  void advance(const std::function<bool()>& goes_on = [] { return true; });
  bool finished() const { return part() >= 1; }
  /// In [0, 1].
  double part() const;
  /// When finished.
  const ReferenceSolution& solution() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hamflow
