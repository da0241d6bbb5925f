// **The graph of an expression** has one node for each different operation. Nodes are found by their operation and
// operands, so that equal parts share a node. They are numbered in the order of their first appearance, so that no
// order depends on addresses.
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
  int a = -1;  // operands; for a number its index in texts(), for a symbol its index
  int b = -1;
  friend bool operator==(const Node&, const Node&) = default;
};

class Graph {
 public:
  /// Returns the node with these operands. Makes it if it does not exist.
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
