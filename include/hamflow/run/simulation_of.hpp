// The typed simulation that implements the type-erased one: a problem, a method for it, an arithmetic and a probe.
#pragma once

#include <algorithm>
#include <limits>
#include <utility>

#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/run/probe.hpp"
#include "hamflow/detail/run/simulation_state.hpp"
#include "hamflow/methods/recipe.hpp"
#include "hamflow/methods/step_control.hpp"

namespace hamflow {

/// **Method**: one step of a map, and claims about it.
template <class M, class P, class A>
concept Method = Problem<P> && Arithmetic<A> &&
    requires(M& method, const P& problem, typename A::Real h, PhasePoint<A, P::dimension>& z) {
  {
    method.step(problem, h, z)
    } -> std::same_as<Outcome>;  // no allocation, no input or output; does not advance the time
  { method.info() } -> std::same_as<MethodInfo>;
  { method.effort() } -> std::same_as<Effort>;
  method.invalidate();  // the state was changed from outside
};

template <class P, class M, Arithmetic A, class Probe = ConservationProbe<P, typename A::Real>>
class SimulationOf : public SimulationState<P, A, Probe> {
  using State = SimulationState<P, A, Probe>;

 protected:
  using State::clock_;
  using State::density_;
  using State::probe_;
  using State::problem_;
  using State::z_;
  M method_;

 public:
  static_assert(Method<M, P, A>, "hamflow: this type is not a Method for this problem and arithmetic");
  using State::n;
  using Real = typename A::Real;
  using Stepper = M;
  using Watch = Probe;

  /// @param start canonical (q, p)   @param h step size   @param arithmetic e.g. lattice units
  SimulationOf(P problem, M method, const Vector<Real, n>& q, const Vector<Real, n>& p, Real h, A arithmetic = {},
               Real t0 = 0)
      : State(std::move(problem), q, p, h, arithmetic, t0), method_(std::move(method)) {}

  /// From now on takes reversible steps of varying size, for a symmetric method; the first has the size of the
  /// equal steps (detail/methods/step_density.hpp, step_monitors.hpp). The time is then the sum of the sizes.
  [[gnu::cold]] void vary_steps(typename State::Monitor monitor) {
    State::begin_varying(std::move(monitor));
    if constexpr (requires { method_.keep_unscaled_force(); }) method_.keep_unscaled_force();
    method_.invalidate();
  }

  Outcome advance(std::int64_t steps) override {
    if (z_.arithmetic.lost()) return Outcome::lattice_overflow;
    if (density_) return take_varying(steps);
    std::int64_t taken = 0;
    const Outcome outcome = advance_in_registers(steps, clock_.step_length(), taken, method_, z_, probe_);
    clock_.advance(taken);
    return outcome;
  }

  void reverse_time() override {
    clock_.reverse();
    if (density_) density_->reverse_time(this->monitored_rate());
    method_.invalidate();
    if constexpr (MayHaveClock<P>) {
      if (has_clock(problem_)) turn_clock();
    }
  }
  void negate_momenta() override {
    z_.negate_momenta();
    if constexpr (requires { method_.negate_momenta(); })
      method_.negate_momenta();  // for a method with a copy of the state
    if (density_) density_->turn(this->monitored_rate());
    method_.invalidate();
  }
  StepDiagnostics diagnostics() const override {
    if constexpr (requires { method_.diagnostics(problem_, z_); }) {
      return method_.diagnostics(problem_, z_);
    } else {
      return {};
    }
  }
  Effort effort() const override { return method_.effort(); }
  MethodInfo method() const override {
    return density_ ? with_varying_steps(method_.info(), this->monitor().name) : method_.info();
  }
  std::string failure() const override {
    if (const std::string why = this->unusable_density(); !why.empty()) return why;
    if constexpr (requires { method_.failure(problem_, clock_.step_length(), z_); }) {
      return method_.failure(problem_, this->next_length(), z_);
    } else {
      return {};
    }
  }

