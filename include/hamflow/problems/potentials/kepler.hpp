// Kepler potential V(r) = -k/r, W(u) = -k u^(-1/2).   [Gross1999, Sect. 2.8]
// Starts: the circle at phi = pi/2 (2.127), (2.128), the other conics at pericentre on the x-axis (2.131).
#pragma once

#include "hamflow/detail/core/two.hpp"
#include "hamflow/detail/problems/kepler_flow.hpp"
#include "hamflow/problems/support/central_force.hpp"

namespace hamflow {

template <class R>
class Kepler {
 public:
  static constexpr bool takes_two = true;

  explicit Kepler(R k = R(1)) : k_(k) {}
  explicit Kepler(const Parameters<R>& given) : Kepler(given["k"]) {}
  /// Converts the potential from another number type.
  template <class Q>
  explicit Kepler(const Kepler<Q>& other) : k_(R(other.k_)) {}

  static ProblemInfo info() {
    return {.name = "kepler",
            .example_choices = {"potential"},
            .formula = "V(r) = -k/r",
            .reference = "Gross1999, Sect. 2.8",
            .parameters = {{"k", "1", "strength, k > 0 attracts"}},
            .starts = {{.kind = "circle",
                        .keys = {"r0"},
                        .meaning = "at (0, r0), l = sqrt(mu k r0)",
                        .example = {{"r0", "1"}}},
                       {.kind = "ellipse",
                        .keys = {"r_per", "r_aph"},
                        .meaning = "at pericentre, l = sqrt(2 k mu r_per r_aph/(r_per + r_aph))",
                        .example = {{"r_per", "1"}, {"r_aph", "3"}}},
                       {.kind = "parabola",
                        .keys = {"r_per"},
                        .meaning = "at pericentre, l = sqrt(2 mu k r_per)",
                        .example = {{"r_per", "1"}}},
                       {.kind = "hyperbola",
                        .keys = {"r_per", "angular_momentum"},
                        .meaning = "at pericentre, l > sqrt(2 mu k r_per)",
                        .example = {{"r_per", "1"}, {"angular_momentum", "2"}}},
                       start_by_energy({{"energy", "-0.3"}, {"angular_momentum", "1"}})},
            // From r = 1 to r = 3; the time is a seventh of the period, 2 pi sqrt(8).
            .region = {.centre = {1, 0, 0, sqrt(1.5)}},
            .example = {.start = "ellipse"}};
  }

  template <class S>
  S value(const S& u) const {
    return -k_ / sqrt(u);
  }
  template <class S, class F = R>
  S slope(const S& u, const F& factor = F(1)) const {
    return (factor * k_) / (u * sqrt(u));
  }
  template <class S>
  CentralDerivatives<S> derivatives(const S& u) const {
    const S inverse = R(1) / u;
    const S root = sqrt(inverse);  // named, because compilers evaluate factors in any order, and slopes depend on it
    const S slope = k_ * inverse * root;
    return {slope, R(-3) * slope * inverse};
  }

  static Start<R, 2> start(const std::string& kind, R mass, const Parameters<R>& given, const Parameters<R>& orbit,
                           Conditions& conditions) {
    const R k = given["k"];
    conditions.require("problem.k", "0 < k", R(0), k, true);
    if (kind == "circle") {
      const R r0 = orbit["r0"];
      conditions.require("problem.orbit.r0", "0 < r0", R(0), r0, true);
      return circular_start(r0, R(sqrt(mass * k * r0)));
    }
    const R r_per = orbit["r_per"];
    conditions.require("problem.orbit.r_per", "0 < r_per", R(0), r_per, true);
    R l{};
    if (kind == "ellipse") {
      const R r_aph = orbit["r_aph"];
      conditions.require("problem.orbit.r_aph", "r_per <= r_aph", r_per, r_aph, false);
      l = sqrt(R(2) * k * mass * r_per * r_aph / (r_per + r_aph));
    } else {
      const R parabolic = sqrt(R(2) * mass * k * r_per);
      l = parabolic;
      if (kind == "hyperbola") {
        l = orbit["angular_momentum"];
        conditions.require("problem.orbit.angular_momentum", "sqrt(2 mass k r_per) < angular_momentum", parabolic, l,
                           true);
      }
    }
    return pericentre_start(r_per, l);
  }

  /// r(phi) = (l^2/(mu k))/(1 + eps cos(phi - phi')), (2.112)-(2.118), with eps and phi' from the eccentricity vector p
  /// x L/(mu k) - q/|q|. Not positive if the orbit does not reach phi.
  std::function<double(double)> exact_radius(double mass, const Vector<double, 2>& q,
                                             const Vector<double, 2>& p) const {
    const double k = static_cast<double>(k_);
    const double l = q[0] * p[1] - q[1] * p[0];
    const double r = sqrt(q[0] * q[0] + q[1] * q[1]);
    if (!(k > 0) || l == 0) return {};
    const double ex = p[1] * l / (mass * k) - q[0] / r;
    const double ey = -p[0] * l / (mass * k) - q[1] / r;
    const double parameter = l * l / (mass * k);
    return [=](double phi) { return parameter / (1 + ex * cos(phi) + ey * sin(phi)); };
  }

  /// The conic. @param energy its sign, 0 when it vanishes to rounding   @param straight l = 0
  const char* conic(bool circular, int energy, bool straight) const {
    if (straight || k_ == R(0)) return "line";
    if (circular) return "circle";
    if (k_ < R(0)) return "hyperbola";
    return energy < 0 ? "ellipse" : energy == 0 ? "parabola" : "hyperbola";
  }
  /// The state after time t, on every conic.
  std::optional<Start<long double, 2>> exact(long double mass, const Vector<long double, 2>& q,
                                             const Vector<long double, 2>& p, long double t) const {
    return kepler_flow(static_cast<long double>(k_), mass, q, p, t);
  }

 private:
  template <class>
  friend class Kepler;
  R k_;
};

}  // namespace hamflow
