// A simulation of H(q, p, t) that hides its last coordinates, which hold the time (detail/core/step_clock.hpp): frames
// show only the named coordinates.
#pragma once

#include "hamflow/run/simulation.hpp"
#include "recorded_step.hpp"

namespace hamflow {

class TimedSimulation final : public Simulation, public RecordedMember {
 public:
  explicit TimedSimulation(std::unique_ptr<Simulation> extended)
      : extended_(std::move(extended)), recorded_(dynamic_cast<RecordedMember*>(extended_.get())) {}

  Outcome advance(std::int64_t steps) override { return extended_->advance(steps); }
  std::int64_t step() const override { return extended_->step(); }
  void look(Frame& frame) const override {
    extended_->look(frame);
    strip(frame);
  }
  void reverse_time() override { extended_->reverse_time(); }
  void negate_momenta() override { extended_->negate_momenta(); }
  std::vector<std::byte> bits() const override { return extended_->bits(); }
  Excursion energy() const override { return extended_->energy(); }
  void restart_energy_range() override { extended_->restart_energy_range(); }
  std::vector<InvariantExcursion> invariants() const override { return extended_->invariants(); }
  std::optional<ConstraintResiduals> constraints() const override { return extended_->constraints(); }
  Effort effort() const override { return extended_->effort(); }
  StepDiagnostics diagnostics() const override { return extended_->diagnostics(); }
  MethodInfo method() const override { return extended_->method(); }
  std::string failure() const override { return extended_->failure(); }
  bool is_recorded() const override { return extended_->is_recorded(); }
  std::vector<WallCount> wall_counts() const override { return extended_->wall_counts(); }
  void on_bounce(std::function<void(const Bounce&)> callback) override {
    if (!callback) return extended_->on_bounce({});
    extended_->on_bounce([callback = std::move(callback)](const Bounce& extended) {
      Bounce bounce = extended;
      strip(bounce.q);
      strip(bounce.p);
      strip(bounce.digits.q);
      strip(bounce.digits.p);
      callback(bounce);
    });
  }
  std::vector<std::byte> save() const override { return extended_->save(); }
  void restore(std::span<const std::byte> saved) override { extended_->restore(saved); }
  std::unique_ptr<Simulation> clone() const override { return std::make_unique<TimedSimulation>(extended_->clone()); }
  Outcome look_ahead(const std::string& time, Frame& frame) const override {
    const Outcome outcome = extended_->look_ahead(time, frame);
    strip(frame);
    return outcome;
  }
  Outcome look_part(double theta, Frame& frame) const override {
    const Outcome outcome = extended_->look_part(theta, frame);
    strip(frame);
    return outcome;
  }

  std::shared_ptr<const RecordedStep> recorded_step(AtWalls at_walls) override {
    const auto extended = recorded_ != nullptr ? recorded_->recorded_step(at_walls) : nullptr;
    if (!extended) return nullptr;
    auto step = std::make_shared<RecordedStep>(*extended);
    const auto end_of_q = step->state.begin() + static_cast<std::ptrdiff_t>(step->state.size() / 2);
    std::vector<std::size_t> q(step->state.begin(), end_of_q);
    std::vector<std::size_t> p(end_of_q, step->state.end());
    strip(q);
    strip(p);
    q.insert(q.end(), p.begin(), p.end());
    step->state = std::move(q);
    return step;
  }
  void make_ready() override { recorded_->make_ready(); }
  Outcome step_ordinarily(const RecordedStep& undone) override { return recorded_->step_ordinarily(undone); }
  const RecordedStep* undone_step() const override { return recorded_ != nullptr ? recorded_->undone_step() : nullptr; }
  /// Not supported for H(q, p, t).
  std::shared_ptr<const RecordedStep> tangent_step(RecordedAt) override { return nullptr; }
  bool read_values(const RecordedStep& step, std::span<double> values) const override {
    return recorded_->read_values(step, values);
  }
  void take_values(const RecordedStep& step, std::span<const double> values, std::int64_t steps) override {
    recorded_->take_values(step, values, steps);
  }
  double time_after(std::int64_t steps) const override { return recorded_->time_after(steps); }

 private:
  static void strip(Frame& frame) {
    strip(frame.q);
    strip(frame.p);
    strip(frame.digits.q);
    strip(frame.digits.p);
  }
  /// Removes the entries of the hidden coordinates, if there are any.
  template <class T>
  static void strip(std::vector<T>& of_each) {
    if (!of_each.empty()) of_each.resize(of_each.size() - clock_coordinates);
  }

  std::unique_ptr<Simulation> extended_;
  RecordedMember* recorded_;  // the interface of the simulation inside; null if it has none
};

}  // namespace hamflow
