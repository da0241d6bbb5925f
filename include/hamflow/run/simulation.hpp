// The type-erased simulation. Only here are virtual calls: one call advances many steps, and the loop over steps inside
// is fully typed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hamflow/core/function_set.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"

namespace hamflow {

/// The numbers of a frame with all digits, in arithmetics beyond double; else empty.
struct FrameDigits {
  std::string time;
  std::vector<std::string> q;
  std::vector<std::string> p;
  std::string energy;
  std::string initial_energy;
};

struct NamedExpression;
struct StepSum;

/// The smallest and the largest H - H0 at the ends of some steps.
struct EnergyRange {
  double least = 0;
  double largest = 0;
};

/// A copy of the state in double. Its buffers are reused from call to call.
struct Frame {
  std::int64_t step = 0;
  double time = 0;
  std::vector<double> q;
  std::vector<double> p;
  double energy = 0;
  EnergyRange energy_range;  // since Simulation::restart_energy_range(), including the state at that call
  std::vector<double> invariants;
  Effort effort;                // totals since the start
  StepDiagnostics diagnostics;  // of the last step, on request
  FrameDigits digits;
};

/// The deviation of the energy over every step.
struct Excursion {
  double initial = 0;
  double final = 0;
  double max_error = 0;
  double scale_at_start = 0;  // max(|H0|, |T0| + |V0|); |H0| if H is not T + V
  double exchanged = 0;       // T at the start, or the largest so far; |p . dH/dp| if H is not T + V
  /// The energy relative to which errors are given.
  double scale() const { return scale_at_start < exchanged ? exchanged : scale_at_start; }
};

/// The range of an invariant, with a number for each component. max_error is the length of the deviation.
struct InvariantExcursion {
  std::vector<double> initial;
  std::vector<double> final;
  double max_error = 0;
  // The values with all digits, in arithmetics beyond double; else empty.
  std::vector<std::string> initial_digits{};
  std::vector<std::string> final_digits{};
  std::string max_error_digits{};
};

/// A bounce of a coordinate off a wall, with the state after it.
struct Bounce {
  std::int64_t step = 0;  // the first step at whose end the bounce is past
  double time = 0;
  std::size_t coordinate = 0;
  int side = 1;  // -1: the lower wall, 1: the upper wall
  std::vector<double> q;
  std::vector<double> p;
  FrameDigits digits{};  // time, q and p in arithmetics beyond double; else empty
};
/// The number of bounces off a wall.
struct WallCount {
  std::size_t coordinate = 0;
  int side = 1;
  std::int64_t bounces = 0;
};

/// For constraints g(q) = 0: the largest |g| and |g' M^-1 p| over every step, including the start.
struct ConstraintResiduals {
  double position = 0;
  double velocity = 0;
};

class Simulation {
 public:
  virtual ~Simulation() = default;

  /// Takes `steps` steps, or stops at the last good one. advance(1000) gives the same bits as 1000 calls of advance(1).
  virtual Outcome advance(std::int64_t steps) = 0;
  virtual std::int64_t step() const = 0;
  /// Fills `frame` from the present state.
  virtual void look(Frame& frame) const = 0;
  /// h <- -h. The state does not change.
  virtual void reverse_time() = 0;
  /// p <- -p. The step size does not change.
  virtual void negate_momenta() = 0;
  /// The stored bits of q and p, for tests of exact reversal.
  virtual std::vector<std::byte> bits() const = 0;
  /// Energy over every step since the start.
  virtual Excursion energy() const = 0;
  double energy_scale() const { return energy().scale(); }
  /// Restarts the range of energies that look() shows, from the present state on.
  virtual void restart_energy_range() = 0;
  /// The ranges of the invariants, in the order of the problem.
  virtual std::vector<InvariantExcursion> invariants() const = 0;
  /// nullopt if there are no constraints.
  virtual std::optional<ConstraintResiduals> constraints() const { return {}; }
  virtual Effort effort() const = 0;
  /// Diagnostics of implicit steps, if requested; else unset.
  virtual StepDiagnostics diagnostics() const = 0;
  virtual MethodInfo method() const = 0;
  /// After a failure: a sentence about what went wrong in the step after the present one.
  virtual std::string failure() const = 0;
  /// Whether steps are recorded and many of them run as one compiled loop (src/engine/recorded_simulation.hpp).
  virtual bool is_recorded() const { return false; }
  /// The counts of each hard wall since the start.
  virtual std::vector<WallCount> wall_counts() const { return {}; }
  /// Calls `callback` for every later bounce, in order, when its step is done. Copies do not call it.
  virtual void on_bounce(std::function<void(const Bounce&)> /*callback*/) {}

  /// After this call, advance() adds the values of expressions after each step to sums. This gives the same result as
  /// an observer of every step (detail/run/step_sums.hpp), but faster. An empty list ends it. Copies do not add.
  /// @return false if this simulation does not support it
  virtual bool add_to_sums(std::span<const NamedExpression> /*summed*/, std::span<StepSum> /*sums*/) { return false; }

  /// Saves everything that affects the bits of later steps and of the summary: state, clock, and the memory of the
  /// method and of the probe. Equal simulations give equal bytes.
  virtual std::vector<std::byte> save() const = 0;
  /// Restores the state of save(), to continue bit for bit.
  /// @throws Error if the bytes belong to another kind of simulation or are damaged; then nothing has changed
  virtual void restore(std::span<const std::byte> saved) = 0;
  virtual std::unique_ptr<Simulation> clone() const = 0;
  /// Fills `frame` with the state at another time: after one partial step Psi_(theta h), theta h = time - t_n, of the
  /// same method from the present state. The simulation does not change, and counters count only its own steps. A time
  /// that differs from t_n only by rounding is t_n.
  /// @param time a number expression, read in the arithmetic of the simulation
  virtual Outcome look_ahead(const std::string& time, Frame& frame) const = 0;
  /// Shows the state after the part theta of a step, theta in [0, 1], so that events within a step are located to the
  /// rounding of theta h instead of that of the time.
  virtual Outcome look_part(double theta, Frame& frame) const = 0;

 private:
  FunctionsInUse functions_;
};

}  // namespace hamflow
