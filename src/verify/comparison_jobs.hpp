// The runs of a comparison, and how long those that are left will take.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "hamflow/verify/comparison.hpp"

namespace hamflow {

/// One run: a method with one dt or tolerance.
struct ComparisonJob {
  std::size_t method = 0;  // in the request
  Request request;
  ComparisonPoint point;
  bool finished = false;
  double work = 1;                 // relative to the first run of the method, as it is expected
  double seconds = 0;              // of one run, once finished
  std::vector<std::string> end{};  // the state, with all digits
};

/// Method by method, in the order of their rows.
std::vector<ComparisonJob> comparison_jobs(const ComparisonRequest& asked);
/// Whether a method chooses its sub-steps itself and was given the tolerance to do so: then no dt matters.
bool has_own_tolerance(const MethodSpec& method);

/// How long the timing of a run that takes so many seconds goes on, the first run included.
double seconds_of_timing(double seconds, bool beyond_double);

/// Tells part and time left from the pace of what is done.
class ComparisonClock {
 public:
  using Clock = std::chrono::steady_clock;
  ComparisonClock(const std::vector<ComparisonJob>& jobs, bool beyond_double)
      : jobs_(jobs), beyond_double_(beyond_double) {}
  void reference_spent(double seconds, double part);
  /// @param part of the job that runs, in [0, 1]
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
