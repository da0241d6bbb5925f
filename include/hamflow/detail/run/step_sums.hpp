// Sums of expressions over every step, with compensation for rounding, so that the mean of 10^9 steps has the digits of
// the values. Observers and recorded steps add with the same bits.
#pragma once

#include <cmath>
#include <optional>
#include <span>

#include "hamflow/detail/numerics/program.hpp"
#include "hamflow/detail/run/state_expression.hpp"

namespace hamflow {

/// An unevaluated sum of two numbers: the rounding errors of all additions are summed separately.   [Neumaier1974]
struct StepSum {
  double sum = 0;
  double lost = 0;

  void add(double x) {
    const double next = sum + x;
    lost += std::abs(sum) >= std::abs(x) ? (sum - next) + x : (x - next) + sum;
    sum = next;
  }
  double value() const { return sum + lost; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(sum, lost);
  }
};

/// An observer of every step that needs only sums. If the simulation adds them, it is not called at every step.
class SummedSteps {
 public:
  virtual ~SummedSteps() = default;
  virtual std::span<const NamedExpression> summed() const = 0;
  /// The sums to add to, one for each expression.
  virtual std::span<StepSum> sums() = 0;
  /// Called instead of the steps up to this state, whose values are in the sums.
  virtual void reach(const Frame& last) = 0;
};

/// A program that also adds the values of expressions after each step: two more values for each, a sum and its rounding
/// error.
/// @param state which outputs are q, then p @param undone the output that is not 0 if the step was not taken and must
/// not be counted; nullopt: every step is taken
/// @return nullopt if an expression uses the time
std::optional<Program> with_sums(const Program& program, std::span<const std::size_t> state,
                                 std::optional<std::size_t> undone, std::span<const NamedExpression> expressions);

}  // namespace hamflow
