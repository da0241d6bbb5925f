// What walls ask of a simulation: steps in parts, a way back to a mark, and single momenta turned round, in the numbers
// of the simulation itself. One implementation of walls then serves every problem, method and arithmetic
// (src/walls/walled_simulation.hpp). What depends on the method too is in in_parts.hpp.
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>

#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/run/simulation.hpp"

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
  /// p_i <- -p_i, every bit.
  virtual void negate_momentum(std::size_t i) = 0;
  virtual void push_momentum(std::size_t i, const R& change) = 0;
  /// q_i <- 2w - q_i.
  virtual void mirror_position(std::size_t i, const R& twice_the_wall) = 0;
  /// A step has been taken in parts: the probe looks at the state, the clock goes on.
  virtual Outcome complete_step() = 0;
  /// The present state as one of another time.
  virtual void show_at(const R& time, Frame& frame) const = 0;

  /// Keeps everything as it is now, in one of two places.
  enum class Place { step, path };
  virtual void remember_state(Place /*place*/) { refuse(); }
  /// To what was kept, which stays kept.
  virtual void restore_state(Place /*place*/) { refuse(); }
  /// The same, but the method goes on counting its work. @return false where it cannot: then nothing was done
  virtual bool restore_state_keeping_effort(Place /*place*/) { return false; }
  /// z <- Psi_h(z), with no kick, force or guess remembered. Clock and probe stay.
  virtual Outcome take_part(const R& /*h*/) { refuse(); }
  /// Where Psi_h leads from the mark of the flight: q, then dH/dp, for as long as nothing else is asked. Nobody moves.
  /// Null: only take_part knows.
  virtual const R* see_part(const R& /*h*/) { return nullptr; }
  /// Goes where see_part has just looked.
  virtual void take_seen_part() { refuse(); }
  /// What all parts cost that were ever taken, also those from which there was a way back.
  virtual Effort effort_of_parts() const { refuse(); }
  /// The state was changed: what the method remembers of it is dropped.
  virtual void forget() { refuse(); }
  /// The same where momenta alone were changed.
  virtual void forget_momenta() { forget(); }
  /// The same where the state was mirrored in the i-th coordinate, of a force that is its own mirror image.
  virtual void forget_mirrored(std::size_t /*i*/) { forget(); }
  /// What the next step begins with is computed now, where a method keeps it and has forgotten it.
  virtual void prepare() {}
  /// Takes recorded steps, and says how many; none where no step is recorded. `bounces` has a number for each side:
  /// what is bounced within such steps is added there. Without numbers no step bounces, and the first that may is not
  /// taken.
  virtual std::int64_t take_recorded(std::int64_t /*steps*/, std::span<std::int64_t> /*bounces*/) { return 0; }

 private:
  [[noreturn]] static void refuse() { throw std::logic_error("hamflow: this simulation takes no steps in parts"); }
};

}  // namespace hamflow
