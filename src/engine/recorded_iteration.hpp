// A step that is solved by iteration, recorded as two programs: one correction of its unknowns with the resulting end
// of the step, and the data for the next step. The number of corrections varies, so the whole step is not a program;
// the caller of the programs decides which correction is the last (src/lanes/iterated_pack.cpp), as Newton itself does
// (detail/methods/implicit/newton.hpp).
//
// The numbers are in a frame, which both programs read and write.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "element_programs.hpp"
#include "hamflow/methods/averages.hpp"
#include "recorded_step.hpp"

namespace hamflow {

namespace detail {
/// The coefficients for traces, rounded like those for doubles.
template <class Make>
const AverageTable<Trace<double>>& traced_table(int averages, int points, const Make& make) {
  static std::mutex mutex;
  static std::map<std::pair<int, int>, AverageTable<Trace<double>>> tables;
  const std::lock_guard lock(mutex);
  const auto found = tables.find({averages, points});
  if (found != tables.end()) return found->second;
  return tables.emplace(std::pair(averages, points), rounded<Trace<double>>(make())).first->second;
}
}  // namespace detail
template <>
inline const AverageTable<Trace<double>>& element_table<Trace<double>>(int averages, int points) {
  return detail::traced_table(averages, points, [&] { return element_table<double>(averages, points); });
}
template <>
inline const AverageTable<Trace<double>>& stage_table<Trace<double>>(int stages) {
  return detail::traced_table(stages, stages, [&] { return stage_table<double>(stages); });
}

/// The places of the numbers in a frame.
struct IterationFrame {
  std::size_t n = 0;         // coordinates
  std::size_t m = 0;         // unknowns that are iterated
  std::size_t recorded = 0;  // numbers in the archives of state and probe

  static constexpr std::size_t h = 0;
  static constexpr std::size_t position = 1;  // steps from the start of time
  static constexpr std::size_t carried = 2;   // state and probe, in the order of their archives
  /// The k-th number of (q, p). Each is followed by its compensation.
  static constexpr std::size_t state(std::size_t k) { return carried + 2 * k; }
  std::size_t memory() const { return 2 + recorded; }    // unknowns of the last step
  std::size_t x() const { return memory() + m; }         // the present unknowns
  std::size_t correction() const { return x() + m; }     // the last correction
  std::size_t unit() const { return correction() + m; }  // rounding of its entries
  std::size_t end() const { return unit() + m; }         // the unknowns at the end of the step
  std::size_t increment() const { return end() + m; }    // of q and p
  // For the test of points: H at the state; the energy gain of the last step with finer equations, and its rounding;
  // the change of H beyond rounding.
  std::size_t energy() const { return increment() + 2 * n; }
  std::size_t gain() const { return energy() + 1; }
  std::size_t change() const { return gain() + 2; }
  std::size_t size() const { return change() + 1; }
};

/// The programs of one setting of a method's equations. Both carry the whole frame.
struct RecordedIteration {
  IterationFrame frame;
  RecordedStep correct;  // from h, state and x: x, correction, unit, end and increment
  RecordedStep finish;   // from h, position, state, end and increment: all of the next step, and the gain
  Effort of_correct;
  Effort of_finish;
};

/// The programs to record; without the correction if that is computed in another way (stages_in_lanes.hpp).
enum class IterationParts { all, finish };

/// The time of a step: `start` plus a whole number of steps, which increases or decreases.
struct IterationTime {
  double start = 0;
  double direction = 1;  // or -1, with h < 0
};

/// Records the programs at a frame whose unknowns are an initial guess. Returns nullopt if they branch or are too long.
/// @param points the number of quadrature points
using IterationRecorder = std::function<std::optional<RecordedIteration>(
    const IterationFrame&, std::vector<double> values, int points, const IterationTime& time, IterationParts parts)>;

/// The interface of a simulation to lanes (src/engine/iterated_simulation.hpp).
class IteratedMember {
 public:
  virtual ~IteratedMember() = default;
  virtual const IterationFrame& frame() const = 0;
  virtual NewtonOptions newton() const = 0;
  /// Whether the points are tested at the end of every step.
  virtual bool automatic() const = 0;
  /// The number of quadrature points with which the next step begins.
  virtual int points() const = 0;
  virtual bool can_be_recorded() const = 0;
  /// @pre can_be_recorded()
  virtual std::optional<RecordedIteration> recorded_iteration() const = 0;
  /// Fills in the numbers of a frame. @return whether the last step left an initial guess for the next one, which is
  /// then x
  virtual bool read(std::span<double> frame) const = 0;
  /// Sets the simulation to the state after the given number of further steps. @param effort the work of these steps
  virtual void take(std::span<const double> frame, std::int64_t steps, const Effort& effort) = 0;
  /// The time after the given number of further steps, in double.
  virtual double time_after(std::int64_t steps) const = 0;
};

namespace detail {

/// The numbers of a frame as inputs of a recording, and the state and the probe made of them.
template <class P, class TA>
struct TracedFrame {
  using Number = Trace<double>;
  using V = Vector<Number, dynamic>;

