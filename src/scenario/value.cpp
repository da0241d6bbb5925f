#include "hamflow/scenario/value.hpp"

#include <toml++/toml.h>

#include <algorithm>

#include "hamflow/core/complaint.hpp"
#include "scenario_reader.hpp"
#include "toml_depth.hpp"
#include "toml_text.hpp"

namespace hamflow {

namespace {

toml::table table_of(const Value::Table& from, int depth);
toml::array list_of(const Value::List& from, int depth);

/// Calls `put` with the value as a TOML value.
template <class Put>
void give(const Value& value, int depth, const Put& put) {
  if (depth > most_nested_brackets) throw Error("the scenario has lists or tables that are nested too deeply");
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

ChosenProblem read_problem_tree(const Value::Table& problem) {
  std::vector<Complaint> complaints;
  const auto document = parsed_document(scenario_text(Value::Table{{"problem", problem}}), "problem", {}, complaints);
  Scenario scenario;
  if (document) scenario = ScenarioReader(*document, "problem", complaints).read_problem_alone();
  const auto is_given = [&](const std::string& key) {
    return std::any_of(problem.begin(), problem.end(), [&](const auto& entry) { return entry.first == key; });
  };
  std::erase_if(complaints, [&](const Complaint& complaint) {  // the start is not needed here
    for (const std::string key : {"initial", "orbit", "bodies", "case"}) {
      if (complaint.key.starts_with("problem." + key) && !is_given(key)) return true;
    }
    return false;
  });
  if (!complaints.empty()) throw Rejection(std::move(complaints));
  if (scenario.problem == nullptr) throw Error("the keys of [problem] are not sufficient to choose a problem");
  return {scenario.problem, scenario.request.variant, scenario.request.parameters};
}

Reading read_scenario_tree(const Value::Table& tree, const std::string& name) {
  return read_scenario_text(scenario_text(tree), name, {});
}

}  // namespace hamflow
