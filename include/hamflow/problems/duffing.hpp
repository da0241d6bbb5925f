// Duffing oscillator, H = p^2/(2 mu) + alpha/2 x^2 + beta/4 x^4 + gamma: the binomial potential on a line through its
// centre.   [Gross1999, (2.175)-(2.178)]   With V = k/2 (x^2 - lambda)^2,
//     alpha = -2 k lambda,   beta = 2 k,   gamma = k lambda^2/2,                                               (2.177)
// and the phase curve mu v^2 = -k (x^2 - lambda + lambda_inf)(x^2 - lambda - lambda_inf), lambda_inf^2 = 2 E/k, (2.184)
// has two, three or four zeros as lambda is below, at or above |lambda_inf|: cases 1, 2 (separatrix) and 3.
#pragma once

#include <optional>
#include <string>

#include "hamflow/core/problem_info.hpp"
#include "hamflow/detail/problems/duffing_exact.hpp"
#include "hamflow/detail/problems/one_dimensional.hpp"

namespace hamflow {

/// lambda from a geometric start at rest at r0, for V = k/2 (x^2 - lambda)^2. E = k lambda_inf^2/2.
template <class R>
struct DuffingCase {
  R lambda;
  R lambda_inf;
};
/// Case 1: the motion passes the centre with `speed`, (2.201), (2.197).
template <class R>
DuffingCase<R> duffing_case1(R mass, R k, R r0, R speed) {
  const R ratio = speed / r0;
  const R lambda_inf = mass / (R(2) * k) * ratio * ratio + r0 * r0 / R(2);
  return {r0 * r0 - lambda_inf, lambda_inf};
}
/// Case 2: the motion reaches the centre after an infinite time, (2.205).
template <class R>
DuffingCase<R> duffing_case2(R r0) {
  return {r0 * r0 / R(2), r0 * r0 / R(2)};
}
/// Case 3: the motion stays on one side. r0 is the outer turning point, and `speed` the largest speed, which is reached
/// at x^2 = lambda <= r0^2, (2.215), (2.209).
template <class R>
DuffingCase<R> duffing_case3(R mass, R k, R r0, R speed) {
  const R lambda_inf = sqrt(mass / k) * speed;
  return {r0 * r0 - lambda_inf, lambda_inf};
}

template <class R = double>
class Duffing : public OneDimensional<R> {
 public:
  explicit Duffing(R mass = R(1), R alpha = R(-1), R beta = R(1), R gamma = R(0))
      : OneDimensional<R>(R(1) / mass), alpha_(alpha), beta_(beta), gamma_(gamma) {}
  /// Converts the problem from another number type.
  template <class Q>
  explicit Duffing(const Duffing<Q>& other)
      : OneDimensional<R>(R(other.inverse_mass())),
        alpha_(R(other.alpha_)),
        beta_(R(other.beta_)),
        gamma_(R(other.gamma_)) {}
  /// Takes alpha and beta if they are given, else k and lambda.
  explicit Duffing(const Parameters<R>& given) : Duffing(given["mass"]) {
    if (given.has("alpha") || given.has("beta")) {
      alpha_ = value_or(given, "alpha", R(0));
      beta_ = value_or(given, "beta", R(0));
    } else {
      const R k = value_or(given, "k", R(1));
      const R lambda = value_or(given, "lambda", R(1));
      alpha_ = R(-2) * k * lambda;
      beta_ = R(2) * k;
      gamma_ = k * lambda * lambda / R(2);
    }
  }

