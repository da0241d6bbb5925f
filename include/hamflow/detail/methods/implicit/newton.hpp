// Newton's iteration for the equations of a step, and where it starts.
//
// The first guess is extrapolated from the last steps; without memory it is the explicit predictor. Where it fails, the
// predictor, the last state (as in the first thesis' programs) and a Newton whose steps are damped until the residual
// shrinks are tried in turn, each with max_iterations of its own. Where all of them fail, ImplicitMethod follows the
// solution of a short step to that of the whole one.
//
// Where h is longer than the fastest motion, a polynomial through the last steps says nothing about the next one.
// Newton may yet converge from there, to a root on the other side of a singularity, say. So, where the first guess lies
// farther from the solution than the whole step is long, it is in *doubt*: steps then start from the last state, until
// three extrapolations in a row would have been nearer. As long as guesses are good nothing of this costs an
// evaluation.
#pragma once

#include "hamflow/detail/methods/implicit/equations.hpp"
#include "hamflow/detail/methods/implicit/extrapolation.hpp"
#include "hamflow/detail/methods/implicit/newton_log.hpp"
#include "hamflow/detail/methods/implicit/rounding_by_state.hpp"
#include "hamflow/detail/numerics/few.hpp"
#include "hamflow/detail/numerics/lu_factors.hpp"
#include "hamflow/detail/numerics/newton_progress.hpp"

namespace hamflow {

namespace detail {
/// Equations whose tangent is computed where it is asked for: they can be solved by every Iteration.
template <class E>
concept AnyIteration = requires(typename E::Point& at) {
  { at.linearised } -> std::same_as<bool&>;
};
template <class E>
struct GuessesOf {
  using type = Extrapolation<typename E::Memory>;
};
template <class E>
requires requires { typename E::Guesses; }
struct GuessesOf<E> {
  using type = typename E::Guesses;
};

template <class M>
[[gnu::noinline]] void note_tangent(const M& tangent, StepDiagnostics& out) {
  out.condition_tangent = static_cast<double>(condition_number(tangent));
  out.determinant_tangent = static_cast<double>(determinant(tangent));
}
}  // namespace detail

/// What Newton works with beside the equations: the options of a run, and what it reports.
struct NewtonReport {
  const NewtonOptions& options;
  Effort& effort;
  StepDiagnostics& diagnostics;
  NewtonLog* log;  // null but for the report of a failure
};

template <StepEquations E>
class Newton {
 public:
  using Real = typename E::Real;
  using Variables = typename E::Variables;
  using Point = typename E::Point;
  struct Solution {
    Variables x{};
    Increment<Real, E::n> taken{};  // z1 - z0
  };

  /// How the first guess went.
  struct FirstAttempt {
    bool settled = false;  // its solution is that of the step; else retry_from_other_guesses() has to look
    bool found = false;    // but it is a solution, from far away
    bool refused = false;  // criterion "seed"
    Guess start = Guess::extrapolated;
  };

