// Differences of functions without cancellation. A number that changes from x(0) to x(t) carries both values and its
// slope
//     s = (x(t) - x(0))/t,   x'(0) at t = 0,
// so that t itself is not needed. A function has the slope f[x(0), x(t)] s with its divided difference
//     f[a, b] = (f(b) - f(a))/(b - a),   f[a, a] = f'(a),
// for which each elementary function has a formula that rounds like f': sqrt[a, b] = 1/(sqrt a + sqrt b), for example.
// [KrawczykNeumaier1985] The change of an energy in a step, and its limit for a vanishing step, then have only the
// rounding of the changes of its terms; the difference of two energies would have the rounding of the energy.
#pragma once

#include "hamflow/core/dual.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/detail/core/operation.hpp"

namespace hamflow {

namespace detail {

/// sum_k c_k x^k with c_0 = 1, c_k = ratio(k) c_(k-1), for |x| < 1.
template <class S, class Ratio>
S power_series(const S& x, const Ratio& ratio) {
  using R = base_scalar<S>;
  S term(R(1));
  S sum(R(1));
  for (int k = 1; k < 1000; ++k) {
    term = term * (x * ratio(R(k)));
    sum = sum + term;
    if (abs(value_of(term)) <= std::numeric_limits<R>::epsilon() / R(64)) break;
  }
  return sum;
}
template <class S>
bool is_small(const S& x, double bound) {
  return abs(value_of(x)) <= base_scalar<S>(bound);
}

/// sin(x)/x.
template <class S>
S sine_quotient(const S& x) {
  using R = base_scalar<S>;
  if (!is_small(x, 1)) return sin(x) / x;
  return power_series(S(x * x), [](const R& k) { return R(-1) / (R(2) * k * (R(2) * k + R(1))); });
}
/// sinh(x)/x.
template <class S>
S sinh_quotient(const S& x) {
  using R = base_scalar<S>;
  if (!is_small(x, 1)) return sinh(x) / x;
  return power_series(S(x * x), [](const R& k) { return R(1) / (R(2) * k * (R(2) * k + R(1))); });
}
/// artanh(x)/x for |x| <= 1/4, with sign = -1 arctan(x)/x.
template <class S>
S artanh_quotient(const S& x, int sign) {
  using R = base_scalar<S>;
  return power_series(S(x * x), [&](const R& k) { return R(sign) * (R(2) * k - R(1)) / (R(2) * k + R(1)); });
}

// Divided differences.
template <class S>
S difference_of_exp(const S& a, const S& b) {
  const S half = (b - a) / base_scalar<S>(2);
  if (!is_small(half, 1)) return (exp(b) - exp(a)) / (b - a);
  return exp(a + half) * sinh_quotient(half);
}
template <class S>
S difference_of_log(const S& a, const S& b) {
  const S sum = a + b;
  const S x = (b - a) / sum;
  if (!is_small(x, 0.25)) return (log(b) - log(a)) / (b - a);
  return base_scalar<S>(2) * artanh_quotient(x, 1) / sum;
}
template <class S>
S difference_of_atan(const S& a, const S& b) {
  using R = base_scalar<S>;
  const S product = R(1) + a * b;
  const S x = (b - a) / product;
  if (value_of(product) > R(0) && is_small(x, 0.25)) return artanh_quotient(x, -1) / product;
  return (atan(b) - atan(a)) / (b - a);
}
template <class S>
S difference_of_tanh(const S& a, const S& b) {
  if (!is_small(S(b - a), 1)) return (tanh(b) - tanh(a)) / (b - a);
  return sinh_quotient(S(b - a)) / (cosh(a) * cosh(b));
}
}  // namespace detail

/// A number and its slope. @tparam S any number type, also dual numbers
template <class S>
struct Slope {
  S first{};  // x(0)
  S last{};   // x(t)
  S slope{};

  Slope() = default;
  explicit Slope(const S& constant) : first(constant), last(constant), slope(base_scalar<S>(0)) {}
  Slope(const S& from, const S& to, const S& s) : first(from), last(to), slope(s) {}