  [[gnu::cold]] std::vector<std::byte> save() const override {
    Writer ar;
    State::save_state(ar);
    if constexpr (detail::HasArchive<M, Writer>) ar(method_);  // other methods have no memory
    return ar.take();
  }
  [[gnu::cold]] void restore(std::span<const std::byte> saved) override {
    Reader ar(saved);
    typename State::Saved found = State::read_state(ar);
    M method = method_;
    if constexpr (detail::HasArchive<M, Reader>) ar(method);
    ar.finish();
    State::expect_same(found);
    State::take(std::move(found));
    method_ = std::move(method);
    if constexpr (MayHaveClock<P>) {
      if (has_clock(problem_)) measure_span_of_clock();
    }
  }
  [[gnu::cold]] std::unique_ptr<Simulation> clone() const override { return std::make_unique<SimulationOf>(*this); }

 private:
  /// Measures the increment of the time coordinate in a step: on the lattice an integer, the same in every step.
  [[gnu::cold]] void measure_span_of_clock() {
    if constexpr (A::exact_undo) {
      M method = method_;
      method.invalidate();
      PhasePoint<A, n> z = z_;
      (void)method.step(problem_, clock_.step(), z);
      this->span_of_clock_ = z.q[z.q.size() - 2] - z_.q[z_.q.size() - 2];
    }
  }
  [[gnu::cold]] void turn_clock() {
    measure_span_of_clock();
    if (!density_) this->set_clock_after(0, clock_.step(), z_);
    set_method_time(method_, z_);
  }
  /// Passes the new time to the method, which may hold a copy of the state. On the lattice the last force of a step is
  /// not kept for the next one, because the time is rounded again; otherwise steps could not be reversed exactly.
  static void set_method_time(M& method, [[maybe_unused]] const PhasePoint<A, n>& z) {
    if constexpr (requires { method.set_clock(z); }) method.set_clock(z);
    if constexpr (A::exact_undo) method.invalidate();
  }
  [[gnu::cold]] Outcome complete_step() final {
    const Outcome outcome = State::complete_step();
    if (has_clock(problem_)) set_method_time(method_, z_);
    return outcome;
  }

  /// Takes varying steps one by one, since each determines the length of the next.
  [[gnu::cold, gnu::noinline]] Outcome take_varying(std::int64_t steps) {
    for (; steps > 0; --steps) {
      if (!density_->is_usable()) return Outcome::not_converged;
      const Real h = density_->length();
      std::int64_t taken = 0;
      const Outcome outcome = advance_in_registers(1, h, taken, method_, z_, probe_);
      if (outcome != Outcome::done) return outcome;
      clock_.advance(1);
      density_->advance(h, this->monitored_rate());
    }
    return Outcome::done;
  }

 protected:
  [[gnu::cold]] Outcome show_after(const Real& part, const Real& t, Frame& frame) const override {
    if (z_.arithmetic.lost()) return Outcome::lattice_overflow;
    M method = method_;
    method.invalidate();  // its memory belongs to steps of length h
    PhasePoint<A, n> z = z_;
    Probe probe = probe_;
    std::int64_t taken = 0;
    const Outcome outcome = advance_in_registers(1, part, taken, method, z, probe);
    if constexpr (MayHaveClock<P>) {
      if (has_clock(problem_)) set_clock(z, TimeWords<Real>{t, Real(0)});
    }
    if (outcome == Outcome::done) this->show(z, t, frame);
    return outcome;
  }

  /// Works on local copies, which the compiler can keep in registers, and writes them back at the end. A failure is
  /// detected cheaply afterwards; the steps up to the last good one are then repeated from the unchanged originals.
  /// @param h the step of the clock, or of a partial step
  [[gnu::noinline]] Outcome advance_in_registers(std::int64_t steps, const Real& h, std::int64_t& taken, M& method_out,
                                                 PhasePoint<A, n>& z_out, Probe& probe_out) const {
    M method = method_out;
    PhasePoint<A, n> z = z_out;
    Probe probe = probe_out;
    const P problem = problem_;
    const Real step_length = h;
    for (std::int64_t i = 0; i < steps; ++i) {
      const Outcome outcome = method.step(problem, step_length, z);
      if (outcome != Outcome::done) [[unlikely]]
        return retrace(i, outcome, h, taken, method_out, z_out, probe_out);
      if (z.arithmetic.lost()) [[unlikely]]
        return retrace(i, Outcome::lattice_overflow, h, taken, method_out, z_out, probe_out);
      if (!probe.look(problem, z.positions(), z.momenta(), this->time_after(i + 1, h))) [[unlikely]] {
        return retrace(i, Outcome::non_finite, h, taken, method_out, z_out, probe_out);
      }
      if constexpr (MayHaveClock<P>) {  // after the probe, which needs the time of the last force
        if (has_clock(problem)) {
          this->set_clock_after(i + 1, h, z);
          set_method_time(method, z);
        }
      }
    }
    if (!is_finite(problem, z)) {  // without a probe this has not been checked yet
      return one_by_one(steps, h, taken, method_out, z_out, probe_out);
    }
    method_out = method;
    z_out = z;
    probe_out = probe;
    taken += steps;
    return Outcome::done;
  }

