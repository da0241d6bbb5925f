#include "hamflow/scenario/value.hpp"

#include <toml++/toml.h>

#include "toml_depth.hpp"
#include "toml_text.hpp"

namespace hamflow {

namespace {

void fill(toml::table& to, const Value::Table& from, int depth);

/// Calls add with the value as TOML has it.
template <class Add>
void give(const Value& value, int depth, const Add& add) {
  if (depth > most_nested_brackets) throw Error("the scenario has lists or tables that are nested too deep");
  std::visit(
      [&]<class T>(const T& x) {
        if constexpr (std::is_same_v<T, Value::List>) {
          toml::array list;
          for (const Value& entry : x) give(entry, depth + 1, [&](auto&& one) { list.push_back(one); });
          add(list);
        } else if constexpr (std::is_same_v<T, Value::Table>) {
          toml::table table;
          fill(table, x, depth + 1);
          add(table);
        } else {
          add(x);
        }
      },
      value.content);
}

void fill(toml::table& to, const Value::Table& from, int depth) {
  for (const auto& [key, value] : from) {
    if (to.contains(key)) throw Error("the scenario has the key " + key + " twice");
    give(value, depth, [&, name = key](auto&& one) { to.insert(name, one); });
  }
}

}  // namespace

std::string scenario_text(const Value::Table& tree) {
  toml::table root;
  fill(root, tree, 0);
  return toml_text(root);
}

Reading read_scenario_tree(const Value::Table& tree, const std::string& name) {
  return read_scenario_text(scenario_text(tree), name, {});
}

}  // namespace hamflow
