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
};

/// "PATH=a:b:n", n numbers from a to b, both included; or "PATH=v1,v2,...", commas in parentheses, brackets and quotes
/// do not split. @throws Error naming what was found and what is allowed
Vary parse_vary(const std::string& text);

/// A value as it was given, without the quotes of a TOML string: 1/3, not '1/3'.
std::string without_quotes(const std::string& text);

/// The number of members: the product of the numbers of values. @throws Error when there are too many
std::size_t member_count(const std::vector<Vary>& varied);
/// Which value of each key a member has; the last key changes fastest.
std::vector<std::size_t> values_of_member(const std::vector<Vary>& varied, std::size_t member);

}  // namespace hamflow
