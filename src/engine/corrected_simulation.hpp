// A simulation for a method with a corrector C, whose step is C^-1 M C. It takes steps of M from C z, and C^-1 is
// applied only to states that are shown. Energy and invariants are watched in these states.
#pragma once

#include <memory>
#include <utility>

#include "hamflow/run/simulation_of.hpp"
#include "planetary_steps.hpp"

namespace hamflow {

template <class M>
concept Corrected = requires(M& method) {
  method.step_without_corrector();
};

template <class P, class M, class A>
class CorrectedSimulation final : public Simulation, public PlanetarySteps {
  using Real = typename A::Real;
  using State = PhasePoint<A, P::dimension>;
  using Numbers = Vector<Real, P::dimension>;

  /// Takes the steps of M.
  class Stepping : public SimulationOf<P, M, A, NoProbe> {
    using Base = SimulationOf<P, M, A, NoProbe>;

   public:
    Stepping(const P& problem, M method, const Numbers& q, const Numbers& p, Real h, A arithmetic)
        : Base(problem, without_corrector(std::move(method)), q, p, h, arithmetic) {}
    Outcome correct() { return Base::method_.correct(clock().step_length(), Base::z_); }
    /// C^-1 z.
    Outcome show_in(State& z) const {
      M method = Base::method_;
      z = Base::z_;
      return method.undo_corrector(clock().step_length(), z);
    }
    void place(const State& z) { Base::z_ = z; }
    const StepClock<Real>& clock() const { return Base::clock_; }
    const M& stepper() const { return Base::method_; }

   private:
    static M without_corrector(M method) {
      method.step_without_corrector();
      return method;
    }
  };
  /// Holds the state C^-1 z, and watches it.
  class Shown : public SimulationOf<P, M, A> {
    using Base = SimulationOf<P, M, A>;

   public:
    using Base::Base;
    State& place() { return Base::z_; }
    StepClock<Real>& clock() { return Base::clock_; }
    void watch() {
      (void)Base::probe_.look(Base::problem_, Base::z_.positions(), Base::z_.momenta(), Base::clock_.time());
    }
  };

 public:
  CorrectedSimulation(const P& problem, const M& method, const Numbers& q, const Numbers& p, Real h, A arithmetic)
      : stepping_(problem, method, q, p, h, arithmetic), shown_(problem, method, q, p, h, arithmetic) {
    begin();
  }

  Outcome advance(std::int64_t steps) override {
    if (begun_ != Outcome::done) return begun_;
    const Stepping before = stepping_;
    const Outcome outcome = stepping_.advance(steps);
    if (show()) return outcome;
    stepping_ = before;  // the last step from which C^-1 leads to a state is found one by one
    for (; steps > 0; --steps) {
      const Stepping last = stepping_;
      const Outcome one = stepping_.advance(1);
      if (show()) {
        if (one != Outcome::done) return one;
        continue;
      }
      stepping_ = last;
      return Outcome::not_converged;
    }
    return Outcome::done;
  }
  std::int64_t step() const override { return stepping_.step(); }
  void look(Frame& frame) const override {
    if (!is_watched_) shown_.watch();
    is_watched_ = true;
    shown_.look(frame);
    frame.effort = effort();
  }
  void reverse_time() override {
    stepping_.reverse_time();
    shown_.reverse_time();
    begin();
  }
  void negate_momenta() override {
    shown_.negate_momenta();
    begin();
  }
  std::vector<std::byte> bits() const override { return shown_.bits(); }
  Excursion energy() const override { return shown_.energy(); }
  void restart_energy_range() override { shown_.restart_energy_range(); }
  std::vector<InvariantExcursion> invariants() const override { return shown_.invariants(); }
  Effort effort() const override { return stepping_.effort(); }
  StepDiagnostics diagnostics() const override { return {}; }
  MethodInfo method() const override { return shown_.method(); }
  std::string failure() const override { return stepping_.failure(); }
  std::optional<CloseEncounter> first_encounter() const override {
    return encounter_of(stepping_.stepper(), stepping_.clock());
  }
  bool watches_every_step() const override { return false; }

  std::vector<std::byte> save() const override {
    Writer ar;
    ar(stepping_.save(), shown_.save(), is_watched_);
    return ar.take();
  }
  void restore(std::span<const std::byte> saved) override {
    Reader ar(saved);
    std::vector<std::byte> of_stepping;
    std::vector<std::byte> of_shown;
    bool is_watched = false;
    ar(of_stepping, of_shown, is_watched);
    ar.finish();
    CorrectedSimulation restored = *this;
    restored.stepping_.restore(of_stepping);
    restored.shown_.restore(of_shown);
    restored.is_watched_ = is_watched;
    restored.begun_ = Outcome::done;
    *this = std::move(restored);
  }
  std::unique_ptr<Simulation> clone() const override { return std::make_unique<CorrectedSimulation>(*this); }
  Outcome look_ahead(const std::string& time, Frame& frame) const override { return shown_.look_ahead(time, frame); }
  Outcome look_part(double theta, Frame& frame) const override { return shown_.look_part(theta, frame); }

 private:
  /// Steps from the shown state, C z.
  void begin() {
    stepping_.place(shown_.place());
    begun_ = stepping_.correct();
  }
  /// Makes the shown state that of the present step; false if C^-1 leads to none.
  bool show() {
    State z;
    if (stepping_.show_in(z) != Outcome::done) return false;
    if (shown_.step() != stepping_.step()) is_watched_ = false;
    shown_.place() = z;
    shown_.clock() = stepping_.clock();
    return true;
  }

  Stepping stepping_;
  mutable Shown shown_;             // its probe sees the states that look() shows
  mutable bool is_watched_ = true;  // whether it has seen the present one
  Outcome begun_ = Outcome::done;   // of the corrector at the start
};

}  // namespace hamflow
