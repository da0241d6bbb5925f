// A recorded partial step: Psi_h of a method without memory, with the length h as an input. Walls are located with such
// parts (docs/design/walls.md), about six for each bounce, each with another length. So are points of sections and
// events.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <utility>

#include "carried.hpp"
#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/methods/step_density.hpp"
#include "hamflow/detail/run/steps_in_parts.hpp"
#include "numerics/program_of_tape.hpp"
#include "parts_in_numbers.hpp"

namespace hamflow {

/// Records a part from a state and a length; nullopt if it branches.
using PartRecorder = std::function<std::optional<RecordedPart>(const Vector<double, dynamic>& q,
                                                               const Vector<double, dynamic>& p, double h)>;

/// The part of a simulation and its copies, recorded once it is worth it. The copies may be on several threads.
class SharedPart {
 public:
  /// @param recorder empty: no part is recorded
  explicit SharedPart(PartRecorder recorder) : recorder_(std::move(recorder)) {}

  /// Partial steps on plain numbers; nullopt if there are none, or this was called too few times so far.
  std::optional<PartsInNumbers> find(const Vector<double, dynamic>& q, const Vector<double, dynamic>& p, double h) {
    if (!recorder_) return {};
    const std::lock_guard lock(mutex_);
    if (!made_ && ++asked_ == worth_recording) {
      asked_ = 0;  // another branch may be recorded next time
      if (std::optional<RecordedPart> recorded = recorder_(q, p, h)) made_.emplace(*std::move(recorded));
    }
    return made_;
  }

 private:
  /// The number of parts that recording and compiling a part cost.
  static constexpr int worth_recording = 400;

  PartRecorder recorder_;
  std::mutex mutex_;
  std::optional<PartsInNumbers> made_;
  int asked_ = 0;
};

/// Calls leaf(x) for every counter in the archives of objects: whole numbers that steps only increment.
template <class Leaf, class... Objects>
void for_each_counter(Leaf&& leaf, Objects&... objects) {
  for_each_carried(
      [&]<class T>(T& x) {
        if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) leaf(x);
      },
      objects...);
}

/// Records a part.
/// @tparam A an arithmetic of traces with any step size (detail/methods/step_density.hpp)
/// @param method bound to `problem`
template <class A, class P, class M>
std::optional<RecordedPart> record_part(const P& problem, M method, const Vector<double, dynamic>& q,
                                        const Vector<double, dynamic>& p, double h, std::size_t most_operations) {
  using Number = Trace<double>;
  PhasePoint<A, dynamic> z;
  z.store(cast<Number>(q), cast<Number>(p));
  try {
    RecordedPart recorded{.program = {}, .size = q.size(), .effort = {}};
    Recorder<double> recorder(Folding::exact, most_operations);
    for_each_carried(
        [&]<class T>(T& x) {
          static_assert(std::is_same_v<T, Number>, "hamflow: a state of other numbers has no recorded parts");
          x = recorder.input(x.value);
          ++recorded.state;
        },
        z);
    const Number length = recorder.input(h);
    for (std::size_t i = 0; i < 2 * q.size() + 1; ++i) (void)recorder.input(0.0);
    method.invalidate();
    const Effort before = method.effort();
    for_each_counter([&](auto& x) { recorded.counters.push_back(-static_cast<std::int64_t>(x)); }, method);
    if (method.step(problem, length, z) != Outcome::done) return std::nullopt;
    add_evaluations(recorded.effort, method.effort(), before);
    std::size_t k = 0;
    for_each_counter([&](auto& x) { recorded.counters[k++] += static_cast<std::int64_t>(x); }, method);
    std::vector<Number> after;
    for_each_carried(
        [&]<class T>(T& x) {
          if constexpr (std::is_same_v<T, Number>) after.push_back(x);
        },
        z);
    after.push_back(length);
    const Vector<Number, dynamic> q1 = z.positions();
    const Vector<Number, dynamic> p1 = z.momenta();
    Vector<Number, dynamic> v = zeros_like(p1);
    velocity(problem, p1, v);
    after.insert(after.end(), q1.begin(), q1.end());
    after.insert(after.end(), v.begin(), v.end());
    after.push_back(energy(problem, q1, p1));
    recorded.program = program_of(recorder.finish(after));
    return recorded;
  } catch (const CannotRecord&) {
    return std::nullopt;
  }
}

}  // namespace hamflow
