// The part of a simulation that does not depend on its method: problem, state, clock and probe. It is compiled once for
// each problem, arithmetic and probe, and not for each method.
#pragma once

#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "hamflow/core/number.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/core/archive.hpp"
#include "hamflow/detail/core/step_clock.hpp"
#include "hamflow/detail/methods/step_density.hpp"
#include "hamflow/detail/run/probe.hpp"
#include "hamflow/detail/run/steps_in_parts.hpp"
#include "hamflow/run/simulation.hpp"

namespace hamflow {

namespace detail {
// The messages of save and restore, compiled once and not in every simulation.
inline std::string arithmetic_kind(std::string_view name, int digits) {
  return std::string(name) + " in " + std::to_string(digits) + " bits";
}
[[gnu::noinline]] inline void expect_same_kind(const std::string& found, const std::string& wanted) {
  if (found != wanted) throw Error("the saved state belongs to " + found + ", not to " + wanted);
}
[[gnu::noinline]] inline void expect_same_size(std::size_t found, std::size_t wanted) {
  if (found != wanted) {
    throw Error("the saved state has " + std::to_string(found) + " degrees of freedom, not " + std::to_string(wanted));
  }
}
[[gnu::noinline]] inline void expect_same_step(bool same) {
  if (!same) throw Error("the saved state belongs to another step size");
}
}  // namespace detail

template <class P, Arithmetic A, class Probe>
class SimulationState : public Simulation, public StepsInParts<typename A::Real> {
 public:
  using Real = typename A::Real;
  static constexpr std::size_t n = P::dimension;
  using Monitor = StepMonitor<Real, n>;

  std::int64_t step() const final { return clock_.steps_taken(); }
  const PhasePoint<A, n>& state() const { return z_; }
  const P& problem() const { return problem_; }

  void look(Frame& frame) const final { show(z_, time(), frame); }
  [[gnu::cold]] Outcome look_ahead(const std::string& time, Frame& frame) const final {
    const Real t = evaluate_number<Real>(time);
    const Real part = t - SimulationState::time();
    if (abs(part) <= 4 * std::numeric_limits<Real>::epsilon() * abs(t)) {  // t_n is a rounded product
      look(frame);
      return Outcome::done;
    }
    return show_after(part, t, frame);
  }
  [[gnu::cold]] Outcome look_part(double theta, Frame& frame) const final {
    if (theta == 0) {
      look(frame);
      return Outcome::done;
    }
    const Real part = Real(theta) * next_length();
    return show_after(part, time() + part, frame);
  }

  std::vector<std::byte> bits() const final {
    Writer ar;
    for (std::size_t i = 0; i < z_.q.size() - clocks_of(problem_); ++i)
      ar(z_.q[i]);  // clocks are not part of the motion
    for (std::size_t i = 0; i < z_.p.size(); ++i) ar(z_.p[i]);
    return ar.take();
  }

  Real length_of_step() const final { return next_length(); }
  Real present_time() const final { return time(); }
  [[gnu::cold]] Vector<Real, dynamic> present_positions() const final { return values(z_.positions()); }
  [[gnu::cold]] Vector<Real, dynamic> present_momenta() const final { return values(z_.momenta()); }
  [[gnu::cold]] void negate_momentum(std::size_t i) override { z_.p[i] = A::Axis::negated(z_.p[i]); }
  [[gnu::cold]] void push_momentum(std::size_t i, const Real& change) override {
    z_.arithmetic.momentum.add(z_.p[i], change);
  }
  [[gnu::cold]] void mirror_position(std::size_t i, const Real& twice_the_wall) final {
    z_.q[i] = A::Axis::negated(z_.q[i]);
    z_.arithmetic.position.add(z_.q[i], twice_the_wall);
  }
  [[gnu::cold]] Outcome complete_step() override {
    if (!probe_.look(problem_, z_.positions(), z_.momenta(), time_after(1, next_length()))) return Outcome::non_finite;
    if constexpr (MayHaveClock<P>) {
      if (has_clock(problem_)) set_clock_after(1, next_length(), z_);
    }
    clock_.advance(1);
    return Outcome::done;
  }
  void show_at(const Real& time, Frame& frame) const final { show(z_, time, frame); }

