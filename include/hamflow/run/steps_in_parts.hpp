// What walls ask of a simulation: steps in parts, a way back to a mark, and single momenta turned round, in the numbers
// of the simulation itself. One implementation of walls then serves every problem, method and arithmetic
// (src/catalog/walled_simulation.hpp).
#pragma once

#include <array>
#include <optional>
#include <tuple>

#include "hamflow/run/simulation_of.hpp"

namespace hamflow {

/// to += now - before, of what is evaluated.
inline void add_evaluations(Effort& to, const Effort& now, const Effort& before = {}) {
  to.force += now.force - before.force;
  to.gradient += now.gradient - before.gradient;
  to.hessian += now.hessian - before.hessian;
  to.linear_solves += now.linear_solves - before.linear_solves;
}

template <class R>
class StepsInParts {
 public:
  virtual ~StepsInParts() = default;
  virtual R length_of_step() const = 0;
  virtual R present_time() const = 0;
  virtual Vector<R, dynamic> present_positions() const = 0;
  virtual Vector<R, dynamic> present_momenta() const = 0;

  /// Keeps everything as it is now, in one of two places.
  enum class Place { step, flight };
  virtual void mark(Place place) = 0;
  /// To what was kept, which stays kept.
  virtual void back(Place place) = 0;
  /// z <- Psi_h(z), with nothing remembered. Clock and probe stay.
  virtual Outcome take_part(const R& h) = 0;
  /// What all parts cost that were ever taken, also those from which there was a way back.
  virtual Effort effort_of_parts() const = 0;
  /// A step has been taken in parts: the probe looks at the state, the clock goes on.
  virtual Outcome complete_step() = 0;
  /// p_i <- -p_i, every bit.
  virtual void negate_momentum(std::size_t i) = 0;
  virtual void push_momentum(std::size_t i, const R& change) = 0;
  /// q_i <- 2w - q_i.
  virtual void mirror_position(std::size_t i, const R& twice_the_wall) = 0;
  /// The state was changed: what the method remembers is dropped.
  virtual void forget() = 0;
  /// The present state as one of another time.
  virtual void show_at(const R& time, Frame& frame) const = 0;
  /// Takes recorded steps as long as they stay within the walls, and says how many; none where no step is recorded.
  virtual std::int64_t take_recorded(std::int64_t /*steps*/) { return 0; }
};

/// A simulation that can be asked so.
template <class Base>
class InParts : public Base, public StepsInParts<typename Base::Real> {
  using Real = typename Base::Real;
  using Parts = StepsInParts<Real>;

 protected:
  using Base::clock_;
  using Base::method_;
  using Base::probe_;
  using Base::z_;

 public:
  using Base::Base;
  using typename Parts::Place;
  explicit InParts(Base simulation) : Base(std::move(simulation)) {}

  Real length_of_step() const override { return this->next_length(); }
  Real present_time() const override { return this->time(); }
  Vector<Real, dynamic> present_positions() const override { return values(z_.positions()); }
  Vector<Real, dynamic> present_momenta() const override { return values(z_.momenta()); }
  void mark(Place place) override { marks_[static_cast<std::size_t>(place)].emplace(z_, method_, probe_, clock_); }
  void back(Place place) override { std::tie(z_, method_, probe_, clock_) = *marks_[static_cast<std::size_t>(place)]; }
  Outcome take_part(const Real& h) override {
    method_.invalidate();
    auto probe = probe_;
    std::int64_t taken = 0;
    const Effort before = method_.effort();
    const Outcome outcome = this->march(1, h, taken, method_, z_, probe);
    add_evaluations(effort_of_parts_, method_.effort(), before);
    method_.invalidate();
    return outcome;
  }
  Effort effort_of_parts() const override { return effort_of_parts_; }
  Outcome complete_step() override {
    if (!probe_.look(Base::problem(), z_.positions(), z_.momenta(), this->time_after(1, this->next_length()))) {
      return Outcome::non_finite;
    }
    clock_.advance(1);
    return Outcome::done;
  }
  void negate_momentum(std::size_t i) override {
    using Axis = std::remove_cvref_t<decltype(z_.arithmetic.momentum)>;
    z_.p[i] = Axis::negated(z_.p[i]);
  }
  void push_momentum(std::size_t i, const Real& change) override { z_.arithmetic.momentum.add(z_.p[i], change); }
  void mirror_position(std::size_t i, const Real& twice_the_wall) override {
    using Axis = std::remove_cvref_t<decltype(z_.arithmetic.position)>;
    z_.q[i] = Axis::negated(z_.q[i]);
    z_.arithmetic.position.add(z_.q[i], twice_the_wall);
  }
  void forget() override { method_.invalidate(); }
  void show_at(const Real& time, Frame& frame) const override { this->show(z_, time, frame); }
  [[gnu::cold]] std::unique_ptr<Simulation> clone() const override { return std::make_unique<InParts>(*this); }

 private:
  using Mark = std::tuple<std::remove_cvref_t<decltype(std::declval<Base&>().state())>,
                          typename Base::Stepper, typename Base::Watch, StepClock<Real>>;

  static Vector<Real, dynamic> values(const auto& x) {
    Vector<Real, dynamic> all(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) all[i] = x[i];
    return all;
  }

  std::array<std::optional<Mark>, 2> marks_;
  Effort effort_of_parts_;
};

}  // namespace hamflow
