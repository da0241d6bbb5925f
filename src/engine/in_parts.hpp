// A simulation whose steps can be taken in parts.
#pragma once

#include <array>
#include <memory>

#include "hamflow/run/simulation_of.hpp"

namespace hamflow {

template <class Base>
class InParts : public Base {
  using Real = typename Base::Real;

 protected:
  using Base::clock_;
  using Base::method_;
  using Base::probe_;
  using Base::z_;

 public:
  using Base::Base;
  using typename StepsInParts<Real>::Place;
  explicit InParts(Base simulation) : Base(std::move(simulation)) {}

  void remember_state(Place place) override {
    std::unique_ptr<InParts>& kept = marks_.kept[static_cast<std::size_t>(place)];
    if (!kept) kept = std::make_unique<InParts>(*this);
    kept->take(*this);
  }
  void restore_state(Place place) override { take(*marks_.kept[static_cast<std::size_t>(place)]); }
  Outcome take_part(const Real& h) override {
    InParts::forget();
    const Effort before = method_.effort();
    Outcome outcome = method_.step(this->problem_, h, z_);
    if (outcome == Outcome::done && z_.arithmetic.lost()) outcome = Outcome::lattice_overflow;
    if (outcome == Outcome::done && !Base::is_finite(this->problem_, z_)) outcome = Outcome::non_finite;
    add_evaluations(effort_of_parts_, method_.effort(), before);
    InParts::forget();
    return outcome;
  }
  void negate_momentum(std::size_t i) override {
    Base::negate_momentum(i);
    if constexpr (requires { method_.negate_momentum(i); }) method_.negate_momentum(i);
  }
  void push_momentum(std::size_t i, const Real& change) override {
    Base::push_momentum(i, change);
    if constexpr (requires { method_.push_momentum(i, change); }) method_.push_momentum(i, change);
  }
  Effort effort_of_parts() const override { return effort_of_parts_; }
  void forget() override {
    if constexpr (requires { method_.forget_guesses(); }) {
      method_.forget_guesses();
    } else {
      method_.invalidate();
    }
  }
  void forget_momenta() override {
    if (!memory_depends_on_positions_only<typename Base::Stepper>() || has_clock(Base::problem())) InParts::forget();
  }
  void forget_mirrored(std::size_t i) override {
    // If a position is a single number, the mirror image of a force has the same bits except for the sign.
    if constexpr (std::is_same_v<decltype(z_.arithmetic), Plain<Real>> && requires { method_.mirror_kept(i); }) {
      method_.mirror_kept(i);
    } else {
      InParts::forget();
    }
  }
  void prepare() override {
    if constexpr (requires { method_.prepare(Base::problem(), clock_.step_length(), z_); }) {
      if (!Base::varies_steps()) method_.prepare(Base::problem(), clock_.step_length(), z_);
    }
  }
  [[gnu::cold]] std::unique_ptr<Simulation> clone() const override { return std::make_unique<InParts>(*this); }

 protected:
  Effort effort_of_parts_;

 private:
  void take(const InParts& other) {
    z_ = other.z_;
    method_ = other.method_;
    probe_ = other.probe_;
    clock_ = other.clock_;
  }
  /// Saved states. A copy of the simulation has none.
  struct Marks {
    std::array<std::unique_ptr<InParts>, 2> kept;
    Marks() = default;
    Marks(const Marks&) {}
    Marks& operator=(const Marks&) { return *this; }
  };
  Marks marks_;
};

}  // namespace hamflow
