// A particle of (reduced) mass mu in a central field in polar coordinates, H = (p_r^2 + p_phi^2/r^2)/(2 mu) + V(r).
// [Gross1999, (2.77)-(2.106)]   phi is cyclic and not wrapped. With p_phi = 0 the motion may pass through the centre to
// negative r if the potential is finite there.
#pragma once

#include "hamflow/detail/problems/one_dimensional.hpp"
#include "hamflow/problems/support/central_force.hpp"

namespace hamflow {

/// The motion in r alone at angular momentum l: H = p_r^2/(2 mu) + V(r) + l^2/(2 mu r^2).   [Gross1999, (2.40)]
template <class R, template <class> class Potential>
class RadialHamiltonian : public OneDimensional<R> {
 public:
  RadialHamiltonian(R mass, Potential<R> potential, R angular_momentum)
      : OneDimensional<R>(R(1) / mass), potential_(potential), momentum_squared_(angular_momentum * angular_momentum) {}

  template <class S>
  S potential(const Vector<S, 1>& q) const {
    const S u = q[0] * q[0];
    S v = potential_.value(u);
    if (momentum_squared_ != R(0)) v += (momentum_squared_ * this->inverse_mass() / R(2)) / u;
    return v;
  }
  template <class S>
  void force(const Vector<S, 1>& q, Vector<S, 1>& f) const {
    const S u = q[0] * q[0];
    f[0] = -(potential_.slope(u) * q[0]);
    if (momentum_squared_ != R(0)) f[0] += momentum_squared_ * this->inverse_mass() / (u * q[0]);
  }
  template <class S>
  void force_and_hessian(const Vector<S, 1>& q, Vector<S, 1>& f, Matrix<S, 1>& hessian) const {
    const S u = q[0] * q[0];
    const CentralDerivatives<S> d = potential_.derivatives(u);
    f[0] = -(d.slope * q[0]);
    hessian[0][0] = d.slope + d.curvature * u;
    if (momentum_squared_ != R(0)) {
      const S centrifugal = momentum_squared_ * this->inverse_mass() / (u * q[0]);
      f[0] += centrifugal;
      hessian[0][0] += R(3) * centrifugal / q[0];
    }
  }

 private:
  Potential<R> potential_;
  R momentum_squared_;
};

/// A planar Cartesian state in polar coordinates, phi in (-pi, pi].
template <class R>
Start<R, 2> to_polar(const Start<R, 2>& s) {
  const R r = sqrt(s.q[0] * s.q[0] + s.q[1] * s.q[1]);
  return {{r, R(atan2(s.q[1], s.q[0]))}, {(s.q[0] * s.p[0] + s.q[1] * s.p[1]) / r, s.q[0] * s.p[1] - s.q[1] * s.p[0]}};
}
/// And back.
template <class R>
Start<R, 2> to_cartesian(const Start<R, 2>& s) {
  const R c = cos(s.q[1]);
  const R n = sin(s.q[1]);
  const R across = s.p[1] == R(0) ? R(0) : s.p[1] / s.q[0];
  return {{s.q[0] * c, s.q[0] * n}, {s.p[0] * c - across * n, s.p[0] * n + across * c}};
}

template <class R, template <class> class Potential>
class PolarCentralForce {
 public:
  using Real = R;
  using Reduced = RadialHamiltonian<R, Potential>;
  using Cartesian = CentralForce<R, Potential>;
  static constexpr std::size_t dimension = 2;

  PolarCentralForce(R mass, Potential<R> potential) : mass_(mass), potential_(potential) {}
  explicit PolarCentralForce(const Parameters<R>& given) : PolarCentralForce(given["mass"], Potential<R>(given)) {}

  static ProblemInfo info() {
    ProblemInfo all = Cartesian::info();
    all.variant[1].second = "polar";
    all.formula = "H = (p_r^2 + p_phi^2/r^2)/(2 mu) + V(r), " + Potential<R>::info().formula;
    all.reference = "Gross1999, (2.77)-(2.106); " + Potential<R>::info().reference;
    all.coordinates = {"r", "phi"};
    all.angles = {"phi"};
    all.default_choices.clear();
    all.invariants = {{"angular_momentum", "p_phi", Components::one, Terms::momentum}};
    all.example = polar_example(all);
    all.region.centre = {1.2, 0.3, -0.2, 0.9};
    all.region.step *= 0.7;  // phi turns faster than the state in the plane
    return all;
  }

  template <class S>
  S energy(const Vector<S, 2>& q, const Vector<S, 2>& p) const {
    const S u = q[0] * q[0];
    S square = p[0] * p[0];
    if (value_of(p[1]) != base_scalar<S>(0)) square += p[1] * p[1] / u;  // else through the centre, without 0/0
    return square / (R(2) * mass_) + potential_.value(u);
  }
  template <class S>
  void gradient(const Vector<S, 2>& q, const Vector<S, 2>& p, Vector<S, 2>& dq, Vector<S, 2>& dp) const {
    const S u = q[0] * q[0];
    const S turn = turning(p[1], u);
    dq[0] = potential_.slope(u) * q[0];
    if (value_of(p[1]) != base_scalar<S>(0)) dq[0] -= p[1] * turn / (mass_ * q[0]);
    dq[1] = S(0);
    dp[0] = p[0] / mass_;
    dp[1] = turn / mass_;
  }
  template <class S>
  void hessian(const Vector<S, 2>& q, const Vector<S, 2>& p, Matrix<S, 2>& qq, Matrix<S, 2>& qp,
               Matrix<S, 2>& pp) const {
    const S u = q[0] * q[0];
    const CentralDerivatives<S> d = potential_.derivatives(u);
    const S turn = turning(p[1], u);
    qq = {};
    qp = {};
    pp = {};
    qq[0][0] = d.slope + d.curvature * u + R(3) * turn * turn / mass_;
    if (value_of(p[1]) != base_scalar<S>(0)) qp[0][1] = R(-2) * turn / (mass_ * q[0]);
    pp[0][0] = S(R(1) / mass_);
    pp[1][1] = R(1) / (mass_ * u);
  }
  /// The rate of change of the distance from the centre.
  template <class S>
  S distance_rate(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
    return v[0] / q[0];
  }
  template <class S>
  Vector<S, 1> invariants(const Vector<S, 2>&, const Vector<S, 2>& p, const S& /*t*/) const {
    return {p[1]};
  }