  friend Slope operator+(const Slope& a, const Slope& b) {
    return {a.first + b.first, a.last + b.last, a.slope + b.slope};
  }
  friend Slope operator-(const Slope& a, const Slope& b) {
    return {a.first - b.first, a.last - b.last, a.slope - b.slope};
  }
  friend Slope operator-(const Slope& a) { return {-a.first, -a.last, -a.slope}; }
  friend Slope operator*(const Slope& a, const Slope& b) {
    return {a.first * b.first, a.last * b.last, a.slope * b.last + a.first * b.slope};
  }
  friend Slope operator/(const Slope& a, const Slope& b) {
    const S quotient = a.first / b.first;
    return {quotient, a.last / b.last, (a.slope - quotient * b.slope) / b.last};
  }
};

namespace detail {
/// f(x) with the divided difference of f.
template <class S>
Slope<S> follow(const Slope<S>& x, const S& first, const S& last, const S& difference) {
  return {first, last, difference * x.slope};
}
}  // namespace detail

template <class S>
Slope<S> square(const Slope<S>& x) {
  return detail::follow(x, S(x.first * x.first), S(x.last * x.last), S(x.first + x.last));
}
template <class S>
Slope<S> sqrt(const Slope<S>& x) {
  const S a = sqrt(x.first);
  const S b = sqrt(x.last);
  return detail::follow(x, a, b, S(base_scalar<S>(1) / (a + b)));
}
template <class S>
Slope<S> exp(const Slope<S>& x) {
  return detail::follow(x, S(exp(x.first)), S(exp(x.last)), detail::difference_of_exp(x.first, x.last));
}
template <class S>
Slope<S> log(const Slope<S>& x) {
  return detail::follow(x, S(log(x.first)), S(log(x.last)), detail::difference_of_log(x.first, x.last));
}
template <class S>
Slope<S> sin(const Slope<S>& x) {
  const S half = (x.last - x.first) / base_scalar<S>(2);
  return detail::follow(x, S(sin(x.first)), S(sin(x.last)), S(cos(x.first + half) * detail::sine_quotient(half)));
}
template <class S>
Slope<S> cos(const Slope<S>& x) {
  const S half = (x.last - x.first) / base_scalar<S>(2);
  return detail::follow(x, S(cos(x.first)), S(cos(x.last)), S(-sin(x.first + half) * detail::sine_quotient(half)));
}
template <class S>
Slope<S> tan(const Slope<S>& x) {
  const S difference = detail::sine_quotient(S(x.last - x.first)) / (cos(x.first) * cos(x.last));
  return detail::follow(x, S(tan(x.first)), S(tan(x.last)), difference);
}
template <class S>
Slope<S> sinh(const Slope<S>& x) {
  const S half = (x.last - x.first) / base_scalar<S>(2);
  return detail::follow(x, S(sinh(x.first)), S(sinh(x.last)), S(cosh(x.first + half) * detail::sinh_quotient(half)));
}
template <class S>
Slope<S> cosh(const Slope<S>& x) {
  const S half = (x.last - x.first) / base_scalar<S>(2);
  return detail::follow(x, S(cosh(x.first)), S(cosh(x.last)), S(sinh(x.first + half) * detail::sinh_quotient(half)));
}
template <class S>
Slope<S> tanh(const Slope<S>& x) {
  return detail::follow(x, S(tanh(x.first)), S(tanh(x.last)), detail::difference_of_tanh(x.first, x.last));
}
template <class S>
Slope<S> atan(const Slope<S>& x) {
  return detail::follow(x, S(atan(x.first)), S(atan(x.last)), detail::difference_of_atan(x.first, x.last));
}
template <class S>
Slope<S> asin(const Slope<S>& x) {
  const Slope<S> one(S(base_scalar<S>(1)));
  return atan(x / sqrt((one - x) * (one + x)));
}
template <class S>
Slope<S> acos(const Slope<S>& x) {
  const Slope<S> one(S(base_scalar<S>(1)));
  return (one + one) * atan(sqrt((one - x) / (one + x)));
}
/// The angle of (x, y), by the half-angle formula without cancellation at x(0).
template <class S>
Slope<S> atan2(const Slope<S>& y, const Slope<S>& x) {
  const Slope<S> two(S(base_scalar<S>(2)));
  const Slope<S> r = sqrt(square(x) + square(y));
  if (value_of(x.first) < base_scalar<S>(0)) return two * atan((r - x) / y);
  return two * atan(y / (r + x));
}
/// x^y, x > 0.
template <class S>
Slope<S> pow(const Slope<S>& x, const Slope<S>& y) {
  return exp(y * log(x));
}
/// 0 at 0, where |x| has no derivative.
template <class S>
Slope<S> abs(const Slope<S>& x) {
  using R = base_scalar<S>;
  const S a = abs(x.first);
  const S b = abs(x.last);
  const S sum = a + b;
  return detail::follow(x, a, b, value_of(sum) > R(0) ? S((x.first + x.last) / sum) : S(R(0)));
}
/// x^c for a constant c: whole powers are products, others those of x > 0.
template <class S>
Slope<S> pow(const Slope<S>& x, const base_scalar<S>& c) {
  using R = base_scalar<S>;
  const double near = static_cast<double>(c);
  const int whole = near >= -64 && near <= 64 ? static_cast<int>(near) : 0;
  if (c <= R(whole) && R(whole) <= c) {
    Slope<S> product(S(R(1)));
    for (int k = 0; k < (whole < 0 ? -whole : whole); ++k) product = product * x;
    return whole < 0 ? Slope<S>(S(R(1))) / product : product;
  }
  const Slope<S> exponent = Slope<S>(S(c)) * log(x);
  return {pow(x.first, c), pow(x.last, c), exp(exponent).slope};
}

/// Functions that are not defined above have no divided difference.
#define HAMFLOW_SLOPE_OF_known(name)
#define HAMFLOW_SLOPE_OF_unknown(name)                                                                      \
  template <class S>                                                                                        \
  Slope<S> name(const Slope<S>&) {                                                                          \
    throw Error("found " #name                                                                              \
                " in a Hamiltonian; allowed with this method functions whose divided difference is known"); \
  }
#define HAMFLOW_SLOPE_OF(name, symmetry, rule, series) HAMFLOW_SLOPE_OF_##series(name)
HAMFLOW_FUNCTIONS(HAMFLOW_SLOPE_OF)
#undef HAMFLOW_SLOPE_OF
#undef HAMFLOW_SLOPE_OF_unknown
#undef HAMFLOW_SLOPE_OF_known

}  // namespace hamflow
