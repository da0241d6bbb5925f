// Sums of expressions over every step. They keep what they lose, so that the mean of 10^9 steps has the digits of the
// values; whoever adds, an observer or a recorded step, adds with the same bits.
#pragma once

#include <cmath>
#include <optional>
#include <span>

#include "hamflow/detail/numerics/program.hpp"
#include "hamflow/detail/run/state_expression.hpp"

namespace hamflow {

/// An unevaluated sum of two numbers: what each addition loses is added up beside it.   [Neumaier1974]
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

/// An observer of every step that needs nothing of them but sums: it can be spared the steps, where somebody else adds.
class SummedSteps {
 public:
  virtual ~SummedSteps() = default;
  virtual std::span<const NamedExpression> summed() const = 0;
  /// To add to, one for each of them.
  virtual std::span<StepSum> sums() = 0;
  /// Instead of the steps up to this state, whose values are in the sums.
  virtual void reach(const Frame& last) = 0;
};

/// A program that also adds the values of expressions behind each step: two more values for each, a sum and what it
/// lost.
/// @param state which outputs are q, then p   @param undone which output is not 0 where a step was left undone, and is
/// not counted; none: no step is
/// @return nothing where an expression uses the time
std::optional<Program> with_sums(const Program& program, std::span<const std::size_t> state,
                                 std::optional<std::size_t> undone, std::span<const NamedExpression> expressions);

}  // namespace hamflow
