// The runs of a comparison, and estimates of the time that the remaining ones take.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "hamflow/verify/comparison.hpp"

namespace hamflow {

/// One run: a method with one dt or tolerance.
struct ComparisonJob {
  std::size_t method = 0;  // index in the request
  Request request;
  ComparisonPoint point;
  bool finished = false;
  double work = 1;                 // expected work relative to the first run of the method
  double seconds = 0;              // time of one run, known once it is finished
  std::vector<std::string> end{};  // final state with all digits
};

/// Returns the runs, ordered by method like the rows of the table.
std::vector<ComparisonJob> comparison_jobs(const ComparisonRequest& asked);
/// Returns whether a method chooses its own sub-steps and was given a tolerance. Then dt has no influence.
bool has_own_tolerance(const MethodSpec& method);

/// Returns how long the timing of a run takes that needs `seconds` once, including the first run.
double seconds_of_timing(double seconds, bool beyond_double);

/// Estimates progress and remaining time from the speed of the finished runs.
class ComparisonClock {
 public:
  using Clock = std::chrono::steady_clock;
  ComparisonClock(const std::vector<ComparisonJob>& jobs, bool beyond_double)
      : jobs_(jobs), beyond_double_(beyond_double) {}
  void reference_spent(double seconds, double part);
  /// @param part finished fraction of the running job, in [0, 1]
  ComparisonProgress look(const ComparisonJob* running, double part);

 private:
  std::optional<double> expected(const ComparisonJob& job) const;

  const std::vector<ComparisonJob>& jobs_;
  bool beyond_double_;
  double reference_seconds_ = 0;
  double reference_part_ = 0;
  double shown_ = 0;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace hamflow
