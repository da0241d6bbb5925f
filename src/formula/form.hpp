// **Normal forms.** A form is a sum of terms; a term is a fraction times powers of bases. A base is a symbol, a
// constant that is not a short fraction, a function of forms, or a sum in parentheses (a group). Equal forms are stored
// once. Terms and factors keep the order in which they were typed, and products of sums are not expanded. Forms have
// derivatives, know the symbols on which they depend, and are translated to operations (emission.hpp).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "hamflow/detail/formula/graph.hpp"
#include "rational.hpp"

namespace hamflow::formula {

struct Factor {
  int base;
  Rational exponent;
};

struct Term {
  Rational c{1, 1};
  std::vector<Factor> factors{};
};

struct Form {
  std::vector<Term> terms;
};

struct Base {
  enum class Kind { symbol, number, pi, function, group, power };
  Kind kind;
  Op op = Op::number;  // the function, if it is one
  int a = -1;          // a symbol, the node of a constant, or the form of an argument, a group or the base of a power
  int b = -1;          // the form of a second argument or of the exponent of a power
  std::vector<int> variables{};  // the varying symbols on which it depends, in order
};

/// The forms of the expressions in a graph.
class Forms {
 public:
  /// @param fixed for each symbol, whether it is constant   @param longest limit for the number of factors in all forms
  Forms(const Graph& graph, std::vector<bool> fixed, std::size_t longest);

  /// Returns the form of a node of the graph.
  int of_node(int node);
  /// Returns the derivative of a form with respect to a symbol.
  int derivative(int form, int symbol);

  int zero() { return constant({0, 1}); }
  int constant(const Rational& c) { return intern({{Term{c, {}}}}); }
  int symbol(int index) { return of_base(base({Base::Kind::symbol, Op::symbol, index, -1, {}})); }
  int sum(const std::vector<int>& forms);
  int product(int x, int y);
  int scaled(const Rational& c, int form) { return product(constant(c), form); }
  int power(int x, const Rational& exponent);
  int difference(int x, int y) { return sum({x, scaled({-1, 1}, y)}); }
  int function(Op op, int x, int y = -1);
  /// Returns the form of a sum of terms.
  int of_terms(std::vector<Term> terms) { return intern({std::move(terms)}); }

  const Form& operator[](int form) const { return forms_[static_cast<std::size_t>(form)]; }
  const Base& base_at(int i) const { return bases_[static_cast<std::size_t>(i)]; }
  bool is_zero(int form) const { return (*this)[form].terms.empty(); }
  const std::vector<int>& variables(int form) const { return variables_[static_cast<std::size_t>(form)]; }
  bool depends(int form, int symbol) const;
  bool is_constant(int form) const { return variables(form).empty(); }
  bool is_constant(const Factor& factor) const { return base_at(factor.base).variables.empty(); }
  const Graph& graph() const { return graph_; }

 private:
  int intern(Form form);
  int base(Base base);
  int of_base(int base, Rational exponent = {1, 1}) { return intern({{Term{{1, 1}, {{base, exponent}}}}}); }
  int made(int node);
  std::vector<std::pair<int, bool>> summands(int node) const;
  int of_number(int node);
  /// Returns a form as a single term: its only term, or a group. @param with_content whether common factors are
  /// extracted
  Term as_term(int form, bool with_content);
  Term product(const Term& a, const Term& b);
  int general_power(int x, int exponent);
  int derivative_of_base(int base, int symbol);

  const Graph& graph_;
  std::vector<bool> fixed_;
  std::size_t size_left_;
  int depth_ = 0;
  std::vector<Form> forms_;
  std::vector<std::vector<int>> variables_;
  std::unordered_map<std::string, int> known_forms_;
  std::vector<Base> bases_;
  std::map<std::vector<int>, int> known_bases_;
  std::unordered_map<int, int> of_nodes_;
  std::map<std::pair<int, int>, int> derivatives_;
  std::map<std::pair<int, int>, int> base_derivatives_;
};

/// Returns a key that is equal for terms with equal factors.
std::string key_of(const Term& term);

}  // namespace hamflow::formula
