// A simulation by name in double. It is the simulation behind virtual calls; if many steps are requested, a step is
// recorded once (recorded_step.hpp), compiled into a loop (detail/numerics/program.hpp) and repeated, with the same
// bits. If a check of the loop fails, or the step cannot be recorded, the simulation takes the block from its start.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "hamflow/detail/run/step_sums.hpp"
#include "in_parts.hpp"
#include "planetary_steps.hpp"
#include "recorded_part.hpp"
#include "recorded_step.hpp"

namespace hamflow {

/// Records the step of length h from a state, with or without the probe.
using StepRecorder = std::function<std::optional<RecordedStep>(
    const Vector<double, dynamic>& q, const Vector<double, dynamic>& p, double h, const RecordedTime& time, bool watch,
    RecordedAt at, AtWalls at_walls)>;

template <class P, class M, Arithmetic A>
class RecordedSimulation final : public InParts<SimulationOf<P, M, A>>,
                                 public RecordedMember,
                                 public HasPartsInNumbers,
                                 public PlanetaryStepsIf<EncounterWatcher<M>> {
  using Base = InParts<SimulationOf<P, M, A>>;
  using typename StepsInParts<double>::Place;
  using Base::clock_;
  using Base::density_;
  using Base::effort_of_parts_;
  using Base::method_;
  using Base::probe_;
  using Base::z_;

 public:
  /// @param recorder empty: no step is recorded @param parts empty: no part is recorded
  /// @param watch false: the probe is not updated
  RecordedSimulation(SimulationOf<P, M, A> simulation, StepRecorder recorder, PartRecorder parts, bool watch)
      : Base(std::move(simulation)),
        recorder_(std::make_shared<const StepRecorder>(std::move(recorder))),
        part_(std::make_shared<SharedPart>(std::move(parts))),
        watch_(watch) {}

  Outcome advance(std::int64_t steps) override {
    if (resting_ > 0) {
      resting_ -= steps;
      return ordinary(steps);
    }
    const Loop* const loop = loop_for(clock_.step_length(), steps, AtWalls::stop);
    if (loop == nullptr || steps < 1 || loop->step->stops) return ordinary(steps);
    if (!read_all(*loop->step)) {
      // One step computes the data that the method keeps for the next one.
      const Outcome outcome = ordinary(1);
      if (outcome != Outcome::done || --steps == 0) return outcome;
      if (!read_all(*loop->step)) return ordinary(steps);
    }
    if (!loop->steps->run(values_, steps) || !are_finite()) {
      rest(steps);
      return ordinary(steps);
    }
    rest_ = std::max<std::int64_t>(0, rest_ - steps);
    if (watch_) {
      take_all(*loop->step, steps);
      return Outcome::done;
    }
    // The energy has not been checked yet.
    const auto z = z_;
    const auto method = method_;
    const auto clock = clock_;
    const auto density = density_;
    const std::vector<StepSum> sums(sums_.begin(), sums_.end());
    take_all(*loop->step, steps);
    if (Base::is_finite(Base::problem(), z_)) return Outcome::done;
    std::copy(sums.begin(), sums.end(), sums_.begin());
    z_ = z;
    method_ = method;
    clock_ = clock;
    density_ = density;
    return ordinary(steps);
  }

  /// The size of blocks increases, so that few steps are repeated if a check fails. A block that ends at a wall has not
  /// failed.
  std::int64_t take_recorded(std::int64_t steps, std::span<std::int64_t> bounces) override {
    behind_walls_ = true;
    undone_ = nullptr;
    const double h = clock_.step_length();
    const Loop* loop = bounces.empty() ? nullptr : loop_for(h, steps, AtWalls::bounce);
    const bool is_none = loop == nullptr && (bounces.empty() || asked_ >= worth_recording);
    if (is_none) loop = loop_for(h, steps, AtWalls::stop);
    if (loop == nullptr) return 0;
    const RecordedStep& step = *loop->step;
    Base::prepare();
    if (!read_all(step)) return 0;  // one ordinary step corrects this
    std::int64_t taken = 0;
    std::int64_t block = block_;
    bool has_failed = false;
    while (taken < steps && block > 0 && undone_ == nullptr) {
      const std::int64_t most = std::min(block, steps - taken);
      kept_values_ = values_;
      const std::int64_t some = loop->steps->take(values_, most);
      if (some < 0 || !are_finite()) {
        values_.swap(kept_values_);
        block = most / 2;  // bisects towards the step that fails
        has_failed = true;
        continue;
      }
      add_bounces(step, values_, bounces);
      for (std::size_t k = 0; k < step.words; ++k) values_[step.first_word() + k] = 0;
      if (step.stops && values_[step.stop()] != 0) undone_ = loop->step;
      taken += undone_ != nullptr ? some - 1 : some;
      block = std::min(2 * block, BounceWord::most_steps);
    }
    block_ = has_failed ? first_block : block;
    take_all(step, taken);
    return taken;
  }

  const RecordedStep* undone_step() const override { return undone_.get(); }

  /// With walls, only for the steps of take_recorded().
  bool add_to_sums(std::span<const NamedExpression> summed, std::span<StepSum> sums) override {
    const auto uses_time = [](const NamedExpression& each) { return each.expression.uses_time(); };
    if (!*recorder_ || std::any_of(summed.begin(), summed.end(), uses_time)) return false;
    if (!summed_.empty() || !summed.empty()) loops_ = {};
    summed_ = summed;
    sums_ = sums;
    return true;
  }

  void remember_state(Place place) override {
    Base::remember_state(place);
    if (place != Place::path) return;
    is_at_mark_ = true;
    if (numbers_) read_state();
  }
  Outcome take_part(const double& h) override {
    is_at_mark_ = false;
    return Base::take_part(h);
  }
  bool restore_state_keeping_effort(Place place) override {
    std::vector<std::int64_t> counts;
    for_each_counter([&](auto& x) { counts.push_back(static_cast<std::int64_t>(x)); }, method_);
    Base::restore_state(place);
    std::size_t k = 0;
    for_each_counter([&]<class T>(T& x) { x = static_cast<T>(counts[k++]); }, method_);
    return true;
  }
  const double* see_part(const double& h) override {
    if (!numbers_ && !make_part(h)) return nullptr;
    const double* const end = numbers_->look(h);
    if (end != nullptr) add_evaluations(effort_of_parts_, numbers_->part().effort);
    return end;
  }
  void take_seen_part() override {
    if (!std::exchange(is_at_mark_, false)) Base::restore_state(Place::path);
    numbers_->go();
    take_numbers(1);
  }
  PartsInNumbers* parts_in_numbers() override {
    if (!numbers_) return nullptr;
    read_state();
    return &*numbers_;
  }
  bool write_back_state() override {
    const double error = std::abs(numbers_->energy() - probe_.initial_energy());
    if (!(error <= std::numeric_limits<double>::max())) return false;
    take_numbers(numbers_->parts());
    return true;
  }
  /// Lanes take equal steps.
  std::shared_ptr<const RecordedStep> recorded_step(AtWalls at_walls) override {
    return Base::varies_steps() ? nullptr : record(at_walls);
  }
  /// Only for steps in plain double. The derivative of a Kepler drift is not that of its recorded operations, which
  /// leave out a part of Newton's method that is below rounding (orbits/kepler_tangent.hpp).
  std::shared_ptr<const RecordedStep> tangent_step(RecordedAt at) override {
    if constexpr (std::is_same_v<A, Plain<double>> && !EncounterWatcher<M>) {
      if (!*recorder_) return nullptr;
      auto step = (*recorder_)(z_.positions(), z_.momenta(), clock_.step_length(), {}, false, at, AtWalls::stop);
      return step ? std::make_shared<const RecordedStep>(*std::move(step)) : nullptr;
    } else {
      return nullptr;
    }
  }
  void make_ready() override { Base::prepare(); }
  Outcome step_ordinarily(const RecordedStep& /*undone*/) override { return ordinary(1); }
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
    loops_ = {};  // the start time is a constant of the loops
    step_ = nullptr;
    undone_ = nullptr;
  }
  // These override functions of PlanetarySteps if the method watches for encounters.
  std::optional<CloseEncounter> first_encounter() const {
    if constexpr (EncounterWatcher<M>) {
      return encounter_of(method_, clock_);
    } else {
      return {};
    }
  }
  bool watches_every_step() const { return true; }
  bool is_recorded() const override {
    return std::any_of(loops_.begin(), loops_.end(), [](const auto& loop) { return loop && loop->steps; });
  }
  [[gnu::cold]] std::unique_ptr<Simulation> clone() const override {
    auto copy = std::make_unique<RecordedSimulation>(*this);
    (void)copy->add_to_sums({}, {});
    return copy;
  }

