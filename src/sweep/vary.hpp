// A key of the scenario that a sweep varies, and its values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hamflow {

/// Equidistant numbers, which are computed when they are asked for: a range of a million texts takes time and memory,
/// and a shard needs few of them.
struct ValueRange {
  double first = 0;
  double last = 0;
  std::size_t count = 0;
  std::string first_text;  // the ends as --set accepts them
  std::string last_text;

  /// Both ends are exact. Values of whole numbers stay whole, for keys that only accept whole numbers.
  double number(std::size_t i) const;
  std::string text(std::size_t i) const;
};

struct Vary {
  std::string path;                   // dotted path such as problem.initial.q[0]
  std::vector<std::string> texts;     // values of a list PATH=v1,v2,... as --set accepts them
  std::vector<double> numbers;        // the same as numbers; empty if one of them is not a number
  std::optional<ValueRange> range{};  // the values of PATH=a:b:n
  std::string formula{};              // a formula of other varied keys, in place of values; empty: there is none

  bool is_list() const { return !range && formula.empty(); }
  bool is_number() const { return range || !numbers.empty() || !formula.empty(); }
  /// Number of values; 0 for a formula.
  std::size_t count() const { return range ? range->count : texts.size(); }
  std::string text(std::size_t i) const { return range ? range->text(i) : texts[i]; }
  double number(std::size_t i) const { return range ? range->number(i) : numbers[i]; }
};

/// A path of the scenario that a text contains, such as problem.initial.q[1], and its position.
struct NamedPath {
  std::string path;
  std::size_t at = 0;
};
/// Returns the paths in a formula; empty if a value contains none.
std::vector<NamedPath> paths_in(const std::string& formula);

/// Parses "PATH=a:b:n", n numbers from a to b inclusive; "PATH=v1,v2,...", where commas in parentheses, brackets and
/// quotes do not separate; or "PATH=FORMULA" with paths of other keys. @throws Error that says what was found and what
/// is allowed
Vary parse_vary(const std::string& text);

/// Returns the number of values of a range "PATH=a:b:n", without making them; 1 for other texts and for refused ranges.
std::size_t count_of_range(const std::string& text);

/// Returns a value without the quotes of a TOML string: 1/3 for '1/3'.
std::string without_quotes(const std::string& text);

}  // namespace hamflow
