// What the operations of a formula do in every number type: numbers of any precision, dual numbers, recordings.
#pragma once

#include "hamflow/core/dual.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/tape.hpp"
#include "hamflow/formula/graph.hpp"

namespace hamflow::formula {

template <class S>
struct IsTrace : std::false_type {};
template <class R>
struct IsTrace<Trace<R>> : std::true_type {};
/// Neither dual nor recorded.
template <class S>
inline constexpr bool is_plain = !IsDual<S>::value && !IsTrace<S>::value;

/// A constant as a number of type S, through any nesting of dual numbers.
template <class S, class R>
S lifted(const R& x) {
  if constexpr (std::is_same_v<S, R>) {
    return x;
  } else if constexpr (IsDual<S>::value) {
    return S(lifted<decltype(S::value)>(x));
  } else {
    return static_cast<S>(x);
  }
}

/// Whether the operations of an exact recording are those of plain numbers: what is composed of others elsewhere is one
/// of them here, or it would have other last bits.
template <class S>
bool is_exact_recording([[maybe_unused]] const S& x) {
  if constexpr (IsTrace<S>::value) {
    return x.is_exact();
  } else {
    return false;
  }
}

template <class S>
S arcsine(const S& x) {
  if constexpr (is_plain<S>) {
    return asin(x);
  } else {
    if constexpr (IsTrace<S>::value) {
      if (is_exact_recording(x)) return asin(x);
    }
    return atan(x / sqrt((S(1) - x) * (S(1) + x)));
  }
}
template <class S>
S arccosine(const S& x) {
  if constexpr (is_plain<S>) {
    return acos(x);
  } else {
    if constexpr (IsTrace<S>::value) {
      if (is_exact_recording(x)) return acos(x);
    }
    return S(2) * atan(sqrt((S(1) - x) / (S(1) + x)));
  }
}
/// The angle of (x, y). Beside plain numbers it is taken from the quotient that does not cancel.
template <class S>
S angle_of(const S& y, const S& x) {
  if constexpr (is_plain<S>) {
    return atan2(y, x);
  } else if constexpr (IsDual<S>::value) {
    const auto angle = angle_of(y.value, x.value);
    const auto square = x.value * x.value + y.value * y.value;
    S out(angle);
    for (std::size_t k = 0; k < out.slope.size(); ++k) {
      out.slope[k] = (x.value * y.slope[k] - y.value * x.slope[k]) / square;
    }
    return out;
  } else {
    if (is_exact_recording(y) || is_exact_recording(x)) return atan2(y, x);
    using R = decltype(S::value);
    // Either half angle formula; the branch is that of the state at the recording, both are the same function where
    // neither divides by 0. A test for equality tells where the recorded one does: there it is recorded anew.
    const S r = sqrt(x * x + y * y);
    const S sum = r + x;
    if (!(x.value < R(0)) && !(sum == S(0))) return S(2) * atan(y / sum);
    if (y == S(0)) return S(pi_value<R>()) + S(2) * atan(y / (x - r));  // the same, from the other side
    return S(2) * atan((r - x) / y);
  }
}

/// x^n for a whole n, by squaring; n = 0 gives 1.
template <class S>
S whole_power(const S& x, int n) {
  if (n < 0) return S(1) / whole_power(x, -n);
  if (n == 0) return S(1);
  if (n == 1) return x;
  const S half = whole_power(x, n / 2);
  const S even = half * half;
  return n % 2 == 1 ? even * x : even;
}
/// Up to here a whole power is a product.
inline constexpr int largest_whole_power = 64;

/// Whether no derivative is carried.
template <class S>
bool carries_nothing(const S& x) {
  if constexpr (IsDual<S>::value) {
    for (const auto& slope : x.slope) {
      if (!carries_nothing(slope) || !(value_of(slope) == base_scalar<S>(0))) return false;
    }
    return carries_nothing(x.value);
  } else {
    return true;
  }
}

/// x^y, with an exponent that is no constant by way of the logarithm where the number type has no such power.
template <class S>
S any_power(const S& x, const S& y) {
  if constexpr (is_plain<S>) {
    return pow(x, y);
  } else if constexpr (IsTrace<S>::value) {
    if (y.is_constant()) return pow(x, y.value);
    if (is_exact_recording(x) || is_exact_recording(y)) return pow(x, y);
    return exp(y * log(x));
  } else {
    if (carries_nothing(y)) return pow(x, value_of(y));
    return exp(y * log(x));
  }
}

/// The value of one operation.
template <class S>
S applied(Op op, const S& x, const S& y) {
  switch (op) {
    case Op::negate:
      return -x;
    case Op::add:
      return x + y;
    case Op::subtract:
      return x - y;
    case Op::multiply:
      return x * y;
    case Op::divide:
      return x / y;
    case Op::power:
      return any_power(x, y);
    case Op::atan2:
      return angle_of(x, y);
    case Op::sqrt:
      return sqrt(x);
    case Op::exp:
      return exp(x);
    case Op::log:
      return log(x);
    case Op::sin:
      return sin(x);
    case Op::cos:
      return cos(x);
    case Op::tan:
      return tan(x);
    case Op::asin:
      return arcsine(x);
    case Op::acos:
      return arccosine(x);
    case Op::atan:
      return atan(x);
    case Op::sinh:
      return sinh(x);
    case Op::cosh:
      return cosh(x);
    case Op::tanh:
      return tanh(x);
    case Op::abs:
      return abs(x);
    case Op::number:
    case Op::pi:
    case Op::symbol:
      break;
  }
  return x;
}

}  // namespace hamflow::formula