  /// Solves the step from its first guess. Where that is in doubt nothing is tried.
  FirstAttempt solve(const E& step, const NewtonReport& report, Solution& found) const {
    if (guess_failures_ > 0) [[unlikely]]
      return {};
    const Guess start = memory_.empty() ? Guess::predicted : Guess::extrapolated;
    found.x = memory_.empty() ? step.predicted() : step.started(memory_.predicted());
    Point at;
    IterationResult result;
    if (report.log != nullptr) report.log->attempt(start);
    const Ending ending = iterate<false>(step, report, found, at, result);
    return {ending == Ending::converged && !result.guess_was_far, ending == Ending::converged,
            ending == Ending::refused, start};
  }
  /// The first guess has failed, is in doubt, or has led to a root from far away. @return whether a solution was found
  [[gnu::cold, gnu::noinline]] bool retry_from_other_guesses(const E& step, const NewtonReport& report,
                                                             const FirstAttempt& first, Solution& found) {
    if (first.refused) return false;
    if (!first.found) return from_other_starts(step, report, found, first.start);
    if (!energy_error_acceptable(step, report, found)) {
      const Solution far = found;
      if (!from_other_starts(step, report, found, first.start)) found = far;  // it solves the equations, after all
    }
    guess_failures_ = good_guesses_needed;
    return true;
  }
  /// From a guess that is neither extrapolated nor one of the usual starts.
  [[gnu::cold, gnu::noinline]] bool solve_from(const E& step, const NewtonReport& report, Solution& found) const {
    Point at;
    IterationResult result;
    return iterate<false>(step, report, found, at, result) == Ending::converged &&
           energy_error_acceptable(step, report, found);
  }
  /// The step was solved in such a way: what is extrapolated is in doubt.
  void note_continued_step() {
    ++solved_[static_cast<int>(Guess::continued)];
    guess_failures_ = good_guesses_needed;
  }
  /// Solves the step again, from its solution with coarser equations.
  [[gnu::noinline]] bool solve_refined(const E& step, const NewtonReport& report, Solution& found) {
    Point at;
    IterationResult result;
    if (report.log != nullptr) report.log->attempt(Guess::converged);
    const Ending ending = iterate<false>(step, report, found, at, result);
    if (ending != Ending::diverged) return ending == Ending::converged;
    return from_other_starts(step, report, found, Guess::converged);
  }

  /// After a step that was taken.
  void remember(const E& step, const Solution& found) { memory_.remember(step.memory(found.x, found.taken)); }
  /// What is remembered belongs to steps of one length in one direction.
  void forget() {
    memory_.forget();
    guess_failures_ = 0;
  }
  template <class Archive>
  void archive(Archive& ar) {
    ar(memory_, guess_failures_);
  }
  /// For lanes: what is remembered, and whether the next step begins with it.
  const auto& memory() const { return memory_; }
  bool uses_memory() const { return guess_failures_ == 0 && !memory_.empty(); }
  void remember(const typename E::Memory& memory) { memory_.remember(memory); }
  /// How many steps were solved from there after the first guess had failed or was in doubt. No part of a run's state.
  long long solved_from(Guess start) const { return solved_[static_cast<int>(start)]; }

 private:
  enum class Ending {
    converged,
    diverged,
    refused  // at rounding level above the tolerance, which criterion "seed" calls an error: a solution was found
  };
  /// Of an iteration that converged.
  struct IterationResult {
    bool guess_was_far = false;  // the first correction was larger than the terms of the step
    Real noise{0};               // what the last correction was compared with
  };
  static constexpr auto epsilon = Epsilon<Real>{};

