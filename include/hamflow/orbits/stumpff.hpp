// The functions of universal variables: G_k(s) = s^k c_k(beta s^2), k = 0..3, with Stumpff's
//     c_k(x) = 1/k! - x/(k + 2)! + x^2/(k + 4)! - ...,                                        [Danby1988, Sect. 6.9]
// dG_k/ds = G_(k-1), dG_0/ds = -beta G_1. They are smooth in beta: one set of formulas holds for ellipses (beta > 0),
// parabolas and hyperbolas, without loss of accuracy near the parabola.
#pragma once

#include <limits>
#include <vector>

#include "hamflow/core/math.hpp"
#include "hamflow/core/number.hpp"

namespace hamflow {

/// G_0 ... G_3 at one s.
template <class R>
struct UniversalFunctions {
  R g0;
  R g1;
  R g2;
  R g3;
};

namespace detail {

/// 2 pi. It is computed only once for types with a fixed number of digits.
template <class R>
R full_turn() {
  if constexpr (std::numeric_limits<R>::digits > 0) {
    static const R turn = R(2) * pi_value<R>();
    return turn;
  } else {
    return R(2) * pi_value<R>();
  }
}

/// 1/2!, 1/3!, ...: the coefficients that the series of c_2 and c_3 need for |x| <= 1.
template <class R>
std::vector<R> inverse_factorials() {
  std::vector<R> found;
  R factorial(1);
  for (int k = 2; factorial * std::numeric_limits<R>::epsilon() < R(1); ++k) {
    factorial *= R(k);
    found.push_back(R(1) / factorial);
  }
  if (found.size() % 2 == 1) found.pop_back();  // a term of c_2 and one of c_3 belong together
  return found;
}

/// c_2(x) and c_3(x) for |x| <= 1.
template <class R>
void stumpff_series(const R& x, R& c2, R& c3) {
  const auto sum = [&](const std::vector<R>& inverse) {
    c2 = R(0);
    c3 = R(0);
    for (std::size_t k = inverse.size(); k > 0; k -= 2) {
      c2 = inverse[k - 2] - x * c2;
      c3 = inverse[k - 1] - x * c3;
    }
  };
  if constexpr (std::numeric_limits<R>::digits > 0) {
    static const std::vector<R> inverse = inverse_factorials<R>();
    sum(inverse);
  } else {  // the digits are chosen at run time
    sum(inverse_factorials<R>());
  }
}

}  // namespace detail

/// y - sin y, to the relative precision of y.
template <class R>
R angle_minus_sine(const R& y) {
  if (R(1) < abs(y)) return y - sin(y);
  R c2;
  R c3;
  detail::stumpff_series<R>(y * y, c2, c3);
  return y * y * y * c3;
}

/// sinh y - y, to the relative precision of y.
template <class R>
R sinh_minus_angle(const R& y) {
  if (R(1) < abs(y)) return sinh(y) - y;
  R c2;
  R c3;
  detail::stumpff_series<R>(-(y * y), c2, c3);
  return y * y * y * c3;
}

/// The inverse of sinh, to the relative precision of x.
template <class R>
R inverse_sinh(const R& x) {
  const R root = sqrt(R(1) + x * x);
  const R first = x < R(0) ? -log(root - x) : log(x + root);
  if (!(abs(x) < R(1))) return first;
  return first - (sinh(first) - x) / root;  // the logarithm lost digits of a small value; one Newton step restores them
}
inline double inverse_sinh(double x) { return std::asinh(x); }
inline long double inverse_sinh(long double x) { return std::asinh(x); }

/// G_0 ... G_3 at s. Ellipses: |s| sqrt(beta) at most a few revolutions.
template <class R>
UniversalFunctions<R> universal_functions(const R& beta, const R& s) {
  const R x = beta * s * s;
  if (abs(x) <= R(1)) {
    R c2;
    R c3;
    detail::stumpff_series(x, c2, c3);
    const R g2 = s * s * c2;
    const R g3 = s * s * s * c3;
    return {R(1) - beta * g2, s - beta * g3, g2, g3};
  }
  if (R(0) < beta) {
    const R root = sqrt(beta);
    const R y = root * s;
    const R half_sine = sin(y / R(2));
    const R sine = R(2) * half_sine * cos(y / R(2));
    const R versine = R(2) * half_sine * half_sine;
    return {R(1) - versine, sine / root, versine / beta, (y - sine) / (beta * root)};
  }
  const R root = sqrt(-beta);
  const R y = root * s;
  const R half_sine = sinh(y / R(2));
  const R sine = sinh(y);
  const R square = half_sine * half_sine;
  return {R(1) + R(2) * square, sine / root, R(2) * square / -beta, (sine - y) / (-beta * root)};
}

}  // namespace hamflow
