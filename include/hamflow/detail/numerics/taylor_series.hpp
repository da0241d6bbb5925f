// Taylor coefficients of the solution of z' = f(z), with f recorded on a tape. They follow one after the other: the
// coefficients of z up to k give those of all nodes up to k, and z_(k+1) = f_k/(k + 1). Each node costs O(k).
// [JorbaZou2005, Prop. 2.1; GriewankWalther2008, tables 13.1, 13.2]
//
// Time is in units chosen by the caller: z(t0 + s unit) = sum_k z_k s^k.
#pragma once

#include <cstddef>
#include <type_traits>

#include "hamflow/core/stop_question.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/detail/core/tape.hpp"

namespace hamflow {

namespace detail {

/// sum_{j=first}^{last} a[j] b[k - j]. Four parallel sums, because a single sum would be a chain of dependent
/// additions.
template <class R>
R convolution(const R* a, const R* b, std::size_t k, std::size_t first, std::size_t last) {
  if (last + 1 < first + 4) {
    R sum(0);
    for (std::size_t j = first; j <= last; ++j) sum = sum + a[j] * b[k - j];
    return sum;
  }
  R sum0 = a[first] * b[k - first];
  R sum1 = a[first + 1] * b[k - first - 1];
  R sum2 = a[first + 2] * b[k - first - 2];
  R sum3 = a[first + 3] * b[k - first - 3];
  std::size_t j = first + 4;
  for (; j + 3 <= last; j += 4) {
    sum0 = sum0 + a[j] * b[k - j];
    sum1 = sum1 + a[j + 1] * b[k - j - 1];
    sum2 = sum2 + a[j + 2] * b[k - j - 2];
    sum3 = sum3 + a[j + 3] * b[k - j - 3];
  }
  for (; j <= last; ++j) sum0 = sum0 + a[j] * b[k - j];
  return (sum0 + sum1) + (sum2 + sum3);
}
/// sum_{j=first}^{last} j a[j] b[k - j].
template <class R>
R weighted_convolution(const R* a, const R* b, std::size_t k, std::size_t first, std::size_t last) {
  R sum(0);
  for (std::size_t j = first; j <= last; ++j) sum = sum + R(static_cast<int>(j)) * a[j] * b[k - j];
  return sum;
}
/// sum_{j=first}^{k-first} a[j] a[k - j], each product once.
template <class R>
R self_convolution(const R* a, std::size_t k, std::size_t first) {
  const std::size_t half = (k + 1) / 2;  // the first j that is not below k - j
  R sum(0);
  if (half > first) sum = R(2) * convolution(a, a, k, first, half - 1);
  if (k % 2 == 0 && k / 2 >= first) sum = sum + a[k / 2] * a[k / 2];
  return sum;
}

}  // namespace detail

/// @tparam R the numbers of the state, those of the tape or dual numbers over them
template <class R>
class TaylorSeries {
 public:
  using Constant = base_scalar<R>;

  /// Room for coefficients 0..order of every node.
  void resize(const Tape<Constant>& tape, std::size_t order) {
    width_ = order + 1;
    if (coefficients_.size() != tape.nodes.size() * width_)
      coefficients_ = Vector<R, dynamic>(tape.nodes.size() * width_);
  }
  /// The coefficients of a node.
  R* of(int node) { return coefficients_.begin() + static_cast<std::size_t>(node) * width_; }
  const R* of(int node) const { return coefficients_.begin() + static_cast<std::size_t>(node) * width_; }

  /// Coefficients 1..order of the inputs, from their coefficients 0. f_i is output i.
  /// In many digits it may be stopped (StopQuestion); the coefficients are then incomplete.
  /// @return false, with nothing computed, if a guard of the tape does not hold at this state
  template <class U>
  bool solve(const Tape<Constant>& tape, std::size_t order, const U& unit) {
    for (std::size_t k = 0; k < order; ++k) {
      if (!std::is_floating_point_v<Constant> && StopQuestion::stop_requested()) return true;
      for (std::size_t i = tape.inputs; i < tape.nodes.size(); ++i) extend(tape, static_cast<int>(i), k);
      if (k == 0 && !guards_hold(tape)) return false;
      for (std::size_t i = 0; i < tape.inputs; ++i) {
        of(static_cast<int>(i))[k + 1] = unit * of(tape.outputs[i])[k] / R(static_cast<int>(k + 1));
      }
    }
    return true;
  }

