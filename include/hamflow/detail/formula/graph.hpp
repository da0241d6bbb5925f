// **The graph of an expression**: operations as nodes, each once. A node is found again by what it is made of, so that
// equal parts are one node, numbered in the order in which they were first met: no address decides about an order.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "hamflow/detail/core/operation.hpp"

namespace hamflow::formula {

using Op = Operation;

struct Node {
  Op op;
  int a = -1;  // operands; of a number its place in texts(), of a symbol its number
  int b = -1;
  friend bool operator==(const Node&, const Node&) = default;
};

class Graph {
 public:
  /// The node with these operands, made if there is none.
  int node(Op op, int a = -1, int b = -1);
  /// @param text a decimal number without a sign
  int number(std::string_view text);
  int symbol(int index) { return node(Op::symbol, index); }

  const Node& operator[](int i) const { return nodes_[static_cast<std::size_t>(i)]; }
  int size() const { return static_cast<int>(nodes_.size()); }
  const std::string& text(const Node& number) const { return texts_[static_cast<std::size_t>(number.a)]; }

 private:
  std::vector<Node> nodes_;
  std::vector<std::string> texts_;
  std::unordered_map<std::uint64_t, std::vector<int>> known_;
  std::unordered_map<std::string, int> known_texts_;
};

}  // namespace hamflow::formula
