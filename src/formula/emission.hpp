// **Operations from normal forms**, in an order that rounds and costs as what a person would write:
//   - Constants are multiplied together first, and meet what is not constant once. 1/m is a constant.
//   - A term is its constant times functions and groups over their powers in the denominator, then times its
//     coordinates: k/(u sqrt u) is shared by the x and y of a central force. Powers are products and square roots.
//   - A sum in one base alone is nested (Horner): x (alpha + x^2 beta); if all its powers are negative and whole, it is
//   a
//     polynomial in 1/x^g: 12 (i6 i6 - i6)/x.
//   - Other sums are added up as they were typed, terms of equal degree in the coordinates together, common factors
//     before them: q2 + lambda (q1^2 - q2^2).
// With these rules the forces of the built-in problems come out with the bits of their hand-written functions
// (tests/unit/formula_bits_test.cpp says which).
#pragma once

#include "form.hpp"

namespace hamflow::formula {

/// A node, or its negative.
struct Signed {
  int node;
  bool negative = false;
};

class Emission {
 public:
  /// @param out receives the operations; symbols keep their numbers
  Emission(Forms& forms, Graph& out) : forms_(forms), out_(out) {}

  /// The value of a form. @param negated its negative
  int value(int form, bool negated = false);
  /// The same multiplied by a symbol, which meets its constants: only for a form of one term.
  int scaled_value(int form, int symbol, bool negated = false);

 private:
  using Terms = std::vector<Term>;
  struct Coefficient {
    int node = -1;             // none: 1
    std::int64_t divisor = 1;  // of what it is multiplied with
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

  /// base^exponent for a positive exponent.
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
