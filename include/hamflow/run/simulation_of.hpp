// The typed simulation behind the type-erased one: a problem, a method bound to it, an arithmetic and a probe.
#pragma once

#include <cstring>
#include <limits>

#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/core/step_clock.hpp"
#include "hamflow/run/probe.hpp"
#include "hamflow/run/simulation.hpp"

namespace hamflow {

/// **Method**: one step of a map, and claims about it.
template <class M, class P, class A>
concept Method = Problem<P> && Arithmetic<A> &&
    requires(M& method, const P& problem, typename A::Real h, PhasePoint<A, P::dimension>& z) {
  { method.step(problem, h, z) } -> std::same_as<Outcome>;  // no allocation, no IO, no bookkeeping of time
  { method.info() } -> std::same_as<MethodInfo>;
  { method.effort() } -> std::same_as<Effort>;
  method.invalidate();  // the state was changed from outside
};

template <class P, class M, Arithmetic A, class Probe = ConservationProbe<P, typename A::Real>>
class SimulationOf final : public Simulation {
 public:
  static_assert(Method<M, P, A>, "hamflow: this type is no Method for this problem and arithmetic");
  using Real = typename A::Real;
  static constexpr std::size_t n = P::dimension;

  /// @param start canonical (q, p)   @param h step length   @param arithmetic e.g. lattice units
  SimulationOf(P problem, M method, const Vector<Real, n>& q, const Vector<Real, n>& p, Real h, A arithmetic = {},
               Real t0 = 0)
      : problem_(std::move(problem)), method_(std::move(method)), clock_(t0, h) {
    z_.arithmetic = arithmetic;
    z_.store(q, p);
    const auto stored_q = z_.positions();
    const auto stored_p = z_.momenta();
    probe_.start(problem_, stored_q, stored_p, t0);
    initial_energy_ = hamflow::energy(problem_, stored_q, stored_p);
    scale_ = abs(initial_energy_);
    if constexpr (Separable<P>) {
      scale_ = larger(scale_, Real(abs(problem_.kinetic(stored_p)) + abs(problem_.potential(stored_q))));
    }
  }

  Outcome advance(std::int64_t steps) override {
    if (z_.arithmetic.lost()) return Outcome::lattice_overflow;
    std::int64_t taken = 0;
    const Outcome outcome = march(steps, taken, method_, z_, probe_);
    clock_.advance(taken);
    return outcome;
  }

  std::int64_t step() const override { return clock_.steps_taken(); }
  const PhasePoint<A, n>& state() const { return z_; }
  const P& problem() const { return problem_; }

  void look(Frame& frame) const override {
    const auto q = z_.positions();
    const auto p = z_.momenta();
    frame.step = clock_.steps_taken();
    frame.time = static_cast<double>(clock_.time());
    frame.q.assign(q.size(), 0);
    frame.p.assign(p.size(), 0);
    for (std::size_t i = 0; i < q.size(); ++i) {
      frame.q[i] = static_cast<double>(q[i]);
      frame.p[i] = static_cast<double>(p[i]);
    }
    frame.energy = static_cast<double>(hamflow::energy(problem_, q, p));
    frame.invariants.clear();
    if constexpr (detail::HasInvariants<P, Real>) {
      for (const Real& value : detail::invariants_of(problem_, q, p, clock_.time()))
        frame.invariants.push_back(static_cast<double>(value));
    }
    frame.effort = method_.effort();
    frame.diagnostics = diagnostics();
  }

  void reverse_time() override {
    clock_.reverse();
    method_.invalidate();
  }
  void negate_momenta() override {
    z_.negate_momenta();
    method_.invalidate();
  }
  std::vector<std::byte> bits() const override {
    using Stored = typename A::Stored;
    const std::size_t size = z_.q.size();
    std::vector<std::byte> all(2 * size * sizeof(Stored));
    for (std::size_t i = 0; i < size; ++i) {
      std::memcpy(all.data() + i * sizeof(Stored), &z_.q[i], sizeof(Stored));
      std::memcpy(all.data() + (size + i) * sizeof(Stored), &z_.p[i], sizeof(Stored));
    }
    return all;
  }

  Excursion energy() const override {
    const Real now = hamflow::energy(problem_, z_.positions(), z_.momenta());
    Excursion e{static_cast<double>(initial_energy_), static_cast<double>(now), 0};
    if constexpr (requires { probe_.worst_energy_error(); })
      e.max_error = static_cast<double>(probe_.worst_energy_error());
    return e;
  }
  double energy_scale() const override { return static_cast<double>(scale_); }
  std::vector<InvariantExcursion> invariants() const override {
    std::vector<InvariantExcursion> all;
    if constexpr (detail::HasInvariants<P, Real> && requires { probe_.worst(0); }) {
      const auto now = detail::invariants_of(problem_, z_.positions(), z_.momenta(), clock_.time());
      std::size_t i = 0;
      for (const std::size_t size : detail::invariant_sizes(problem_, now.size())) {
        InvariantExcursion e{{}, {}, static_cast<double>(probe_.worst(all.size()))};
        for (const std::size_t end = i + size; i < end; ++i) {
          e.initial.push_back(static_cast<double>(probe_.initial()[i]));
          e.final.push_back(static_cast<double>(now[i]));
        }
        all.push_back(e);
      }
    }
    return all;
  }
  StepDiagnostics diagnostics() const override {
    if constexpr (requires { method_.diagnostics(problem_, z_); }) {
      return method_.diagnostics(problem_, z_);
    } else {
      return {};
    }
  }
  Effort effort() const override { return method_.effort(); }
  MethodInfo method() const override { return method_.info(); }
  std::string failure() const override {
    if constexpr (requires { method_.failure(problem_, clock_.step_length(), z_); }) {
      return method_.failure(problem_, clock_.step_length(), z_);
    } else {
      return {};
    }
  }

