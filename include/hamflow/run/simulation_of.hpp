// The typed simulation behind the type-erased one: a problem, a method bound to it, an arithmetic and a probe.
#pragma once

#include <cstring>
#include <limits>
#include <utility>

#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/core/archive.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/core/step_clock.hpp"
#include "hamflow/methods/recipe.hpp"
#include "hamflow/run/probe.hpp"
#include "hamflow/run/simulation.hpp"

namespace hamflow {

namespace detail {
// The messages of saving and restoring, compiled once and not in every simulation.
inline std::string arithmetic_kind(std::string_view name, int digits) {
  return std::string(name) + " in " + std::to_string(digits) + " bits";
}
inline std::string kind_of(const std::string& problem, const std::vector<std::pair<std::string, std::string>>& variant,
                           const std::string& method, const std::string& arithmetic) {
  std::string text = problem;
  for (const auto& [key, value] : variant) text += " " + key + " = " + value;
  return text + ", " + method + ", " + arithmetic;
}
[[gnu::noinline]] inline void expect_same_kind(const std::string& found, const std::string& wanted) {
  if (found != wanted) throw Error("the saved state is that of " + found + ", not of " + wanted);
}
[[gnu::noinline]] inline void expect_same_size(std::size_t found, std::size_t wanted) {
  if (found != wanted) {
    throw Error("the saved state has " + std::to_string(found) + " degrees of freedom, not " + std::to_string(wanted));
  }
}
[[gnu::noinline]] inline void expect_same_step(bool same) {
  if (!same) throw Error("the saved state was reached with another step length");
}
}  // namespace detail

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
  static_assert(Method<M, P, A>, "hamflow: this type is not a Method for this problem and arithmetic");
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
    const Outcome outcome = march(steps, clock_.step_length(), taken, method_, z_, probe_);
    clock_.advance(taken);
    return outcome;
  }

  std::int64_t step() const override { return clock_.steps_taken(); }
  const PhasePoint<A, n>& state() const { return z_; }
  const P& problem() const { return problem_; }

  void look(Frame& frame) const override { show(z_, clock_.time(), frame); }
  [[gnu::cold]] Outcome look_ahead(const std::string& time, Frame& frame) const override {
    const Real t = evaluate_number<Real>(time);
    const Real part = t - clock_.time();
    if (abs(part) <= 4 * std::numeric_limits<Real>::epsilon() * abs(t)) {  // t_n itself is a rounded product
      look(frame);
      return Outcome::done;
    }
    return show_after(part, t, frame);
  }
  [[gnu::cold]] Outcome look_part(double theta, Frame& frame) const override {
    if (theta == 0) {
      look(frame);
      return Outcome::done;
    }
    const Real part = Real(theta) * clock_.step_length();
    return show_after(part, clock_.time() + part, frame);
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
    Writer ar;
    for (std::size_t i = 0; i < z_.q.size(); ++i) ar(z_.q[i]);
    for (std::size_t i = 0; i < z_.p.size(); ++i) ar(z_.p[i]);
    return ar.take();
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
    if constexpr (HasInvariants<P, Real> && requires { probe_.worst(0); }) {
      const auto now = problem_.invariants(z_.positions(), z_.momenta(), clock_.time());
      std::size_t i = 0;
      for (const std::size_t size : detail::invariant_sizes(problem_)) {
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

  [[gnu::cold]] std::vector<std::byte> save() const override {
    Writer ar;
    ar(kind());
    archive(ar, *this);
    return ar.take();
  }
  [[gnu::cold]] void restore(std::span<const std::byte> saved) override {
    Reader ar(saved);
    std::string of;
    ar(of);
    detail::expect_same_kind(of, kind());
    SimulationOf other = *this;
    archive(ar, other);
    ar.finish();
    detail::expect_same_size(other.z_.q.size(), z_.q.size());
    detail::expect_same_size(other.z_.p.size(), z_.p.size());
    detail::expect_same_step(other.clock_.step() == clock_.step());
    z_ = std::move(other.z_);
    method_ = std::move(other.method_);
    probe_ = std::move(other.probe_);
    clock_ = other.clock_;
    initial_energy_ = other.initial_energy_;
    scale_ = other.scale_;
  }
  [[gnu::cold]] std::unique_ptr<Simulation> clone() const override { return std::make_unique<SimulationOf>(*this); }

 private:
  /// What may be restored here: the format's version, problem, method and arithmetic.
  [[gnu::cold]] std::string kind() const {
    const std::string arithmetic = detail::arithmetic_kind(A::name, std::numeric_limits<Real>::digits);
    if constexpr (requires { P::info().variant; }) {
      const auto info = P::info();
      return detail::kind_of(info.name, info.variant, method_.info().name, arithmetic);
    } else {
      return detail::kind_of("a problem", {}, method_.info().name, arithmetic);
    }
  }
  /// A method without archive() has no memory.
  template <class Archive, class Self>
  [[gnu::cold]] static void archive(Archive& ar, Self& self) {
    ar(self.z_, self.clock_, self.probe_, self.initial_energy_, self.scale_);
    if constexpr (detail::HasArchive<M, Archive>) ar(self.method_);
  }

  /// The state after one step of length `part`, which is at time t.
  [[gnu::cold]] Outcome show_after(const Real& part, const Real& t, Frame& frame) const {
    if (z_.arithmetic.lost()) return Outcome::lattice_overflow;
    M method = method_;
    method.invalidate();  // what it remembers belongs to steps of length h
    PhasePoint<A, n> z = z_;
    Probe probe = probe_;
    std::int64_t taken = 0;
    const Outcome outcome = march(1, part, taken, method, z, probe);
    if (outcome == Outcome::done) show(z, t, frame);
    return outcome;
  }

  [[gnu::noinline]] void show(const PhasePoint<A, n>& z, const Real& time, Frame& frame) const {
    const auto q = z.positions();
    const auto p = z.momenta();
    frame.step = clock_.steps_taken();
    frame.time = static_cast<double>(time);
    frame.q.assign(q.size(), 0);
    frame.p.assign(p.size(), 0);
    for (std::size_t i = 0; i < q.size(); ++i) {
      frame.q[i] = static_cast<double>(q[i]);
      frame.p[i] = static_cast<double>(p[i]);
    }
    frame.energy = static_cast<double>(hamflow::energy(problem_, q, p));
    frame.invariants.clear();
    if constexpr (HasInvariants<P, Real>) {
      for (const Real& value : problem_.invariants(q, p, time)) frame.invariants.push_back(static_cast<double>(value));
    }
    frame.effort = method_.effort();
    frame.diagnostics = diagnostics();
    if constexpr (requires(const Real& x) { written_digits(x); }) {
      frame.digits.time = written_digits(time);
      frame.digits.energy = written_digits(hamflow::energy(problem_, q, p));
      frame.digits.initial_energy = written_digits(initial_energy_);
      frame.digits.q.clear();
      frame.digits.p.clear();
      for (std::size_t i = 0; i < q.size(); ++i) {
        frame.digits.q.push_back(written_digits(q[i]));
        frame.digits.p.push_back(written_digits(p[i]));
      }
    }
  }

  /// Works on local copies, which the compiler can keep in registers, and writes them back at the end. Trouble is found
  /// cheaply, after the fact; the way to the last good step is then walked again from the unchanged originals.
  /// @param h that of the clock, or of a partial step
  [[gnu::noinline]] Outcome march(std::int64_t steps, const Real& h, std::int64_t& taken, M& method_out,
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
      if (!probe.look(problem, z.positions(), z.momenta(), clock_.time_after(i + 1))) [[unlikely]] {
        return retrace(i, Outcome::non_finite, h, taken, method_out, z_out, probe_out);
      }
    }
    if (!is_finite(problem, z)) {  // without a probe nobody has looked yet
      if (steps == 1) return Outcome::non_finite;
      for (std::int64_t i = 0; i < steps; ++i) {
        const Outcome outcome = march(1, h, taken, method_out, z_out, probe_out);
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
  Outcome retrace(std::int64_t good, Outcome why, const Real& h, std::int64_t& taken, M& method, PhasePoint<A, n>& z,
                  Probe& probe) const {
    if (good > 0) {
      const Outcome again = march(good, h, taken, method, z, probe);
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

template <class P, class M>
using DefaultArithmetic = std::conditional_t<always_compensated<M>(), Compensated<RealOf<P>>, Plain<RealOf<P>>>;

/// A simulation whose method is a type: everything is inlined into one loop.
///     auto orbit = hamflow::simulate(problem, Composition<compositions::stv4>{}, {0.4, 0}, {0, 2}, 0.1);
/// @param q, p canonical start   @param h step length
/// @tparam Watch false drops the probe that looks at energy and invariants in every step
template <bool Watch = true, class P, MethodRecipe Method, class A = DefaultArithmetic<P, Method>>
auto simulate(const P& problem, const Method& recipe, const Vector<typename A::Real, P::dimension>& q,
              const Vector<typename A::Real, P::dimension>& p, typename A::Real h, A arithmetic = {}) {
  using M = typename Method::template Stepper<P, A>;
  using Probe = std::conditional_t<Watch, ConservationProbe<P, typename A::Real>, NoProbe>;
  return SimulationOf<P, M, A, Probe>(problem, recipe.template bind<P, A>(problem), q, p, h, arithmetic);
}

}  // namespace hamflow
