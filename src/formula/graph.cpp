#include "hamflow/detail/formula/graph.hpp"

namespace hamflow::formula {

int Graph::node(Op op, int a, int b) {
  const auto key =
      (static_cast<std::uint64_t>(static_cast<std::uint32_t>(a)) << 32U | static_cast<std::uint32_t>(b)) * 31 +
      static_cast<std::uint64_t>(op);
  std::vector<int>& same_key = known_[key];
  const Node wanted{op, a, b};
  for (const int i : same_key) {
    if ((*this)[i] == wanted) return i;
  }
  same_key.push_back(size());
  nodes_.push_back(wanted);
  return size() - 1;
}

int Graph::number(std::string_view text) {
  const auto [at, is_new] = known_texts_.emplace(std::string(text), static_cast<int>(texts_.size()));
  if (is_new) texts_.emplace_back(text);
  return node(Op::number, at->second);
}

}  // namespace hamflow::formula
