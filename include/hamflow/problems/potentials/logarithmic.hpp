// Logarithmic potential V(r) = k log r, W(u) = (k/2) log u, with the force k/r.   [BT2008, Sect. 2.2.2]
#pragma once

#include "hamflow/problems/support/central_flow.hpp"
#include "hamflow/problems/support/central_force.hpp"

namespace hamflow {

template <class R>
class Logarithmic {
 public:
  explicit Logarithmic(R k = R(1)) : k_(k) {}
  explicit Logarithmic(const Parameters<R>& given) : Logarithmic(given["k"]) {}

  static ProblemInfo info() {
    return {.name = "logarithmic",
            .formula = "V(r) = k log r",
            .reference = "BT2008, Sect. 2.2.2",
            .parameters = {{"k", "1", "strength, k > 0 binds"}},
            .starts = {{.kind = "circle",
                        .keys = {"r0"},
                        .meaning = "at (0, r0), k > 0, l = r0 sqrt(mu k)",
                        .example = {{"r0", "1"}}},
                       start_by_energy({{"energy", "1"}, {"angular_momentum", "1"}})},
            .region = {.centre = {1, 0.3, -0.2, 0.9}}};
  }

  template <class S>
  S value(const S& u) const {
    return log(u) * (k_ / R(2));
  }
  template <class S, class F = R>
  S slope(const S& u, const F& factor = F(1)) const {
    return (factor * k_) / u;
  }
  template <class S>
  CentralDerivatives<S> derivatives(const S& u) const {
    return {k_ / u, R(-2) * k_ / (u * u)};
  }

  static Start<R, 2> start(const std::string&, R mass, const Parameters<R>& given, const Parameters<R>& orbit,
                           Conditions& conditions) {
    const R k = given["k"];
    const R r0 = orbit["r0"];
    conditions.require("problem.k", "0 < k", R(0), k, true);
    conditions.require("problem.orbit.r0", "0 < r0", R(0), r0, true);
    return circular_start(r0, r0 * sqrt(mass * k));
  }

  /// The state after time t, by quadrature.
  std::optional<Start<long double, 2>> exact(long double mass, const Vector<long double, 2>& q,
                                             const Vector<long double, 2>& p, long double t) const {
    return central_flow(*this, mass, q, p, t);
  }

 private:
  R k_;
};

}  // namespace hamflow
