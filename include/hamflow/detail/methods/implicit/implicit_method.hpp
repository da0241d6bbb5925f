// Makes a method from the equations of its steps, with the loop around Newton that all of them share.
#pragma once

#include <optional>
#include <string>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/methods/implicit/energy_gain.hpp"
#include "hamflow/detail/methods/implicit/newton.hpp"

namespace hamflow {

/// cond_inf(M^-1(q)), with M^-1 = d^2 H/dp^2; unset if H has no second derivatives.
template <class P, class Real, std::size_t N>
double inverse_mass_condition(const P& problem, const Vector<Real, N>& q, const Vector<Real, N>& p) {
  if constexpr (!Smooth<P>)
    return StepDiagnostics::unset;
  else {
    Matrix<Real, N> qq = zero_matrix(q);
    Matrix<Real, N> qp = qq;
    Matrix<Real, N> pp = qq;
    hessian(problem, q, p, qq, qp, pp);
    return static_cast<double>(condition_number(pp));
  }
}

/// One step of the method that the equations E define. The memory of Newton and the changing part of E::Setup belong to
/// the state of a run. Increments are added with compensation if the arithmetic has it.
template <class P, Arithmetic A, class E>
class ImplicitMethod {
 public:
  static_assert(detail::HasStepTypes<E>,
                "hamflow: equations of a step need the types Problem, Real, Setup, Variables, Unknowns, Memory, Point "
                "and the constant n, see detail/methods/implicit/equations.hpp");
  static_assert(detail::SolvableByNewton<E>,
                "hamflow: equations of a step need last_state(), predicted(), started(memory), evaluate(x, at), "
                "at.residual, tangent(at), norm(x, at), measure(x, at, correction), see "
                "detail/methods/implicit/equations.hpp");
  static_assert(detail::EndsStep<E>,
                "hamflow: equations of a step need taken(x, at), taken(x, at, correction), memory(x, taken), "
                "unknowns(x, taken), see detail/methods/implicit/equations.hpp");
  static_assert(detail::Verifiable<E>,
                "hamflow: equations of a step need residual(q0, p0, unknowns) and increment(unknowns), templates over "
                "the number type, see detail/methods/implicit/equations.hpp");
  static_assert(detail::HasStepSetup<E>,
                "hamflow: the Setup of equations needs info(), newton(), detail() and residual_name, see "
                "detail/methods/implicit/equations.hpp");
  static_assert(
      !A::exact_undo,
      "hamflow: the lattice needs an explicit splitting method: an implicit step is not a bijection of the lattice");
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = Real;
  using Unknowns = typename E::Unknowns;
  using Equations = E;

  /// @param options of E::Setup
  template <class Options>
  ImplicitMethod(const P& problem, const Options& options) : setup_(problem, options), options_(setup_.newton()) {
    if constexpr (has_fast_path) {
      uses_fast_path_ = !options_.tolerance && !options_.diagnostics && !setup_.automatic();
    }
  }

  MethodInfo info() const { return setup_.info(); }

  Outcome step(const P& problem, const Base& h, PhasePoint<A, n>& z) { return counted(problem, h, z, nullptr); }
  /// Takes a step and returns its unknowns, which are invalid if effort() counts one more halved step.
  Outcome step(const P& problem, const Base& h, PhasePoint<A, n>& z, Unknowns& unknowns) {
    return counted(problem, h, z, &unknowns);
  }

  /// Drops the guesses and the points of "auto", which belong to steps of one size in one direction.
  void invalidate() {
    newton_.forget();
    if constexpr (requires { setup_.restart(); }) {
      if (setup_.automatic()) setup_.restart();
    }
  }
  /// Drops the guesses after the state was changed. The points of "auto" are kept: found again after every bounce they
  /// would be the fewest possible, and their energy error has a fixed sign (docs/design/walls.md).
  void forget_guesses() { newton_.forget(); }
  Effort effort() const { return effort_; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(effort_, diagnostics_, setup_, newton_);
  }
  const Newton<E>& newton() const { return newton_; }
  const typename E::Setup& setup() const { return setup_; }
  /// Continues after steps that were taken in lanes, with the memory of the last one and the work of all.
  void go_on(const typename E::Memory& memory, const Effort& effort) {
    newton_.remember(memory);
    effort_ = effort;
  }
  /// The diagnostics of the last step and over all steps; unset unless requested.
  StepDiagnostics diagnostics(const P& problem, const PhasePoint<A, n>& z) const {
    StepDiagnostics d;
    if (!options_.diagnostics) return d;
    d = diagnostics_;
    d.condition_inverse_mass = inverse_mass_condition(problem, z.positions(), z.momenta());  // at the start, too
    return d;
  }