  /// A function of its own, with x by value and the rest where it is: fastest by far (measured; inlined into solve() a
  /// step takes a quarter more).
  template <bool damped>
  [[gnu::noinline]] Ending iterate(const E& step, const NewtonReport& report, Solution& found, Point& at,
                                   IterationResult& result) const {
    const NewtonOptions& options = report.options;
    Variables x = found.x;
    Real noise(0);
    bool at_rounding = false;  // no further correction can be told from rounding
    bool was_at_rounding = false;
    bool shortened = false;  // by damping
    bool evaluated = false;  // by damping, already
    [[maybe_unused]] Iteration iteration = first_iteration(options.iteration);
    NewtonProgress<Real> progress(detail::AnyIteration<E> ? convergence_of(iteration) : Convergence::quadratic);
    [[maybe_unused]] Variables rounding{};   // of the residual, beside what its terms tell; empty: not asked for
    [[maybe_unused]] Real rounded_terms(0);  // what its terms told there
    [[maybe_unused]] std::conditional_t<detail::AnyIteration<E>, LuFactors<Real>, int> factors{};
    for (int k = 0;; ++k) {
      if constexpr (detail::AnyIteration<E>) {
        at.linearised = iteration == Iteration::newton || (k == 0 && iteration == Iteration::simplified);
      }
      if (!damped || !evaluated) step.evaluate(x, at);
      evaluated = false;
      if constexpr (detail::EvaluatesNearbyStates<E>) {
        // What was asked far from a solution, where forces are larger, is not true at one.
        if (rounding.size() > 0 && detail::sum_of(at.noise) < rounded_terms / 2) {
          rounding = {};
          progress.restart();
        }
        for (std::size_t i = 0; i < rounding.size(); ++i) at.noise[i] += rounding[i];
      }
      if (options.tolerance || report.log != nullptr || options.diagnostics) {
        const Variables here = x;  // a copy: what has an address does not stay in registers
        const Real norm = step.norm(here, at);
        if (report.log != nullptr) report.log->residual(static_cast<double>(norm));
        report.diagnostics.residual = static_cast<double>(norm);
        if (options.tolerance) {
          const bool small = norm < static_cast<Real>(*options.tolerance);
          if (small || (at_rounding && !options.seed_criterion)) {
            if (!small) ++report.effort.stagnated;
            found.taken = step.taken(x, at);
            found.x = x;
            result = {progress.began_far_away(noise), noise};
            return Ending::converged;
          }
        }
      }
      if (k == options.max_iterations) {
        if (!was_at_rounding) return Ending::diverged;
        if (report.log != nullptr) report.log->remark("at rounding level, above the tolerance");
        return Ending::refused;
      }
      if constexpr (requires { step.remove_residual_rounding(x, at); }) {
        if (k > 0) step.remove_residual_rounding(x, at);  // this correction is the last one, mostly
      }
      const auto solved = [&]() -> Variables {
        if constexpr (detail::AnyIteration<E>) {
          if (at.linearised && options.diagnostics) detail::note_tangent(step.tangent(at), report.diagnostics);
          if (at.linearised) factors.factor(step.tangent(at));
          return iteration == Iteration::fixed_point ? at.residual : factors.solve(at.residual);
        } else {
          const auto tangent = step.tangent(at);
          if (options.diagnostics) {
            const auto copy = tangent;
            detail::note_tangent(copy, report.diagnostics);
          }
          return hamflow::solve(tangent, at.residual);
        }
      };
      Variables correction = solved();
      ++report.effort.linear_solves;
      Correction<Real> c = step.measure(x, at, correction);
      if constexpr (detail::AnyIteration<E>) {
        // In a stiff step a correction is far smaller than the residual, which is what changes the energy and what a
        // tangent of old leaves a part of.
        if (iteration == Iteration::simplified) {
          c.size = larger(c.size, step.measure(x, at, at.residual).size);
        }
      }
      noise = c.noise;
      Real total = c.size;  // NaN and infinity do not get lost in a sum, as they do in a maximum
      for (std::size_t i = 0; i < x.size(); ++i) total += abs(correction[i]);
      if (shortened) progress.restart();
      const NewtonDecision decision = progress.judge(c.size, total, noise);
      if (decision == NewtonDecision::not_finite) {
        if (report.log != nullptr) report.log->remark("not finite");
        return Ending::diverged;
      }
      at_rounding = decision == NewtonDecision::settled;
      if constexpr (detail::AnyIteration<E>) {
        // What a tangent of old leaves of the last correction is no more than rounding where the residual is. Where the
        // unknowns round by more than that, it takes the tangent of the solution.
        if (!at_rounding && iteration == Iteration::simplified && progress.stalls() >= 2) {
          iteration = Iteration::newton;
          progress.restart(Convergence::quadratic);
        }
      }
      [[maybe_unused]] bool has_stalled = false;
      if constexpr (detail::EvaluatesNearbyStates<E>) {
        has_stalled = decision == NewtonDecision::stalled && rounding.size() == 0;
        if (has_stalled && iteration == Iteration::fixed_point) {
          at_rounding = max_norm(correction) <= Real(4) * detail::rounding_by_unknowns(step, x);
        }
      }
      if constexpr (requires { step.hidden_terms(x, at, correction); }) {
        if (at_rounding) {
          const Real terms = step.hidden_terms(x, at, correction);
          if (terms > Real(0) && progress.goes_on_with(terms)) [[unlikely]]
            at_rounding = false;
        }
      }
      if constexpr (detail::EvaluatesNearbyStates<E>) {
        if (!at_rounding && has_stalled) {
          rounding = detail::rounding_by_state(step, x);
          rounded_terms = detail::sum_of(at.noise);
          progress.restart();
        }
      }
      was_at_rounding = was_at_rounding || at_rounding;
      if (at_rounding && !options.tolerance) {
        if constexpr (requires { step.remove_residual_rounding(x, at); }) {
          // The guess was the solution, as it is of a constant force: what its residual had lost to rounding had a sign
          // there, and with it the energy that walls bring back over and over.
          if (k == 0) {
            step.remove_residual_rounding(x, at);
            correction = solved();
          }
        }
        found.taken = step.taken(x, at, correction);
        found.x = x;
        result = {progress.began_far_away(noise), noise};
        return Ending::converged;
      }
      if constexpr (damped) {
        if (!at_rounding) {
          if (!shorten(step, x, at, correction, shortened)) {
            if (report.log != nullptr) report.log->remark("no smaller residual along the correction");
            return Ending::diverged;
          }
          evaluated = true;
          continue;
        }
      }
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += correction[i];
    }
  }