  Excursion energy() const final {
    const Real now = hamflow::energy(problem_, z_.positions(), z_.momenta());
    Excursion e{static_cast<double>(initial_energy_), static_cast<double>(now), 0};
    if constexpr (requires { probe_.worst_energy_error(); })
      e.max_error = static_cast<double>(probe_.worst_energy_error());
    e.scale_at_start = static_cast<double>(scale_);
    if constexpr (requires { probe_.exchanged_energy(); }) e.exchanged = static_cast<double>(probe_.exchanged_energy());
    return e;
  }
  void restart_energy_range() final {
    if constexpr (requires { probe_.least_difference(); }) {
      probe_.restart_range(Real(hamflow::energy(problem_, z_.positions(), z_.momenta()) - initial_energy_));
    }
  }
  std::vector<InvariantExcursion> invariants() const final {
    std::vector<InvariantExcursion> all;
    if constexpr (HasInvariants<P, Real> && requires { probe_.worst(0); }) {
      const auto now = problem_.invariants(z_.positions(), z_.momenta(), time());
      std::size_t i = 0;
      std::size_t left = detail::invariant_sizes(problem_).size() - residual_groups();
      for (const std::size_t size : detail::invariant_sizes(problem_)) {
        if (left-- == 0) break;
        InvariantExcursion e{{}, {}, static_cast<double>(probe_.worst(all.size()))};
        for (const std::size_t end = i + size; i < end; ++i) {
          e.initial.push_back(static_cast<double>(probe_.initial()[i]));
          e.final.push_back(static_cast<double>(now[i]));
          if constexpr (requires(const Real& x) { written_digits(x); }) {
            e.initial_digits.push_back(written_digits(probe_.initial()[i]));
            e.final_digits.push_back(written_digits(now[i]));
          }
        }
        if constexpr (requires(const Real& x) { written_digits(x); }) {
          e.max_error_digits = written_digits(probe_.worst(all.size()));
        }
        all.push_back(e);
      }
    }
    return all;
  }
  std::optional<ConstraintResiduals> constraints() const final {
    if constexpr (requires { probe_.worst(0); }) {
      if (residual_groups() == 2) {
        const std::size_t k = detail::invariant_sizes(problem_).size();
        return ConstraintResiduals{static_cast<double>(probe_.worst(k - 2)), static_cast<double>(probe_.worst(k - 1))};
      }
    }
    return {};
  }

 protected:
  SimulationState(P problem, const Vector<Real, n>& q, const Vector<Real, n>& p, Real h, A arithmetic, Real t0)
      : problem_(std::move(problem)), clock_(t0, h) {
    z_.arithmetic = arithmetic;
    z_.store(q, p);
    if constexpr (MayHaveClock<P>) {
      if (has_clock(problem_)) begin_clock(q, p);
    }
    const auto stored_q = z_.positions();
    const auto stored_p = z_.momenta();
    probe_.start(problem_, stored_q, stored_p, t0);
    initial_energy_ = hamflow::energy(problem_, stored_q, stored_p);
    scale_ = abs(initial_energy_);
    if constexpr (Separable<P>) {
      scale_ = larger(scale_, Real(abs(problem_.kinetic(stored_p)) + abs(problem_.potential(stored_q))));
    } else if constexpr (requires { problem_.size_of_parts(stored_q, stored_p); }) {
      scale_ = larger(scale_, problem_.size_of_parts(stored_q, stored_p));
    }
  }

  std::size_t residual_groups() const {
    if constexpr (requires { problem_.residual_groups(); }) {
      return problem_.residual_groups();
    } else {
      return 0;
    }
  }
  /// Removes the residuals of constraints, which come after the invariants.
  void drop_residuals([[maybe_unused]] std::vector<double>& invariants) const {
    if constexpr (requires { problem_.residual_groups(); }) {
      const std::vector<std::size_t>& sizes = problem_.invariant_sizes();
      for (std::size_t k = 0; k < problem_.residual_groups(); ++k) {
        invariants.resize(invariants.size() - sizes[sizes.size() - 1 - k]);
      }
    }
  }
  bool varies_steps() const { return density_.has_value(); }
  const Monitor& monitor() const { return *monitor_; }
  /// Equal steps are counted; lengths of varying steps are summed.
  Real time() const { return density_ ? density_->time() : clock_.time(); }
  Real next_length() const { return density_ ? density_->length() : clock_.step_length(); }
  /// The time after the given number of further steps, or after one step of length h if steps vary.
  Real time_after(std::int64_t steps, const Real& h) const {
    return density_ ? Real(density_->time() + h) : clock_.time_after(steps);
  }
  /// Sets the coordinates that hold the time to their values after the given number of further steps, or after one step
  /// of length h if steps vary. On the lattice `span` is the exact increment of a step; times of varying steps are
  /// summed by the method there, so that they can be reversed exactly.
  void set_clock_after(std::int64_t steps, const Real& h, PhasePoint<A, n>& z) const {
    if (density_) {
      if constexpr (!A::exact_undo) set_clock(z, density_->time_in_words_after(h));
    } else if constexpr (A::exact_undo) {
      set_clock(z, clock_.begin_after(steps));
      if (clock_.direction() < 0) z.arithmetic.position.add_units(z.q[z.q.size() - 2], span_of_clock_);
    } else {
      set_clock(z, clock_.begin_after(steps), clock_.passed());
    }
  }
  /// A start without the coordinates that hold the time begins at the time of the clock; otherwise at the given time.
  [[gnu::cold]] void begin_clock(const Vector<Real, n>& q, const Vector<Real, n>& p) {
    const auto whole = [&](const Vector<Real, n>& x) {
      Vector<Real, n> all = zeros<Real, n>(problem_.size());
      for (std::size_t i = 0; i < x.size() && i < all.size(); ++i) all[i] = x[i];
      return all;
    };
    const Vector<Real, n> all_q = whole(q);
    z_.store(all_q, whole(p));
    Real start = clock_.start();
    for (std::size_t i = 1; i <= clock_coordinates; ++i) start += all_q[all_q.size() - i];
    clock_ = StepClock<Real>(start, clock_.step());
    set_clock_after(0, clock_.step(), z_);
  }
  [[gnu::cold]] void begin_varying(Monitor monitor) {
    monitor_ = std::make_shared<const Monitor>(std::move(monitor));
    density_.emplace(clock_.step_length(), clock_.time());
  }
  Real monitored_rate() const { return monitor_->rate(z_.positions(), z_.momenta()); }
  /// Why there is no next step; empty if there is one.
  [[gnu::cold]] std::string unusable_density() const {
    if (!density_ || density_->is_usable()) return {};
    return "the density of steps became " + shortest(static_cast<double>(density_->density())) +
           ": the step size that the monitor gives changes too much within one step";
  }

