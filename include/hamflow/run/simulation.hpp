// The type-erased block: the only virtual boundary. One call advances many steps; the hot loop is inside, fully typed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"

namespace hamflow {

/// The numbers of a frame with all their digits, of arithmetic beyond double; else empty.
struct FrameDigits {
  std::string time;
  std::vector<std::string> q;
  std::vector<std::string> p;
  std::string energy;
  std::string initial_energy;
};

struct NamedExpression;
struct StepSum;

/// The least and the largest H - H0 at the ends of some steps.
struct EnergyRange {
  double least = 0;
  double largest = 0;
};

/// A look at the state, in double. Buffers are reused from call to call.
struct Frame {
  std::int64_t step = 0;
  double time = 0;
  std::vector<double> q;
  std::vector<double> p;
  double energy = 0;
  EnergyRange energy_range;  // since Simulation::restart_energy_range(), the state there included
  std::vector<double> invariants;
  Effort effort;                // totals since the start
  StepDiagnostics diagnostics;  // of the last step, on request
  FrameDigits digits;
};

/// How far a conserved quantity deviated, over every step.
struct Excursion {
  double initial = 0;
  double final = 0;
  double max_error = 0;
  double scale_at_start = 0;  // max(|H0|, |T0| + |V0|); |H0| where H is not T + V
  double exchanged = 0;       // T at the start, or the largest so far; |p . dH/dp| where H is not T + V
  /// A part of this is the relative error.
  double scale() const { return scale_at_start < exchanged ? exchanged : scale_at_start; }
};

/// The same for an invariant, with as many numbers as it has components. max_error is the length of the deviation.
struct InvariantExcursion {
  std::vector<double> initial;
  std::vector<double> final;
  double max_error = 0;
  // The same with all their digits, in arithmetic beyond double; else empty.
  std::vector<std::string> initial_digits{};
  std::vector<std::string> final_digits{};
  std::string max_error_digits{};
};

/// A coordinate has met a wall: the state behind the bounce.
struct Bounce {
  std::int64_t step = 0;  // at the end of which the bounce is behind
  double time = 0;
  std::size_t coordinate = 0;
  int side = 1;  // -1: the wall below, 1: that above
  std::vector<double> q;
  std::vector<double> p;
  FrameDigits digits{};  // time, q and p in arithmetic beyond double; else empty
};
/// How often.
struct WallCount {
  std::size_t coordinate = 0;
  int side = 1;
  std::int64_t bounces = 0;
};

/// Of constraints g(q) = 0: the largest |g| and |g' M^-1 p| over every step, the start included.
struct ConstraintResiduals {
  double position = 0;
  double velocity = 0;
};

class Simulation {
 public:
  virtual ~Simulation() = default;

  /// Takes `steps` steps, or stops at the last good one. advance(1000) gives the bits of 1000 times advance(1).
  virtual Outcome advance(std::int64_t steps) = 0;
  virtual std::int64_t step() const = 0;
  /// Fills `frame` from the present state.
  virtual void look(Frame& frame) const = 0;
  /// h <- -h. The state stays.
  virtual void reverse_time() = 0;
  /// p <- -p. The step stays.
  virtual void negate_momenta() = 0;
  /// The stored bits of q and p, for tests of exact return.
  virtual std::vector<std::byte> bits() const = 0;
  /// Energy over every step since the start.
  virtual Excursion energy() const = 0;
  double energy_scale() const { return energy().scale(); }
  /// Begins the range of energies that look() shows anew, from the state of the present step on.
  virtual void restart_energy_range() = 0;
  /// In the order of the problem's invariants.
  virtual std::vector<InvariantExcursion> invariants() const = 0;
  /// Without value where there are no constraints.
  virtual std::optional<ConstraintResiduals> constraints() const { return {}; }
  virtual Effort effort() const = 0;
  /// Of implicit steps, on request; else unset.
  virtual StepDiagnostics diagnostics() const = 0;
  virtual MethodInfo method() const = 0;
  /// After a failure: what went wrong in the step after the present one, in a sentence.
  virtual std::string failure() const = 0;
  /// Whether steps have been recorded, and many of them run as one compiled loop (src/engine/recorded_simulation.hpp).
  virtual bool is_recorded() const { return false; }
  /// Of each hard wall, since the start.
  virtual std::vector<WallCount> wall_counts() const { return {}; }
  /// Calls `told` for every bounce from here on, in their order, when its step is done. A copy tells nobody.
  virtual void tell_bounces(std::function<void(const Bounce&)> /*told*/) {}

  /// From here on advance() adds the values of expressions behind each of its steps to sums, as observers of every step
  /// would (detail/run/step_sums.hpp), and faster. None: no longer. A copy adds nothing.
  /// @return false: this simulation does not
  virtual bool add_to_sums(std::span<const NamedExpression> /*summed*/, std::span<StepSum> /*sums*/) { return false; }

  /// Everything that decides the bits of the steps to come and of the summary: state, clock, and the memory of the
  /// method and of the probe. Equal simulations give equal bytes.
  virtual std::vector<std::byte> save() const = 0;
  /// Continues from the state of save(), bit for bit.
  /// @throws Error when the bytes belong to another kind of simulation, or are damaged; then nothing has changed
  virtual void restore(std::span<const std::byte> saved) = 0;
  virtual std::unique_ptr<Simulation> clone() const = 0;
  /// Fills `frame` with the state at another time: that after one partial step Psi_(theta h), theta h = time - t_n, of
  /// the same method from the present state. The simulation does not change; counters stay those of its own steps.
  /// A time that differs from t_n by rounding alone is t_n.
  /// @param time a number expression, read in the arithmetic of the simulation
  virtual Outcome look_ahead(const std::string& time, Frame& frame) const = 0;
  /// The same after the part theta of a step, theta in [0, 1]: what happens within a step is found to the rounding of
  /// theta h, not of the time.
  virtual Outcome look_part(double theta, Frame& frame) const = 0;
};

}  // namespace hamflow