 private:
  /// The number of steps that recording and compiling a step cost.
  static constexpr std::int64_t worth_recording = 200;
  static constexpr std::int64_t first_block = 32;
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
  [[gnu::cold]] bool make_part(double h) {
    numbers_ = part_->find(z_.positions(), z_.momenta(), h);
    if (!numbers_) return false;
    Base::restore_state(Place::path);
    is_at_mark_ = true;
    read_state();
    return true;
  }
  void read_state() { read_state_into(*numbers_); }
  void read_state_into(PartsInNumbers& numbers) const {
    double* value = numbers.begin();
    for_each_carried([&](const double& x) { *value++ = x; }, z_);
  }
  /// With a recorded part, if there is one, and the same bits.
  [[gnu::cold]] Outcome show_after(const double& part, const double& t, Frame& frame) const override {
    if (!looks_) looks_ = part_->find(z_.positions(), z_.momenta(), part);
    if (looks_) read_state_into(*looks_);
    if (!looks_ || looks_->look(part) == nullptr) return Base::show_after(part, t, frame);
    looks_->go();
    constexpr double most = std::numeric_limits<double>::max();
    bool finite = std::abs(looks_->energy() - probe_.initial_energy()) <= most;
    auto z = z_;
    const double* value = looks_->state();
    for_each_carried(
        [&](double& x) {
          x = *value++;
          finite = finite && std::abs(x) <= most;
        },
        z);
    if (!finite) return Base::show_after(part, t, frame);
    Base::show(z, t, looks_->energy(), frame);
    return Outcome::done;
  }
  void take_numbers(std::int64_t parts) {
    const double* value = numbers_->state();
    for_each_carried([&](double& x) { x = *value++; }, z_);
    const std::int64_t* count = numbers_->part().counters.data();
    for_each_counter([&]<class T>(T& x) { x += static_cast<T>(parts * *count++); }, method_);
    Base::forget();
  }
  Outcome ordinary(std::int64_t steps) {
    if (summed_.empty() || behind_walls_) return ordinary_steps(steps);
    Frame frame;
    for (; steps > 0; --steps) {
      if (const Outcome outcome = ordinary_steps(1); outcome != Outcome::done) return outcome;
      Base::look(frame);
      for (std::size_t i = 0; i < summed_.size(); ++i) sums_[i].add(summed_[i].expression(frame));
    }
    return Outcome::done;
  }
  Outcome ordinary_steps(std::int64_t steps) {
    if (watch_) return Base::advance(steps);
    const auto probe = probe_;
    const Outcome outcome = Base::advance(steps);
    probe_ = probe;
    return outcome;
  }
  /// Whether all numbers are finite; sums may be NaN.
  bool are_finite() const {
    double most = 0;
    for (const double x : std::span(values_).first(values_.size() - 2 * summed_.size())) {
      most = most < abs(x) || x != x ? abs(x) : most;
    }
    return most <= std::numeric_limits<double>::max();
  }
  /// Reads the values of a step, followed by those of the sums.
  bool read_all(const RecordedStep& step) {
    const std::size_t of_step = step.program.values();
    values_.resize(of_step + 2 * summed_.size());
    if (!read_values(step, std::span(values_).first(of_step))) return false;
    for (std::size_t i = 0; i < summed_.size(); ++i) {
      values_[of_step + 2 * i] = sums_[i].sum;
      values_[of_step + 2 * i + 1] = sums_[i].lost;
    }
    return true;
  }
  void take_all(const RecordedStep& step, std::int64_t steps) {
    const std::size_t of_step = step.program.values();
    take_values(step, std::span(values_).first(of_step), steps);
    for (std::size_t i = 0; i < summed_.size(); ++i) {
      sums_[i] = {values_[of_step + 2 * i], values_[of_step + 2 * i + 1]};
    }
  }

