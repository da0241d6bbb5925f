// Linear potential V(r) = k r, W(u) = k sqrt(u); k > 0 binds.   [Gross1999, Sect. 2.10; (2.165) lacks a factor k]
#pragma once

#include "hamflow/detail/problems/central_flow.hpp"
#include "hamflow/problems/support/central_force.hpp"

namespace hamflow {

template <class R>
class Linear {
 public:
  explicit Linear(R k = R(1)) : k_(k) {}
  explicit Linear(const Parameters<R>& given) : Linear(given["k"]) {}
  /// Converts the potential from another number type.
  template <class Q>
  explicit Linear(const Linear<Q>& other) : k_(R(other.k_)) {}

  static ProblemInfo info() {
    return {.name = "linear",
            .formula = "V(r) = k r",
            .reference = "Gross1999, Sect. 2.10",
            .parameters = {{"k", "1", "strength, k > 0 binds"}},
            .starts = {{.kind = "circle",
                        .keys = {"r0"},
                        .meaning = "at (0, r0), k > 0, l = sqrt(k mu r0^3), E = 3 k r0/2",
                        .example = {{"r0", "1"}}},
                       {.kind = "bounded",
                        .keys = {"r_per", "r_aph"},
                        .meaning = "at pericentre, k > 0, l = r_per r_aph sqrt(2 mu k/(r_per + r_aph))",
                        .example = {{"r_per", "1"}, {"r_aph", "3"}}},
                       {.kind = "unbounded",
                        .keys = {"r_per", "energy"},
                        .meaning = "at pericentre, k < 0, l = r_per sqrt(2 mu (E - k r_per))",
                        .example = {{"r_per", "1"}, {"energy", "-0.3"}},
                        .example_parameters = {{"k", "-1"}}},
                       start_by_energy({{"energy", "2"}, {"angular_momentum", "1"}})},
            .region = {.centre = {1, 0.3, -0.2, 0.9}},
            .example = {.start = "bounded"}};
  }

  template <class S>
  S value(const S& u) const {
    return k_ * sqrt(u);
  }
  template <class S, class F = R>
  S slope(const S& u, const F& factor = F(1)) const {
    return (factor * k_) / sqrt(u);
  }
  template <class S>
  CentralDerivatives<S> derivatives(const S& u) const {
    const S slope = k_ / sqrt(u);
    return {slope, -slope / u};
  }

  static Start<R, 2> start(const std::string& kind, R mass, const Parameters<R>& given, const Parameters<R>& orbit,
                           Conditions& conditions) {
    const R k = given["k"];
    if (kind == "circle") {
      const R r0 = orbit["r0"];
      conditions.require("problem.k", "0 < k", R(0), k, true);
      conditions.require("problem.orbit.r0", "0 < r0", R(0), r0, true);
      return circular_start(r0, sqrt(k * mass * r0 * r0 * r0));
    }
    const R r_per = orbit["r_per"];
    conditions.require("problem.orbit.r_per", "0 < r_per", R(0), r_per, true);
    if (kind == "bounded") {
      const R r_aph = orbit["r_aph"];
      conditions.require("problem.k", "0 < k", R(0), k, true);
      conditions.require("problem.orbit.r_aph", "r_per <= r_aph", r_per, r_aph, false);
      return pericentre_start(r_per, r_per * r_aph * sqrt(R(2) * mass * k / (r_per + r_aph)));
    }
    const R energy = orbit["energy"];
    conditions.require("problem.k", "k < 0", k, R(0), true);
    conditions.require("problem.orbit.energy", "k r_per < energy", k * r_per, energy, true);
    return pericentre_start(r_per, r_per * sqrt(R(2) * mass * (energy - k * r_per)));
  }

  /// The state after time t, by quadrature.
  std::optional<Start<long double, 2>> exact(long double mass, const Vector<long double, 2>& q,
                                             const Vector<long double, 2>& p, long double t) const {
    return central_flow(*this, mass, q, p, t);
  }

 private:
  template <class>
  friend class Linear;
  R k_;
};

}  // namespace hamflow
