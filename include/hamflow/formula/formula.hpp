// **Formulas as text**: "p^2/(2*m) + k*(1 - cos(q))" is parsed to a graph, which can be evaluated in any number type.
// The grammar has + - * / ^ ** (^ associates to the right, -x^2 = -(x^2)), the functions sqrt exp log sin cos tan asin
// acos atan atan2 sinh cosh tanh abs, pi or Pi, parentheses, names, and
//     let r = sqrt(x^2 + y^2), u = 1/r in ...     names for repeated parts
//     sum(i, 1, n - 1, (x[i+1] - x[i])^2)         sums; an index is a whole number from i, numbers and parameters
// A text is parsed and never executed as code; it can use only the values that it names. Every error has the column,
// what was found, what is allowed, and the nearest name (src/core/text_place.hpp).
#pragma once

#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hamflow/detail/formula/code.hpp"

namespace hamflow {

/// The names that a formula may use.
struct FormulaSymbols {
  /// The names, in the order of their values: "x", "x[1]" (an entry of a list), "problem.initial.q[1]" (a key), "t"
  /// (time).
  std::vector<std::string> names;
  /// Names with a value that is known when the formula is parsed. Whole values may be used in indices and limits of
  /// sums; constant parts of a formula must be finite with these values.
  std::map<std::string, double> known{};
  /// Word for the names in messages.
  std::string what = "names";
};

/// Limits of the length of a formula.
struct FormulaLimits {
  static constexpr std::size_t characters = 100'000;
  static constexpr std::size_t terms = 300'000;  // operations, counting all terms of sums
  static constexpr int nodes = 200'000;          // different operations
};

/// **Formula**: a parsed expression with one value. Copies share it.
class Formula {
 public:
  Formula();
  Formula(std::shared_ptr<const formula::Graph> graph, int root, std::size_t symbols);

  /// Evaluates the formula. @param values one for each name, in their order   @tparam S any number type
  template <class S>
  S evaluate(std::span<const S> values) const {
    using R = base_number<S>;
    return evaluate(formula::BoundCode<R>(code_, [](int) { return R(0); }), values);
  }
  /// Evaluates the formula at many states: call `bind<R>()` once, which evaluates the constants, then this.
  template <class R>
  formula::BoundCode<R> bind() const {
    return formula::BoundCode<R>(code_, [](int) { return R(0); });
  }
  template <class R, class S>
  static S evaluate(const formula::BoundCode<R>& bound, std::span<const S> values) {
    S result{};
    bound.template run<S>([&](int symbol) -> const S& { return values[static_cast<std::size_t>(symbol)]; },
                          [&](std::size_t, const S& value) { result = value; });
    return result;
  }

  /// The numbers of the names that occur.
  const std::vector<int>& symbols() const { return code_->symbols; }
  bool uses(int symbol) const;
  const formula::Graph& graph() const { return *graph_; }
  int root() const { return root_; }

 private:
  template <class S>
  struct BaseNumber {
    using type = base_scalar<S>;
  };
  template <class R>
  struct BaseNumber<Trace<R>> {
    using type = R;
  };
  template <class S>
  using base_number = typename BaseNumber<S>::type;

  std::shared_ptr<const formula::Graph> graph_;
  int root_ = -1;
  std::shared_ptr<const formula::Code> code_;
};

/// @throws Error with the column of a syntax error or of a constant part that is not finite
Formula parse_formula(std::string_view text, const FormulaSymbols& symbols);

namespace formula {
/// Parses into a graph that may already have other expressions of the same symbols. @return its node
/// @param whole receives the known names whose values were needed for indices and limits of sums
int read_into(Graph& graph, std::string_view text, const FormulaSymbols& symbols,
              std::set<std::string>* whole = nullptr);
}  // namespace formula

}  // namespace hamflow