 private:
  /// Takes single steps from the originals up to the one that is not finite. It is cold, so that the compiler does not
  /// make a second copy of advance_in_registers for single steps.
  [[gnu::cold, gnu::noinline]] Outcome one_by_one(std::int64_t steps, const Real& h, std::int64_t& taken, M& method,
                                                  PhasePoint<A, n>& z, Probe& probe) const {
    for (std::int64_t i = 0; steps > 1 && i < steps; ++i) {
      const Outcome outcome = advance_in_registers(1, h, taken, method, z, probe);
      if (outcome != Outcome::done) return outcome;
    }
    return Outcome::non_finite;
  }
  /// Takes `good` steps from the originals, which are known to succeed, and reports why the next one fails.
  [[gnu::cold]] Outcome retrace(std::int64_t good, Outcome why, const Real& h, std::int64_t& taken, M& method,
                                PhasePoint<A, n>& z, Probe& probe) const {
    if (good > 0) {
      const Outcome again = advance_in_registers(good, h, taken, method, z, probe);
      if (again != Outcome::done) return again;
    }
    return why;
  }

 protected:
  /// It is here and not in the base class, where several methods would share it, because arguments passed by reference
  /// cannot stay in registers.
  static bool is_finite(const P& problem, const PhasePoint<A, n>& z) {
    const auto q = z.positions();
    const auto p = z.momenta();
    bool finite = abs(hamflow::energy(problem, q, p)) <= std::numeric_limits<Real>::max();
    for (std::size_t i = 0; i < q.size(); ++i) {
      finite = finite && abs(q[i]) <= std::numeric_limits<Real>::max() && abs(p[i]) <= std::numeric_limits<Real>::max();
    }
    return finite;
  }
};

template <class P, class M>
using DefaultArithmetic = std::conditional_t<always_compensated<M>(), Compensated<RealOf<P>>, Plain<RealOf<P>>>;

/// A simulation with a typed method, all of which is inlined into one loop.
///     auto orbit = hamflow::simulate(problem, Composition<compositions::stv4>{}, {0.4, 0}, {0, 2}, 0.1);
/// @param q, p canonical start   @param h step size
/// @tparam Watch false removes the probe of energy and invariants at every step
template <bool Watch = true, class P, MethodRecipe Method, class A = DefaultArithmetic<P, Method>>
auto simulate(const P& problem, const Method& recipe, const Vector<typename A::Real, P::dimension>& q,
              const Vector<typename A::Real, P::dimension>& p, typename A::Real h, A arithmetic = {}) {
  using M = typename Method::template Stepper<P, A>;
  using Probe = std::conditional_t<Watch, ConservationProbe<P, typename A::Real>, NoProbe>;
  return SimulationOf<P, M, A, Probe>(problem, recipe.template bind<P, A>(problem), q, p, h, arithmetic);
}

/// As above, with a start in braces. Its numbers are counted at compile time; a vector would be filled up with zeros.
template <bool Watch = true, class P, MethodRecipe Method, std::size_t of_q, std::size_t of_p,
          class A = DefaultArithmetic<P, Method>>
requires(P::dimension != dynamic) auto simulate(const P& problem, const Method& recipe,
                                                const typename A::Real (&q)[of_q], const typename A::Real (&p)[of_p],
                                                typename A::Real h, A arithmetic = {}) {
  static_assert(of_q == P::dimension && of_p == P::dimension,
                "hamflow: a start needs as many coordinates and as many momenta as the problem has degrees of freedom");
  Vector<typename A::Real, P::dimension> at_q{};
  Vector<typename A::Real, P::dimension> at_p{};
  std::copy(q, q + of_q, at_q.begin());
  std::copy(p, p + of_p, at_p.begin());
  return simulate<Watch>(problem, recipe, at_q, at_p, h, arithmetic);
}

}  // namespace hamflow
