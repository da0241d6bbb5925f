// One whole step of a method, recorded: the step template is called with traces in place of numbers, on a problem
// behind virtual calls, and what it computes becomes a Program. Everything that a step leaves for the next one is
// carried, the kick that is kept as well as what the probe has seen, so that the program can be repeated by itself.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "hamflow/core/phase_point.hpp"
#include "hamflow/methods/step_density.hpp"
#include "hamflow/numerics/program_of_tape.hpp"
#include "hamflow/run/any_problem.hpp"
#include "hamflow/run/carried.hpp"
#include "hamflow/run/probe.hpp"
#include "hamflow/run/walls.hpp"

namespace hamflow {

/// A step as a program, and where its values are in the archives of state, method and probe, in this order; the last
/// value is the number of steps from the start of time, as a double.
struct RecordedStep {
  Program program;
  std::vector<CarriedField> fields;
  std::vector<std::size_t> state;  // which values q, then p, are shown as
};

/// Longer steps take the ordinary road: straight code of twice this length, which no longer fits into a processor's
/// second cache, is as slow as the compiled loops over bodies (20 bodies with stv4, 9 with kahan-li8).
inline constexpr std::size_t most_recorded_operations = 20000;

/// Which step of many is recorded: one that goes on from what the last one kept, or one from a state that was changed
/// from outside, which carries nothing in but the state.
enum class RecordedAt { steady, start };

/// What a simulation offers to lanes: its step, and the numbers that go through it (run/recorded_simulation.hpp).
class RecordedMember {
 public:
  virtual ~RecordedMember() = default;
  /// The step from the present state; null where it cannot be recorded.
  virtual std::shared_ptr<const RecordedStep> recorded_step() = 0;
  /// The step that tangent vectors take from the present state, without a probe; null where there is none.
  virtual std::shared_ptr<const RecordedStep> tangent_step(RecordedAt at) = 0;
  /// The values that are carried into such a step. @return false where what the method keeps is not as recorded: one
  /// step by the ordinary road mends it
  virtual bool read_values(const RecordedStep& step, std::span<double> values) const = 0;
  /// The values after so many steps, from those that were read.
  virtual void take_values(const RecordedStep& step, std::span<const double> values, std::int64_t steps) = 0;
  /// The time that so many steps from now will have, in double.
  virtual double time_after(std::int64_t steps) const = 0;
};

namespace detail {
/// The numbers of a traced object, before the step and behind it.
struct TracedFields {
  std::vector<Trace<double>> traces;
  std::vector<std::optional<std::uint64_t>> others;  // bits, in the order of all fields; none for a trace
};
template <class... Objects>
TracedFields traced_fields(Objects&... objects) {
  TracedFields all;
  for_each_carried(
      [&]<class T>(T& x) {
        if constexpr (IsTrace<T>::value) {
          all.traces.push_back(x);
          all.others.push_back(std::nullopt);
        } else {
          all.others.push_back(field_bits(x));
        }
      },
      objects...);
  return all;
}
/// Before and behind a step. Empty where a field changes in another way than a counter does.
std::vector<CarriedField> carried_fields(const TracedFields& before, const TracedFields& after,
                                         const std::vector<bool>& counts);
}  // namespace detail

using TracedMonitor = StepMonitor<Trace<double>, dynamic>;
struct NoDensity {};

/// Hard walls that a recorded step has to stay within, as a check of its own.
struct StepWalls {
  std::vector<WallSide<double>> sides;
  bool and_turns = false;  // also where it goes out and comes back within the step
};

/// Whether a step of length h from (q0, v0) to (q1, v1) stays within the walls. The motion that turns within the step
/// is inside for certain where it would be so by going on for two steps from either end; where it would not, and where
/// the step ends outside, one has to look closer. More than one turn within a step is not seen.
template <class S>
bool stays_within(const StepWalls& walls, const double& h, const Vector<S, dynamic>& q0, const Vector<S, dynamic>& v0,
                  const Vector<S, dynamic>& q1, const Vector<S, dynamic>& v1) {
  for (const WallSide<double>& wall : walls.sides) {
    const std::size_t i = wall.coordinate;
    if (wall.side > 0 ? S(wall.at) < q1[i] : q1[i] < S(wall.at)) return false;
    if (!walls.and_turns) continue;
    const S ahead = q0[i] + S(2 * h) * v0[i];
    const S behind = q1[i] - S(2 * h) * v1[i];
    if (wall.side > 0 ? S(wall.at) < -larger(-ahead, -behind) : larger(ahead, behind) < S(wall.at)) return false;
  }
  return true;
}
/// dH/dp of a problem behind virtual calls.
template <class P, class S>
Vector<S, dynamic> velocities(const P& problem, const Vector<S, dynamic>& q, const Vector<S, dynamic>& p) {
  Vector<S, dynamic> v = zeros_like(p);
  if constexpr (Separable<P>) {
    velocity(problem, p, v);
  } else {
    Vector<S, dynamic> by_q = zeros_like(q);
    gradient(problem, q, p, by_q, v);
  }
  return v;
}

/// Time as a StepClock counts it, for the recording: t = start + position step.
struct RecordedTime {
  double start = 0;
  double step = 0;  // of the clock, forwards
  double position = 0;
  double direction = 1;
};

/// Records the step from (q, p).
/// @tparam A of traces; where it has any lengths (methods/step_density.hpp) the density of steps is carried, too
/// @param method bound to the traced problem   @param watch the energy and the invariants are looked at in every step
/// @param monitor of steps of varying length   @param walls that the step stays within; null: none
/// @return nothing where the step is not a straight line of this kind or is longer than most_recorded_operations
template <class A, class P, class M>
std::optional<RecordedStep> record_step(const P& problem, M method, const Vector<double, dynamic>& q,
                                        const Vector<double, dynamic>& p, double h, const RecordedTime& time,
                                        bool watch, RecordedAt at = RecordedAt::steady,
                                        [[maybe_unused]] const TracedMonitor* monitor = nullptr,
                                        const StepWalls* walls = nullptr) {
  using Number = Trace<double>;
  constexpr bool varies = requires { typename A::Length; };
  PhasePoint<A, dynamic> z;
  z.store(cast<Number>(q), cast<Number>(p));
  ConservationProbe<P, Number> probe;
  try {
    probe.start(problem, z.positions(), z.momenta(), Number(time.start));
    auto density = [&] {
      if constexpr (varies) {
        return StepDensity<A>(Number(h), Number(time.start));
      } else {
        return NoDensity{};
      }
    }();
    Number end_of_varying(0);
    const auto step = [&] {
      if constexpr (varies) {
        if (!density.is_usable()) return Outcome::not_converged;
        const Number length = density.length();
        end_of_varying = density.time() + length;
        const Outcome outcome = method.step(problem, length, z);
        density.advance(length, monitor->rate(z.positions(), z.momenta()));
        return outcome;
      } else {
        return method.step(problem, h, z);
      }
    };
    // On constants, for what the method keeps of it.
    if (step() != Outcome::done) return std::nullopt;
    if (at == RecordedAt::start) method.invalidate();
    Recorder<double> recorder(Folding::exact, most_recorded_operations);
    std::vector<bool> counts;
    for_each_carried(
        [&]<class T>(T& x) {
          if constexpr (detail::IsTrace<T>::value) x = recorder.input(x.value);
          counts.push_back(std::is_integral_v<T> && !std::is_same_v<T, bool>);
        },
        z, method, probe, density);
    RecordedStep recorded;
    for (const Number& x : z.positions()) recorded.state.push_back(static_cast<std::size_t>(x.node));
    for (const Number& x : z.momenta()) recorded.state.push_back(static_cast<std::size_t>(x.node));
    const Number position = recorder.input(time.position + time.direction) + Number(time.direction);
    const detail::TracedFields before = detail::traced_fields(z, method, probe, density);
    const Vector<Number, dynamic> q0 = z.positions();
    const Vector<Number, dynamic> p0 = z.momenta();
    if (step() != Outcome::done) return std::nullopt;
    if (walls != nullptr) {
      const Vector<Number, dynamic> q1 = z.positions();
      const Vector<Number, dynamic> p1 = z.momenta();
      if (!stays_within(*walls, h, q0, velocities(problem, q0, p0), q1, velocities(problem, q1, p1))) {
        return std::nullopt;
      }
    }
    const Number t = varies ? end_of_varying : Number(time.start) + position * Number(time.step);
    if (watch && !probe.look(problem, z.positions(), z.momenta(), t)) return std::nullopt;
    detail::TracedFields after = detail::traced_fields(z, method, probe, density);
    if (at == RecordedAt::steady) {
      recorded.fields = detail::carried_fields(before, after, counts);
      if (recorded.fields.empty()) return std::nullopt;
    }
    after.traces.push_back(position);
    recorded.program = program_of(recorder.finish(after.traces));
    return recorded;
  } catch (const CannotRecord&) {
    return std::nullopt;
  }
}

}  // namespace hamflow
