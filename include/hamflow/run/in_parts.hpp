// A simulation whose steps can be taken in parts.
#pragma once

#include <array>
#include <optional>
#include <tuple>

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

  void mark(Place place) override { marks_[static_cast<std::size_t>(place)].emplace(z_, method_, probe_, clock_); }
  void back(Place place) override { std::tie(z_, method_, probe_, clock_) = *marks_[static_cast<std::size_t>(place)]; }
  Outcome take_part(const Real& h) override {
    InParts::forget();
    auto probe = probe_;
    std::int64_t taken = 0;
    const Effort before = method_.effort();
    const Outcome outcome = this->march(1, h, taken, method_, z_, probe);
    add_evaluations(effort_of_parts_, method_.effort(), before);
    InParts::forget();
    return outcome;
  }
  Effort effort_of_parts() const override { return effort_of_parts_; }
  void forget() override {
    if constexpr (requires { method_.forget_guesses(); }) {
      method_.forget_guesses();
    } else {
      method_.invalidate();
    }
  }
  [[gnu::cold]] std::unique_ptr<Simulation> clone() const override { return std::make_unique<InParts>(*this); }

 private:
  using Mark = std::tuple<std::remove_cvref_t<decltype(std::declval<Base&>().state())>, typename Base::Stepper,
                          typename Base::Watch, StepClock<Real>>;
  std::array<std::optional<Mark>, 2> marks_;
  Effort effort_of_parts_;
};

}  // namespace hamflow
