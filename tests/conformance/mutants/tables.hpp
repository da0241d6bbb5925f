// Broken coefficient tables, run by the real kernel.
#pragma once

#include <string>
#include <vector>

#include "hamflow/methods/compositions/stv4.hpp"
#include "hamflow/methods/runge_kutta.hpp"
#include "hamflow/methods/splitting.hpp"

namespace hamflow::mutants {

/// Any kick-drift-...-kick sequence of texts with any claims. Shape::any, because the ends may differ.
struct Sequence {
  static constexpr bool implicit = false;
  static constexpr bool bijective = true;
  template <class P>
  static constexpr bool accepts = Separable<P>;
  std::vector<std::string> coefficients;
  MethodInfo claims;
  template <class P, class A>
  using Stepper = Splitting<P, A, Shape::any>;
  template <class P, class A>
  Stepper<P, A> bind(const P&) const {
    using Base = typename Stepper<P, A>::Base;
    SplittingSequence<Base> sequence{StartsWith::kick, {}};
    for (const std::string& text : coefficients) sequence.coefficients.push_back(evaluate_number<Base>(text));
    return {sequence, [](const void* self) { return static_cast<const Sequence*>(self)->claims; }, this};
  }
};

inline Sequence composition(const std::vector<std::string>& gamma, MethodInfo claims) {
  Sequence sequence{{"(" + gamma.front() + ")/2"}, std::move(claims)};
  for (std::size_t i = 0; i < gamma.size(); ++i) {
    sequence.coefficients.push_back(gamma[i]);
    sequence.coefficients.push_back(i + 1 < gamma.size() ? "((" + gamma[i] + ")+(" + gamma[i + 1] + "))/2"
                                                         : "(" + gamma[i] + ")/2");
  }
  return sequence;
}

inline const std::string a = "1/(2-2^(1/3))";
inline const std::string b = "1-2/(2-2^(1/3))";

inline MethodInfo stv4_claims(const std::string& name) {
  MethodInfo claims = describe(compositions::stv4, StartsWith::kick);
  claims.name = name;
  return claims;
}

/// The control: no fault, so that what catches the others is their fault.
inline Sequence sound_stv4() { return composition({a, b, a}, stv4_claims("stv4, sound")); }
/// The 6th digit of gamma_1 is 1 instead of 0; the middle one still makes the sum 1.
inline Sequence stv4_wrong_digit() {
  const std::string wrong = "1.3512171919596576340476878089714608269219993762171";
  return composition({wrong, "1-2*" + wrong, wrong}, stv4_claims("stv4, wrong 6th digit"));
}
/// The same three steps, not in palindromic order.
inline Sequence stv4_out_of_order() { return composition({a, a, b}, stv4_claims("stv4, order a a b")); }
/// The two inner kicks with the wrong sign: still a palindrome.
inline Sequence stv4_wrong_sign() {
  Sequence sequence = composition({a, b, a}, stv4_claims("stv4, inner kicks reversed"));
  for (const std::size_t i : {2u, 4u}) sequence.coefficients[i] = "-(" + sequence.coefficients[i] + ")";
  return sequence;
}
/// The last kick is forgotten to be halved.
inline Sequence verlet_whole_last_kick() {
  MethodInfo claims = stv4_claims("verlet, last kick whole");
  claims.order = 2;
  claims.forces_per_step = 1;
  return {{"1/2", "1", "1"}, claims};
}
/// A sound method with other claims.
inline Sequence verlet_claiming(const std::string& what, void (*change)(MethodInfo&)) {
  MethodInfo claims = stv4_claims("verlet, claiming " + what);
  claims.order = 2;
  claims.forces_per_step = 1;
  change(claims);
  return {{"1/2", "1", "1/2"}, claims};
}

/// rk4 with equal weights, which meet the conditions of order 2 that the compiler checks.
inline constexpr ButcherTableau<4> rk4_wrong_weight{
    .name = "rk4, wrong weight",
    .order = 4,
    .reference = "",
    .a = {{{}, {Ratio{1, 2}}, {Ratio{0, 1}, Ratio{1, 2}}, {Ratio{0, 1}, Ratio{0, 1}, Ratio{1, 1}}}},
    .b = {Ratio{1, 4}, Ratio{1, 4}, Ratio{1, 4}, Ratio{1, 4}}};

}  // namespace hamflow::mutants
