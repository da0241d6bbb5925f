// What Newton did in a step that failed, in words. Written only when a failed step is repeated for its report.
#pragma once

#include <string>

#include "hamflow/core/number.hpp"

namespace hamflow {

/// From where an attempt at a step starts.
enum class Guess { extrapolated, predicted, last_state, damped, converged };

/// All out of line: strings in the middle of an iteration cost it its registers.
class NewtonLog {
 public:
  [[gnu::cold, gnu::noinline]] void attempt(Guess from) {
    static constexpr const char* names[] = {"from the extrapolated guess", "from the explicit predictor",
                                            "from the last state", "damped from the last state",
                                            "from the solution with fewer points"};
    text_ += std::string(attempts_ == 0 ? "" : "; ") + names[static_cast<int>(from)] + " ";
    ++attempts_;
    iterations_ = 0;
  }
  [[gnu::cold, gnu::noinline]] void residual(double norm) {
    text_ += (iterations_++ == 0 ? "" : ", ") + shortest(norm);
  }
  [[gnu::cold, gnu::noinline]] void remark(const char* ending) { text_ += std::string(" (") + ending + ")"; }
  /// The equations are others from here on.
  [[gnu::cold, gnu::noinline]] void restart() {
    text_.clear();
    attempts_ = 0;
  }
  void note_too_coarse() { too_coarse_ = true; }
  void note_kink() { kink_ = true; }

  const std::string& text() const { return text_; }
  int attempts() const { return attempts_; }
  bool too_coarse() const { return too_coarse_; }
  bool kink() const { return kink_; }

 private:
  std::string text_;
  int attempts_ = 0;
  int iterations_ = 0;
  bool too_coarse_ = false;
  bool kink_ = false;
};

}  // namespace hamflow
