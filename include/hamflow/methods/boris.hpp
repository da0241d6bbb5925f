// The Boris step for a charge in a uniform magnetic field: half a flight, a rotation of the velocity about the field,
// half a flight.   [Boris 1970; Birdsall and Langdon 1985, Sect. 4-4]
//     x <- x + h v/2,   v <- rotated by v' = v + v x t, v <- v + v' x s, t = (h/2) omega, s = 2 t/(1 + t^2),   x <- x + h v/2
// omega = charge field/mass. |v|, hence the energy, is conserved to rounding. In general the map preserves
// volume and is not symplectic [Qin et al. 2013]; in a uniform field, the only one here, it is symplectic, as measured.
// Order 2, symmetric. Reversing the canonical momenta does not bring it back, and neither the motion itself: the field would have
// to be reversed too [Sonnleitner2010, footnote 21].
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"

namespace hamflow {

template <class P, Arithmetic A>
class BorisStep {
 public:
  static_assert(ChargeInField<P>, "hamflow: boris needs a ChargeInField problem: a charge in a uniform field");
  static_assert(!A::exact_undo, "hamflow: the lattice needs an explicit splitting method: boris rotates velocities");
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = base_scalar<Real>;

  static MethodInfo describe() {
    return {.name = "boris",
            .summary = "Boris push: half a flight, a rotation about the magnetic field, half a flight",
            .reference = "Boris 1970",
            .order = 2,
            .symplectic = true,
            .symmetric = true,
            .energy_conserving = Conservation::yes};
  }
  MethodInfo info() const { return describe(); }

  Outcome step(const P& problem, const Base& h, PhasePoint<A, n>& z) {
    const Vector<Real, n> x0 = z.positions();
    const Vector<Real, n> p0 = z.momenta();
    Vector<Real, n> v{};
    problem.velocity_of(x0, p0, v);
    if (h != prepared_for_) prepare(problem, h);
    const Vector<Real, n> turn = cross(v, tangent_);
    Vector<Real, n> half = v;
    for (std::size_t i = 0; i < n; ++i) half[i] += turn[i];
    Vector<Real, n> change = cross(half, tangent_);
    for (std::size_t i = 0; i < n; ++i) change[i] = change[i] * factor_ + change[i] * factor_rest_;
    Vector<Real, n> move{};
    for (std::size_t i = 0; i < n; ++i) move[i] = v[i] + Real(0.5) * change[i];
    z.move(h, move);
    // p = m v + A(x), A linear: both increments are formed before they are added.
    for (std::size_t i = 0; i < n; ++i) move[i] = h * move[i];
    Vector<Real, n> push{};
    problem.momentum_of(move, change, push);
    z.push(Base(1), push);
    ++steps_;
    return Outcome::done;
  }

  void invalidate() {}
  Effort effort() const { return {.gradient = steps_}; }

 private:
  /// t = (h/2) omega and 2/(1 + t^2). The rounding delta of that factor would be the same in every step and change |v|^2
  /// by delta |s x v'|^2 each time, a drift: it is kept to twice the digits.
  void prepare(const P& problem, const Base& h) {
    const auto omega = problem.rotation();
    long double square = 0;
    for (std::size_t i = 0; i < n; ++i) {
      tangent_[i] = (h / Base(2)) * omega[i];
      square += static_cast<long double>(tangent_[i]) * static_cast<long double>(tangent_[i]);
    }
    const long double factor = 2 / (1 + square);
    factor_ = static_cast<Base>(factor);
    factor_rest_ = static_cast<Base>(factor - static_cast<long double>(factor_));
    prepared_for_ = h;
  }
  static Vector<Real, n> cross(const Vector<Real, n>& a, const Vector<Base, n>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  Vector<Base, n> tangent_{};
  Base factor_{};
  Base factor_rest_{};
  Base prepared_for_{};
  long long steps_ = 0;
};

/// The recipe of boris.
struct Boris {
  static constexpr bool implicit = false;
  static constexpr bool compensated = true;  // the velocity is a difference of p and A(q): their rounding would add up
  static constexpr bool bijective = false;
  template <class P>
  static constexpr bool accepts = ChargeInField<P>;
  template <class P, class A>
  using Stepper = BorisStep<P, A>;
  template <class P, class A>
  Stepper<P, A> bind(const P&) const {
    return {};
  }
};

}  // namespace hamflow