  /// Repeats the failed step and reports the cause and, in a second line, the residuals of every attempt. Changes
  /// nothing.
  std::string failure(const P& problem, const Base& h, const PhasePoint<A, n>& z) const {
    ImplicitMethod again = *this;
    PhasePoint<A, n> copy = z;
    NewtonLog log;
    again.options_.halve = false;
    (void)again.attempt(problem, h, copy, 0, nullptr, &log);
    if constexpr (requires { again.setup_.no_finer_rule_message(); }) {
      if (log.change_unseen()) {
        return "H changes along the step by more than its rounding, although no quadrature of up to " +
               again.setup_.detail() +
               " detects a change: the step is far too long, or H has a kink or a jump there, such as abs(x), "
               "at which no quadrature conserves the energy";
      }
      if (log.too_coarse()) return again.setup_.no_finer_rule_message();
    }
    return solver_name(options_.iteration) + " did not converge in " + std::to_string(options_.max_iterations) +
           (options_.max_iterations == 1 ? " iteration" : " iterations") + " with " + again.setup_.detail() +
           (log.attempts() > 1 ? " from any of " + std::to_string(log.attempts()) + " starts" : "") +
           (options_.halve ? ", nor in ten halvings of the step" : "") + end_of_solution(log) + "\n" +
           E::Setup::residual_name + " per iteration of the whole step " + log.text();
  }

  /// r(z0, U) and E(U), for any number type. The verification differentiates them.
  template <class S, class U>
  U residual(const P& problem, const Base& h, const Vector<S, n>& q0, const Vector<S, n>& p0, const U& unknowns) const {
    const Vector<Real, n> nowhere = zeros<Real, n>(q0.size());
    Effort unused;
    return E(setup_, problem, h, nowhere, nowhere, unused).residual(q0, p0, unknowns);
  }
  template <class U>
  auto increment(const U& unknowns) const {
    if constexpr (requires { E::increment(unknowns); }) {
      return E::increment(unknowns);
    } else {
      return setup_.template increment<n>(unknowns);
    }
  }

 private:
  static constexpr int deepest_halving = 10;
  /// Whether the equations have a fast path for ordinary steps, with the bits of Newton's iteration.
  static constexpr bool has_fast_path = requires(const E& step, const typename E::Memory& memory) {
    step.fast_path(memory, 1);
  };

  static std::string end_of_solution(const NewtonLog& log) {
    if (log.solved_part() <= 0) return "";
    return "; the solution could be continued from the beginning of the step to " + shortest(log.solved_part()) +
           " of its length";
  }

  [[gnu::always_inline]] Outcome counted(const P& problem, const Real& h, PhasePoint<A, n>& z, Unknowns* unknowns) {
    const long long before = effort_.linear_solves;
    const Outcome outcome =
        solved_by_fast_path(problem, h, z, unknowns) ? Outcome::done : attempt(problem, h, z, 0, unknowns, nullptr);
    if (outcome != Outcome::done) return outcome;
    const long long solves = effort_.linear_solves - before;
    effort_.solves_min = effort_.steps == 0 || solves < effort_.solves_min ? solves : effort_.solves_min;
    effort_.solves_max = solves > effort_.solves_max ? solves : effort_.solves_max;
    ++effort_.steps;
    if (options_.diagnostics) diagnose(problem, z, solves);
    return outcome;
  }

  /// Takes the step or, if it does not converge and halving is allowed, two steps of half its length.
  Outcome attempt(const P& problem, const Real& h, PhasePoint<A, n>& z, int depth, Unknowns* unknowns, NewtonLog* log) {
    const Vector<Real, n> q0 = z.positions();
    const Vector<Real, n> p0 = z.momenta();
    if (solve(problem, h, q0, p0, z, unknowns, log)) return Outcome::done;
    if (!options_.halve || depth == deepest_halving) return Outcome::not_converged;
    const PhasePoint<A, n> start = z;
    const auto points = current_rule();
    invalidate();
    for (int half = 0; half < 2; ++half) {
      const Outcome outcome = attempt(problem, h / 2, z, depth + 1, unknowns, log);
      if (outcome != Outcome::done) {
        z = start;
        return_to(points);
        return outcome;
      }
    }
    if (depth == 0) ++effort_.halved;
    newton_.forget();
    return_to(points);
    return Outcome::done;
  }