  /// Coefficient k of one node, from those up to k of its operands.
  void extend(const Tape<Constant>& tape, int node, std::size_t k) {
    const TapeNode& n = tape.nodes[static_cast<std::size_t>(node)];
    R* const y = of(node);
    const R* const a = of(n.a < 0 ? 0 : n.a);
    const R* const b = of(n.b < 0 ? 0 : n.b);
    const auto constant = [&]() -> const Constant& { return tape.constants[static_cast<std::size_t>(n.constant)]; };
    const R whole = R(static_cast<int>(k));
    switch (n.operation) {
      case Operation::symbol:
        break;
      case Operation::number:
        y[k] = k == 0 ? R(constant()) : R(0);
        break;
      case Operation::add:
        y[k] = a[k] + b[k];
        break;
      case Operation::subtract:
        y[k] = a[k] - b[k];
        break;
      case Operation::negate:
        y[k] = -a[k];
        break;
      case Operation::add_constant:
        y[k] = k == 0 ? R(a[0] + constant()) : a[k];
        break;
      case Operation::scale:
        y[k] = a[k] * constant();
        break;
      case Operation::divide_constant:
        y[k] = a[k] / constant();
        break;
      case Operation::multiply:
        y[k] = detail::convolution(a, b, k, 0, k);
        break;
      case Operation::square:
        y[k] = detail::self_convolution(a, k, 0);
        break;
      case Operation::divide:  // y b = a
        y[k] = k == 0 ? R(a[0] / b[0]) : R((a[k] - detail::convolution(b, y, k, 1, k)) / b[0]);
        break;
      case Operation::invert:  // y a = c
        y[k] = k == 0 ? R(constant() / a[0]) : R(-detail::convolution(a, y, k, 1, k) / a[0]);
        break;
      case Operation::sqrt:  // y^2 = a
        y[k] = k == 0 ? R(sqrt(a[0])) : R((a[k] - detail::self_convolution(y, k, 1)) / (R(2) * y[0]));
        break;
      case Operation::exp:  // y' = a' y
        y[k] = k == 0 ? R(exp(a[0])) : R(detail::weighted_convolution(a, y, k, 1, k) / whole);
        break;
      case Operation::log:  // a y' = a'
        y[k] = k == 0 ? R(log(a[0])) : R((a[k] - detail::weighted_convolution(y, a, k, 1, k - 1) / whole) / a[0]);
        break;
      case Operation::sin:  // y' = a' b, b = cos a
        y[k] = k == 0 ? R(sin(a[0])) : R(detail::weighted_convolution(a, b, k, 1, k) / whole);
        break;
      case Operation::cos:  // y' = -a' b, b = sin a
        y[k] = k == 0 ? R(cos(a[0])) : R(-detail::weighted_convolution(a, b, k, 1, k) / whole);
        break;
      case Operation::sinh:
        y[k] = k == 0 ? R(sinh(a[0])) : R(detail::weighted_convolution(a, b, k, 1, k) / whole);
        break;
      case Operation::cosh:
        y[k] = k == 0 ? R(cosh(a[0])) : R(detail::weighted_convolution(a, b, k, 1, k) / whole);
        break;
      case Operation::tan:  // y' = a' (1 + b), b = y^2
        y[k] = k == 0 ? R(tan(a[0])) : R(a[k] + detail::weighted_convolution(a, b, k, 1, k) / whole);
        break;
      case Operation::tanh:  // y' = a' (1 - b), b = y^2
        y[k] = k == 0 ? R(tanh(a[0])) : R(a[k] - detail::weighted_convolution(a, b, k, 1, k) / whole);
        break;
      case Operation::atan:  // (1 + b) y' = a', b = a^2
        y[k] = k == 0 ? R(atan(a[0]))
                      : R((a[k] - detail::weighted_convolution(y, b, k, 1, k - 1) / whole) / (R(1) + b[0]));
        break;
      case Operation::power_constant:
        y[k] = k == 0 ? R(pow(a[0], constant())) : power(a, y, constant(), k);
        break;
      default:  // exact recordings, and functions without known coefficients
        Trace<Constant>::refuse();
    }
  }

 private:
  /// a y' = c a' y:  k a_0 y_k = sum_{j=1}^{k} (c j - (k - j)) a_j y_{k-j}.
  static R power(const R* a, const R* y, const Constant& c, std::size_t k) {
    R sum(0);
    for (std::size_t j = 1; j <= k; ++j) {
      sum = sum + (c * Constant(static_cast<int>(j)) - Constant(static_cast<int>(k - j))) * a[j] * y[k - j];
    }
    return sum / (R(static_cast<int>(k)) * a[0]);
  }
  bool guards_hold(const Tape<Constant>& tape) const {
    for (const auto& guard : tape.guards) {
      const Constant now = value_of(of(guard.node)[0]);
      if ((now <= guard.value && guard.value <= now) != guard.holds) return false;
    }
    return true;
  }

  std::size_t width_ = 0;
  Vector<R, dynamic> coefficients_;
};

}  // namespace hamflow
