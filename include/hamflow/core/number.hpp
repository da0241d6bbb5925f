// **Numbers as people write them**: "0.1", "1/3", "2*pi/100", read in any arithmetic to its full precision. The text is
// read once, without an arithmetic (detail/core/syntax.hpp); its operations are then carried out in R.
//
// Every error has the form
//     found "2*pi/0", column 5: 2*pi divided by 0; allowed a divisor other than 0
//     found "1 + sinus(2)", column 5: the unknown function sinus; allowed sqrt, exp, ...; did you mean sin?
// so that a reader of options can put the name of the option in front of it. Columns count characters from 1.
#pragma once

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "hamflow/core/error.hpp"
#include "hamflow/core/math.hpp"
#include "hamflow/detail/core/operation.hpp"
#include "hamflow/detail/core/syntax.hpp"

namespace hamflow {

/// The nearest R to a decimal literal.
template <class R>
R parse_decimal(std::string_view text);
template <>
inline double parse_decimal<double>(std::string_view text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [behind, error] = std::from_chars(text.data(), end, value);
  if (error == std::errc() && behind == end) return value;
  return std::strtod(std::string(text).c_str(), nullptr);  // from_chars refuses numbers that round to 0 or to infinity
}
template <>
inline long double parse_decimal<long double>(std::string_view text) {
  return std::strtold(std::string(text).c_str(), nullptr);
}

/// pi in R; types with more digits bring their own.
template <class R>
R pi_value() {
  return parse_decimal<R>("3.14159265358979323846264338327950288419716939937510582097494459");
}

/// Whether a text is one decimal literal, as most numbers are.
bool is_literal(std::string_view text);

/// The value of a formula of numbers in R: + - * / ^ ** (^ to the right, -x^2 = -(x^2)), pi or Pi, parentheses, and the
/// functions sqrt exp log sin cos tan asin acos atan atan2 sinh cosh tanh abs. At most 10^6 characters, 10^4
/// operations, and 200 nested signs, powers and parentheses.
/// @throws Error with the column of a syntax error, a division by zero, or a value that is not a finite real number in
/// R
template <class R>
R evaluate_number(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (is_literal(text.substr(negative ? 1 : 0))) {
    const R value = parse_decimal<R>(text.substr(negative ? 1 : 0));
    if (abs(value) <= std::numeric_limits<R>::max()) return negative ? R(-value) : value;
  }
  const Syntax syntax = read_syntax(text, {.only_numbers = true, .characters = 1'000'000, .operations = 10'000});
  std::vector<R> stack;
  for (const SyntaxPart& part : syntax.parts) {
    if (part.kind == SyntaxPart::Kind::number) {
      stack.push_back(parse_decimal<R>(part.word));
    } else if (part.kind == SyntaxPart::Kind::pi) {
      stack.push_back(pi_value<R>());
    } else {
      R second{};
      if (takes_two(part.op)) {
        second = stack.back();
        stack.pop_back();
        if (part.op == Operation::divide && second == R(0)) syntax.refuse_division_by_zero(part);
      }
      stack.back() = applied<R>(part.op, stack.back(), second);
    }
    const R& value = stack.back();
    if (!(abs(value) <= std::numeric_limits<R>::max())) syntax.refuse_value(part, value == value);
  }
  return stack.back();
}
// Compiled once, in src/core/number.cpp.
extern template double evaluate_number<double>(std::string_view);
extern template long double evaluate_number<long double>(std::string_view);

/// The whole number that a formula gives: "1e6", "10^6" and "2*500" are whole numbers.
/// @throws Error as evaluate_number does, and if the value is not whole or exceeds 2^53 in size, the limit up to which
/// a double holds every whole number
std::int64_t evaluate_whole(std::string_view text);

/// The shortest decimal that reads back as the same double.
std::string shortest(double x);

}  // namespace hamflow
