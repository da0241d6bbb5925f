#include "hamflow/scenario/value.hpp"

#include <toml++/toml.h>

#include "toml_depth.hpp"
#include "toml_text.hpp"

namespace hamflow {

namespace {

toml::table table_of(const Value::Table& from, int depth);
toml::array list_of(const Value::List& from, int depth);

/// Calls put with the value as TOML has it.
template <class Put>
void give(const Value& value, int depth, const Put& put) {
  if (depth > most_nested_brackets) throw Error("the scenario has lists or tables that are nested too deep");
  std::visit(
      [&]<class T>(const T& x) {
        if constexpr (std::is_same_v<T, Value::List>) {
          put(list_of(x, depth + 1));
        } else if constexpr (std::is_same_v<T, Value::Table>) {
          put(table_of(x, depth + 1));
        } else {
          put(x);
        }
      },
      value.content);
}

toml::array list_of(const Value::List& from, int depth) {
  toml::array list;
  for (const Value& value : from) give(value, depth, [&](const auto& one) { list.push_back(one); });
  return list;
}

toml::table table_of(const Value::Table& from, int depth) {
  toml::table table;
  for (const auto& [key, value] : from) {
    if (table.contains(key)) throw Error("the scenario has the key " + key + " twice");
    give(value, depth, [&, name = key](const auto& one) { table.insert(name, one); });
  }
  return table;
}

}  // namespace

std::string scenario_text(const Value::Table& tree) { return toml_text(table_of(tree, 0)); }

Reading read_scenario_tree(const Value::Table& tree, const std::string& name) {
  return read_scenario_text(scenario_text(tree), name, {});
}

}  // namespace hamflow
