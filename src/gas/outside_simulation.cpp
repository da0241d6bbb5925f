#include "outside_simulation.hpp"

#include "core/outside_note.hpp"

namespace hamflow {

namespace {

class OutsideSimulation final : public Simulation {
 public:
  OutsideSimulation(std::unique_ptr<Simulation> inner, StepInDouble in_double)
      : inner_(std::move(inner)), in_double_(std::move(in_double)) {}

  Outcome advance(std::int64_t steps) override {
    why_.clear();
    std::optional<std::size_t> particle;
    const OutsideNote note(particle);
    const Outcome outcome = inner_->advance(steps);
    if (outcome == Outcome::lattice_overflow && !particle && in_double_) {
      Frame frame;
      inner_->look(frame);
      why_ = in_double_(frame, backwards_);
      if (!why_.empty()) return Outcome::outside;
    }
    return explained(outcome, particle, why_);
  }
  Outcome look_ahead(const std::string& time, Frame& frame) const override {
    std::optional<std::size_t> particle;
    std::string why;
    const OutsideNote note(particle);
    return explained(inner_->look_ahead(time, frame), particle, why);
  }
  Outcome look_part(double theta, Frame& frame) const override {
    std::optional<std::size_t> particle;
    std::string why;
    const OutsideNote note(particle);
    return explained(inner_->look_part(theta, frame), particle, why);
  }
  std::string failure() const override { return why_.empty() ? inner_->failure() : why_; }
  std::unique_ptr<Simulation> clone() const override { return copy(); }

  std::int64_t step() const override { return inner_->step(); }
  void look(Frame& frame) const override { inner_->look(frame); }
  void reverse_time() override {
    inner_->reverse_time();
    backwards_ = !backwards_;
  }
  void negate_momenta() override { inner_->negate_momenta(); }
  std::vector<std::byte> bits() const override { return inner_->bits(); }
  Excursion energy() const override { return inner_->energy(); }
  void restart_energy_range() override { inner_->restart_energy_range(); }
  std::vector<InvariantExcursion> invariants() const override { return inner_->invariants(); }
  std::optional<ConstraintResiduals> constraints() const override { return inner_->constraints(); }
  Effort effort() const override { return inner_->effort(); }
  StepDiagnostics diagnostics() const override { return inner_->diagnostics(); }
  MethodInfo method() const override { return inner_->method(); }
  bool is_recorded() const override { return inner_->is_recorded(); }
  std::vector<WallCount> wall_counts() const override { return inner_->wall_counts(); }
  void on_bounce(std::function<void(const Bounce&)> callback) override { inner_->on_bounce(std::move(callback)); }
  std::vector<std::byte> save() const override { return inner_->save(); }
  void restore(std::span<const std::byte> saved) override { inner_->restore(saved); }

 private:
  /// Explains a NaN, or a number too large for the lattice, by a particle outside.
  static Outcome explained(Outcome outcome, const std::optional<std::size_t>& particle, std::string& why) {
    const bool by_number =
        outcome == Outcome::non_finite || outcome == Outcome::not_converged || outcome == Outcome::lattice_overflow;
    if (!particle || !by_number) return outcome;
    why = "particle " + std::to_string(*particle + 1) + " was on or beyond the soft wall";
    return Outcome::outside;
  }

  std::unique_ptr<OutsideSimulation> copy() const {
    auto other = std::make_unique<OutsideSimulation>(inner_->clone(), in_double_);
    other->backwards_ = backwards_;
    return other;
  }

  std::unique_ptr<Simulation> inner_;
  StepInDouble in_double_;
  bool backwards_ = false;
  std::string why_;
};

}  // namespace

std::unique_ptr<Simulation> telling_who_is_outside(std::unique_ptr<Simulation> simulation, StepInDouble in_double) {
  return std::make_unique<OutsideSimulation>(std::move(simulation), std::move(in_double));
}

}  // namespace hamflow
