// The definition of simulate_erased. One file for each number type instantiates it. Methods whose steps are recorded in
// double have a separate file with light optimisation, because only few of their steps run as compiled code.
#pragma once

#include "engine/corrected_simulation.hpp"
#include "engine/interruptible_functions.hpp"
#include "engine/iterated_simulation.hpp"
#include "engine/iteration_recorder.hpp"
#include "engine/planetary_steps.hpp"
#include "engine/recorded_simulation.hpp"
#include "engine/varying_steps.hpp"
#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/verify/extrapolated_midpoint.hpp"
#include "visit_erased.hpp"
#include "walls/walled_simulation.hpp"

namespace hamflow {

/// The traced arithmetic in which the steps of an arithmetic are recorded.
template <class A>
struct TracedArithmetic;
template <>
struct TracedArithmetic<Plain<double>> {
  using type = Plain<Trace<double>>;
};
template <>
struct TracedArithmetic<Compensated<double>> {
  using type = Compensated<Trace<double>>;
};

/// Records steps of a method on the traced functions of a problem.
template <Capability c, class A, class M>
StepRecorder recorder_of(const ErasedRun<double>& run, const M& recipe) {
  using Traced = AnyProblem<Trace<double>, c>;
  using TA = typename TracedArithmetic<A>::type;
  return [problem = Traced(run.functions.size, run.functions.trace), recipe, walls = run.walls](
             const Vector<double, dynamic>& q, const Vector<double, dynamic>& p, double h, const RecordedTime& time,
             bool watch, RecordedAt at, AtWalls at_walls) {
    return record_step<TA>(problem, recipe.template bind<Traced, TA>(problem), q, p, h, time, watch, at, nullptr,
                           walls.get(), at_walls);
  };
}

/// Whether a method supports recorded steps of varying size.
template <class P, class A, class M>
constexpr bool takes_recorded_lengths = requires(typename M::template Stepper<P, A>& stepper, const P& problem,
                                                 const Trace<double>& h, PhasePoint<A, dynamic>& z) {
  stepper.step(problem, h, z);
};

/// Records parts of steps, with which walls, points of sections and events are located; empty if the method does not
/// support it.
template <Capability c, class A, class M>
PartRecorder part_recorder_of(const ErasedRun<double>& run, const M& recipe) {
  using Traced = AnyProblem<Trace<double>, c>;
  using TA = WithAnyLength<typename TracedArithmetic<A>::type>;
  if constexpr (!Separable<Traced> || !takes_recorded_lengths<Traced, TA, M>) {
    return {};
  } else {
    if (run.walls && run.walls->rule != WallRule::event) return {};
    if (run.functions.plain->has_clock()) return {};  // the time at the start of the step is not a constant
    const std::size_t n = run.functions.size;
    return [problem = Traced(n, run.functions.trace), recipe](const Vector<double, dynamic>& q,
                                                              const Vector<double, dynamic>& p, double h) {
      return record_part<TA>(problem, recipe.template bind<Traced, TA>(problem), q, p, h, most_recorded_operations);
    };
  }
}

/// Records steps of varying size, for methods that support them and natural Hamiltonians; else empty.
template <Capability c, class A, class M>
StepRecorder varying_recorder_of(const ErasedRun<double>& run, const M& recipe, const Request& request) {
  using TA = WithAnyLength<typename TracedArithmetic<A>::type>;
  using Traced = AnyProblem<Trace<double>, c>;
  if constexpr (!takes_recorded_lengths<Traced, TA, M>) {
    return {};
  } else {
    const StepControl control = step_control_of(request.method);
    const bool natural = includes(run.functions.capability, natural_capabilities);
    const bool by_hessian = run.functions.size <= detail::most_with_hessian;
    if (control.monitor == default_monitor && !(natural && by_hessian)) return {};
    using Monitored = AnyProblem<Trace<double>, natural_capabilities>;
    return [problem = Traced(run.functions.size, run.functions.trace), recipe,
            monitor = step_monitor(Monitored(run.functions.size, run.functions.trace), control)](
               const Vector<double, dynamic>& q, const Vector<double, dynamic>& p, double h, const RecordedTime& time,
               bool watch, RecordedAt at, AtWalls /*at_walls*/) {
      return record_step<TA>(problem, recipe.template bind<Traced, TA>(problem), q, p, h, time, watch, at, &monitor);
    };
  }
}

/// The part of simulate_erased<double> for methods whose steps are recorded.
std::unique_ptr<Simulation> simulate_recorded(const ErasedRun<double>& run, const Request& request);
/// Other number types have no recorded steps. clang++ needs this declaration although it is never called.
template <class R>
std::unique_ptr<Simulation> simulate_recorded(const ErasedRun<R>&, const Request&) {
  return nullptr;
}

/// @tparam recorded selects, in double, the methods whose steps are recorded; false: all others, and the lattice
template <class R, bool recorded>
std::unique_ptr<Simulation> simulate_half(const ErasedRun<R>& run, const Request& request) {
  using Result = std::unique_ptr<Simulation>;
  const auto simulate = [&]<Capability c, class M>(const M& recipe) -> Result {
    const auto build = [&]<class A>(A arithmetic) -> Result {
      constexpr bool is_of_recorded = std::is_same_v<R, double> && is_recorded<M>() && !A::exact_undo;
      if constexpr (is_of_recorded && !recorded) {
        return simulate_recorded(run, request);
      } else if constexpr (is_of_recorded != recorded) {
        return nullptr;
      } else {
        const auto problem = run.functions.template as<c>();
        using P = std::remove_const_t<decltype(problem)>;
        auto method = recipe.template bind<P, A>(problem);
        using Ordinary = SimulationOf<P, decltype(method), A>;
        using Parted = InParts<Ordinary>;
        const auto requested = [&](auto simulation) {
          vary_steps_as_requested(*simulation, run, request);
          return simulation;
        };
        if constexpr (recorded) {
          return requested(std::make_unique<RecordedSimulation<P, decltype(method), A>>(
              Ordinary(problem, method, run.q, run.p, run.h, arithmetic),
              !request.record                              ? StepRecorder()
              : step_control_of(request.method).reversible ? varying_recorder_of<c, A>(run, recipe, request)
                                                           : recorder_of<c, A>(run, recipe),
              request.record && !step_control_of(request.method).reversible ? part_recorder_of<c, A>(run, recipe)
                                                                            : PartRecorder(),
              request.watch));
        } else if constexpr (std::is_same_v<R, double> && std::is_same_v<M, Averages>) {
          return requested(std::make_unique<IteratedSimulation<P, decltype(method), A>>(
              Ordinary(problem, method, run.q, run.p, run.h, arithmetic),
              iteration_recorder(run.functions, c, recipe.options), stage_recorder(run.functions, c, recipe.options),
              request.record));
        } else if constexpr (EncounterWatcher<decltype(method)>) {
          if constexpr (requires { method.has_corrector(); }) {
            if (method.has_corrector()) {
              return std::make_unique<CorrectedSimulation<P, decltype(method), A>>(problem, method, run.q, run.p, run.h,
                                                                                   arithmetic);
            }
          }
          if constexpr (std::is_same_v<R, double> && !A::exact_undo) {
            return requested(std::make_unique<RecordedSimulation<P, decltype(method), A>>(
                Ordinary(problem, method, run.q, run.p, run.h, arithmetic),
                request.record ? recorder_of<c, A>(run, recipe) : StepRecorder(), PartRecorder(), request.watch));
          } else {
            return requested(
                std::make_unique<PlanetarySimulation<Parted>>(problem, method, run.q, run.p, run.h, arithmetic));
          }
        } else {
          return requested(std::make_unique<Parted>(problem, method, run.q, run.p, run.h, arithmetic));
        }
      }
    };
    if constexpr (always_compensated<M>()) {
      return build(Compensated<R>{});
    } else if constexpr (!std::is_same_v<R, double>) {
      return build(Plain<R>{});
    } else {
      if (request.arithmetic == "compensated") return build(Compensated<R>{});
      if constexpr (M::bijective) {
        if (request.arithmetic == "lattice") {
          Lattice lattice;
          lattice.position.set_unit(request.position_unit);
          lattice.momentum.set_unit(request.momentum_unit);
          return build(lattice);
        }
      }
      return build(Plain<R>{});
    }
  };
  if constexpr (!std::is_same_v<R, double>) {
    if (request.method.name == ExtrapolatedMidpoint::name) {
      const double tolerance = number_value(request.method.options.at(tolerance_option));
      return detail::visit_capability_set<Result, ExtrapolatedMidpoint, 0>(
          run.functions.capability, ExtrapolatedMidpoint{{.tolerance = tolerance}}, simulate);
    }
  }
  return visit_erased<Result>(run.functions.capability, run.functions.size, request.method, simulate);
}

template <class R>
std::unique_ptr<Simulation> simulate_without_walls(const ErasedRun<R>& run, const Request& request) {
  return simulate_half<R, false>(run, request);
}

template <class R>
std::unique_ptr<Simulation> simulate_asked(const ErasedRun<R>& run, const Request& request) {
  const auto& walls = request.walls;
  if (!walls) return simulate_without_walls(run, request);
  return simulate_with_walls<R>(run, request, *walls, simulate_without_walls<R>);
}

/// A step in mp(d) can take minutes, so it can be interrupted.
template <class R>
std::unique_ptr<Simulation> simulate_erased(const ErasedRun<R>& run, const Request& request) {
  if constexpr (std::is_same_v<R, Mp>) {
    ErasedRun<R> asking = run;
    asking.functions.plain = InterruptibleFunctions<R>::asking(run.functions.plain);
    return simulate_asked(asking, request);
  } else {
    return simulate_asked(run, request);
  }
}

}  // namespace hamflow