  /// Called after a block in which a check failed. A motion that stays on another branch fails in every block, each of
  /// which costs its steps twice. So the loop is not used for as many steps as the block has, for twice as many after
  /// the next failure, and so on, until it has succeeded for as many steps as it was unused. After a long pause it is
  /// recorded again, on the current branch.
  void rest(std::int64_t steps) {
    constexpr std::int64_t most = 1 << 20;
    rest_ = std::min(most, std::max(2 * rest_, steps));
    resting_ = rest_;
    if (rest_ < 10 * worth_recording) return;
    loops_ = {};
    step_ = nullptr;
  }
  /// The loop for these steps; null if there is none or too few steps have been requested. Forward and backward steps,
  /// and the two treatments of walls, have separate loops.
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
    constexpr int often_enough = 32;  // another branch may be recorded next time
    if (!made->step && behind_walls_ && ++failures_ < often_enough) return nullptr;
    if (made->step && summed_.empty()) made->steps = make_step_loop(made->step->program);
    if (made->step && !summed_.empty()) {
      const std::optional<std::size_t> undone = made->step->stops ? std::optional(made->step->stop()) : std::nullopt;
      made->steps = make_step_loop(with_sums(made->step->program, made->step->state, undone, summed_).value());
    }
    const auto free = std::find(loops_.begin(), loops_.end(), nullptr);
    const auto place = free == loops_.end() ? loops_.begin() : free;
    *place = made;
    return made->steps ? made.get() : nullptr;
  }

  std::shared_ptr<const StepRecorder> recorder_;
  std::shared_ptr<SharedPart> part_;
  bool watch_;
  std::array<std::shared_ptr<const Loop>, 4> loops_;
  std::shared_ptr<const RecordedStep> step_;  // the last recorded step, of length step_of_
  std::pair<double, AtWalls> step_of_{};
  std::vector<double> values_;
  std::vector<double> kept_values_;
  std::int64_t block_ = first_block;
  std::int64_t asked_ = 0;
  std::int64_t rest_ = 0;     // length of the last pause of the loop, minus its successful steps since
  std::int64_t resting_ = 0;  // remaining steps of the pause
  bool behind_walls_ = false;
  std::shared_ptr<const RecordedStep> undone_;  // kept when loops are dropped
  int failures_ = 0;                            // failures of recording
  std::span<const NamedExpression> summed_{};   // their values after each step are added to sums_
  std::span<StepSum> sums_{};
  std::optional<PartsInNumbers> numbers_;
  mutable std::optional<PartsInNumbers> looks_;  // for states within a step
  bool is_at_mark_ = false;                      // whether the state is the one saved at Place::path
};

}  // namespace hamflow
