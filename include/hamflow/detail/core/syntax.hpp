// A formula, or a number that people write as one, as it stands in the text: what belongs to what, before names have a
// meaning.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hamflow/detail/core/operation.hpp"

namespace hamflow {

/// One construct; `a`, `b`, `c` are others, by their places in Syntax::parts. An operand stands before what is made of
/// it.
struct SyntaxPart {
  enum class Kind {
    number,
    pi,
    name,       // word, perhaps [a], then perhaps b: the rest of the name
    operation,  // operation of a and perhaps b
    let,        // word = a in b
    sum         // of c for word from a to b
  };
  Kind kind;
  Operation op = Operation::number;
  std::string_view word{};  // of a number its digits
  int a = -1;
  int b = -1;
  int c = -1;
  std::size_t at = 0;     // of its operator or first character: errors point there
  std::size_t begin = 0;  // [begin, end): all of it
  std::size_t end = 0;
};

struct Syntax {
  std::string_view text;
  std::vector<SyntaxPart> parts{};
  int root = -1;

  const SyntaxPart& operator[](int i) const { return parts[static_cast<std::size_t>(i)]; }
  std::string shown_part(const SyntaxPart& part) const;
  /// @throws Error always: the operand b of a division is 0
  [[noreturn]] void refuse_division_by_zero(const SyntaxPart& division) const;
  /// @throws Error always: a value is infinite, or not a number
  [[noreturn]] void refuse_value(const SyntaxPart& part, bool infinite) const;
};

/// What a text may hold.
struct SyntaxRules {
  bool only_numbers = false;  // no names, let and sum
  std::size_t characters;
  std::size_t operations;
  std::span<const std::string> names{};  // for proposals only
  std::string_view what = "names";       // what the names are, in messages
};

/// The grammar:
///     expression := 'let' word '=' expression (',' word '=' expression)* 'in' expression | sum
///     sum        := product (('+'|'-') product)*
///     product    := unary (('*'|'/') unary)*
///     unary      := ('+'|'-') unary | power
///     power      := atom (('^'|'**') unary)?
/// At most 200 signs, powers, parentheses, sums and let are nested.   @throws Error where the text is no formula
Syntax read_syntax(std::string_view text, const SyntaxRules& rules);

/// How deep an expression may be nested.
inline constexpr int deepest_expression = 200;
/// Words that mean something in every formula.
bool is_keyword(std::string_view word);
/// Whether a word begins one of the names: x of "x", "x[1]".
bool names_something(std::span<const std::string> names, std::string_view word);
/// Why something cannot be called `name`: it is a function, `let`, `in`, `sum`, `pi`, `t`, or no word. Empty if it can.
std::string refused_formula_name(const std::string& name);

}  // namespace hamflow
