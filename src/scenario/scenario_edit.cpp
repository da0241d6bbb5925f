#include "scenario_edit.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

#include "hamflow/core/number.hpp"

namespace hamflow {

namespace {

toml::table value_of(const std::string& text) {
  toml::table parsed;
  try {
    parsed = toml::parse("value = " + text);
  } catch (const toml::parse_error&) {
    parsed.clear();
  }
  if (parsed.size() != 1) {
    parsed.clear();
    parsed.insert_or_assign("value", text);
  }
  return parsed;
}

void apply(toml::table& root, const ScenarioEdit& edit) {
  toml::table* table = &root;
  std::string rest = edit.path;
  for (auto dot = rest.find('.'); dot != std::string::npos; dot = rest.find('.')) {
    const std::string head = rest.substr(0, dot);
    if (!table->contains(head)) table->insert(head, toml::table{});
    table = table->get(head)->as_table();
    if (table == nullptr) return;  // not in a scenario that can be read
    rest = rest.substr(dot + 1);
  }
  if (!edit.value) {
    table->erase(rest);
  } else {
    const toml::table value = value_of(*edit.value);
    table->insert_or_assign(rest, *value.get("value"));
  }
}

}  // namespace

std::vector<std::string> sets_of(const std::string& text) {
  const std::string mark = "# --set ";
  std::vector<std::string> sets;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(mark)) sets.push_back(line.substr(mark.size()));
  }
  return sets;
}

std::string edited_scenario(const std::string& text, const std::vector<ScenarioEdit>& edits) {
  toml::table root = toml::parse(text);
  for (const std::string& set : sets_of(text)) {
    const auto equals = set.find('=');
    apply(root, {set.substr(0, equals), set.substr(equals + 1)});
  }
  for (const ScenarioEdit& edit : edits) apply(root, edit);
  // In the order in which scenarios are written; a table itself would come out sorted by name.
  std::vector<std::string> order{"problem", "method", "run", "output"};
  for (const auto& [key, node] : root) {
    const std::string name(key.str());
    if (std::find(order.begin(), order.end(), name) == order.end()) order.push_back(name);
  }
  std::ostringstream out;
  for (const std::string& name : order) {
    const toml::node* node = root.get(name);
    if (node == nullptr) continue;
    toml::table one;
    one.insert_or_assign(name, *node);
    if (toml::table* section = one.get(name)->as_table()) section->is_inline(false);
    out << (out.tellp() > 0 ? "\n" : "") << one << '\n';
  }
  return out.str();
}

std::string toml_list(const std::vector<double>& numbers) {
  std::string text;
  for (const double x : numbers) text += (text.empty() ? "" : ", ") + shortest(x);
  return "[" + text + "]";
}

}  // namespace hamflow
