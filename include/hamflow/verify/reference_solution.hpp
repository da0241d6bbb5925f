// **A reference solution** with a stated uncertainty: the final state with which errors are measured.
// It is a closed form if there is one with enough digits; else two integrations of different kinds, a Taylor series and
// the extrapolated midpoint rule (verify/extrapolated_midpoint.hpp), both with more digits than the run. Their
// difference is the uncertainty.
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
  State<double> sizes;              // for each number the size of its group along the motion (state_units.hpp); 1 for 0
  Magnitude uncertainty;            // of the number with the largest relative uncertainty
};

/// The arithmetic of the reference for a run in `arithmetic`: double-double if it has no more digits than double, else
/// mp with more digits.
std::string reference_arithmetic(const std::string& arithmetic);
/// The decimal digits of the numbers of a run: 16 for double.
int digits_of(const std::string& arithmetic);

/// Integrates piece by piece, so that the caller can show the progress and stop it.
class ReferenceRun {
 public:
  /// Problem, start and arithmetic of the request are used. A run in double starts from numbers rounded to double, and
  /// the reference starts from the same numbers. With more digits, and for built-in numbers of a problem, it uses the
  /// numbers of the scenario with more digits.
  /// @param t_end the final time, a number expression   @param steps of the finest run; they determine the number of
  /// pieces
  /// @throws Error if no reference method can integrate the problem
  ReferenceRun(const Request& request, const std::string& t_end, std::int64_t steps);
  ~ReferenceRun();
  ReferenceRun(const ReferenceRun&) = delete;
  ReferenceRun& operator=(const ReferenceRun&) = delete;

  /// Integrates one piece. @param goes_on called a few times a second within a long piece; if it returns false, the
  /// piece stops and the run cannot be continued   @throws Error if the motion cannot be followed to the end
  void advance(const std::function<bool()>& goes_on = [] { return true; });
  bool finished() const { return part() >= 1; }
  /// In [0, 1].
  double part() const;
  /// The solution, after finished() is true.
  const ReferenceSolution& solution() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace hamflow
