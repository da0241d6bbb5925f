// Binomial potential V(r) = k/2 (r^2 - lambda)^2, W(u) = k/2 (u - lambda)^2.   [Gross1999, Sect. 2.11]
// A polynomial of degree 4 in q: four Gauss points conserve the energy of cg(1) exactly. Stiff for large k.
#pragma once

#include "hamflow/detail/problems/central_flow.hpp"
#include "hamflow/problems/support/central_force.hpp"

namespace hamflow {

template <class R>
class Binomial {
 public:
  explicit Binomial(R k = R(1), R lambda = R(1)) : k_(k), lambda_(lambda) {}
  explicit Binomial(const Parameters<R>& given) : Binomial(given["k"], given["lambda"]) {}
  /// Converts the potential from another number type.
  template <class Q>
  explicit Binomial(const Binomial<Q>& other) : k_(R(other.k_)), lambda_(R(other.lambda_)) {}

  static ProblemInfo info() {
    return {.name = "binomial",
            .formula = "V(r) = k/2 (r^2 - lambda)^2",
            .reference = "Gross1999, Sect. 2.11",
            .parameters = {{"k", "1", "strength"}, {"lambda", "1", "square of the radius of the minimum"}},
            .starts = {{.kind = "bounded",
                        .keys = {"r_per", "r_aph"},
                        .meaning = "at pericentre, lambda <= (r_per^2 + r_aph^2)/2, "
                                   "l = r_per r_aph sqrt(mu k (r_per^2 + r_aph^2 - 2 lambda))",
                        .example = {{"r_per", "1"}, {"r_aph", "3"}}},
                       start_by_energy({{"energy", "0.5"}, {"angular_momentum", "1"}})},
            .region = {.centre = {1.2, 0.3, -0.2, 0.9}, .step = 0.04},
            .example = {.start = "bounded"}};
  }

  template <class S>
  S value(const S& u) const {
    return (u - lambda_) * (u - lambda_) * (k_ / R(2));
  }
  template <class S, class F = R>
  S slope(const S& u, const F& factor = F(1)) const {
    return (u - lambda_) * (factor * (R(2) * k_));
  }
  template <class S>
  CentralDerivatives<S> derivatives(const S& u) const {
    return {slope(u), S(R(4) * k_)};
  }

  static Start<R, 2> start(const std::string&, R mass, const Parameters<R>& given, const Parameters<R>& orbit,
                           Conditions& conditions) {
    const R k = given["k"];
    const R lambda = given["lambda"];
    const R r_per = orbit["r_per"];
    const R r_aph = orbit["r_aph"];
    const R mean = (r_per * r_per + r_aph * r_aph) / R(2);
    conditions.require("problem.k", "0 < k", R(0), k, true);
    conditions.require("problem.orbit.r_per", "0 < r_per", R(0), r_per, true);
    conditions.require("problem.orbit.r_aph", "r_per <= r_aph", r_per, r_aph, false);
    conditions.require("problem.lambda", "lambda <= (r_per^2 + r_aph^2)/2", lambda, mean, false);
    return pericentre_start(r_per, r_per * r_aph * sqrt(R(2) * mass * k * (mean - lambda)));
  }

  /// The state after time t, by quadrature.
  std::optional<Start<long double, 2>> exact(long double mass, const Vector<long double, 2>& q,
                                             const Vector<long double, 2>& p, long double t) const {
    return central_flow(*this, mass, q, p, t);
  }

 private:
  template <class>
  friend class Binomial;
  R k_;
  R lambda_;
};

}  // namespace hamflow