  /// The points of "auto" for whole steps; half steps find theirs separately.
  auto current_rule() const {
    if constexpr (requires { setup_.current_rule(); }) {
      return setup_.current_rule();
    } else {
      return nullptr;
    }
  }
  template <class Mark>
  void return_to(const Mark& points) {
    if constexpr (requires { setup_.return_to(points); }) setup_.return_to(points);
  }

  /// Inlined into the loop over steps, because data whose address is passed to another function cannot stay in
  /// registers.
  [[gnu::always_inline]] bool solved_by_fast_path(const P& problem, const Real& h, PhasePoint<A, n>& z,
                                                  Unknowns* unknowns) {
    if constexpr (has_fast_path) {
      if (!uses_fast_path_ || !newton_.uses_memory()) [[unlikely]]
        return false;
      const Vector<Real, n> q0 = z.positions();
      const Vector<Real, n> p0 = z.momenta();
      const auto end =
          E(setup_, problem, h, q0, p0, effort_).fast_path(newton_.memory().predicted(), options_.max_iterations);
      if (end.corrections == 0) [[unlikely]]
        return false;
      for (std::size_t i = 0; i < n; ++i) {
        add(z.arithmetic.position, z.q[i], end.d[i]);
        add(z.arithmetic.momentum, z.p[i], end.impulse[i]);
      }
      newton_.remember({end.impulse[0], end.impulse[1]});
      if (unknowns != nullptr) *unknowns = {end.d[0], end.d[1], end.impulse[0], end.impulse[1]};
      return true;
    } else {
      return false;
    }
  }

  using Solution = typename Newton<E>::Solution;

  bool solve(const P& problem, const Real& h, const Vector<Real, n>& q0, const Vector<Real, n>& p0, PhasePoint<A, n>& z,
             Unknowns* unknowns, NewtonLog* log) {
    Solution found;
    const E step(setup_, problem, h, q0, p0, effort_);
    const auto first = newton_.solve(step, NewtonReport{options_, effort_, diagnostics_, log}, found);
    if (!first.settled) [[unlikely]] {
      const auto other = retry_from_other_guesses(problem, h, q0, p0, first, found, log);
      if (!other) return false;
      found = *other;
    }
    if constexpr (requires { step.too_coarse(found.x, found.taken); }) {
      if (setup_.automatic()) {
        const auto finer = refined(problem, h, q0, p0, found, log);
        if (!finer) return false;
        found = *finer;
      }
    }
    for (std::size_t i = 0; i < z.q.size(); ++i) {
      add(z.arithmetic.position, z.q[i], found.taken.q[i]);
      add(z.arithmetic.momentum, z.p[i], found.taken.p[i]);
    }
    newton_.remember(step, found);
    if (unknowns != nullptr) *unknowns = E(setup_, problem, h, q0, p0, effort_).unknowns(found.x, found.taken);
    return true;
  }

  /// Adds with all digits of the arithmetic.
  static void add(const typename A::Axis& axis, typename A::Stored& s, const Real& r) {
    if constexpr (requires { axis.add_with_exact_low(s, r); }) {
      axis.add_with_exact_low(s, r);
    } else {
      axis.add(s, r);
    }
  }

  // Both take and return values, so that the data of solve() stay in registers.
  [[gnu::cold, gnu::noinline]] std::optional<Solution> retry_from_other_guesses(
      const P& problem, const Real& h, const Vector<Real, n> q0, const Vector<Real, n> p0,
      const typename Newton<E>::FirstAttempt first, Solution found, NewtonLog* log) {
    const NewtonReport report{options_, effort_, diagnostics_, log};
    if (newton_.retry_from_other_guesses(E(setup_, problem, h, q0, p0, effort_), report, first, found)) return found;
    if (first.refused) return {};
    if (options_.iteration == Iteration::fixed_point_or_newton) {
      NewtonOptions by_newton = options_;
      by_newton.iteration = Iteration::newton;
      by_newton.max_iterations = NewtonOptions{}.max_iterations;
      const NewtonReport again{by_newton, effort_, diagnostics_, log};
      if (newton_.retry_from_other_guesses(E(setup_, problem, h, q0, p0, effort_), again, {}, found)) return found;
    }
    if (options_.halve || options_.iteration != Iteration::newton) return {};
    return continued(problem, h, q0, p0, log);
  }

