// Newton's iteration for the equations of a step, and its initial guesses.
//
// The initial guess is extrapolated from the last steps; without memory it is the explicit predictor. If it fails, the
// predictor, the last state (as in the programs of the first thesis) and a damped Newton iteration are tried in turn,
// each with max_iterations corrections. If all fail, ImplicitMethod continues the solution of a short step to the whole
// step.
//
// If h is longer than the period of the fastest motion, a polynomial through the last steps does not predict the next
// one. Newton may still converge from there, for example to a root on the other side of a singularity. Therefore, if
// the distance of the initial guess from the solution is larger than the whole step, it counts as a guess failure:
// steps then start from the last state, until three extrapolations in a row would have been closer. With good guesses
// this costs no evaluation.
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
/// Equations whose Jacobian is computed on request; every Iteration can solve them.
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

/// The options of a run, and the outputs of Newton.
struct NewtonReport {
  const NewtonOptions& options;
  Effort& effort;
  StepDiagnostics& diagnostics;
  NewtonLog* log;  // null except for the report of a failure
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

  /// The result of the initial guess.
  struct FirstAttempt {
    bool settled = false;  // found the solution of the step; otherwise retry_from_other_guesses() is needed
    bool found = false;    // found a solution, but far from the guess
    bool refused = false;  // criterion "seed"
    Guess start = Guess::extrapolated;
  };

  /// Solves the step from its initial guess. Does nothing after guess failures.
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
  /// Call this if the initial guess failed, was not used, or led to a distant root. @return whether a solution was
  /// found
  [[gnu::cold, gnu::noinline]] bool retry_from_other_guesses(const E& step, const NewtonReport& report,
                                                             const FirstAttempt& first, Solution& found) {
    if (first.refused) return false;
    if (!first.found) return from_other_starts(step, report, found, first.start);
    if (!energy_error_acceptable(step, report, found)) {
      const Solution far = found;
      if (!from_other_starts(step, report, found, first.start)) found = far;  // it still solves the equations
    }
    guess_failures_ = good_guesses_needed;
    return true;
  }
  /// Solves the step from the guess in `found`.
  [[gnu::cold, gnu::noinline]] bool solve_from(const E& step, const NewtonReport& report, Solution& found) const {
    Point at;
    IterationResult result;
    return iterate<false>(step, report, found, at, result) == Ending::converged &&
           energy_error_acceptable(step, report, found);
  }
  /// Records that the step was solved by continuation, so that extrapolated guesses are not used.
  void note_continued_step() {
    ++solved_[static_cast<int>(Guess::continued)];
    guess_failures_ = good_guesses_needed;
  }
  /// Solves the step again, from the solution of coarser equations.
  [[gnu::noinline]] bool solve_refined(const E& step, const NewtonReport& report, Solution& found) {
    Point at;
    IterationResult result;
    if (report.log != nullptr) report.log->attempt(Guess::converged);
    const Ending ending = iterate<false>(step, report, found, at, result);
    if (ending != Ending::diverged) return ending == Ending::converged;
    return from_other_starts(step, report, found, Guess::converged);
  }

  /// Call this after each step that is taken.
  void remember(const E& step, const Solution& found) { memory_.remember(step.memory(found.x, found.taken)); }
  /// Drops the memory, which belongs to steps of one size in one direction.
  void forget() {
    memory_.forget();
    guess_failures_ = 0;
  }
  template <class Archive>
  void archive(Archive& ar) {
    ar(memory_, guess_failures_);
  }
  /// For lanes: the memory, and whether the next step starts from it.
  const auto& memory() const { return memory_; }
  bool uses_memory() const { return guess_failures_ == 0 && !memory_.empty(); }
  void remember(const typename E::Memory& memory) { memory_.remember(memory); }
  /// The number of steps solved from this guess after the initial guess had failed or was not used. Not part of the
  /// state of a run.
  long long solved_from(Guess start) const { return solved_[static_cast<int>(start)]; }

 private:
  enum class Ending {
    converged,
    diverged,
    refused  // a solution at rounding level, but above the tolerance: an error with criterion "seed"
  };
  /// Facts about a converged iteration.
  struct IterationResult {
    bool guess_was_far = false;  // the first correction was larger than the terms of the step
    Real noise{0};               // the noise with which the last correction was compared
  };
  static constexpr auto epsilon = Epsilon<Real>{};

