// **Operations from normal forms.** The order of operations rounds and costs as a person would write them:
//   - Constants are multiplied with each other first, then once with the rest of a term. 1/m is a constant.
//   - A term is its constant times functions and groups, divided by those in the denominator, then times its
//     coordinates. The x and y components of a central force share k/(u sqrt u). Powers are products and square roots.
//   - A sum of powers of one base is nested (Horner's scheme): x (alpha + x^2 beta). If all its powers are negative
//     and whole, it is a polynomial in 1/x^g: 12 (i6 i6 - i6)/x.
//   - Other sums are added in the order in which they were typed. Terms of equal degree in the coordinates are added
//     together, with common factors before them: q2 + lambda (q1^2 - q2^2).
// With these rules the forces of many built-in problems have the bits of their hand-written functions;
// tests/unit/formula_bits_test.cpp lists them.
#pragma once

#include "form.hpp"

namespace hamflow::formula {

/// A node or its negative.
struct Signed {
  int node;
  bool negative = false;
};

class Emission {
 public:
  /// @param out receives the operations; symbols keep their numbers
  Emission(Forms& forms, Graph& out) : forms_(forms), out_(out) {}

  /// Emits the value of a form. @param negated whether to emit its negative instead
  int value(int form, bool negated = false);
  /// Emits a form times a symbol, which is multiplied with the constants first. Only for forms with one term.
  int scaled_value(int form, int symbol, bool negated = false);

 private:
  using Terms = std::vector<Term>;
  struct Coefficient {
    int node = -1;             // -1: the factor is 1
    std::int64_t divisor = 1;  // a divisor of the rest of the term
    bool negative = false;
  };

  Signed of_form(int form);
  Signed of_sum(const Terms& terms);
  Signed of_term(const Term& term, int inside = -1, int scale = -1);
  Signed of_group(const Terms& terms);
  std::optional<Signed> of_one_base(const Terms& terms);
  Signed nested(int base, const Terms& terms);
  Signed inverse_powers(int base, const Terms& terms);
  Signed added(const std::vector<Signed>& parts);
  Coefficient coefficient(const Term& term);
  Signed times(const Coefficient& c, int node);
  Signed as_node(const Coefficient& c);
  Term extracted(Terms& terms);

  /// Emits base^exponent for a positive exponent.
  Signed power(int base, const Rational& exponent);
  int whole_power(int node, std::int64_t n);
  Signed of_base(int base);
  int plain(const Signed& x) { return x.negative ? out_.node(Op::negate, x.node) : x.node; }
  int number(std::int64_t n) { return out_.number(std::to_string(n)); }
  int product(int a, int b) { return a < 0 ? b : b < 0 ? a : out_.node(Op::multiply, a, b); }
  bool is_variable(int base) const {
    return forms_.base_at(base).kind == Base::Kind::symbol && !forms_.base_at(base).variables.empty();
  }

  Forms& forms_;
  Graph& out_;
  std::unordered_map<int, Signed> known_;
  int depth_ = 0;
};

}  // namespace hamflow::formula
