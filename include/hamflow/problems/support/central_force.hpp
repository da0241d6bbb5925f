// A particle of (reduced) mass mu in a central field, H = |p|^2/(2 mu) + V(r), in plane Cartesian coordinates.
// [Gross1999, (2.45)-(2.60)]   V is one file in potentials/, written as a function of u = r^2, W(u) = V(sqrt u), so
// that
//     grad V = 2 W'(u) q,     V'' = 2 W'(u) I + 4 W''(u) q q^T.
#pragma once

#include <optional>
#include <utility>

#include "hamflow/core/derivatives.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/core/radial_forces.hpp"
#include "hamflow/detail/problems/effective_potential.hpp"
#include "hamflow/detail/problems/energy_start.hpp"
#include "hamflow/detail/problems/potential.hpp"

namespace hamflow {

/// The start for circles: on the y-axis, moving to the left, so counter-clockwise.   [Gross1999, (2.127), (2.128)]
template <class R>
Start<R, 2> circular_start(const R& r0, const R& l) {
  return {{R(0), r0}, {-l / r0, R(0)}};
}
/// The start at pericentre on the x-axis.   [Gross1999, (2.131)]
template <class R>
Start<R, 2> pericentre_start(const R& r_per, const R& l) {
  return {{r_per, R(0)}, {R(0), l / r_per}};
}

/// Returns the entries of `orbit` in a summary.
OrbitFacts facts_of(const CentralOrbit& orbit);

template <class R, template <class> class Potential>
class CentralForce {
 public:
  using Real = R;
  static constexpr std::size_t dimension = 2;
  static constexpr bool quadratic_kinetic = true;
  static constexpr bool takes_two = potentials::takes_two<Potential<R>>;

  CentralForce(R mass, Potential<R> potential) : mass_(mass), inverse_mass_(R(1) / mass), potential_(potential) {}
  explicit CentralForce(const Parameters<R>& given) : CentralForce(given["mass"], Potential<R>(given)) {}
  /// Converts the problem from another number type.
  template <class Q>
  explicit CentralForce(const CentralForce<Q, Potential>& other)
      : mass_(R(other.mass_)), inverse_mass_(R(other.inverse_mass_)), potential_(other.potential_) {}

  static ProblemInfo info() {
    ProblemInfo of_potential = Potential<R>::info();
    ProblemInfo all{.name = "central-force",
                    .variant = {{"potential", of_potential.name}, {"coordinates", "cartesian"}},
                    .default_choices = {"coordinates"},
                    .example_choices = of_potential.example_choices,
                    .chart_key = "coordinates",
                    .typed_choice = "potential",
                    .formula = "H = |p|^2/(2 mu) + V(r), " + of_potential.formula,
                    .reference = "Gross1999, (2.45)-(2.60); " + of_potential.reference,
                    .coordinates = {"x", "y"},
                    .parameters = {{"mass", "1", "reduced mass mu", Range::positive}},
                    .invariants = {{"angular_momentum", "x p_y - y p_x", Components::one, Terms::moments}},
                    .starts = of_potential.starts,
                    .two_bodies = true,
                    .region = of_potential.region,
                    .example = of_potential.example};
    if (all.starts.empty() || !all.starts.back().kind.empty()) all.starts.push_back(start_by_energy({}));
    all.parameters.insert(all.parameters.end(), of_potential.parameters.begin(), of_potential.parameters.end());
    return all;
  }

