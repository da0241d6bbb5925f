// The interface of a simulation to walls: partial steps, saving and restoring the state, and changing the sign of
// single momenta, in the number type of the simulation. One implementation of walls then serves every problem, method
// and arithmetic (src/walls/walled_simulation.hpp). Functions that also depend on the method are in in_parts.hpp.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>

#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/run/simulation.hpp"

namespace hamflow {

/// to += now - before, for the counts of evaluations.
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
  /// p_i <- -p_i, exact to every bit.
  virtual void negate_momentum(std::size_t i) = 0;
  virtual void push_momentum(std::size_t i, const R& change) = 0;
  /// q_i <- 2w - q_i.
  virtual void mirror_position(std::size_t i, const R& twice_the_wall) = 0;
  /// Completes a step that was taken in parts: updates the probe and advances the clock.
  virtual Outcome complete_step() = 0;
  /// Shows the present state as the state at another time.
  virtual void show_at(const R& time, Frame& frame) const = 0;

  /// Saves the present state in one of two places.
  enum class Place { step, path };
  virtual void remember_state(Place /*place*/) { refuse(); }
  /// Restores the saved state, which stays saved.
  virtual void restore_state(Place /*place*/) { refuse(); }
  /// As restore_state(), but keeps the counts of the method's work. @return false, with nothing done, if not supported
  virtual bool restore_state_keeping_effort(Place /*place*/) { return false; }
  /// z <- Psi_h(z), without kick, force or initial guess from before. Clock and probe do not change.
  virtual Outcome take_part(const R& /*h*/) { refuse(); }
  /// Evaluates Psi_h from the state saved at Place::path: q, then dH/dp, valid until the next call. The state does not
  /// change. Null if only take_part can evaluate it.
  virtual const R* see_part(const R& /*h*/) { return nullptr; }
  /// Moves to the state that see_part has just evaluated.
  virtual void take_seen_part() { refuse(); }
  /// The work of all parts ever taken, including those after which the state was restored.
  virtual Effort effort_of_parts() const { refuse(); }
  /// Tells the method that the state was changed, so that it drops its memory of the state.
  virtual void forget() { refuse(); }
  /// As forget(), if only momenta were changed.
  virtual void forget_momenta() { forget(); }
  /// As forget(), if the state was mirrored in the i-th coordinate and the force is symmetric under that.
  virtual void forget_mirrored(std::size_t /*i*/) { forget(); }
  /// Computes the quantity that the next step begins with, if the method keeps one and has dropped it.
  virtual void prepare() {}
  /// Takes recorded steps and returns their number; 0 if no step is recorded. `bounces` has a count for each side, to
  /// which bounces within such steps are added. If it is empty, recorded steps do not bounce, and the first step that
  /// might is not taken.
  virtual std::int64_t take_recorded(std::int64_t /*steps*/, std::span<std::int64_t> /*bounces*/) { return 0; }

 private:
  [[noreturn]] static void refuse() {
    throw std::logic_error("hamflow: this simulation does not support partial steps");
  }
};

}  // namespace hamflow