  TracedFrame(const P& problem, const IterationFrame& frame, std::span<const double> values, double start)
      : at(frame), recorder(Folding::exact, most_recorded_operations) {
    for (const double value : values) numbers.push_back(recorder.input(value));
    const V nowhere = zeros<Number, dynamic>(at.n);
    z.store(nowhere, nowhere);
    probe.start(problem, nowhere, nowhere, Number(start));
    std::size_t k = IterationFrame::carried;
    for_each_carried([&](Number& x) { x = numbers[k++]; }, z, probe);
    if (k != at.memory()) throw CannotRecord("a state or a probe of another size");
  }
  V read(std::size_t from, std::size_t count) const {
    V x(count);
    for (std::size_t i = 0; i < count; ++i) x[i] = numbers[from + i];
    return x;
  }
  void put(const V& x, std::size_t to) {
    for (std::size_t i = 0; i < x.size(); ++i) numbers[to + i] = x[i];
  }
  void put_carried() {
    std::size_t k = IterationFrame::carried;
    for_each_carried([&](Number& x) { numbers[k++] = x; }, z, probe);
  }

  IterationFrame at;
  Recorder<double> recorder;
  std::vector<Number> numbers;
  PhasePoint<TA, dynamic> z;
  ConservationProbe<P, Number> probe;
};

}  // namespace detail

namespace detail {

/// Records one correction. @param values the numbers of the frame; afterwards those after the correction
template <class E, class TA>
void record_correction(const typename E::Setup& setup, const typename E::Problem& problem, const IterationFrame& frame,
                       std::vector<double>& values, const IterationTime& time, RecordedIteration& made) {
  using Number = Trace<double>;
  using V = Vector<Number, dynamic>;
  TracedFrame<typename E::Problem, TA> f(problem, frame, values, time.start);
  const V q0 = f.z.positions();
  const V p0 = f.z.momenta();
  const E step(setup, problem, f.numbers[IterationFrame::h], q0, p0, made.of_correct);
  V x = f.read(frame.x(), frame.m);
  typename E::Point at;
  at.linearised = setup.newton().iteration == Iteration::newton;
  step.evaluate(x, at);
  V correction = at.residual;
  if (at.linearised) {
    LuFactors<Number> factors;
    factors.factor(step.tangent(at));
    correction = factors.solve(at.residual);
  }
  f.put(correction, frame.correction());
  for (std::size_t i = 0; i < frame.m; ++i) {
    f.numbers[frame.unit() + i] = Epsilon<Number>{} * Number(at.noise[i] + abs(x[i]));
    f.numbers[frame.x() + i] = x[i] + correction[i];
  }
  const Increment<Number, dynamic> taken = step.taken(x, at, correction);
  f.put(x, frame.end());
  f.put(taken.q, frame.increment());
  f.put(taken.p, frame.increment() + frame.n);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = f.numbers[i].value;
  made.correct.program = program_of(f.recorder.finish(f.numbers));
}

/// A change of H along a step that the simulation would certainly accept without a further check (overlooks_a_change,
/// energy_gain.hpp): half of the smallest bound that it uses, with a sixteenth of the virial terms, from the mean force
/// and velocity.
template <class S>
S explained_change(const S& energy, const S& h, const Vector<S, dynamic>& q, const Vector<S, dynamic>& p,
                   const Vector<S, dynamic>& dq, const Vector<S, dynamic>& dp) {
  S terms(0);
  for (std::size_t i = 0; i < q.size(); ++i) terms += abs(q[i] * dp[i]) + abs(p[i] * dq[i]);
  return S(128 * std::numeric_limits<double>::epsilon()) * S(abs(energy) + terms / S(16 * abs(h)));
}

/// The data for the next step. @param continues includes the initial guess of the next step @return false if a number
/// is not finite
template <class E, class TA>
bool record_finish(const typename E::Setup& setup, const typename E::Problem& problem, const IterationFrame& frame,
                   const std::vector<double>& values, const IterationTime& time, bool continues,
                   RecordedIteration& made) {
  using Number = Trace<double>;
  using V = Vector<Number, dynamic>;
  TracedFrame<typename E::Problem, TA> f(problem, frame, values, time.start);
  const V q0 = f.z.positions();
  const V p0 = f.z.momenta();
  const V end = f.read(frame.end(), frame.m);
  if (setup.automatic()) {
    const auto seen = E(setup, problem, f.numbers[IterationFrame::h], q0, p0, made.of_finish).gain_of_energy(end);
    f.numbers[frame.gain()] = seen.gain;
    f.numbers[frame.gain() + 1] = seen.noise;
  }
  const V dq = f.read(frame.increment(), frame.n);
  const V dp = f.read(frame.increment() + frame.n, frame.n);
  for (std::size_t i = 0; i < frame.n; ++i) {
    f.z.arithmetic.position.add_with_exact_low(f.z.q[i], dq[i]);
    f.z.arithmetic.momentum.add_with_exact_low(f.z.p[i], dp[i]);
  }
  Number& position = f.numbers[IterationFrame::position];
  position += Number(time.direction);
  const Number length = Number(time.direction) * f.numbers[IterationFrame::h];
  const Number t = Number(time.start) + position * length;
  const V q = f.z.positions();
  const V p = f.z.momenta();
  if (!f.probe.look(problem, q, p, t)) return false;
  if (problem.has_clock()) {
    const bool back = time.direction < 0;
    set_clock(f.z, time_in_words(Number(time.start), back ? position - Number(1) : position, length),
              back ? length : Number(0));
  }
  if (setup.automatic()) {
    const Number before = f.numbers[frame.energy()];
    const Number behind = hamflow::energy(problem, q, p);
    f.numbers[frame.energy()] = behind;
    f.numbers[frame.change()] =
        abs(behind - before) - explained_change(before, f.numbers[IterationFrame::h], q0, p0, dq, dp);
  }
  f.put_carried();
  f.put(end, frame.memory());
  Effort unused;
  if (continues) f.put(E(setup, problem, f.numbers[IterationFrame::h], q, p, unused).started(end), frame.x());
  made.finish.program = program_of(f.recorder.finish(f.numbers));
  return true;
}

}  // namespace detail

/// Records a step of averages from a frame.
/// @tparam E the equations on traces   @tparam TA the traced arithmetic   @param values the numbers of the frame
/// @return nullopt if the step is not finite, branches on the state or is longer than most_recorded_operations
template <class E, class TA>
std::optional<RecordedIteration> record_iteration(const typename E::Problem& problem, const AverageOptions& options,
                                                  const IterationFrame& frame, std::vector<double> values, int points,
                                                  const IterationTime& time, IterationParts parts) {
  RecordedIteration made{.frame = frame};
  typename E::Setup setup(problem, options);
  if (setup.current_rule() != points) setup.return_to(points);
  try {
    if (parts == IterationParts::all) {
      detail::record_correction<E, TA>(setup, problem, frame, values, time, made);
    } else {
      made.of_correct.force = setup.table().points;
    }
    if (!detail::record_finish<E, TA>(setup, problem, frame, values, time, parts == IterationParts::all, made))
      return std::nullopt;
    return made;
  } catch (const CannotRecord&) {
    return std::nullopt;
  }
}

}  // namespace hamflow
