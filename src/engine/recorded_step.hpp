// A recorded step of a method: the step template is called with traces instead of numbers, on a problem behind virtual
// calls, and its operations become a Program. The program carries all data that a step passes to the next one,
// including kept kicks and the probe, so that it can be repeated.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "carried.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/core/step_clock.hpp"
#include "hamflow/detail/methods/step_density.hpp"
#include "hamflow/detail/run/any_problem.hpp"
#include "hamflow/detail/run/probe.hpp"
#include "hamflow/detail/run/steps_in_parts.hpp"
#include "hamflow/methods/recipe.hpp"
#include "numerics/program_of_tape.hpp"
#include "recorded_walls.hpp"

namespace hamflow {

/// A step as a program. Its values are the numbers in the archives of state, method and probe, in this order. The last
/// value is the number of steps since the start time, as a double.
struct RecordedStep {
  Program program;
  std::vector<CarriedField> fields;
  std::vector<std::size_t> state;  // the indices of the values of q, then p
  /// With walls, the values before the last one: words that count bounces, 0 at the start of a loop, or one number that
  /// is 1 if a step was not taken and the loop ends.
  std::size_t words = 0;
  bool stops = false;
  Effort effort{};  // the evaluations of one step
  std::size_t first_word() const { return program.values() - 1 - words; }
  std::size_t stop() const { return program.values() - 2; }
};

/// Adds the counts in the words of a step to the numbers of bounces off each side.
inline void add_bounces(const RecordedStep& step, std::span<const double> values, std::span<std::int64_t> bounces) {
  for (std::size_t k = 0; step.words > 0 && k < bounces.size(); ++k) {
    bounces[k] += BounceWord::count(values[step.first_word() + k / BounceWord::sides], k % BounceWord::sides);
  }
}

/// Longer steps are not recorded: straight-line code of twice this length does not fit into the second-level cache and
/// is as slow as the compiled loops over bodies (20 bodies with stv4, 9 with kahan-li8).
inline constexpr std::size_t most_recorded_operations = 20000;

/// Which step is recorded: one that continues with the data of the last step, or one from a state that was changed from
/// outside, without such data.
enum class RecordedAt { steady, start };

/// The interface of a simulation to lanes: its step, and the numbers of the step (src/engine/recorded_simulation.hpp).
class RecordedMember {
 public:
  virtual ~RecordedMember() = default;
  /// The step from the present state; null if it cannot be recorded.
  /// @param at_walls for simulations with walls
  virtual std::shared_ptr<const RecordedStep> recorded_step(AtWalls at_walls = AtWalls::stop) = 0;
  /// Computes the quantity that the next step begins with, if the method keeps one and has dropped it.
  virtual void make_ready() = 0;
  /// The step before which the last recorded steps ended because it may hit a wall; null if they did not.
  virtual const RecordedStep* undone_step() const { return nullptr; }
  /// Takes a step that was not taken by the loop.
  virtual Outcome step_ordinarily(const RecordedStep& undone) = 0;
  /// The step for tangent vectors from the present state, without a probe; null if there is none.
  virtual std::shared_ptr<const RecordedStep> tangent_step(RecordedAt at) = 0;
  /// Reads the values that such a step carries. @return false if the method's data differ from the recording; one
  /// ordinary step corrects this
  virtual bool read_values(const RecordedStep& step, std::span<double> values) const = 0;
  /// Sets the values after the given number of steps since they were read.
  virtual void take_values(const RecordedStep& step, std::span<const double> values, std::int64_t steps) = 0;
  /// The time after the given number of further steps, in double.
  virtual double time_after(std::int64_t steps) const = 0;
};

namespace detail {
/// The numbers of a traced object, before or after the step.
struct TracedFields {
  std::vector<Trace<double>> traces;
  std::vector<std::optional<std::uint64_t>> others;  // bits in the order of all fields; nullopt for a trace
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
/// Returns how the fields change in a step. It is empty if a field that is not a trace changes unlike a counter.
std::vector<CarriedField> carried_fields(const TracedFields& before, const TracedFields& after,
                                         const std::vector<bool>& counts);
}  // namespace detail

using TracedMonitor = StepMonitor<Trace<double>, dynamic>;
struct NoDensity {};

/// The time of a recording, as in StepClock: t = start + position step.
struct RecordedTime {
  double start = 0;
  double step = 0;  // the step size of the clock, positive forward
  double position = 0;
  double direction = 1;
};

/// Records the step from (q, p).
/// @tparam A an arithmetic of traces; if it has any step size (detail/methods/step_density.hpp), the step density is
/// carried, too
/// @param method bound to the traced problem   @param watch whether energy and invariants are computed in every step
/// @param monitor the monitor of varying steps   @param walls hard walls; null: none
/// @return nullopt if the step branches on the state or is longer than most_recorded_operations
template <class A, class P, class M>
std::optional<RecordedStep> record_step(const P& problem, M method, const Vector<double, dynamic>& q,
                                        const Vector<double, dynamic>& p, double h, const RecordedTime& time,
                                        bool watch, RecordedAt at = RecordedAt::steady,
                                        [[maybe_unused]] const TracedMonitor* monitor = nullptr,
                                        const StepWalls* walls = nullptr, AtWalls at_walls = AtWalls::stop) {
  using Number = Trace<double>;
  constexpr bool varies = requires { typename A::Length; };
  PhasePoint<A, dynamic> z;
  z.store(cast<Number>(q), cast<Number>(p));
  ConservationProbe<P, Number> probe;
  if constexpr (varies && requires { method.keep_unscaled_force(); }) method.keep_unscaled_force();
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
    const auto set_clock_at = [&](const Number& position) {
      if (!problem.has_clock()) return;
      if constexpr (varies) {
        set_clock(z, density.time_in_words());
      } else {
        const Number length(time.step);
        const bool back = time.direction < 0;
        set_clock(z, time_in_words(Number(time.start), back ? position - Number(1) : position, length),
                  back ? length : Number(0));
      }
      if constexpr (requires { method.set_clock(z); }) method.set_clock(z);
    };
    // A step on constants first, so that the method has the data that it keeps from step to step.
    if (step() != Outcome::done) return std::nullopt;
    set_clock_at(Number(time.position + time.direction));
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
    recorded.stops = walls != nullptr && at_walls == AtWalls::stop;
    recorded.words = walls != nullptr && at_walls == AtWalls::bounce ? BounceWord::words(walls->sides.size()) : 0;
    std::vector<Number> words;
    for (std::size_t k = 0; k < recorded.words; ++k) words.push_back(recorder.input(0.0));
    if (recorded.stops) (void)recorder.input(0.0);
    const Number position_before = recorder.input(time.position + time.direction);
    const Number position = position_before + Number(time.direction);
    const detail::TracedFields before = detail::traced_fields(z, method, probe, density);
    auto z_before = z;
    auto method_before = method;
    auto probe_before = probe;
    if (step() != Outcome::done) return std::nullopt;
    const Number t = varies ? end_of_varying : Number(time.start) + position * Number(time.step);
    const auto seen = z;  // the state before bounces
    bool is_seen = false;
    add_evaluations(recorded.effort, method.effort(), method_before.effort());
    if (recorded.words > 0) {
      if (!memory_depends_on_positions_only<M>()) return std::nullopt;
      // With a time-dependent H, the force kept from before a rejected step would belong to another time.
      if (walls->rule == WallRule::reject && problem.has_clock()) return std::nullopt;
      // A step that is rejected or mirrored must not fail.
      Number size(0);
      for (const Number& x : Vector<Number, dynamic>(z.positions())) size += x;
      for (const Number& x : Vector<Number, dynamic>(z.momenta())) size += x * x;
      if (!(size <= std::numeric_limits<double>::max())) return std::nullopt;
      std::vector<Number> met;
      if (walls->rule == WallRule::reject) {
        Number thrown_back(0);
        met = reject_within<Number>(walls->sides, z_before, method_before, z, method, thrown_back);
        // A rejected step restores a state with known energy. The last state of the step is checked instead; it shares
        // a root with the last force.
        if (watch && walls->keep_energy && detail::invariant_sizes(problem).empty()) {
          if (!probe.look(problem, seen.positions(), seen.momenta(), t)) return std::nullopt;
          detail::choose_all(thrown_back, probe_before, probe);
          is_seen = true;
        }
      } else if constexpr (requires { method.mirror_kept(0); }) {
        met = mirror_within<Number>(walls->sides, z, method);
        const Vector<Number, dynamic> q1 = z.positions();
        for (const auto& wall : walls->sides) {
          if (Number(0) < wall.beyond(Number(q1[wall.coordinate]))) return std::nullopt;
        }
      } else {
        return std::nullopt;
      }
      for (std::size_t k = 0; k < words.size(); ++k) words[k] += met[k];
    }
    if (watch && !is_seen && !probe.look(problem, z.positions(), z.momenta(), t)) return std::nullopt;
    set_clock_at(position);
    detail::TracedFields after = detail::traced_fields(z, method, probe, density);
    if (at == RecordedAt::steady) {
      recorded.fields = detail::carried_fields(before, after, counts);
      if (recorded.fields.empty()) return std::nullopt;
    }
    after.traces.insert(after.traces.end(), words.begin(), words.end());
    Number position_behind = position;
    if (recorded.stops) {
      const Vector<Number, dynamic> q0 = z_before.positions();
      const Vector<Number, dynamic> p0 = z_before.momenta();
      const Vector<Number, dynamic> q1 = z.positions();
      const Vector<Number, dynamic> p1 = z.momenta();
      const Number beyond = beyond_walls(problem, walls->sides, walls->rule == WallRule::event, h, q0, p0, q1, p1);
      for (std::size_t k = 0; k < after.traces.size(); ++k) {
        after.traces[k] = choose(beyond, before.traces[k], after.traces[k]);
      }
      position_behind = choose(beyond, position_before, position);
      after.traces.push_back(choose(beyond, Number(1), Number(0)));
    }
    after.traces.push_back(position_behind);
    recorded.program = program_of(recorder.finish(after.traces));
    if (recorded.stops) recorded.program.ends_at = {static_cast<std::uint32_t>(recorded.stop())};
    return recorded;
  } catch (const CannotRecord&) {
    return std::nullopt;
  }
}

}  // namespace hamflow