  template <class S>
  S kinetic(const Vector<S, 2>& p) const {
    return (p[0] * p[0] + p[1] * p[1]) * (inverse_mass_ / R(2));
  }
  template <class S>
  S potential(const Vector<S, 2>& q) const {
    return potential_.value(square(q));
  }
  template <class S>
  void velocity(const Vector<S, 2>& p, Vector<S, 2>& v) const {
    v[0] = p[0] * inverse_mass_;
    v[1] = p[1] * inverse_mass_;
  }
  template <class F, class S>
  void scaled_velocity(const F& factor, const Vector<S, 2>& p, Vector<S, 2>& v) const {
    const auto scaled = factor * inverse_mass_;
    v[0] = scaled * p[0];
    v[1] = scaled * p[1];
  }
  template <class S>
  void force(const Vector<S, 2>& q, Vector<S, 2>& f) const {
    attract(potential_.slope(square(q)), q, f);
  }
  /// Only for potentials with a scaled slope.
  template <class F, class S>
  requires potentials::HasScaledSlope<Potential<R>, S, F>
  void scaled_force(const F& factor, const Vector<S, 2>& q, Vector<S, 2>& f) const {
    attract(potential_.slope(square(q), factor), q, f);
  }
  template <class S>
  void force_and_hessian(const Vector<S, 2>& q, Vector<S, 2>& f, Matrix<S, 2>& hessian) const {
    const CentralDerivatives<S> d = potential_.derivatives(square(q));
    attract(d.slope, q, f);
    const S cx = d.curvature * q[0];
    hessian[0][0] = d.slope + cx * q[0];
    hessian[0][1] = hessian[1][0] = cx * q[1];
    hessian[1][1] = d.slope + d.curvature * (q[1] * q[1]);
  }
  // The functions of RadialForces.
  static std::size_t radial_space() { return 2; }
  static std::vector<RadialTerm<R>> radial_terms() { return {{0, RadialTerm<R>::centre, R(1)}}; }
  template <class S>
  RadialLaw<S> radial_law(const S& u) const {
    const CentralDerivatives<S> d = potential_.derivatives(u);
    return {potential_.value(u), d.slope / R(2), d.curvature / R(4)};
  }
  /// The rate of change of the distance from the centre.
  template <class S>
  S distance_rate(const Vector<S, 2>& q, const Vector<S, 2>& v) const {
    return (q[0] * v[0] + q[1] * v[1]) / square(q);
  }
  template <class S>
  Vector<S, 1> invariants(const Vector<S, 2>& q, const Vector<S, 2>& p, const S& /*t*/) const {
    return {q[0] * p[1] - q[1] * p[0]};
  }

  /// Returns the error in the parameters of the potential, as key and message; both empty if they are accepted.
  static std::pair<std::string, std::string> refused_parameters(const Parameters<R>& given) {
    if constexpr (potentials::HasRefusedParameters<Potential<R>, R>) {
      return Potential<R>::refused_parameters(given);
    } else {
      return {};
    }
  }
  /// Sets the parameters that follow from a start, for potentials whose strength is derived from the orbit.
  static void derive(const std::string& kind, const Parameters<R>& orbit, Parameters<R>& given) {
    if constexpr (potentials::HasDerive<Potential<R>, R>) Potential<R>::derive(kind, orbit, given);
  }
  /// Returns a geometric start. @param conditions receives every inequality that the geometry has to satisfy
  static Start<R, 2> start(const std::string& kind, const Parameters<R>& given, const Parameters<R>& orbit,
                           Conditions& conditions) {
    if (kind.empty()) {
      const R l = orbit["angular_momentum"];
      const auto at = turning_point<Potential>(given, R(orbit["energy"]), l, conditions);
      return at.circle ? circular_start(at.radius, l) : pericentre_start(at.radius, l);
    }
    if constexpr (potentials::HasStart<Potential<R>, R>) {
      return Potential<R>::start(kind, given["mass"], given, orbit, conditions);
    } else {
      return {};
    }
  }
  /// Returns the exact orbit through (q, p) as r(phi); empty if there is no closed form.
  std::function<double(double)> exact_radius(const Vector<double, 2>& q, const Vector<double, 2>& p) const {
    if constexpr (potentials::HasExactRadius<Potential<R>>) {
      return potential_.exact_radius(static_cast<double>(mass_), q, p);
    } else {
      return {};
    }
  }
  /// Returns the exact state after time t; nullopt if it cannot be computed.
  std::optional<Start<long double, 2>> exact(const Vector<long double, 2>& q, const Vector<long double, 2>& p,
                                             long double t) const {
    if constexpr (potentials::HasExact<Potential<R>>) {
      return potential_.exact(1 / static_cast<long double>(inverse_mass_), q, p, t);
    } else {
      return std::nullopt;
    }
  }
  /// Returns the facts about the orbit that follow from the effective potential.   [Gross1999, (2.40)-(2.44)]
  OrbitFacts describe_orbit(const Vector<double, 2>& q, const Vector<double, 2>& p) const {
    return facts_of(describe_central_orbit(potential_, static_cast<double>(mass_), q, p));
  }

 private:
  template <class S>
  static void attract(const std::type_identity_t<S>& slope, const Vector<S, 2>& q, Vector<S, 2>& f) {
    f[0] = -(slope * q[0]);
    f[1] = -(slope * q[1]);
  }
  template <class S>
  static S square(const Vector<S, 2>& q) {
    return q[0] * q[0] + q[1] * q[1];
  }

  template <class, template <class> class>
  friend class CentralForce;
  R mass_;
  R inverse_mass_;
  Potential<R> potential_;
};

}  // namespace hamflow