  static ProblemInfo info() {
    return {.name = "duffing",
            .formula = "H = p^2/(2 mu) + alpha/2 x^2 + beta/4 x^4, or p^2/(2 mu) + k/2 (x^2 - lambda)^2",
            .reference = "Gross1999, Sect. 2.11.2-2.11.5",
            .coordinates = {"x"},
            .parameters = {{"mass", "1", "mu", Range::positive},
                           {"alpha", "", "linear stiffness"},
                           {"beta", "", "cubic stiffness"},
                           {"k", "", "strength k, instead of alpha and beta"},
                           {"lambda", "", "square of the position of the minimum, instead of alpha and beta"}},
            .starts = {{.kind = "case1",
                        .keys = {"r0", "speed"},
                        .meaning = "starts at rest at r0 and has the given speed at x = 0; 2 zeros",
                        .derives = {"lambda"},
                        .example = {{"r0", "1"}, {"speed", "0.25"}},
                        .example_parameters = {{"k", "1"}}},
                       {.kind = "case2",
                        .keys = {"r0"},
                        .meaning = "starts at rest at r0 on the separatrix; 3 zeros",
                        .derives = {"lambda"},
                        .example = {{"r0", "1"}},
                        .example_parameters = {{"k", "1"}}},
                       {.kind = "case3",
                        .keys = {"r0", "speed"},
                        .meaning = "starts at rest at r0 >= sqrt(lambda), with the given largest speed; 4 zeros",
                        .derives = {"lambda"},
                        .example = {{"r0", "1"}, {"speed", "0.25"}},
                        .example_parameters = {{"k", "1"}}}},
            .start_key = "case",
            .region = {.parameters = {{"alpha", "-1"}, {"beta", "1"}}, .centre = {1.3, 0.4}}};
  }

  /// Returns the allowed combinations if the given parameters cannot be combined. lambda from a case counts as given.
  static std::pair<std::string, std::string> refused_parameters(const Parameters<R>& given) {
    const bool stiffnesses = given.has("alpha") && given.has("beta");
    const bool binomial = given.has("k") && given.has("lambda");
    const bool both = (given.has("alpha") || given.has("beta")) && (given.has("k") || given.has("lambda"));
    if (both || !(stiffnesses || binomial)) {
      return {"", "alpha with beta, or k with lambda, or k with a case"};
    }
    return {};
  }

  template <class S>
  S potential(const Vector<S, 1>& q) const {
    const S u = q[0] * q[0];
    return u * (u * (beta_ / R(4)) + alpha_ / R(2)) + gamma_;
  }
  template <class S>
  void force(const Vector<S, 1>& q, Vector<S, 1>& f) const {
    f[0] = -(q[0] * (q[0] * q[0] * beta_ + alpha_));
  }
  template <class S>
  void potential_hessian(const Vector<S, 1>& q, Matrix<S, 1>& out) const {
    out[0][0] = q[0] * q[0] * (R(3) * beta_) + alpha_;
  }

  /// Sets lambda for the cases.
  static void derive(const std::string& kind, const Parameters<R>& orbit, Parameters<R>& given) {
    if (kind == "case2") {
      given.set("lambda", duffing_case2(orbit["r0"]).lambda);
    } else if (given.has("k")) {
      const auto lambda = kind == "case1" ? &duffing_case1<R> : &duffing_case3<R>;
      given.set("lambda", lambda(given["mass"], given["k"], orbit["r0"], orbit["speed"]).lambda);
    }
  }
  /// Returns the start at rest at r0, (2.194) with E = V(r0).
  static Start<R, 1> start(const std::string& kind, const Parameters<R>& given, const Parameters<R>& orbit,
                           Conditions& conditions) {
    const R r0 = orbit["r0"];
    const R k = value_or(given, "k", R(0));
    conditions.require("problem.k", "0 < k", R(0), k, true);
    conditions.require("problem.r0", "0 < r0", R(0), r0, true);
    if (kind != "case2") conditions.require("problem.speed", "0 < speed", R(0), orbit["speed"], true);
    if (kind == "case3") {
      const R largest = sqrt(k / given["mass"]) * r0 * r0 / R(2);
      conditions.require("problem.speed", "speed < sqrt(k/mass) r0^2/2", orbit["speed"], largest, true);  // (2.216)
    }
    return {{r0}, {R(0)}};
  }

  /// The exact state at time t, if the motion is bounded or the force linear.
  std::optional<Start<long double, 1>> exact(const Vector<long double, 1>& q, const Vector<long double, 1>& p,
                                             long double t) const {
    const auto w = static_cast<long double>(this->inverse_mass());
    const auto motion =
        duffing_motion(q[0], p[0] * w, static_cast<long double>(alpha_) * w, static_cast<long double>(beta_) * w, t);
    if (!motion) return std::nullopt;
    return Start<long double, 1>{{motion->position}, {motion->velocity / w}};
  }

 private:
  static R value_or(const Parameters<R>& given, const char* name, R otherwise) {
    return given.has(name) ? given[name] : otherwise;
  }

  template <class>
  friend class Duffing;
  R alpha_;
  R beta_;
  R gamma_;
};

}  // namespace hamflow