  /// x and `at` after a part of the correction, the longest of 1, 1/2, 1/4 ... that shrinks the residual by a quarter
  /// of what Newton's linear model says.
  static bool shorten(const E& step, Variables& x, Point& at, const Variables& correction, bool& shortened) {
    const Real now = step.norm(x, at);
    Real part(1);
    for (int halvings = 0; halvings <= 12; ++halvings) {
      Variables trial = x;
      for (std::size_t i = 0; i < x.size(); ++i) trial[i] += part * correction[i];
      Point there;
      step.evaluate(trial, there);
      if (step.norm(trial, there) <= (Real(1) - part / 4) * now) {
        x = trial;
        at = there;
        shortened = halvings > 0;
        return true;
      }
      part = part / 2;
    }
    return false;
  }

  /// @param tried the start that has failed already; `extrapolated` with guess_failures_ > 0: none
  [[gnu::cold, gnu::noinline]] bool from_other_starts(const E& step, const NewtonReport& report, Solution& found,
                                                      Guess tried) {
    const bool has_failures = guess_failures_ > 0;
    const Guess order[] = {has_failures ? Guess::last_state : Guess::predicted,
                           has_failures ? Guess::predicted : Guess::last_state, Guess::damped};
    for (const Guess start : order) {
      if (start == tried) continue;
      if (start == Guess::damped && report.options.iteration != Iteration::newton) continue;  // a part of a Newton step
      found.x = start == Guess::predicted ? step.predicted() : step.last_state();
      if (report.log != nullptr) report.log->attempt(start);
      Point at;
      IterationResult result;
      const Ending ending = start == Guess::damped ? iterate<true>(step, report, found, at, result)
                                                   : iterate<false>(step, report, found, at, result);
      if (ending == Ending::refused) return false;
      if (ending == Ending::diverged || !energy_error_acceptable(step, report, found)) continue;
      ++solved_[static_cast<int>(start)];
      judge_extrapolation(step, found, at, result.noise);
      return true;
    }
    return false;
  }

  static bool energy_error_acceptable(const E& step, const NewtonReport& report, const Solution& found) {
    if constexpr (requires { step.energy_error_acceptable(found.x, found.taken); }) {
      if (!step.energy_error_acceptable(found.x, found.taken)) {
        if (report.log != nullptr) report.log->remark("a root that does not keep the energy");
        return false;
      }
    }
    return true;
  }

  /// Whether the extrapolated guess would have been nearer than the step is long.
  void judge_extrapolation(const E& step, const Solution& found, const Point& at, const Real& noise) {
    bool good = false;
    if (guess_failures_ > 0 && !memory_.empty()) {
      Variables difference = step.started(memory_.predicted());
      for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= found.x[i];
      good = epsilon * step.measure(found.x, at, difference).size <= noise;
    }
    guess_failures_ = good_guesses_needed_after(guess_failures_, good);
  }

  typename detail::GuessesOf<E>::type memory_;
  int guess_failures_ = 0;  // good extrapolations still wanted before one is a first guess again
  long long solved_[6] = {};
};

}  // namespace hamflow
