// **A reference solution** with a stated uncertainty: the final state against which errors are measured.
// It is a closed form, if there is one with enough digits. Otherwise it comes from two integrations of different kinds,
// a Taylor series and the extrapolated midpoint rule (verify/extrapolated_midpoint.hpp), both with more digits than the
// run. Their difference is the uncertainty.
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
  std::string kind;  // "closed form" or "integration"
  std::string description;
  State<double> end;                // q, then p
  std::vector<std::string> digits;  // the same with all digits
  // for each number, the size of its group along the motion (state_units.hpp); 1 if the size is 0
  State<double> sizes;
  Magnitude uncertainty;  // uncertainty of the number whose relative uncertainty is largest
};

/// Returns the arithmetic of the reference for a run in `arithmetic`: double-double if the run has at most the digits
/// of double, otherwise mp with more digits.
std::string reference_arithmetic(const std::string& arithmetic);
/// Returns the number of decimal digits of a run: 16 for double.
int digits_of(const std::string& arithmetic);

/// Integrates piece by piece, so that the caller can show the progress and can stop.
class ReferenceRun {
 public:
  /// Uses problem, start and arithmetic of the request. A run in double starts from numbers rounded to double, so the
  /// reference starts from the same rounded numbers. For a run with more digits, and for built-in numbers of a problem,
  /// the reference uses the numbers with more digits than the run.
  /// @param t_end the final time, a number expression   @param steps steps of the finest run; they determine the number
  /// of pieces
  /// @throws Error if no reference method can integrate the problem
  ReferenceRun(const Request& request, const std::string& t_end, std::int64_t steps);
  ~ReferenceRun();
  ReferenceRun(const ReferenceRun&) = delete;
  ReferenceRun& operator=(const ReferenceRun&) = delete;

  /// Integrates one piece. @param goes_on called a few times a second within a long piece; if it returns false, the
  /// piece stops, and the run cannot be continued   @throws Error if the motion cannot be integrated to the end
  void advance(const std::function<bool()>& goes_on = [] { return true; });
  bool finished() const { return part() >= 1; }
  /// Finished fraction, in [0, 1].
  double part() const;
  /// The solution; only valid once finished() is true.
  const ReferenceSolution& solution() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hamflow
