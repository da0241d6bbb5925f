// A scenario as a tree of values, for programs that have numbers and lists instead of text.
#pragma once

#include <concepts>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// A value of TOML: a boolean, a whole number, a number, a text, a list, or a table.
struct Value {
  using List = std::vector<Value>;
  using Table = std::vector<std::pair<std::string, Value>>;
  std::variant<bool, std::int64_t, double, std::string, List, Table> content;

  Value(bool x) : content(x) {}  // NOLINT: implicit, so that a tree can be written as plain values
  template <std::integral I>
  Value(I x) : content(static_cast<std::int64_t>(x)) {}                                         // NOLINT
  Value(double x) : content(x) {}                                                               // NOLINT
  Value(const char* text) : content(std::string(text)) {}                                       // NOLINT
  Value(std::string text) : content(std::move(text)) {}                                         // NOLINT
  Value(List list) : content(std::move(list)) {}                                                // NOLINT
  Value(Table table) : content(std::move(table)) {}                                             // NOLINT
  Value(const std::vector<double>& numbers) : content(List(numbers.begin(), numbers.end())) {}  // NOLINT
};

/// Returns the TOML text of a scenario. Numbers have the fewest digits that read back exactly.
/// @throws Error if a key occurs twice, or lists and tables are nested deeper than a scenario allows
std::string scenario_text(const Value::Table& tree);

/// A problem with its parameters, but without a start.
struct ChosenProblem {
  std::shared_ptr<const ProblemEntry> entry{};
  std::map<std::string, std::string> variant{};
  Texts parameters{};  // all parameters of the problem
};
/// Reads the problem of a table [problem]. The start may be missing.
/// @throws Rejection if other keys are wrong
ChosenProblem read_problem_tree(const Value::Table& problem);

/// Reads a scenario from a tree. The complaints of the result list all errors; the text of the scenario is
/// scenario_text(tree).
Reading read_scenario_tree(const Value::Table& tree, const std::string& name);

}  // namespace hamflow
