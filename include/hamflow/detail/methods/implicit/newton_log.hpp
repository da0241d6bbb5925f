// What Newton did in a step that failed, in words. Written only when a failed step is repeated for its report.
#pragma once

#include <algorithm>
#include <array>
#include <string>

#include "hamflow/core/number.hpp"

namespace hamflow {

/// From where an attempt at a step starts.
enum class Guess { extrapolated, predicted, last_state, damped, converged, continued };

/// All out of line: strings in the middle of an iteration cost it its registers.
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
  /// Of many iterations the first and the last few are told.
  [[gnu::cold, gnu::noinline]] void residual(double norm) {
    const std::string number = (iterations_ == 0 ? "" : ", ") + shortest(norm);
    if (iterations_ < told) {
      text_ += number;
    } else {
      latest_[static_cast<std::size_t>(iterations_ % told)] = number;
    }
    ++iterations_;
  }
  [[gnu::cold, gnu::noinline]] void remark(const char* ending) {
    text_ = text() + " (" + ending + ")";
    iterations_ = 0;
  }
  /// The equations are others from here on.
  [[gnu::cold, gnu::noinline]] void restart() {
    text_.clear();
    attempts_ = 0;
    iterations_ = 0;
  }
  /// To how much of the step the solution that grows out of its beginning could be followed.
  void note_end_of_solution(double part) { solved_part_ = part; }
  void note_too_coarse() { too_coarse_ = true; }
  void note_change_unseen() { change_unseen_ = true; }

  std::string text() const {
    std::string all = text_;
    if (iterations_ > 2 * told) all += ", ... (" + std::to_string(iterations_ - 2 * told) + " more)";
    for (int i = std::max(told, iterations_ - told); i < iterations_; ++i) {
      all += latest_[static_cast<std::size_t>(i % told)];
    }
    return all;
  }
  int attempts() const { return attempts_; }
  bool too_coarse() const { return too_coarse_; }
  /// 0: none was found, or nobody has looked.
  double solved_part() const { return solved_part_; }
  bool change_unseen() const { return change_unseen_; }

 private:
  static constexpr int told = 4;
  std::string text_;
  std::array<std::string, told> latest_;
  int attempts_ = 0;
  int iterations_ = 0;
  double solved_part_ = 0;
  bool too_coarse_ = false;
  bool change_unseen_ = false;
};

}  // namespace hamflow
