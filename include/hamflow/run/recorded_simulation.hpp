// A simulation by name in double: it is the one behind virtual calls, and where many steps are asked for, a step is
// recorded once (recorded_step.hpp), made into a loop (numerics/program.hpp) and repeated in it, with the same bits.
// Where a check of the loop fails, or the step cannot be recorded, the block takes the ordinary road from where it
// began.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "hamflow/run/in_parts.hpp"
#include "hamflow/run/recorded_step.hpp"

namespace hamflow {

/// Records the step of length h from a state, with what is looked at in every step or without.
using StepRecorder = std::function<std::optional<RecordedStep>(
    const Vector<double, dynamic>& q, const Vector<double, dynamic>& p, double h, const RecordedTime& time, bool watch,
    RecordedAt at, AtWalls at_walls)>;

template <class P, class M, Arithmetic A>
class RecordedSimulation final : public InParts<SimulationOf<P, M, A>>, public RecordedMember {
  using Base = InParts<SimulationOf<P, M, A>>;
  using Base::clock_;
  using Base::density_;
  using Base::method_;
  using Base::probe_;
  using Base::z_;

 public:
  /// @param recorder empty: every step takes the ordinary road   @param watch false: the probe stays as it was
  RecordedSimulation(SimulationOf<P, M, A> simulation, StepRecorder recorder, bool watch)
      : Base(std::move(simulation)),
        recorder_(std::make_shared<const StepRecorder>(std::move(recorder))),
        watch_(watch) {}

  Outcome advance(std::int64_t steps) override {
    const Loop* const loop = loop_for(clock_.step_length(), steps, AtWalls::stop);
    if (loop == nullptr || steps < 1 || loop->step->stops) return ordinary(steps);
    values_.resize(loop->step->program.values());
    if (!read_values(*loop->step, values_)) {
      // One step leaves what the method keeps for the next one.
      const Outcome outcome = ordinary(1);
      if (outcome != Outcome::done || --steps == 0) return outcome;
      if (!read_values(*loop->step, values_)) return ordinary(steps);
    }
    if (!loop->steps->run(values_, steps) || !are_finite()) return ordinary(steps);
    if (watch_) {
      take_values(*loop->step, values_, steps);
      return Outcome::done;
    }
    // Nobody has looked at the energy yet.
    const auto z = z_;
    const auto method = method_;
    const auto clock = clock_;
    const auto density = density_;
    take_values(*loop->step, values_, steps);
    if (Base::is_finite(Base::problem(), z_)) return Outcome::done;
    z_ = z;
    method_ = method;
    clock_ = clock;
    density_ = density;
    return ordinary(steps);
  }

  /// Blocks grow, so that little is taken twice where a check fails.
  std::int64_t take_recorded(std::int64_t steps, std::span<std::int64_t> bounces) override {
    behind_walls_ = true;
    stopped_ = false;
    const double h = clock_.step_length();
    const Loop* loop = bounces.empty() ? nullptr : loop_for(h, steps, AtWalls::bounce);
    const bool is_none = loop == nullptr && (bounces.empty() || asked_ >= worth_recording);
    if (is_none) loop = loop_for(h, steps, AtWalls::stop);
    if (loop == nullptr) return 0;
    const RecordedStep& step = *loop->step;
    values_.resize(step.program.values());
    Base::prepare();
    if (!read_values(step, values_)) return 0;  // one step by the ordinary road mends it
    std::int64_t taken = 0;
    std::int64_t block = 32;
    while (taken < steps && block > 0 && !stopped_) {
      block = std::min(block, steps - taken);
      kept_values_ = values_;
      const std::int64_t some = loop->steps->take(values_, block);
      if (some < 0 || !are_finite()) {
        values_.swap(kept_values_);
        block /= 2;  // to the step that fails
        continue;
      }
      add_bounces(step, values_, bounces);
      for (std::size_t k = 0; k < step.words; ++k) values_[step.first_word() + k] = 0;
      stopped_ = step.stops && values_[step.stop()] != 0;
      taken += stopped_ ? some - 1 : some;
      block = std::min(2 * block, BounceWord::most_steps);
    }
    take_values(step, values_, taken);
    return taken;
  }

