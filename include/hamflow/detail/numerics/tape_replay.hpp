// Repeats a recording (detail/core/tape.hpp) in another number type, mainly slopes (detail/numerics/slope.hpp), so that
// a problem does not need functions of that type.
#pragma once

#include <cstddef>

#include "hamflow/core/vector.hpp"
#include "hamflow/detail/core/tape.hpp"
#include "hamflow/detail/numerics/slope.hpp"

namespace hamflow {

/// Computes the values of all nodes from the inputs, which are the first nodes.
/// @param nodes one for each node of the tape @return whether its guards hold at both ends; else the values are invalid
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
      case Operation::symbol:
        break;
      case Operation::number:
        out = c();
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
      case Operation::square:
        out = square(a());
        break;
      case Operation::invert:
        out = c() / a();
        break;
      case Operation::power_constant:
        out = pow(a(), tape.constants[static_cast<std::size_t>(node.constant)]);
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
      default:
        out = applied(node.operation, a(), takes_two(node.operation) ? b() : a());
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
