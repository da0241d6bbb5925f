// A recording (core/tape.hpp) repeated in numbers of another type: slopes above all (numerics/slope.hpp), so that a
// problem needs no functions of that type.
#pragma once

#include <cstddef>

#include "hamflow/core/tape.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/numerics/slope.hpp"

namespace hamflow {

namespace detail {
/// As formula/operations.hpp has them for recordings.
template <class S>
Slope<S> arcsine(const Slope<S>& x) {
  const Slope<S> one(S(base_scalar<S>(1)));
  return atan(x / sqrt((one - x) * (one + x)));
}
template <class S>
Slope<S> arccosine(const Slope<S>& x) {
  const Slope<S> one(S(base_scalar<S>(1)));
  return (one + one) * atan(sqrt((one - x) / (one + x)));
}
template <class S>
Slope<S> angle_of(const Slope<S>& y, const Slope<S>& x) {
  const Slope<S> two(S(base_scalar<S>(2)));
  const Slope<S> r = sqrt(square(x) + square(y));
  if (value_of(x.first) < base_scalar<S>(0)) return two * atan((r - x) / y);
  return two * atan(y / (r + x));
}
}  // namespace detail

/// The values of all nodes at the inputs, which the first of them hold already.
/// @param nodes as many as the tape has   @return whether its guards hold at both ends; the values are of no use else
template <class R, class S>
bool replay(const Tape<R>& tape, Vector<Slope<S>, dynamic>& nodes) {
  using Number = Slope<S>;
  for (std::size_t i = tape.inputs; i < tape.nodes.size(); ++i) {
    const TapeNode& node = tape.nodes[i];
    const auto a = [&]() -> const Number& { return nodes[static_cast<std::size_t>(node.a)]; };
    const auto b = [&]() -> const Number& { return nodes[static_cast<std::size_t>(node.b)]; };
    const auto c = [&] { return Number(S(tape.constants[static_cast<std::size_t>(node.constant)])); };
    Number& out = nodes[i];
    switch (node.operation) {
      case Operation::input:
        break;
      case Operation::constant:
        out = c();
        break;
      case Operation::add:
        out = a() + b();
        break;
      case Operation::subtract:
        out = a() - b();
        break;
      case Operation::negate:
        out = -a();
        break;
      case Operation::add_constant:
        out = a() + c();
        break;
      case Operation::scale:
        out = a() * c();
        break;
      case Operation::divide_constant:
        out = a() / c();
        break;
      case Operation::multiply:
        out = a() * b();
        break;
      case Operation::square:
        out = square(a());
        break;
      case Operation::divide:
        out = a() / b();
        break;
      case Operation::invert:
        out = c() / a();
        break;
      case Operation::square_root:
        out = sqrt(a());
        break;
      case Operation::exponential:
        out = exp(a());
        break;
      case Operation::logarithm:
        out = log(a());
        break;
      case Operation::sine:
        out = sin(a());
        break;
      case Operation::cosine:
        out = cos(a());
        break;
      case Operation::sinh:
        out = sinh(a());
        break;
      case Operation::cosh:
        out = cosh(a());
        break;
      case Operation::tangent:
        out = tan(a());
        break;
      case Operation::tanh:
        out = tanh(a());
        break;
      case Operation::arctangent:
        out = atan(a());
        break;
      case Operation::power:
        out = pow(a(), tape.constants[static_cast<std::size_t>(node.constant)]);
        break;
      case Operation::absolute:
        out = abs(a());
        break;
      case Operation::larger:
        out = (a() + b() + abs(a() - b())) / Number(S(base_scalar<S>(2)));
        break;
      case Operation::choose: {
        const auto zero = base_scalar<S>(0);
        const bool first = zero < value_of(a().first);
        if (first != (zero < value_of(a().last))) return false;
        out = first ? b() : nodes[static_cast<std::size_t>(node.c)];
        break;
      }
      case Operation::arcsine:
        out = detail::arcsine(a());
        break;
      case Operation::arccosine:
        out = detail::arccosine(a());
        break;
      case Operation::arctangent2:
        out = detail::angle_of(a(), b());
        break;
      case Operation::power_of_two:
        out = exp(b() * log(a()));
        break;
    }
  }
  for (const auto& guard : tape.guards) {
    const Number& x = nodes[static_cast<std::size_t>(guard.node)];
    for (const auto& end : {value_of(x.first), value_of(x.last)}) {
      using Relation = typename Tape<R>::Relation;
      const bool now = guard.relation == Relation::equal  ? end <= guard.value && guard.value <= end
                       : guard.relation == Relation::less ? end < guard.value
                                                          : end > guard.value;
      if (now != guard.holds) return false;
    }
  }
  return true;
}

}  // namespace hamflow
