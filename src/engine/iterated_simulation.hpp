// A simulation by name in double whose steps are solved by iteration and can be taken in lanes
// (recorded_iteration.hpp). It is the simulation behind virtual calls; if many steps are requested, programs take them
// (iteration_runner.hpp), with the same bits.
#pragma once

#include <algorithm>
#include <memory>
#include <utility>

#include "in_parts.hpp"
#include "iteration_runner.hpp"
#include "quick_steps.hpp"

namespace hamflow {

namespace detail {
/// Finds among what an implicit method archives the count of guess failures of Newton, which comes after its
/// memory.
struct GuessFailuresFinder {
  static constexpr bool reading = false;
  int* found = nullptr;
  template <class N>
  void operator()(Effort&, StepDiagnostics&, auto&, N& newton) {
    newton.archive(*this);
  }
  void operator()(auto&, int& guess_failures) { found = &guess_failures; }
};
template <class M>
int& guess_failures_of(M& method) {
  GuessFailuresFinder finder;
  method.archive(finder);
  return *finder.found;
}
}  // namespace detail

template <class P, class M, Arithmetic A>
class IteratedSimulation final : public InParts<SimulationOf<P, M, A>>, public IteratedMember {
  using Base = InParts<SimulationOf<P, M, A>>;
  using Base::clock_;
  using Base::method_;
  using Base::probe_;
  using Base::varies_steps;
  using Base::z_;
  using Equations = typename M::Equations;

 public:
  /// @param stages empty: stages are not iterated in lanes @param record false: no step is recorded
  IteratedSimulation(SimulationOf<P, M, A> simulation, IterationRecorder recorder, StageRecorder stages, bool record)
      : Base(std::move(simulation)),
        recorder_(std::make_shared<const IterationRecorder>(std::move(recorder))),
        stages_(std::make_shared<const StageRecorder>(std::move(stages))),
        record_(record) {
    frame_.n = z_.q.size();
    frame_.m = Equations(method_.setup(), Base::problem(), clock_.step(), z_.positions(), z_.momenta(), unused())
                   .last_state()
                   .size();
    for_each_carried([&](double&) { ++frame_.recorded; }, z_, probe_);
  }

  Outcome advance(std::int64_t steps) override {
    return take_quickly(
        steps, [&](std::int64_t left) { return take_by_programs(left); },
        [&](std::int64_t some) { return Base::advance(some); });
  }
  void reverse_time() override {
    Base::reverse_time();
    runner_.reset();
  }
  bool is_recorded() const override { return runner_.has_value(); }
  [[gnu::cold]] void restore(std::span<const std::byte> saved) override {
    Base::restore(saved);
    runner_.reset();  // the start time is a constant of the programs
  }

  const IterationFrame& frame() const override { return frame_; }
  NewtonOptions newton() const override { return method_.setup().newton(); }
  bool automatic() const override { return method_.setup().automatic(); }
  int points() const override { return method_.setup().current_rule(); }
  bool can_be_recorded() const override { return static_cast<bool>(*recorder_); }
  std::optional<RecordedIteration> recorded_iteration() const override {
    std::vector<double> values(frame_.size());
    if (!read(values)) return std::nullopt;
    return (*recorder_)(frame_, values, points(), time_of_clock(), IterationParts::all);
  }

  bool read(std::span<double> values) const override { return fill(values) && method_.newton().uses_memory(); }
  void take(std::span<const double> values, std::int64_t steps, const Effort& effort) override {
    std::size_t k = IterationFrame::carried;
    for_each_carried([&](double& x) { x = values[k++]; }, z_, probe_);
    Vector<double, dynamic> last(frame_.m);
    for (std::size_t i = 0; i < frame_.m; ++i) last[i] = values[frame_.memory() + i];
    method_.go_on(last, effort);
    clock_.advance(steps);
  }
  double time_after(std::int64_t steps) const override { return static_cast<double>(clock_.time_after(steps)); }
  [[gnu::cold]] std::unique_ptr<Simulation> clone() const override {
    return std::make_unique<IteratedSimulation>(*this);
  }