 private:
  /// Works on local copies, which the compiler can keep in registers, and writes them back at the end. Trouble is found
  /// cheaply, after the fact; the way to the last good step is then walked again from the unchanged originals.
  Outcome march(std::int64_t steps, std::int64_t& taken, M& method_out, PhasePoint<A, n>& z_out,
                Probe& probe_out) const {
    M method = method_out;
    PhasePoint<A, n> z = z_out;
    Probe probe = probe_out;
    const P problem = problem_;
    const Real h = clock_.step_length();
    for (std::int64_t i = 0; i < steps; ++i) {
      const Outcome outcome = method.step(problem, h, z);
      if (outcome != Outcome::done) [[unlikely]]
        return retrace(i, outcome, taken, method_out, z_out, probe_out);
      if (z.arithmetic.lost()) [[unlikely]]
        return retrace(i, Outcome::lattice_overflow, taken, method_out, z_out, probe_out);
      if (!probe.look(problem, z.positions(), z.momenta(), clock_.time_after(i + 1))) [[unlikely]] {
        return retrace(i, Outcome::non_finite, taken, method_out, z_out, probe_out);
      }
    }
    if (!is_finite(problem, z)) {  // without a probe nobody has looked yet
      if (steps == 1) return Outcome::non_finite;
      for (std::int64_t i = 0; i < steps; ++i) {
        const Outcome outcome = march(1, taken, method_out, z_out, probe_out);
        if (outcome != Outcome::done) return outcome;
      }
    }
    method_out = method;
    z_out = z;
    probe_out = probe;
    taken += steps;
    return Outcome::done;
  }

  /// Takes `good` steps from the originals, which are known to succeed, and reports why the next one did not.
  Outcome retrace(std::int64_t good, Outcome why, std::int64_t& taken, M& method, PhasePoint<A, n>& z,
                  Probe& probe) const {
    if (good > 0) {
      const Outcome again = march(good, taken, method, z, probe);
      if (again != Outcome::done) return again;
    }
    return why;
  }

  static bool is_finite(const P& problem, const PhasePoint<A, n>& z) {
    const auto q = z.positions();
    const auto p = z.momenta();
    bool finite = abs(hamflow::energy(problem, q, p)) <= std::numeric_limits<Real>::max();
    for (std::size_t i = 0; i < q.size(); ++i) {
      finite = finite && abs(q[i]) <= std::numeric_limits<Real>::max() && abs(p[i]) <= std::numeric_limits<Real>::max();
    }
    return finite;
  }

  P problem_;
  M method_;
  PhasePoint<A, n> z_;
  Probe probe_;
  StepClock<Real> clock_;
  Real initial_energy_{};
  Real scale_{};
};

/// Methods that conserve the energy add their increments with compensation in every arithmetic; the others compute in the
/// plain type of the problem unless asked.
template <class Recipe>
constexpr bool always_compensated() {
  if constexpr (requires { Recipe::compensated; }) {
    return Recipe::compensated;
  } else {
    return Recipe::implicit;
  }
}
template <class P, class Recipe>
using DefaultArithmetic = std::conditional_t<always_compensated<Recipe>(), Compensated<RealOf<P>>, Plain<RealOf<P>>>;

/// A simulation whose method is a type: everything is inlined into one loop.
///     auto orbit = hamflow::simulate(problem, Composition<compositions::stv4>{}, {0.4, 0}, {0, 2}, 0.1);
/// @param q, p canonical start   @param h step length
/// @tparam Watch false drops the probe that looks at energy and invariants in every step
template <bool Watch = true, class P, class Recipe, class A = DefaultArithmetic<P, Recipe>>
auto simulate(const P& problem, const Recipe& recipe, const Vector<typename A::Real, P::dimension>& q,
              const Vector<typename A::Real, P::dimension>& p, typename A::Real h, A arithmetic = {}) {
  using M = typename Recipe::template Stepper<P, A>;
  using Probe = std::conditional_t<Watch, ConservationProbe<P, typename A::Real>, NoProbe>;
  return SimulationOf<P, M, A, Probe>(problem, recipe.template bind<P, A>(problem), q, p, h, arithmetic);
}

}  // namespace hamflow
