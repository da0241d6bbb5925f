#include "iteration_runner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hamflow {

IterationRunner::IterationRunner(RecordedIteration recorded, const NewtonOptions& options,
                                 std::optional<StagesInLanes> stages)
    : recorded_(std::move(recorded)),
      options_(options),
      stages_(std::move(stages)),
      finish_(make_step_loop(recorded_.finish.program)),
      q_(recorded_.frame.n),
      p_(recorded_.frame.n) {
  if (!stages_) correct_ = make_step_loop(recorded_.correct.program);
}

std::int64_t IterationRunner::run(std::span<double> frame, std::int64_t steps, Effort& effort, int& guess_failures) {
  std::int64_t taken = 0;
  while (taken < steps && take_step(frame, effort, guess_failures)) ++taken;
  return taken;
}

/// @return whether the step was taken; if not, the frame is unchanged
bool IterationRunner::take_step(std::span<double> frame, Effort& effort, int& guess_failures) {
  before_.assign(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(recorded_.frame.correction()));
  int failures_after = guess_failures;
  const int solves = solved(frame, failures_after);
  if (solves == 0 || !finish_->run(frame, 1)) {
    std::copy(before_.begin(), before_.end(), frame.begin());
    return false;
  }
  guess_failures = failures_after;
  if (stages_) std::copy(next_.begin(), next_.end(), frame.begin() + static_cast<std::ptrdiff_t>(recorded_.frame.x()));
  effort.force += solves * recorded_.of_correct.force + recorded_.of_finish.force;
  effort.gradient += solves * recorded_.of_correct.gradient + recorded_.of_finish.gradient;
  effort.hessian += solves * recorded_.of_correct.hessian + recorded_.of_finish.hessian;
  effort.linear_solves += solves;
  effort.solves_min = effort.steps == 0 || solves < effort.solves_min ? solves : effort.solves_min;
  effort.solves_max = solves > effort.solves_max ? solves : effort.solves_max;
  ++effort.steps;
  return true;
}

/// Newton<E>::iterate() without a tolerance, from the initial guess or, after guess failures, from the last state.
/// @return the number of corrections; 0 if it did not converge or needs a further check
int IterationRunner::solved(std::span<double> frame, int& guess_failures) {
  const IterationFrame& at = recorded_.frame;
  if (stages_) {
    for (std::size_t a = 0; a < at.n; ++a) {
      q_[a] = frame[IterationFrame::state(a)];
      p_[a] = frame[IterationFrame::state(at.n + a)];
    }
    start_.assign(at.m, 0.0);
    if (guess_failures == 0) std::copy_n(frame.begin() + static_cast<std::ptrdiff_t>(at.x()), at.m, start_.begin());
    stages_->begin(frame[IterationFrame::h], q_, p_, start_);
  }
  NewtonProgress<double> progress(convergence_of(options_.iteration));
  for (int k = 0; k < options_.max_iterations; ++k) {
    if (!correct(frame)) return 0;
    const NewtonDecision decision = judge(frame, progress);
    if (decision == NewtonDecision::go_on) continue;
    if (decision != NewtonDecision::settled) return 0;  // needs a further check
    if (!stages_ && options_.iteration == Iteration::newton && is_hidden(frame)) return 0;
    const bool guess_was_far = guess_failures == 0 && progress.began_far_away(1.0);
    if ((guess_was_far && !stages_) || !end(frame)) return 0;
    if (guess_was_far) {
      guess_failures = good_guesses_needed;
    } else if (guess_failures > 0) {  // tests whether the guess would have been better
      const double distance = stages_->distance_of(frame.subspan(at.x(), at.m));
      guess_failures =
          good_guesses_needed_after(guess_failures, std::numeric_limits<double>::epsilon() * distance <= 1);
    }
    return k + 1;
  }
  return 0;
}

bool IterationRunner::correct(std::span<double> frame) {
  return stages_ ? stages_->correct() : correct_->run(frame, 1);
}

bool IterationRunner::end(std::span<double> frame) {
  if (!stages_) return true;
  const IterationFrame& at = recorded_.frame;
  const auto increment = frame.subspan(at.increment(), 2 * at.n);
  next_.resize(at.m);
  return stages_->end(frame.subspan(at.end(), at.m), increment.first(at.n), increment.last(at.n), next_);
}

NewtonDecision IterationRunner::judge(std::span<const double> frame, NewtonProgress<double>& progress) const {
  if (stages_) return progress.judge(stages_->size(), stages_->size(), 1.0);
  const IterationFrame& at = recorded_.frame;
  double size = 0;
  double total = 0;
  measure_corrections(&frame[at.correction()], &frame[at.unit()], at.m, 1, &size, &total);
  return progress.judge(size, total, 1.0);
}

bool IterationRunner::is_hidden(std::span<const double> frame) const {
  const IterationFrame& at = recorded_.frame;
  return hidden_by_rounding(&frame[at.unit()], &frame[at.x()], at.m, 1);
}

}  // namespace hamflow