 private:
  /// Fills in the numbers of a frame. @return whether the last step left an initial guess, used or not
  bool fill(std::span<double> values) const {
    values[IterationFrame::h] = clock_.step_length();
    values[IterationFrame::position] = static_cast<double>(clock_.position());
    auto z = z_;
    auto probe = probe_;
    std::size_t k = IterationFrame::carried;
    for_each_carried([&](double& x) { values[k++] = x; }, z, probe);
    if (method_.newton().memory().empty()) return false;
    const Vector<double, dynamic> q0 = z_.positions();
    const Vector<double, dynamic> p0 = z_.momenta();
    if (automatic()) values[frame_.energy()] = hamflow::energy(Base::problem(), q0, p0);
    const auto& last = method_.newton().memory().predicted();
    const auto x = Equations(method_.setup(), Base::problem(), clock_.step_length(), q0, p0, unused()).started(last);
    if (last.size() != frame_.m) return false;
    for (std::size_t i = 0; i < frame_.m; ++i) {
      values[frame_.memory() + i] = last[i];
      values[frame_.x() + i] = x[i];
    }
    return true;
  }

  /// The number of steps that recording and compiling cost.
  static constexpr std::int64_t worth_recording = 200;
  /// Fewer steps do not use programs, since filling a frame costs about as much as a step.
  static constexpr std::int64_t least_steps_for_programs = 4;

  /// See take_quickly().
  std::optional<std::int64_t> take_by_programs(std::int64_t steps) {
    if (!is_worth_running(steps)) return std::nullopt;
    if (!fill(values_)) return 0;
    if (!runner_) make_runner();
    if (!runner_) return std::nullopt;
    Effort effort = method_.effort();
    int guess_failures = detail::guess_failures_of(method_);
    if (guess_failures > 0 && !runner_->counts_guess_failures()) return 0;
    const std::int64_t taken = runner_->run(values_, steps, effort, guess_failures);
    if (taken == 0) return 0;
    take(values_, taken, effort);
    detail::guess_failures_of(method_) = guess_failures;
    return taken;
  }
  /// Whether programs can take these steps. They do not support a tolerance, diagnostics, a kept Jacobian, changing
  /// points or varying steps.
  bool is_worth_running(std::int64_t steps) {
    if (!record_ || steps < least_steps_for_programs || varies_steps() || automatic() || !can_be_recorded())
      return false;
    const NewtonOptions options = newton();
    if (options.tolerance || options.diagnostics || options.iteration == Iteration::simplified) return false;
    values_.resize(frame_.size());
    return runner_ || (asked_ += steps) >= worth_recording;
  }
  IterationTime time_of_clock() const { return {clock_.start(), static_cast<double>(clock_.direction())}; }
  [[gnu::cold]] void make_runner() {
    std::optional<StagesInLanes> stages;
    if (*stages_) {
      std::vector<double> q(frame_.n);
      std::vector<double> p(frame_.n);
      for (std::size_t a = 0; a < frame_.n; ++a) {
        q[a] = values_[IterationFrame::state(a)];
        p[a] = values_[IterationFrame::state(frame_.n + a)];
      }
      stages = (*stages_)(q, p);
    }
    auto recorded =
        (*recorder_)(frame_, values_, points(), time_of_clock(), stages ? IterationParts::finish : IterationParts::all);
    if (!recorded) {
      record_ = false;
      return;
    }
    runner_.emplace(*std::move(recorded), newton(), std::move(stages));
  }

  static Effort& unused() {
    static thread_local Effort effort;
    return effort;
  }

  IterationFrame frame_;
  std::shared_ptr<const IterationRecorder> recorder_;
  std::shared_ptr<const StageRecorder> stages_;
  bool record_;
  std::optional<IterationRunner> runner_;
  std::vector<double> values_;
  std::int64_t asked_ = 0;
};

}  // namespace hamflow