  /// The radial problem for a given angular momentum.
  Reduced reduced(const R& angular_momentum) const { return Reduced(mass_, potential_, angular_momentum); }
  /// phi'.
  R cyclic_rate(const Vector<R, 1>& q, const R& angular_momentum) const {
    return angular_momentum == R(0) ? R(0) : angular_momentum / (mass_ * q[0] * q[0]);
  }

  static std::pair<std::string, std::string> refused_parameters(const Parameters<R>& given) {
    return Cartesian::refused_parameters(given);
  }
  static void derive(const std::string& kind, const Parameters<R>& orbit, Parameters<R>& given) {
    Cartesian::derive(kind, orbit, given);
  }
  static Start<R, 2> start(const std::string& kind, const Parameters<R>& given, const Parameters<R>& orbit,
                           Conditions& conditions) {
    return to_polar(Cartesian::start(kind, given, orbit, conditions));
  }

  // Cartesian coordinates are the reference chart.
  static Start<R, 2> to_reference(const Start<R, 2>& s) {
    if (s.q[0] == R(0) && s.p[1] != R(0)) {
      throw Error("found r = 0 with p_phi = " + shortest(static_cast<double>(s.p[1])) + "; allowed r other than 0");
    }
    return to_cartesian(s);
  }
  static Start<R, 2> from_reference(const Start<R, 2>& s) {
    if (s.q[0] == R(0) && s.q[1] == R(0)) {
      throw Error("found the centre, r = 0, where there are no polar coordinates; allowed any other point");
    }
    return to_polar(s);
  }

  // The facts about the orbit are computed in Cartesian coordinates.
  std::function<double(double)> exact_radius(const Vector<double, 2>& q, const Vector<double, 2>& p) const {
    const Start<double, 2> s = to_cartesian(Start<double, 2>{q, p});
    return cartesian().exact_radius(s.q, s.p);
  }
  OrbitFacts describe_orbit(const Vector<double, 2>& q, const Vector<double, 2>& p) const {
    const Start<double, 2> s = to_cartesian(Start<double, 2>{q, p});
    return cartesian().describe_orbit(s.q, s.p);
  }
  /// phi in (-pi, pi].
  std::optional<Start<long double, 2>> exact(const Vector<long double, 2>& q, const Vector<long double, 2>& p,
                                             long double t) const {
    if (p[1] == 0) return exact_on_line(q, p, t);
    if (!(q[0] > 0)) return std::nullopt;
    const Start<long double, 2> s = to_cartesian(Start<long double, 2>{q, p});
    const auto end = exact_in_plane(s.q, s.p, t);
    if (!end) return std::nullopt;
    return to_polar(*end);
  }

 private:
  /// Returns the example of the Cartesian problem, or the example of its region.
  static ExampleInfo polar_example(const ProblemInfo& cartesian) {
    ExampleInfo all = cartesian.example;
    const std::vector<double>& z = cartesian.region.centre;
    if (all.q.empty() && z.size() == 4) {
      all.q = {z[0], z[1]};
      all.p = {z[2], z[3]};
    }
    if (all.dt == 0) all.dt = cartesian.region.step;
    if (all.q.empty()) return all;
    const Start<double, 2> s = to_polar(Start<double, 2>{{all.q[0], all.q[1]}, {all.p[0], all.p[1]}});
    all.q = {s.q[0], s.q[1]};
    all.p = {s.p[0], s.p[1]};
    return all;
  }
  /// The motion with l = 0: phi is constant, and r changes its sign if the potential is finite at the centre.
  std::optional<Start<long double, 2>> exact_on_line(const Vector<long double, 2>& q, const Vector<long double, 2>& p,
                                                     long double t) const {
    const auto end = exact_in_plane({q[0], 0}, {p[0], 0}, t);
    if (!end) return std::nullopt;
    return Start<long double, 2>{{end->q[0], q[1]}, {end->p[0], 0}};
  }
  /// The motion in the plane. It uses the mass itself, because this H divides by it; the Cartesian H multiplies by the
  /// rounded 1/mass.
  std::optional<Start<long double, 2>> exact_in_plane(const Vector<long double, 2>& q, const Vector<long double, 2>& p,
                                                      long double t) const {
    if constexpr (potentials::HasExact<Potential<R>>) {
      return potential_.exact(static_cast<long double>(mass_), q, p, t);
    } else {
      return std::nullopt;
    }
  }
  /// mu phi' = p_phi/r^2; at the centre, where only p_phi = 0 can be, 0.
  template <class S>
  static S turning(const S& angular_momentum, const S& u) {
    return value_of(u) == base_scalar<S>(0) && value_of(angular_momentum) == base_scalar<S>(0) ? S(0)
                                                                                               : angular_momentum / u;
  }
  Cartesian cartesian() const { return Cartesian(mass_, potential_); }

  R mass_;
  Potential<R> potential_;
};

}  // namespace hamflow
