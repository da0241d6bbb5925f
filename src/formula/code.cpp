#include "hamflow/detail/formula/code.hpp"

#include <cstdlib>

namespace hamflow::formula {

namespace {

/// Returns the exponent if it is a whole number or a negated one, so that the power is a product.
std::optional<int> whole_exponent(const Graph& graph, int exponent) {
  const bool negated = graph[exponent].op == Op::negate;
  const Node& n = graph[negated ? graph[exponent].a : exponent];
  if (n.op != Op::number) return std::nullopt;
  const double value = std::strtod(graph.text(n).c_str(), nullptr);
  if (!(value >= 0 && value <= largest_whole_power)) return std::nullopt;
  const int whole = static_cast<int>(value);
  if (static_cast<double>(whole) < value) return std::nullopt;
  return negated ? -whole : whole;
}

}  // namespace

Code code_of(const Graph& graph, std::span<const int> outputs, const std::vector<bool>& fixed) {
  const auto size = static_cast<std::size_t>(graph.size());
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  // Operands come before their operations. A backward pass finds the nodes that are needed, a forward pass the
  // constants.
  std::vector<bool> needed(size);
  std::vector<std::optional<int>> whole(size);
  for (const int output : outputs) needed[at(output)] = true;
  for (int i = graph.size() - 1; i >= 0; --i) {
    const Node& n = graph[i];
    if (!needed[at(i)] || is_leaf(n.op)) continue;
    needed[at(n.a)] = true;
    if (n.op == Op::power) whole[at(i)] = whole_exponent(graph, n.b);
    if (n.b >= 0 && !whole[at(i)]) needed[at(n.b)] = true;
  }
  std::vector<bool> constant(size);
  for (int i = 0; i < graph.size(); ++i) {
    const Node& n = graph[i];
    constant[at(i)] = n.op == Op::number || n.op == Op::pi || (n.op == Op::symbol && fixed.at(at(n.a))) ||
                      (!is_leaf(n.op) && constant[at(n.a)] && (n.b < 0 || whole[at(i)] || constant[at(n.b)]));
  }

  Code code;
  std::vector<int> place(size, -1);
  int next = 0;
  const auto step_of = [&](int i) {
    const Node& n = graph[i];
    CodeStep step{n.op, place[at(n.a)], n.b < 0 || whole[at(i)] ? -1 : place[at(n.b)]};
    if (whole[at(i)]) step.whole = *whole[at(i)];
    return step;
  };
  using Kind = Code::Constant::Kind;
  for (int i = 0; i < graph.size(); ++i) {
    if (!needed[at(i)] || !constant[at(i)]) continue;
    const Node& n = graph[i];
    place[at(i)] = next++;
    if (n.op == Op::number) {
      code.constants.push_back({.kind = Kind::number, .text = graph.text(n)});
    } else if (n.op == Op::pi) {
      code.constants.push_back({.kind = Kind::pi});
    } else if (n.op == Op::symbol) {
      code.constants.push_back({.kind = Kind::symbol, .symbol = n.a});
    } else {
      code.constants.push_back({.kind = Kind::result, .step = step_of(i)});
    }
  }
  for (int i = 0; i < graph.size(); ++i) {
    if (!needed[at(i)] || constant[at(i)] || graph[i].op != Op::symbol) continue;
    place[at(i)] = next++;
    code.symbols.push_back(graph[i].a);
  }
  for (int i = 0; i < graph.size(); ++i) {
    if (!needed[at(i)] || constant[at(i)] || graph[i].op == Op::symbol) continue;
    place[at(i)] = next++;
    code.steps.push_back(step_of(i));
  }
  for (const int output : outputs) code.outputs.push_back(place[at(output)]);
  return code;
}

}  // namespace hamflow::formula