  /// Continues the solution from a sixteenth of the step to the whole step: this branch belongs to the motion. It may
  /// meet another branch and end before the whole step.
  [[gnu::cold, gnu::noinline]] std::optional<Solution> continued(const P& problem, const Real& h,
                                                                 const Vector<Real, n>& q0, const Vector<Real, n>& p0,
                                                                 NewtonLog* log) {
    const NewtonReport report{options_, effort_, diagnostics_, nullptr};
    constexpr double shortest_part = 1.0 / 4096;
    double solved = 0;
    double more = 1.0 / 16;
    Solution found;
    while (solved < 1 && more >= shortest_part) {
      const double part = solved + more < 1 ? solved + more : 1;
      const Real length = Real(part) * h;
      const E step(setup_, problem, length, q0, p0, effort_);
      Solution trial;
      trial.x = solved > 0 ? found.x : step.predicted();
      if (solved > 0) {
        for (std::size_t i = 0; i < trial.x.size(); ++i) trial.x[i] = Real(part / solved) * trial.x[i];
      }
      if (newton_.solve_from(step, report, trial)) {
        found = trial;
        solved = part;
        more = 1.5 * more;
      } else {
        more = more / 4;
      }
    }
    if (log != nullptr) log->note_end_of_solution(solved);
    if (solved < 1) return {};
    newton_.note_continued_step();
    return found;
  }

  /// Solves the step with finer equations until they are fine enough. If the step is not taken, the coarser ones are
  /// restored.
  [[gnu::noinline]] std::optional<Solution> refined(const P& problem, const Real& h, const Vector<Real, n> q0,
                                                    const Vector<Real, n> p0, Solution found, NewtonLog* log) {
    const NewtonReport report{options_, effort_, diagnostics_, log};
    const auto before = setup_.current_rule();
    for (;;) {
      const E step(setup_, problem, h, q0, p0, effort_);
      const bool coarse = step.too_coarse(found.x, found.taken);
      if (!coarse && !energy_test_misses_change(step, problem, q0, p0, found)) return found;
      if (options_.tolerance && fine_without_tolerance(problem, h, q0, p0, found)) return found;
      const bool finer = setup_.refine();
      if (!finer && !energy_test_misses_change(step, problem, q0, p0, found, 16))
        return found;  // roundings of such forces
      if (log != nullptr) {
        log->restart();
        if (!coarse) log->note_change_unseen();
        if (!finer) log->note_too_coarse();
      }
      if (!finer || !newton_.solve_refined(E(setup_, problem, h, q0, p0, effort_), report, found)) {
        if (log == nullptr) setup_.return_to(before);  // a report needs the last equations
        return {};
      }
    }
  }

  /// Tests the points along the solution to rounding. The energy gain along a solution with a residual at the tolerance
  /// includes the effect of that residual, which more points cannot reduce.
  [[gnu::noinline]] bool fine_without_tolerance(const P& problem, const Real& h, const Vector<Real, n>& q0,
                                                const Vector<Real, n>& p0, Solution found) {
    NewtonOptions to_rounding = options_;
    to_rounding.tolerance.reset();
    to_rounding.seed_criterion = to_rounding.diagnostics = false;
    to_rounding.max_iterations = std::max(to_rounding.max_iterations, NewtonOptions{}.max_iterations);
    const NewtonReport report{to_rounding, effort_, diagnostics_, nullptr};
    const E step(setup_, problem, h, q0, p0, effort_);
    Newton<E> trial = newton_;  // its memory of guesses does not belong to the state of the run
    return trial.solve_refined(step, report, found) && !step.too_coarse(found.x, found.taken) &&
           !energy_test_misses_change(step, problem, q0, p0, found);
  }
  static bool energy_test_misses_change(const E& step, const P& problem, const Vector<Real, n>& q0,
                                        const Vector<Real, n>& p0, const Solution& found, int most_roundings = 256) {
    return detail::energy_test_misses_change(
        problem, q0, p0, found.taken,
        [&] {
          if constexpr (requires { step.own_gain(found.x); }) {
            return step.own_gain(found.x);
          } else {
            return Real(0);
          }
        },
        most_roundings);
  }

  [[gnu::noinline]] void diagnose(const P& problem, const PhasePoint<A, n>& z, long long solves) {
    StepDiagnostics& d = diagnostics_;
    d.iterations = static_cast<double>(solves);
    d.condition_inverse_mass = inverse_mass_condition(problem, z.positions(), z.momenta());
    d.extend(effort_.steps);
  }

  typename E::Setup setup_;
  NewtonOptions options_;
  Effort effort_{};
  StepDiagnostics diagnostics_{};
  Newton<E> newton_;
  bool uses_fast_path_ = false;  // no requested output needs Newton's iteration
};

}  // namespace hamflow
