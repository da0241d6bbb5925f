// A formula as it stands in the text: what belongs to what, before names have a meaning.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hamflow/formula/formula.hpp"

namespace hamflow::formula {

/// One construct; `a`, `b`, `c` are others, by their places in Syntax::parts.
struct Part {
  enum class Kind {
    number,
    pi,
    name,       // word, perhaps [a], then perhaps b: the rest of the name
    operation,  // op of a and perhaps b
    let,        // word = a in b
    sum         // of c for word from a to b
  };
  Kind kind;
  Op op = Op::number;
  std::string_view word{};
  int a = -1;
  int b = -1;
  int c = -1;
  std::size_t at = 0;     // of its operator or first character: errors point there
  std::size_t begin = 0;  // [begin, end): all of it
  std::size_t end = 0;
};

struct Syntax {
  std::string_view text;
  std::vector<Part> parts;
  int root = -1;

  const Part& operator[](int i) const { return parts[static_cast<std::size_t>(i)]; }
  std::string shown_part(const Part& part) const;
};

/// @param symbols for proposals only   @throws Error where the text is no formula
Syntax read_syntax(std::string_view text, const FormulaSymbols& symbols);

/// Words that mean something in every formula.
bool is_keyword(std::string_view word);
const Op* find_function(std::string_view word);
/// Whether a word begins one of the names: x of "x", "x[1]".
bool names_something(const FormulaSymbols& symbols, std::string_view word);

}  // namespace hamflow::formula
