#include "recorded_cg.hpp"

#include "erased.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "quick_steps.hpp"
#include "recorded_element.hpp"
#include "segment_loop.hpp"
#include "varying_steps.hpp"

namespace hamflow {

namespace {

constexpr Capability natural_h = Capability::separable | Capability::quadratic_kinetic;

template <Capability c>
auto recorder(const ErasedFunctions<double>& functions, const CgOptions& options, const ElementFrame& frame) {
  using Traced = AnyProblem<Trace<double>, c>;
  return [=, problem = functions.as<c>(), traced = Traced(functions.size, functions.trace)](int points) {
    CgOptions of_rule = options;
    of_rule.quadrature = points;
    return detail::element_programs<includes(c, Capability::quadratic_kinetic)>(problem, traced, of_rule, frame);
  };
}

/// Makes a loop for a number of points from the numbers of a first step; empty if that is impossible.
using SegmentMaker = std::function<std::optional<SegmentLoop>(const SegmentFrame&, std::span<const double>,
                                                              const IterationTime&, int points)>;

template <Capability c>
SegmentMaker segment_maker(const ErasedFunctions<double>& functions, const CgOptions& options) {
  using Traced = AnyProblem<Trace<double>, c>;
  using Watched = AnyProblem<Trace<double>, Capability::smooth>;
  return [=](const SegmentFrame& frame, std::span<const double> numbers, const IterationTime& time, int points) {
    CgOptions of_rule = options;
    of_rule.quadrature = points;
    return SegmentRecorder<includes(c, Capability::quadratic_kinetic), Traced, Watched>(
               Traced(functions.size, functions.trace), Watched(functions.size, functions.trace), of_rule, frame,
               options.quadrature == 0)
        .loop(numbers, time);
  };
}

/// A simulation of cg(1) that uses a segment loop if many steps are requested, with the same bits.
template <class P, class M, Arithmetic A>
class SegmentSimulation final : public SimulationOf<P, M, A> {
  using Base = SimulationOf<P, M, A>;
  using Base::clock_;
  using Base::method_;
  using Base::probe_;
  using Base::z_;
  using Equations = typename M::Equations;

 public:
  /// @param maker empty: no step is recorded
  SegmentSimulation(Base simulation, const SegmentFrame& frame, SegmentMaker maker)
      : Base(std::move(simulation)), frame_(frame), maker_(std::move(maker)) {
    for_each_carried([&](double&) { ++frame_.recorded; }, z_, probe_);
  }

  Outcome advance(std::int64_t steps) override {
    return take_quickly(
        steps, [&](std::int64_t left) { return take_by_loop(left); },
        [&](std::int64_t some) { return Base::advance(some); });
  }
  void reverse_time() override {
    Base::reverse_time();
    loop_.reset();
  }
  bool is_recorded() const override { return loop_.has_value(); }
  [[gnu::cold]] void restore(std::span<const std::byte> saved) override {
    Base::restore(saved);
    loop_.reset();  // the start time is a constant of the loop
  }
  [[gnu::cold]] std::unique_ptr<Simulation> clone() const override {
    return std::make_unique<SegmentSimulation>(*this);
  }

 private:
  /// The number of steps that recording and compiling cost.
  static constexpr std::int64_t worth_recording = 200;
  /// Filling a frame costs about as much as a step.
  static constexpr std::int64_t least_steps_for_programs = 4;