  /// Not inlined, with a local copy of x and references to the rest: this is the fastest form (measured; inlined into
  /// solve() a step takes a quarter longer).
  template <bool damped>
  [[gnu::noinline]] Ending iterate(const E& step, const NewtonReport& report, Solution& found, Point& at,
                                   IterationResult& result) const {
    const NewtonOptions& options = report.options;
    Variables x = found.x;
    Real noise(0);
    bool at_rounding = false;  // a further correction would be rounding
    bool was_at_rounding = false;
    bool shortened = false;  // by damping
    bool evaluated = false;  // by damping, already
    [[maybe_unused]] Iteration iteration = first_iteration(options.iteration);
    NewtonProgress<Real> progress(detail::AnyIteration<E> ? convergence_of(iteration) : Convergence::quadratic);
    [[maybe_unused]] Variables rounding{};   // of the residual, in addition to that of its terms; empty: not measured
    [[maybe_unused]] Real rounded_terms(0);  // the noise of its terms at that iterate
    [[maybe_unused]] std::conditional_t<detail::AnyIteration<E>, LuFactors<Real>, int> factors{};
    for (int k = 0;; ++k) {
      if constexpr (detail::AnyIteration<E>) {
        at.linearised = iteration == Iteration::newton || (k == 0 && iteration == Iteration::simplified);
      }
      if (!damped || !evaluated) step.evaluate(x, at);
      evaluated = false;
      if constexpr (detail::EvaluatesNearbyStates<E>) {
        // A measurement far from the solution, where forces are larger, is not valid near it.
        if (rounding.size() > 0 && detail::sum_of(at.noise) < rounded_terms / 2) {
          rounding = {};
          progress.restart();
        }
        for (std::size_t i = 0; i < rounding.size(); ++i) at.noise[i] += rounding[i];
      }
      if (options.tolerance || report.log != nullptr || options.diagnostics) {
        const Variables here = x;  // a copy, because a variable with an address does not stay in registers
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
        if (k > 0) step.remove_residual_rounding(x, at);  // this correction is usually the last one
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
        // In a stiff step a correction is far smaller than the residual. The residual changes the energy, and a
        // Jacobian from an earlier iteration leaves a part of it.
        if (iteration == Iteration::simplified) {
          c.size = larger(c.size, step.measure(x, at, at.residual).size);
        }
      }
      noise = c.noise;
      Real total = c.size;  // a sum keeps NaN and infinity, a maximum may not
      for (std::size_t i = 0; i < x.size(); ++i) total += abs(correction[i]);
      if (shortened) progress.restart();
      const NewtonDecision decision = progress.judge(c.size, total, noise);
      if (decision == NewtonDecision::not_finite) {
        if (report.log != nullptr) report.log->remark("not finite");
        return Ending::diverged;
      }
      at_rounding = decision == NewtonDecision::settled;
      if constexpr (detail::AnyIteration<E>) {
        // With a Jacobian from an earlier iteration the error of the last correction is at rounding level if the
        // residual is. If the unknowns round by more than that, the Jacobian at the solution is needed.
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
          if (terms > Real(0) && progress.continues_with_terms(terms)) [[unlikely]]
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
          // The guess was the solution, as for a constant force. The rounding error of its residual then has a fixed
          // sign, and so has the energy error, which accumulates with walls.
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

  /// Adds the largest part 1, 1/2, 1/4, ... of the correction that reduces the residual by at least a quarter of what
  /// Newton's linear model predicts.
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

  /// @param tried the guess that has failed already; `extrapolated` with guess_failures_ > 0: none
  [[gnu::cold, gnu::noinline]] bool from_other_starts(const E& step, const NewtonReport& report, Solution& found,
                                                      Guess tried) {
    const bool has_failures = guess_failures_ > 0;
    const Guess order[] = {has_failures ? Guess::last_state : Guess::predicted,
                           has_failures ? Guess::predicted : Guess::last_state, Guess::damped};
    for (const Guess start : order) {
      if (start == tried) continue;
      if (start == Guess::damped && report.options.iteration != Iteration::newton)
        continue;  // damping needs a Newton correction
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
        if (report.log != nullptr) report.log->remark("a root that does not conserve the energy");
        return false;
      }
    }
    return true;
  }

  /// Tests whether the distance of the extrapolated guess would have been smaller than the step.
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
  int guess_failures_ = 0;  // number of good extrapolations still needed before one is used as initial guess
  long long solved_[6] = {};
};

}  // namespace hamflow