  bool stopped_at_wall() const override { return stopped_; }
  /// Lanes take equal steps.
  std::shared_ptr<const RecordedStep> recorded_step(AtWalls at_walls) override {
    return Base::varies_steps() ? nullptr : record(at_walls);
  }
  /// Tangent vectors follow steps in plain double alone.
  std::shared_ptr<const RecordedStep> tangent_step(RecordedAt at) override {
    if constexpr (std::is_same_v<A, Plain<double>>) {
      if (!*recorder_) return nullptr;
      auto step = (*recorder_)(z_.positions(), z_.momenta(), clock_.step_length(), {}, false, at, AtWalls::stop);
      return step ? std::make_shared<const RecordedStep>(*std::move(step)) : nullptr;
    } else {
      return nullptr;
    }
  }
  void make_ready() override { Base::prepare(); }
  Outcome step_ordinarily() override { return ordinary(1); }
  double time_after(std::int64_t steps) const override { return static_cast<double>(clock_.time_after(steps)); }
  bool read_values(const RecordedStep& step, std::span<double> values) const override {
    std::fill(values.begin(), values.end(), 0.0);
    values.back() = static_cast<double>(clock_.position());
    return density_ ? gather(step.fields, values, z_, method_, probe_, *density_)
                    : gather(step.fields, values, z_, method_, probe_);
  }
  void take_values(const RecordedStep& step, std::span<const double> values, std::int64_t steps) override {
    if (density_) {
      scatter(step.fields, values, steps, z_, method_, probe_, *density_);
    } else {
      scatter(step.fields, values, steps, z_, method_, probe_);
    }
    clock_.advance(steps);
  }
  [[gnu::cold]] void restore(std::span<const std::byte> saved) override {
    Base::restore(saved);
    loops_ = {};  // where time begins is a constant of theirs
    step_ = nullptr;
  }
  bool is_recorded() const override {
    return std::any_of(loops_.begin(), loops_.end(), [](const auto& loop) { return loop && loop->steps; });
  }
  [[gnu::cold]] std::unique_ptr<Simulation> clone() const override {
    return std::make_unique<RecordedSimulation>(*this);
  }

 private:
  /// Recording and compiling a step costs about as much as so many of them.
  static constexpr std::int64_t worth_recording = 200;
  struct Loop {
    double h = 0;
    AtWalls at_walls = AtWalls::stop;
    std::shared_ptr<const RecordedStep> step;
    std::unique_ptr<const StepLoop> steps;  // null: the step cannot be recorded
  };

  std::shared_ptr<const RecordedStep> record(AtWalls at_walls) {
    if (!*recorder_) return nullptr;
    const double h = clock_.step_length();
    if (!step_ || step_of_ != std::pair(h, at_walls)) {
      const RecordedTime time{clock_.start(), clock_.step(), static_cast<double>(clock_.position()),
                              static_cast<double>(clock_.direction())};
      auto step = (*recorder_)(z_.positions(), z_.momenta(), h, time, watch_, RecordedAt::steady, at_walls);
      if (!step) return nullptr;
      step_ = std::make_shared<const RecordedStep>(*std::move(step));
      step_of_ = {h, at_walls};
    }
    return step_;
  }
  Outcome ordinary(std::int64_t steps) {
    if (watch_) return Base::advance(steps);
    const auto probe = probe_;
    const Outcome outcome = Base::advance(steps);
    probe_ = probe;
    return outcome;
  }
  bool are_finite() const {
    double most = 0;
    for (const double x : values_) most = most < abs(x) || x != x ? abs(x) : most;
    return most <= std::numeric_limits<double>::max();
  }

  /// Null where there is none, or too few steps have been asked for. Forwards and backwards are two loops, and so are
  /// the two ways of meeting walls.
  const Loop* loop_for(double h, std::int64_t steps, AtWalls at_walls) {
    for (const auto& loop : loops_) {
      if (loop && loop->h == h && loop->at_walls == at_walls) return loop->steps ? loop.get() : nullptr;
    }
    asked_ += steps;
    if (asked_ < worth_recording || !*recorder_) return nullptr;
    auto made = std::make_shared<Loop>();
    made->h = h;
    made->at_walls = at_walls;
    made->step = record(at_walls);
    constexpr int often_enough = 32;  // the step that was to be recorded may be one of another branch
    if (!made->step && behind_walls_ && ++failures_ < often_enough) return nullptr;
    if (made->step) made->steps = make_step_loop(made->step->program);
    const auto free = std::find(loops_.begin(), loops_.end(), nullptr);
    const auto place = free == loops_.end() ? loops_.begin() : free;
    *place = made;
    return made->steps ? made.get() : nullptr;
  }

  std::shared_ptr<const StepRecorder> recorder_;
  bool watch_;
  std::array<std::shared_ptr<const Loop>, 4> loops_;
  std::shared_ptr<const RecordedStep> step_;  // the last one that was recorded, of length step_of_
  std::pair<double, AtWalls> step_of_{};
  std::vector<double> values_;
  std::vector<double> kept_values_;
  std::int64_t asked_ = 0;
  bool behind_walls_ = false;
  bool stopped_ = false;  // the last recorded steps, at a wall
  int failures_ = 0;      // of recording
};

}  // namespace hamflow