  /// See take_quickly().
  std::optional<std::int64_t> take_by_loop(std::int64_t steps) {
    if (!is_worth_running(steps)) return std::nullopt;
    if (!fill()) return 0;
    if ((!loop_ || points_ != points()) && !make_loop()) return std::nullopt;
    Effort effort = method_.effort();
    const std::int64_t taken = loop_->begin(numbers_) ? loop_->run(numbers_, steps, effort) : 0;
    if (taken == 0) return 0;
    const std::span state(numbers_.data(), frame_.correction());
    if (!std::all_of(state.begin(), state.end(), [](double x) { return std::isfinite(x); })) return std::nullopt;
    take(taken, effort);
    return taken;
  }
  int points() const { return method_.setup().rule().points; }
  /// Whether programs can take these steps. They do not support a tolerance, diagnostics or varying steps.
  bool is_worth_running(std::int64_t steps) {
    if (!maker_ || steps < least_steps_for_programs || Base::varies_steps()) return false;
    const NewtonOptions options = method_.setup().newton();
    if (options.tolerance || options.diagnostics || options.iteration != Iteration::newton) return false;
    return loop_ || (asked_ += steps) >= worth_recording;
  }
  /// Fills in the numbers of the next step, without its initial guess. @return whether the guess is extrapolated from
  /// the last three solutions
  bool fill() {
    if (!method_.newton().uses_memory() || !method_.newton().memory().is_full()) return false;
    numbers_.assign(frame_.size(), 0.0);
    numbers_[IterationFrame::h] = clock_.step_length();
    numbers_[IterationFrame::position] = static_cast<double>(clock_.position());
    std::size_t k = IterationFrame::carried;
    for_each_carried([&](double& x) { numbers_[k++] = x; }, z_, probe_);
    const auto& memory = method_.newton().memory();
    if (method_.setup().automatic()) {
      numbers_[frame_.energy()] = hamflow::energy(Base::problem(), z_.positions(), z_.momenta());
    }
    for (std::size_t i = 0; i < frame_.m; ++i) {
      for (std::size_t back = 0; back < 3; ++back) {
        if (memory.last(back).size() != frame_.m) return false;
        numbers_[frame_.memory() + back * frame_.m + i] = memory.last(back)[i];
      }
    }
    return true;
  }
  [[gnu::cold]] bool make_loop() {
    const Vector<double, dynamic> q0 = z_.positions();
    const Vector<double, dynamic> p0 = z_.momenta();
    Effort unused;
    const SmallVector x = Equations(method_.setup(), Base::problem(), clock_.step_length(), q0, p0, unused)
                              .started(method_.newton().memory().predicted());
    for (std::size_t i = 0; i < frame_.m; ++i) numbers_[frame_.x() + i] = x[i];
    points_ = points();
    loop_ = maker_(frame_, numbers_, {clock_.start(), static_cast<double>(clock_.direction())}, points_);
    if (!loop_) maker_ = {};
    return loop_.has_value();
  }
  void take(std::int64_t steps, const Effort& effort) {
    std::size_t k = IterationFrame::carried;
    for_each_carried([&](double& x) { x = numbers_[k++]; }, z_, probe_);
    for (std::size_t back = 3; back-- > 0;) {
      SmallVector solution{{}, frame_.m};
      for (std::size_t i = 0; i < frame_.m; ++i) solution[i] = numbers_[frame_.memory() + back * frame_.m + i];
      method_.go_on(solution, effort);
    }
    clock_.advance(steps);
  }

  SegmentFrame frame_;
  SegmentMaker maker_;
  std::optional<SegmentLoop> loop_;
  int points_ = 0;  // the number of points of the loop
  std::vector<double> numbers_;
  std::int64_t asked_ = 0;
};

}  // namespace

std::unique_ptr<Simulation> simulate_recorded_element(const ErasedRun<double>& run, const Request& request,
                                                      const CgOptions& options) {
  using P = Erased<double, Capability::smooth>;
  const std::size_t n = run.functions.size;
  if (n > ElementFrame::most_coordinates) return nullptr;
  const bool is_natural = includes(run.functions.capability, natural_h);
  RecordedElementOptions recorded{options, {n, is_natural ? n : 2 * n}, {}};
  SegmentMaker maker;
  if (is_natural) {
    recorded.record = recorder<natural_h>(run.functions, options, recorded.frame);
    maker = segment_maker<natural_h>(run.functions, options);
  } else {
    recorded.record = recorder<Capability::smooth>(run.functions, options, recorded.frame);
    maker = segment_maker<Capability::smooth>(run.functions, options);
  }
  if (!request.record || run.functions.plain->has_clock()) maker = {};
  using A = Compensated<double>;
  using Method = ImplicitMethod<P, A, RecordedElement<P>>;
  const P problem = run.functions.as<Capability::smooth>();
  auto simulation = std::make_unique<SegmentSimulation<P, Method, A>>(
      SimulationOf<P, Method, A>(problem, Method(problem, recorded), run.q, run.p, run.h),
      SegmentFrame{n, recorded.frame.m, 0}, maker);
  vary_steps_as_requested(*simulation, run, request);
  return simulation;
}

}  // namespace hamflow
