// What a sweep varies: a key of the scenario and the values it takes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hamflow {

struct Vary {
  std::string path;                // dotted, problem.initial.q[0]
  std::vector<std::string> texts;  // values as --set takes them
  std::vector<double> numbers;     // the same as numbers; empty where one of them is none
  bool is_list = false;            // PATH=v1,v2,...
  std::string formula{};           // of other varied keys, in place of values; empty: none

  bool is_number() const { return !numbers.empty() || !formula.empty(); }
};

/// A path of the scenario that a text names, problem.initial.q[1], and where.
struct NamedPath {
  std::string path;
  std::size_t at = 0;
};
/// Those that stand in a formula; empty where a value is none.
std::vector<NamedPath> paths_in(const std::string& formula);

/// "PATH=a:b:n", n numbers from a to b, both included; "PATH=v1,v2,...", commas in parentheses, brackets and quotes
/// do not split; or "PATH=FORMULA" with paths of other keys in it. @throws Error naming what was found and what is
/// allowed
Vary parse_vary(const std::string& text);

/// How many values a range "PATH=a:b:n" has, without making them; 1 for other texts and for ranges that are refused.
std::size_t count_of_range(const std::string& text);

/// A value as it was given, without the quotes of a TOML string: 1/3, not '1/3'.
std::string without_quotes(const std::string& text);

}  // namespace hamflow
