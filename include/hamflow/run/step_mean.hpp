// Means of expressions over every step of a run. The sums keep what they lose, so that the mean of 10^9 steps has the
// digits of the values.
#pragma once

#include <cmath>
#include <span>

#include "hamflow/run/observer.hpp"
#include "hamflow/run/state_expression.hpp"

namespace hamflow {

/// The values of one expression over a run: at the start, then behind each step.
struct StepMean {
  double initial = 0;
  double final = 0;
  double sum = 0;   // of those behind steps, rounded   [Neumaier1974]
  double lost = 0;  // and what its roundings lost

  void begin(double x) { initial = final = x; }
  void add(double x) {
    final = x;
    const double next = sum + x;
    lost += std::abs(sum) >= std::abs(x) ? (sum - next) + x : (x - next) + sum;
    sum = next;
  }
  /// Without steps the initial value.
  double mean(std::int64_t steps) const { return steps > 0 ? (sum + lost) / static_cast<double>(steps) : initial; }

  template <class Archive>
  void archive(Archive& ar) {
    ar(initial, final, sum, lost);
  }
};

/// Takes such means of one run. As an observer it is woken at every step; whoever evaluates the expressions in steps of
/// its own need not wake it, and tells it in the end what they came to: the same sums, in the same order.
class MeanWatch : public Observer {
 public:
  virtual std::span<const NamedExpression> expressions() const = 0;
  /// @param steps that were taken   @param means of each expression
  virtual void take(std::int64_t steps, std::span<const StepMean> means) = 0;
};

}  // namespace hamflow
