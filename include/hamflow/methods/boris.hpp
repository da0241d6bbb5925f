// The Boris step for a charge in a uniform magnetic field: half a drift, a rotation of the velocity about the field,
// half a drift.   [Boris1970; BirdsallLangdon1985, Sect. 4-4]
//     x <- x + h v/2,   v' = v + v x t,   v <- v + v' x s,   x <- x + h v/2,   t = (h/2) omega, s = 2 t/(1 + t^2),
// omega = charge field/mass. |v|, hence the energy, is conserved to rounding. In general the map preserves volume and
// is not symplectic [QinEtAl2013]; in a uniform field, the only case here, it is symplectic, as measured. Order 2,
// symmetric. Reversing the canonical momenta reverses neither the method nor the motion; the field must be reversed,
// too [Sonnleitner2010, footnote 21].
#pragma once

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/method_info.hpp"
#include "hamflow/core/outcome.hpp"
#include "hamflow/core/phase_point.hpp"
#include "hamflow/detail/arithmetic/number_types.hpp"
#include "hamflow/detail/core/capability.hpp"

namespace hamflow {

inline MethodInfo describe_boris() {
  return {.name = "boris",
          .summary = "Boris push: half a drift, a rotation about the magnetic field, half a drift",
          .reference = "Boris1970",
          .order = 2,
          .symplectic = true,
          .symmetric = true,
          .energy_conserving = Conservation::yes};
}

template <class P, Arithmetic A>
class BorisStep {
 public:
  static_assert(ChargeInField<P>, "hamflow: boris needs a ChargeInField problem: a charge in a uniform field");
  static_assert(!A::exact_undo, "hamflow: the lattice needs an explicit splitting method: boris rotates velocities");
  static constexpr std::size_t n = P::dimension;
  using Real = typename A::Real;
  using Base = base_scalar<Real>;

  MethodInfo info() const { return describe_boris(); }

  Outcome step(const P& problem, const Base& h, PhasePoint<A, n>& z) {
    const Vector<Real, n> x0 = z.positions();
    const Vector<Real, n> p0 = z.momenta();
    Vector<Real, n> v = zeros_like(x0);
    problem.velocity_of(x0, p0, v);
    const Vector<Real, n> change = rotated_by(problem, h, v);
    Vector<Real, n> move = zeros_like(x0);
    for (std::size_t i = 0; i < v.size(); ++i) move[i] = v[i] + Real(0.5) * change[i];
    z.move(h, move);
    // p = m v + A(x), A linear: both increments are formed before they are added.
    for (std::size_t i = 0; i < v.size(); ++i) move[i] = h * move[i];
    Vector<Real, n> push = zeros_like(x0);
    problem.momentum_of(move, change, push);
    z.push(Base(1), push);
    ++steps_;
    return Outcome::done;
  }

  void invalidate() {}
  Effort effort() const { return {.gradient = steps_}; }
  template <class Archive>
  void archive(Archive& ar) {
    ar(steps_);
  }

 private:
  /// A double is rotated in Wide and rounded once. In double some rounding errors of the rotation are the same
  /// in every step (that of 2/(1 + t^2)) and make the energy drift by 10^-3 roundings per step, as measured.
  using Fine = std::conditional_t<std::is_same_v<Real, double>, Wide, Real>;

  /// The increment of v by the rotation.
  static Vector<Real, n> rotated_by(const P& problem, const Base& h, const Vector<Real, n>& v) {
    const auto omega = problem.rotation();
    Vector<Fine, n> t = zeros<Fine, n>(v.size());
    Fine square(0);
    for (std::size_t i = 0; i < v.size(); ++i) {
      t[i] = (h / Base(2)) * omega[i];
      square += t[i] * t[i];
    }
    Vector<Fine, n> half = t;
    for (std::size_t i = 0; i < v.size(); ++i) half[i] = v[i];
    const Vector<Fine, n> turn = cross(half, t);
    for (std::size_t i = 0; i < v.size(); ++i) half[i] += turn[i];
    const Vector<Fine, n> change = cross(half, t);
    Vector<Real, n> out = zeros_like(v);
    for (std::size_t i = 0; i < v.size(); ++i) out[i] = static_cast<Real>(change[i] * (Fine(2) / (Fine(1) + square)));
    return out;
  }
  static Vector<Fine, n> cross(const Vector<Fine, n>& a, const Vector<Fine, n>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  long long steps_ = 0;
};

/// The recipe of boris.
struct Boris {
  static constexpr bool implicit = false;
  static constexpr bool compensated =
      true;  // the velocity is a difference of p and A(q), whose rounding errors would accumulate
  static constexpr bool bijective = false;
  static constexpr bool typed = true;
  static constexpr Capability capability_sets[] = {Capability::charge};
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