  [[gnu::cold]] static Vector<Real, dynamic> values(const auto& x) {
    Vector<Real, dynamic> all(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) all[i] = x[i];
    return all;
  }
  /// Fills `frame` with the state after one step of length `part`, at time t.
  virtual Outcome show_after(const Real& part, const Real& t, Frame& frame) const = 0;

  void show(const PhasePoint<A, n>& z, const Real& time, Frame& frame) const {
    show(z, time, hamflow::energy(problem_, z.positions(), z.momenta()), frame);
  }
  /// @param now the energy of z
  [[gnu::noinline]] void show(const PhasePoint<A, n>& z, const Real& time, const Real& now, Frame& frame) const {
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
    frame.energy = static_cast<double>(now);
    if constexpr (requires { probe_.least_difference(); }) {
      const Real difference = now - initial_energy_;
      frame.energy_range = {0.0 - static_cast<double>(larger(Real(-probe_.least_difference()), Real(-difference))),
                            static_cast<double>(larger(probe_.largest_difference(), difference))};
    }
    frame.invariants.clear();
    if constexpr (HasInvariants<P, Real>) {
      for (const Real& value : problem_.invariants(q, p, time)) frame.invariants.push_back(static_cast<double>(value));
      drop_residuals(frame.invariants);
    }
    frame.effort = effort();
    frame.diagnostics = diagnostics();
    if constexpr (requires(const Real& x) { written_digits(x); }) {
      frame.digits.time = written_digits(time);
      frame.digits.energy = written_digits(now);
      frame.digits.initial_energy = written_digits(initial_energy_);
      frame.digits.q.clear();
      frame.digits.p.clear();
      for (std::size_t i = 0; i < q.size(); ++i) {
        frame.digits.q.push_back(written_digits(q[i]));
        frame.digits.p.push_back(written_digits(p[i]));
      }
    }
  }

  /// The kind of state that can be restored here: version of the format, problem, method and arithmetic.
  [[gnu::cold]] std::string kind() const {
    const std::string arithmetic = detail::arithmetic_kind(A::name, std::numeric_limits<Real>::digits);
    const std::string rest = ", " + method().name + ", " + arithmetic;
    if constexpr (requires { problem_.label(); }) {
      return problem_.label() + rest;
    } else {
      return detail::problem_label<P>() + rest;
    }
  }

  [[gnu::cold]] void save_state(Writer& ar) const {
    ar(kind());
    ar(z_, clock_, probe_, initial_energy_, scale_);
    if (density_) ar(*density_);
  }
  /// The saved state except the method. It is read completely before anything changes.
  struct Saved {
    PhasePoint<A, n> z;
    StepClock<Real> clock;
    Probe probe;
    Real initial_energy;
    Real scale;
    std::optional<StepDensity<A>> density;
  };
  [[gnu::cold]] Saved read_state(Reader& ar) const {
    std::string of;
    ar(of);
    detail::expect_same_kind(of, kind());
    Saved saved{z_, clock_, probe_, initial_energy_, scale_, density_};
    ar(saved.z, saved.clock, saved.probe, saved.initial_energy, saved.scale);
    if (saved.density) ar(*saved.density);
    return saved;
  }
  [[gnu::cold]] void expect_same(const Saved& saved) const {
    detail::expect_same_size(saved.z.q.size(), z_.q.size());
    detail::expect_same_size(saved.z.p.size(), z_.p.size());
    detail::expect_same_step(saved.clock.step() == clock_.step());
  }
  [[gnu::cold]] void take(Saved&& saved) {
    z_ = std::move(saved.z);
    probe_ = std::move(saved.probe);
    clock_ = saved.clock;
    initial_energy_ = saved.initial_energy;
    scale_ = saved.scale;
    density_ = std::move(saved.density);
  }

  P problem_;
  PhasePoint<A, n> z_;
  Probe probe_;
  StepClock<Real> clock_;
  Real initial_energy_{};
  Real scale_{};
  typename A::Stored span_of_clock_{};     // on the lattice, while the time runs backwards
  std::optional<StepDensity<A>> density_;  // for reversible steps of varying size
  std::shared_ptr<const Monitor> monitor_;
};

}  // namespace hamflow
