// Gauss-Legendre quadrature on [0, 1], computed in the working arithmetic.   [HLW2006, Sect. II.1.3]
#pragma once

#include <map>
#include <type_traits>
#include <vector>

#include "hamflow/core/number.hpp"
#include "hamflow/detail/arithmetic/number_types.hpp"

namespace hamflow {

/// s points c = 1/2 + offset and weights b, exact for polynomials of degree 2 s - 1, ascending. Offsets and weights are
/// symmetric bit for bit; c cannot be, because 1/2 + offset rounds; so symmetric computations use the offsets.
template <class R>
struct GaussRule {
  int points = 0;
  std::vector<R> c;
  std::vector<R> offset;
  std::vector<R> b;
};

inline constexpr int most_gauss_points = 64;

namespace detail {
/// Newton on the Legendre polynomial P_s, x in (-1, 1), from the Chebyshev-like initial guess of Tricomi.
template <class R>
GaussRule<R> make_gauss_rule(int s) {
  const auto count = static_cast<std::size_t>(s);
  GaussRule<R> rule{s, std::vector<R>(count), std::vector<R>(count), std::vector<R>(count)};
  for (int i = 0; i < (s + 1) / 2; ++i) {
    R x = cos(pi_value<R>() * (R(4 * i + 3)) / R(4 * s + 2));
    if (2 * i + 1 == s) x = R(0);
    R derivative(0);
    for (int pass = 0; pass < 12;
         ++pass) {  // quadratic convergence from 3 digits: 5 passes reach any precision in use, 12 are always enough
      R previous(1);
      R value = x;
      for (int k = 2; k <= s; ++k) {
        const R next = (R(2 * k - 1) * x * value - R(k - 1) * previous) / R(k);
        previous = value;
        value = next;
      }
      derivative = R(s) * (x * value - previous) / (x * x - R(1));
      x = x - value / derivative;
    }
    const R weight = R(1) / ((R(1) - x * x) * derivative * derivative);  // half of the weight on [-1, 1]
    const auto low = static_cast<std::size_t>(i);
    const auto high = static_cast<std::size_t>(s - 1 - i);
    rule.offset[low] = -x / R(2);
    rule.offset[high] = x / R(2);
    rule.c[low] = (R(1) - x) / R(2);
    rule.c[high] = (R(1) + x) / R(2);
    rule.b[low] = rule.b[high] = weight;
  }
  return rule;
}
/// The recurrence loses 10 roundings with 8 points and 400 with 64, so it is computed with more digits and rounded once
/// (src/numerics/gauss_rules.cpp).
template <>
GaussRule<Extended<dd_real>> make_gauss_rule<Extended<dd_real>>(int s);
template <>
GaussRule<Extended<QuadNumber>> make_gauss_rule<Extended<QuadNumber>>(int s);
template <class To, class From>
GaussRule<To> rounded(const GaussRule<From>& rule) {
  GaussRule<To> out{rule.points, {}, {}, {}};
  const auto round = [](const std::vector<From>& from, std::vector<To>& to) {
    for (const From& x : from) to.push_back(static_cast<To>(x));
  };
  round(rule.c, out.c);
  round(rule.offset, out.offset);
  round(rule.b, out.b);
  return out;
}
}  // namespace detail

/// The Gauss rule with s points, made once per number type. @param s 1 .. most_gauss_points
template <class R>
const GaussRule<R>& gauss_rule(int s) {
  if (s < 1 || s > most_gauss_points) {
    throw Error("a Gauss rule has 1 to " + std::to_string(most_gauss_points) + " points, not " + std::to_string(s));
  }
  if constexpr (std::is_floating_point_v<R>) {
    static const std::vector<GaussRule<R>> rules = [] {
      std::vector<GaussRule<R>> all(1);
      for (int k = 1; k <= most_gauss_points; ++k) {
        if constexpr (std::is_same_v<R, double>) {
          // Computed in Wide and rounded once.
          all.push_back(detail::rounded<double>(detail::make_gauss_rule<Wide>(k)));
        } else {
          all.push_back(detail::make_gauss_rule<R>(k));
        }
      }
      return all;
    }();
    return rules[static_cast<std::size_t>(s)];
  } else {  // in slow arithmetics made on first use; runs keep the address
    static thread_local std::map<std::pair<long, int>, GaussRule<R>> rules;
    const std::pair<long, int> key{precision_in_use<R>(), s};
    const auto found = rules.find(key);
    if (found != rules.end()) return found->second;
    return rules.emplace(key, detail::make_gauss_rule<R>(s)).first->second;
  }
}

}  // namespace hamflow
