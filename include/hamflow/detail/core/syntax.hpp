// The syntax tree of a formula, or of a number written as a formula, before names are resolved.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hamflow/detail/core/operation.hpp"

namespace hamflow {

/// A node of the syntax tree; `a`, `b`, `c` are indices of other nodes in Syntax::parts. Operands come before their
/// operation.
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
  std::string_view word{};  // for a number its digits
  int a = -1;
  int b = -1;
  int c = -1;
  std::size_t at = 0;     // position of its operator or first character, shown in errors
  std::size_t begin = 0;  // [begin, end): the whole part of the text
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
  /// @throws Error always: a value is infinite or NaN
  [[noreturn]] void refuse_value(const SyntaxPart& part, bool infinite) const;
};

/// The optional parts of the grammar that a text may contain.
struct SyntaxRules {
  bool only_numbers = false;  // no names, let and sum
  std::size_t characters;
  std::size_t operations;
  std::span<const std::string> names{};  // known names, for proposals only
  std::string_view what = "names";       // word for the names in messages
};

/// The grammar:
///     expression := 'let' word '=' expression (',' word '=' expression)* 'in' expression | sum
///     sum        := product (('+'|'-') product)*
///     product    := unary (('*'|'/') unary)*
///     unary      := ('+'|'-') unary | power
///     power      := atom (('^'|'**') unary)?
/// At most 200 signs, powers, parentheses, sums and let are nested. @throws Error if the text is not a formula
Syntax read_syntax(std::string_view text, const SyntaxRules& rules);

/// The largest depth of nested expressions.
inline constexpr int deepest_expression = 200;
/// Whether the word is reserved in formulas.
bool is_keyword(std::string_view word);
/// Whether the word is one of the names or the part of it before an index: x of "x", "x[1]".
bool names_something(std::span<const std::string> names, std::string_view word);
/// Why `name` cannot be used as a name: it is a function, `let`, `in`, `sum`, `pi`, `t`, or not a word. Empty if it
/// can.
std::string refused_formula_name(const std::string& name);

}  // namespace hamflow
