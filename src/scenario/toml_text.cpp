#include "toml_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

#include "hamflow/core/number.hpp"
#include "hamflow/core/text.hpp"

namespace hamflow {

namespace {

/// Returns the keys in the order of the file, followed by new ones.
std::vector<std::pair<std::string, const toml::node*>> in_order(const toml::table& table) {
  std::vector<std::pair<toml::source_position, std::pair<std::string, const toml::node*>>> placed;
  for (const auto& [key, node] : table) {
    toml::source_position at = key.source().begin;
    if (at.line == 0) at.line = std::numeric_limits<toml::source_index>::max();
    placed.push_back({at, {std::string(key.str()), &node}});
  }
  std::stable_sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::pair<std::string, const toml::node*>> all;
  all.reserve(placed.size());
  for (const auto& entry : placed) all.push_back(entry.second);
  return all;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += std::string("\\") + c;
    } else if (byte < 0x20 || byte == 0x7f) {
      constexpr const char* digits = "0123456789abcdef";
      out += std::string("\\u00") + digits[byte >> 4] + digits[byte & 15];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string key_text(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  return bare ? key : quoted(key);
}

/// Writes a value on one line. The printer of toml++ would write 0.1 as 0.10000000000000001.
std::string value_text(const toml::node& node) {
  std::string text;
  if (const auto* table = node.as_table()) {
    for (const auto& [key, value] : in_order(*table))
      text += (text.empty() ? " " : ", ") + key_text(key) + " = " + value_text(*value);
    return "{" + text + (text.empty() ? "}" : " }");
  }
  if (const auto* array = node.as_array()) {
    return "[" + joined(*array, value_text) + "]";
  }
  if (const auto* string = node.as_string()) return quoted(string->get());
  if (const auto* real = node.as_floating_point(); real != nullptr && std::isfinite(real->get())) {
    text = shortest(real->get());
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
  }
  std::ostringstream out;
  node.visit([&](const auto& plain) {
    if constexpr (toml::is_value<decltype(plain)>) out << plain;
  });
  return out.str();
}

}  // namespace

std::string toml_text(const toml::table& root) {
  std::vector<std::string> order{"problem", "method", "run", "output"};
  for (const auto& [key, node] : root) {
    const std::string name(key.str());
    if (std::find(order.begin(), order.end(), name) == order.end()) order.push_back(name);
  }
  std::string out;
  for (const std::string& name : order) {
    const toml::node* node = root.get(name);
    if (node == nullptr) continue;
    const toml::table* section = node->as_table();
    if (section == nullptr) {  // does not occur in a valid scenario
      out += key_text(name) + " = " + value_text(*node) + "\n";
      continue;
    }
    out += (out.empty() ? "[" : "\n[") + key_text(name) + "]\n";
    for (const auto& [key, value] : in_order(*section)) out += key_text(key) + " = " + value_text(*value) + "\n";
  }
  return out;
}

}  // namespace hamflow
