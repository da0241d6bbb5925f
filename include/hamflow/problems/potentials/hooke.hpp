// Hooke potential V(r) = -k r^2/2, W(u) = -k u/2; k < 0 binds.   [Gross1999, Sect. 2.9]
// The bound starts are given by their energy, from which k follows: circle (2.127), (2.128), the others at pericentre
// on the x-axis (2.131).
#pragma once

#include "hamflow/detail/problems/hooke_flow.hpp"
#include "hamflow/problems/support/central_force.hpp"

namespace hamflow {

template <class R>
class Hooke {
 public:
  explicit Hooke(R k = R(-1)) : k_(k) {}
  explicit Hooke(const Parameters<R>& given) : Hooke(given["k"]) {}
  /// Converts the potential from another number type.
  template <class Q>
  explicit Hooke(const Hooke<Q>& other) : k_(R(other.k_)) {}

  static ProblemInfo info() {
    return {.name = "hooke",
            .formula = "V(r) = -k r^2/2",
            .reference = "Gross1999, Sect. 2.9",
            .parameters = {{"k", "1", "strength, k < 0 binds"}},
            .starts = {{.kind = "circle",
                        .keys = {"r0", "energy"},
                        .meaning = "at (0, r0), k = -E/r0^2, l = r0 sqrt(mu E)",
                        .derives = {"k"},
                        .example = {{"r0", "1"}, {"energy", "0.5"}}},
                       {.kind = "ellipse",
                        .keys = {"r_per", "r_aph", "energy"},
                        .meaning = "at pericentre, k = -2 E/(r_per^2 + r_aph^2), l = r_per r_aph sqrt(-mu k)",
                        .derives = {"k"},
                        .example = {{"r_per", "1"}, {"r_aph", "3"}, {"energy", "0.5"}}},
                       {.kind = "line",
                        .keys = {"r_per", "energy"},
                        .meaning = "at pericentre, k = 0, l = r_per sqrt(2 mu E)",
                        .derives = {"k"},
                        .example = {{"r_per", "1"}, {"energy", "0.5"}}},
                       {.kind = "hyperbola",
                        .keys = {"r_per", "energy"},
                        .meaning = "at pericentre, k > 0, l = r_per sqrt(mu (2 E + k r_per^2))",
                        .example = {{"r_per", "1"}, {"energy", "-0.3"}},
                        .example_parameters = {{"k", "1"}}},
                       start_by_energy({{"energy", "1"}, {"angular_momentum", "1"}})},
            .region = {.parameters = {{"k", "-1"}}, .centre = {1, 0.3, -0.2, 0.6}},
            .example = {.start = "ellipse"}};
  }

  template <class S>
  S value(const S& u) const {
    return u * (k_ / R(-2));
  }
  template <class S, class F = R>
  S slope(const S&, const F& factor = F(1)) const {
    return S(-(factor * k_));
  }
  template <class S>
  CentralDerivatives<S> derivatives(const S&) const {
    return {S(-k_), S(0)};
  }

  /// k of the bound starts, from their energy.
  static void derive(const std::string& kind, const Parameters<R>& orbit, Parameters<R>& given) {
    if (kind == "circle") given.set("k", -orbit["energy"] / (orbit["r0"] * orbit["r0"]));
    if (kind == "line") given.set("k", R(0));
    if (kind == "ellipse") {
      const R r_per = orbit["r_per"];
      const R r_aph = orbit["r_aph"];
      given.set("k", R(-2) * orbit["energy"] / (r_per * r_per + r_aph * r_aph));
    }
  }

  static Start<R, 2> start(const std::string& kind, R mass, const Parameters<R>& given, const Parameters<R>& orbit,
                           Conditions& conditions) {
    const R energy = orbit["energy"];
    const R k = given["k"];
    if (kind == "circle") {
      const R r0 = orbit["r0"];
      conditions.require("problem.orbit.r0", "0 < r0", R(0), r0, true);
      conditions.require("problem.orbit.energy", "0 < energy", R(0), energy, true);
      return circular_start(r0, r0 * sqrt(mass * energy));
    }
    const R r_per = orbit["r_per"];
    conditions.require("problem.orbit.r_per", "0 < r_per", R(0), r_per, true);
    R l{};
    if (kind == "hyperbola") {
      conditions.require("problem.k", "0 < k", R(0), k, true);
      conditions.require("problem.orbit.energy", "-k r_per^2/2 < energy", -k * r_per * r_per / R(2), energy, true);
      l = r_per * sqrt(mass * (R(2) * energy + k * r_per * r_per));
    } else {
      conditions.require("problem.orbit.energy", "0 < energy", R(0), energy, true);
      l = r_per * sqrt(R(2) * mass * energy);
      if (kind == "ellipse") {
        const R r_aph = orbit["r_aph"];
        conditions.require("problem.orbit.r_aph", "r_per <= r_aph", r_per, r_aph, false);
        l = r_per * r_aph * sqrt(-mass * k);
      }
    }
    return pericentre_start(r_per, l);
  }

  /// F = v v^T - (k/mu) q q^T with v = p/mu is conserved, and q^T (tr F - F) q = (l/mu)^2 is the conic (2.143)-(2.148)
  /// about its centre. The radius is not finite if the orbit does not reach phi.
  std::function<double(double)> exact_radius(double mass, const Vector<double, 2>& q,
                                             const Vector<double, 2>& p) const {
    const double kappa = -static_cast<double>(k_) / mass;
    const Vector<double, 2> v{p[0] / mass, p[1] / mass};
    const double l = q[0] * v[1] - q[1] * v[0];
    if (l == 0) return {};
    const double xx = v[0] * v[0] + kappa * q[0] * q[0];
    const double xy = v[0] * v[1] + kappa * q[0] * q[1];
    const double yy = v[1] * v[1] + kappa * q[1] * q[1];
    return [=](double phi) {
      const double c = cos(phi);
      const double s = sin(phi);
      return abs(l) / sqrt(yy * c * c - 2 * xy * c * s + xx * s * s);
    };
  }

  /// The conic. @param straight l = 0
  const char* conic(bool circular, int /*energy*/, bool straight) const {
    if (straight || k_ == R(0)) return "line";
    if (circular) return "circle";
    return k_ < R(0) ? "ellipse" : "hyperbola";
  }
  /// The state after time t.
  std::optional<Start<long double, 2>> exact(long double mass, const Vector<long double, 2>& q,
                                             const Vector<long double, 2>& p, long double t) const {
    return hooke_flow(static_cast<long double>(k_), mass, q, p, t);
  }

 private:
  template <class>
  friend class Hooke;
  R k_;
};

}  // namespace hamflow
