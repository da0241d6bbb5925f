// **Operations** of formulas, recordings and programs. Formulas are parsed into operations, differentiated, recorded,
// translated into machine code and interpreted; each of these has a rule for every operation, or uses the row of the
// operation.
//
// A function of one number that formulas can name is one row of HAMFLOW_FUNCTIONS, and a function of that name for
// every number type. Its row has
//   name      as in formulas and in C++
//   symmetry  odd: f(-x) = -f(x); even: f(-x) = f(x); neither
//   rule      the derivative: times(slope) multiplies that of x by the slope, over(slope) divides by it. It is written
//             with x, y = f(x) and one, and may call other functions
//   series    known: detail/numerics/taylor_series.hpp and detail/core/tape.hpp compute its Taylor coefficients;
//             unknown: they do not, and methods that need them refuse it
#pragma once

#include <cstdint>
#include <span>
#include <stdexcept>
#include <string_view>

#include "hamflow/core/math.hpp"

namespace hamflow {

#define HAMFLOW_FUNCTIONS(X)                        \
  X(exp, neither, times(y), known)                  \
  X(log, neither, over(x), known)                   \
  X(sin, odd, times(cos(x)), known)                 \
  X(cos, even, times(-sin(x)), known)               \
  X(tan, odd, times(one + y * y), known)            \
  X(asin, odd, over(sqrt(one - x * x)), known)      \
  X(acos, neither, over(-sqrt(one - x * x)), known) \
  X(atan, odd, over(one + x * x), known)            \
  X(sinh, odd, times(cosh(x)), known)               \
  X(cosh, even, times(sinh(x)), known)              \
  X(tanh, odd, times(one - y * y), known)

enum class Operation : std::uint8_t {
  // In formulas and recordings.
  number,  // a decimal text; in a recording a constant
  pi,
  symbol,  // a given value: in a formula by name, in a recording an input
  negate,
  add,
  subtract,
  multiply,
  divide,
  power,  // a^b
  atan2,
  sqrt,  // correctly rounded
#define HAMFLOW_ENUMERATOR(name, symmetry, rule, series) name,
  HAMFLOW_FUNCTIONS(HAMFLOW_ENUMERATOR)
#undef HAMFLOW_ENUMERATOR
      abs,
  // In recordings and programs only.
  larger,  // a < b ? b : a
  choose,  // a > 0 ? b : c
  // In recordings only, with a constant c.
  add_constant,     // a + c
  scale,            // a c
  divide_constant,  // a/c
  square,           // a^2
  invert,           // c/a
  power_constant,   // a^c
  // In machine code only: the sine of a number and, directly after it, its cosine, by one call.
  sine_of_both,
  cosine_of_both,
  // In lanes that form one step together (src/numerics/program_lanes.hpp): broadcasts a from lane number b. a is
  // carried over between lanes unchanged; b is a constant.
  of_lane
};

constexpr bool is_leaf(Operation operation) { return operation <= Operation::symbol; }
/// Whether an operation of formulas has two operands.
constexpr bool takes_two(Operation operation) { return operation >= Operation::add && operation <= Operation::atan2; }

/// Whether it is one of HAMFLOW_FUNCTIONS.
constexpr bool is_listed_function(Operation operation) {
  switch (operation) {
#define HAMFLOW_CASE(name, symmetry, rule, series) case Operation::name:
    HAMFLOW_FUNCTIONS(HAMFLOW_CASE)
#undef HAMFLOW_CASE
    return true;
    default:
      return false;
  }
}

enum class Symmetry : std::uint8_t { neither, odd, even };
/// The symmetry of a function of one number.
constexpr Symmetry symmetry_of(Operation operation) {
  switch (operation) {
#define HAMFLOW_CASE(name, symmetry, rule, series) \
  case Operation::name:                            \
    return Symmetry::symmetry;
    HAMFLOW_FUNCTIONS(HAMFLOW_CASE)
#undef HAMFLOW_CASE
    case Operation::abs:
      return Symmetry::even;
    default:
      return Symmetry::neither;
  }
}

struct NamedFunction {
  std::string_view name;
  Operation operation;
};
/// The functions that formulas can name.
std::span<const NamedFunction> named_functions();
/// Null if no function has that name.
const Operation* find_function(std::string_view name);

/// The factor of the chain rule: the derivative of the argument is multiplied or divided by a number.
template <class Number>
struct DerivativeRule {
  bool divides;
  Number by;
};
/// The chain rule of a listed function y = f(x), for number types with + - * and the functions.
/// @param one the number 1
template <class Number>
DerivativeRule<Number> derivative_rule(Operation function, const Number& x, const Number& y, const Number& one) {
  const auto times = [](const Number& by) { return DerivativeRule<Number>{false, by}; };
  const auto over = [](const Number& by) { return DerivativeRule<Number>{true, by}; };
  switch (function) {
#define HAMFLOW_CASE(name, symmetry, rule, series) \
  case Operation::name:                            \
    return rule;
    HAMFLOW_FUNCTIONS(HAMFLOW_CASE)
#undef HAMFLOW_CASE
    default:
      throw std::logic_error("hamflow: an operation without a row has no rule of its derivative");
  }
}

/// The value of an operation of formulas in any number type. @param y ignored if there is no second operand
template <class S>
S applied(Operation operation, const S& x, const S& y) {
  switch (operation) {
    case Operation::negate:
      return -x;
    case Operation::add:
      return x + y;
    case Operation::subtract:
      return x - y;
    case Operation::multiply:
      return x * y;
    case Operation::divide:
      return x / y;
    case Operation::power:
      return pow(x, y);
    case Operation::atan2:
      return atan2(x, y);
    case Operation::sqrt:
      return sqrt(x);
    case Operation::abs:
      return abs(x);
#define HAMFLOW_CASE(name, symmetry, rule, series) \
  case Operation::name:                            \
    return name(x);
      HAMFLOW_FUNCTIONS(HAMFLOW_CASE)
#undef HAMFLOW_CASE
    default:
      return x;
  }
}

}  // namespace hamflow
