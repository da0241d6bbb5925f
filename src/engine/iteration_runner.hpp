// The steps of one simulation that are solved by iteration, by their programs: Newton's decisions (newton.hpp) around
// recorded corrections (recorded_iteration.hpp), or around stages in lanes (stages_in_lanes.hpp), with the bits of the
// simulation behind virtual calls. All other steps are left to the simulation.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hamflow/detail/numerics/newton_progress.hpp"
#include "recorded_iteration.hpp"
#include "stages_in_lanes.hpp"

namespace hamflow {

/// Makes stages in lanes at a state; nullopt if the method does not use them or H is not recorded.
using StageRecorder = std::function<std::optional<StagesInLanes>(std::span<const double> q, std::span<const double> p)>;

class IterationRunner {
 public:
  /// @param recorded its `correct` is not used if there are stages
  IterationRunner(RecordedIteration recorded, const NewtonOptions& options, std::optional<StagesInLanes> stages);

  /// Takes steps from a frame with an initial guess, until a step must be left to the simulation.
  /// @return the number of steps taken; the frame is the one after them @param effort to which their work is added
  /// @param guess_failures the count of Newton's method; must be 0 unless counts_guess_failures()
  std::int64_t run(std::span<double> frame, std::int64_t steps, Effort& effort, int& guess_failures);
  /// Whether it can take steps that begin from the last state; this is so for stages, whose result needs no check.
  bool counts_guess_failures() const { return stages_.has_value(); }

 private:
  bool take_step(std::span<double> frame, Effort& effort, int& guess_failures);
  int solved(std::span<double> frame, int& guess_failures);
  bool correct(std::span<double> frame);
  bool end(std::span<double> frame);
  NewtonDecision judge(std::span<const double> frame, NewtonProgress<double>& progress) const;
  /// Whether rounding hides the unknowns, see detail::hiding_terms (averages_rows.hpp).
  bool is_hidden(std::span<const double> frame) const;

  RecordedIteration recorded_;
  NewtonOptions options_;
  std::optional<StagesInLanes> stages_;
  std::shared_ptr<const StepLoop> correct_;  // null with stages
  std::shared_ptr<const StepLoop> finish_;
  std::vector<double> before_;
  std::vector<double> q_;
  std::vector<double> p_;
  std::vector<double> start_;
  std::vector<double> next_;  // for stages: the initial guess of the next step
};

}  // namespace hamflow
