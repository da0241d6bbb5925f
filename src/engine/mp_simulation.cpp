#include "mp_simulation.hpp"

#include <chrono>

#include "hamflow/arithmetic/mp.hpp"
#include "planetary_steps.hpp"
#include "step_interruption.hpp"

namespace hamflow {

namespace {
class MpSimulation final : public Simulation, public PlanetarySteps {
 public:
  MpSimulation(int digits, std::unique_ptr<Simulation> inner) : digits_(digits), inner_(std::move(inner)) {}
  ~MpSimulation() override {
    const MpDigits scope(digits_);
    inner_.reset();
  }
  Outcome advance(std::int64_t steps) override {
    return in_scope([&] {
      for (; steps > 0 && has_long_steps_; --steps) {
        const auto before = inner_->clone();
        try {
          const StepInterruption interruption;
          if (const Outcome outcome = measured_advance(1); outcome != Outcome::done) return outcome;
        } catch (const StepInterruption::Taken&) {
          inner_->restore(before->save());
          return Outcome::stopped;
        }
      }
      return steps > 0 ? measured_advance(steps) : Outcome::done;
    });
  }
  std::int64_t step() const override { return inner_->step(); }
  void look(Frame& frame) const override {
    in_scope([&] { inner_->look(frame); });
  }
  void reverse_time() override {
    in_scope([&] { inner_->reverse_time(); });
  }
  void negate_momenta() override {
    in_scope([&] { inner_->negate_momenta(); });
  }
  std::vector<std::byte> bits() const override {
    return in_scope([&] { return inner_->bits(); });
  }
  Excursion energy() const override {
    return in_scope([&] { return inner_->energy(); });
  }
  void restart_energy_range() override {
    in_scope([&] { inner_->restart_energy_range(); });
  }
  std::vector<InvariantExcursion> invariants() const override {
    return in_scope([&] { return inner_->invariants(); });
  }
  std::optional<ConstraintResiduals> constraints() const override {
    return in_scope([&] { return inner_->constraints(); });
  }
  Effort effort() const override { return inner_->effort(); }
  StepDiagnostics diagnostics() const override {
    return in_scope([&] { return inner_->diagnostics(); });
  }
  MethodInfo method() const override { return inner_->method(); }
  std::string failure() const override {
    return in_scope([&]() -> std::string {  // the step is taken again
      try {
        const StepInterruption interruption;
        return inner_->failure();
      } catch (const StepInterruption::Taken&) {
        return {};
      }
    });
  }
  std::optional<CloseEncounter> first_encounter() const override {
    return in_scope([&]() -> std::optional<CloseEncounter> {
      const auto* const steps = dynamic_cast<const PlanetarySteps*>(inner_.get());
      return steps != nullptr ? steps->first_encounter() : std::nullopt;
    });
  }
  bool watches_every_step() const override {
    const auto* const steps = dynamic_cast<const PlanetarySteps*>(inner_.get());
    return steps == nullptr || steps->watches_every_step();
  }
  std::vector<WallCount> wall_counts() const override { return inner_->wall_counts(); }
  void on_bounce(std::function<void(const Bounce&)> callback) override { inner_->on_bounce(std::move(callback)); }
  std::vector<std::byte> save() const override {
    return in_scope([&] { return inner_->save(); });
  }
  void restore(std::span<const std::byte> saved) override {
    in_scope([&] { inner_->restore(saved); });
  }
  std::unique_ptr<Simulation> clone() const override {
    return in_scope([&] { return with_digits(digits_, inner_->clone()); });
  }
  Outcome look_ahead(const std::string& time, Frame& frame) const override {
    return in_scope([&] { return inner_->look_ahead(time, frame); });
  }
  Outcome look_part(double theta, Frame& frame) const override {
    return in_scope([&] { return inner_->look_part(theta, frame); });
  }

 private:
  template <class F>
  std::invoke_result_t<F> in_scope(F&& f) const {
    const MpDigits scope(digits_);
    return f();
  }
  Outcome measured_advance(std::int64_t steps) {
    using Clock = std::chrono::steady_clock;
    constexpr double long_step = 1e-3;  // seconds; a copy of the simulation costs little compared with that
    const Clock::time_point begin = Clock::now();
    const Outcome outcome = inner_->advance(steps);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    has_long_steps_ = seconds > long_step * static_cast<double>(steps);
    return outcome;
  }
  int digits_;
  std::unique_ptr<Simulation> inner_;
  bool has_long_steps_ = true;  // none was measured yet
};
}  // namespace

std::unique_ptr<Simulation> with_digits(int digits, std::unique_ptr<Simulation> simulation) {
  return std::make_unique<MpSimulation>(digits, std::move(simulation));
}

}  // namespace hamflow
