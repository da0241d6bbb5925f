// The report of Newton's iteration in a failed step, in words. It is written only when the step is repeated for the
// report.
#pragma once

#include <algorithm>
#include <array>
#include <string>

#include "hamflow/core/number.hpp"

namespace hamflow {

/// The initial guess of an attempt.
enum class Guess { extrapolated, predicted, last_state, damped, converged, continued };

/// No function is inlined, because strings within the iteration would use its registers.
class NewtonLog {
 public:
  [[gnu::cold, gnu::noinline]] void attempt(Guess from) {
    static constexpr const char* names[] = {"from the extrapolated guess",
                                            "from the explicit predictor",
                                            "from the last state",
                                            "damped from the last state",
                                            "from the solution with fewer points",
                                            "from the solution of a part of the step"};
    text_ = text() + (attempts_ == 0 ? "" : "; ") + names[static_cast<int>(from)] + " ";
    ++attempts_;
    iterations_ = 0;
  }
  /// Records a residual; of many iterations the first and the last few are reported.
  [[gnu::cold, gnu::noinline]] void residual(double norm) {
    const std::string number = (iterations_ == 0 ? "" : ", ") + shortest(norm);
    if (iterations_ < shown) {
      text_ += number;
    } else {
      latest_[static_cast<std::size_t>(iterations_ % shown)] = number;
    }
    ++iterations_;
  }
  [[gnu::cold, gnu::noinline]] void remark(const char* ending) {
    text_ = text() + " (" + ending + ")";
    iterations_ = 0;
  }
  /// Restarts the report, because the equations have changed.
  [[gnu::cold, gnu::noinline]] void restart() {
    text_.clear();
    attempts_ = 0;
    iterations_ = 0;
  }
  /// Records up to which part of the step the solution could be continued.
  void note_end_of_solution(double part) { solved_part_ = part; }
  void note_too_coarse() { too_coarse_ = true; }
  void note_change_unseen() { change_unseen_ = true; }

  std::string text() const {
    std::string all = text_;
    if (iterations_ > 2 * shown) all += ", ... (" + std::to_string(iterations_ - 2 * shown) + " more)";
    for (int i = std::max(shown, iterations_ - shown); i < iterations_; ++i) {
      all += latest_[static_cast<std::size_t>(i % shown)];
    }
    return all;
  }
  int attempts() const { return attempts_; }
  bool too_coarse() const { return too_coarse_; }
  /// That part; 0 if there was no solution or no continuation.
  double solved_part() const { return solved_part_; }
  bool change_unseen() const { return change_unseen_; }

 private:
  static constexpr int shown = 4;
  std::string text_;
  std::array<std::string, shown> latest_;
  int attempts_ = 0;
  int iterations_ = 0;
  double solved_part_ = 0;
  bool too_coarse_ = false;
  bool change_unseen_ = false;
};

}  // namespace hamflow
