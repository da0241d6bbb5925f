#include "form.hpp"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <limits>

#include "hamflow/core/error.hpp"

namespace hamflow::formula {

namespace {

constexpr int deepest = 1000;  // limit for nested functions

std::vector<int> united(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> all;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

/// Counts the digits of the mantissa from the first to the last one that is not 0.
std::ptrdiff_t significant_digits(const std::string& text) {
  const std::string mantissa = text.substr(0, text.find_first_of("eE"));
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string::npos) return 0;
  const std::string between = mantissa.substr(first, mantissa.find_last_of("123456789") + 1 - first);
  return std::count_if(between.begin(), between.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Converts a decimal text to a fraction if a double represents it exactly: 2, 0.5 and 1e3, but not 0.1.
std::optional<Rational> fraction_of(const std::string& text) {
  const double value = std::strtod(text.c_str(), nullptr);
  double scaled = value;
  std::int64_t down = 1;
  while (scaled <= 0x1p40 && scaled != static_cast<double>(static_cast<std::int64_t>(scaled)) && down < (1 << 20)) {
    scaled *= 2;
    down *= 2;
  }
  if (!(scaled <= 0x1p53) || scaled != static_cast<double>(static_cast<std::int64_t>(scaled))) return std::nullopt;
  const auto found = fraction(static_cast<std::int64_t>(scaled), down);
  // The nearest double of a text such as 0.1 has another value, which the comparison with the nearest long double
  // shows. A text with more digits than a long double has is not converted.
  if (significant_digits(text) > std::numeric_limits<long double>::digits10) return std::nullopt;
  if (!found || std::strtold(text.c_str(), nullptr) != static_cast<long double>(value)) return std::nullopt;
  return found;
}

}  // namespace

std::string key_of(const Term& term) {
  std::vector<std::pair<int, std::string>> sorted;
  for (const Factor& f : term.factors) sorted.emplace_back(f.base, f.exponent.key());
  std::sort(sorted.begin(), sorted.end());
  std::string key;
  for (const auto& [base, exponent] : sorted) key += "b" + std::to_string(base) + "^" + exponent;
  return key;
}

Forms::Forms(const Graph& graph, std::vector<bool> fixed, std::size_t longest)
    : graph_(graph), fixed_(std::move(fixed)), size_left_(longest) {}

bool Forms::depends(int form, int symbol) const {
  const std::vector<int>& all = variables(form);
  return std::binary_search(all.begin(), all.end(), symbol);
}

/// Collects like terms and removes terms that are 0. Returns the number of an equal form if there is one.
int Forms::intern(Form form) {
  Form clean;
  std::unordered_map<std::string, std::size_t> places;
  std::vector<std::string> keys;
  for (Term& term : form.terms) {
    if (term.c.is_zero()) continue;
    std::string key = key_of(term);
    const auto [at, is_new] = places.emplace(key, clean.terms.size());
    if (!is_new) {
      if (const auto total = formula::sum(clean.terms[at->second].c, term.c)) {
        clean.terms[at->second].c = *total;
        continue;
      }
    }
    clean.terms.push_back(std::move(term));
    keys.push_back(std::move(key));
  }
  std::string whole;
  Form kept;
  for (std::size_t i = 0; i < clean.terms.size(); ++i) {
    if (clean.terms[i].c.is_zero()) continue;
    whole += clean.terms[i].c.key() + keys[i] + "+";
    kept.terms.push_back(std::move(clean.terms[i]));
  }
  const auto [at, is_new] = known_forms_.emplace(whole, static_cast<int>(forms_.size()));
  if (!is_new) return at->second;
  std::size_t size = 1;
  for (const Term& term : kept.terms) size += 1 + term.factors.size();
  if (size > size_left_) throw Error("found derivatives that are too long; allowed formulas with shorter derivatives");
  size_left_ -= size;
  std::vector<int> variables;
  for (const Term& term : kept.terms) {
    for (const Factor& f : term.factors) {
      const std::vector<int>& more = base_at(f.base).variables;
      if (!more.empty()) variables = united(variables, more);
    }
  }
  forms_.push_back(std::move(kept));
  variables_.push_back(std::move(variables));
  return at->second;
}

int Forms::base(Base made) {
  const std::vector<int> key{static_cast<int>(made.kind), static_cast<int>(made.op), made.a, made.b};
  const auto [at, is_new] = known_bases_.emplace(key, static_cast<int>(bases_.size()));
  if (!is_new) return at->second;
  if (made.kind == Base::Kind::symbol && !fixed_.at(static_cast<std::size_t>(made.a))) made.variables = {made.a};
  if (made.kind == Base::Kind::function || made.kind == Base::Kind::group || made.kind == Base::Kind::power) {
    made.variables = variables(made.a);
    if (made.b >= 0) made.variables = united(made.variables, variables(made.b));
  }
  bases_.push_back(std::move(made));
  return at->second;
}

Term Forms::product(const Term& a, const Term& b) {
  Term all = a;
  const auto add = [&](const Factor& f) {
    for (Factor& own : all.factors) {
      if (own.base != f.base) continue;
      if (const auto total = formula::sum(own.exponent, f.exponent)) {
        own.exponent = *total;
        return;
      }
    }
    all.factors.push_back(f);
  };
  if (const auto c = formula::product(a.c, b.c)) {
    all.c = *c;
  } else {
    // The product is too long for a fraction, so one factor becomes a separate constant.
    const int form = intern({{Term{b.c, {}}}});
    add({base({Base::Kind::group, Op::number, form, -1, {}}), {1, 1}});
  }
  for (const Factor& f : b.factors) add(f);
  std::erase_if(all.factors, [](const Factor& f) { return f.exponent.is_zero(); });
  return all;
}

/// Writes a form as a factor times a group: 2 x + 2 y is 2 (x + y), -x + 1 is -(x - 1). Groups that differ only in a
/// factor become equal.
Term Forms::as_term(int form, bool with_content) {
  const Form& f = (*this)[form];
  if (f.terms.size() == 1) return f.terms[0];
  Rational content{1, 1};
  if (with_content) {
    const Rational& first = f.terms[0].c;
    const bool equal =
        std::all_of(f.terms.begin(), f.terms.end(), [&](const Term& t) { return t.c == first || t.c == -first; });
    if (equal) {
      content = first;
    } else {
      const bool whole = std::all_of(f.terms.begin(), f.terms.end(), [](const Term& t) { return t.c.is_whole(); });
      std::int64_t divisor = 0;
      for (const Term& t : f.terms) divisor = std::gcd(divisor, t.c.up);
      if (whole) content.up = divisor;
      if (first.up < 0) content.up = -content.up;
    }
  }
  int inside = form;
  if (!content.is(1)) {
    std::vector<Term> terms = f.terms;
    for (Term& t : terms) t.c = *formula::product(t.c, *fraction(content.down, content.up));
    inside = intern({std::move(terms)});
  }
  return {content, {{base({Base::Kind::group, Op::number, inside, -1, {}}), {1, 1}}}};
}

int Forms::sum(const std::vector<int>& forms) {
  std::vector<Term> all;
  for (const int form : forms) {
    for (const Term& term : (*this)[form].terms) {
      // A term that consists of one group only is replaced by the terms of the group.
      const bool alone = term.factors.size() == 1 && term.factors[0].exponent.is(1) &&
                         (term.c.is(1) || term.c.is(-1)) && base_at(term.factors[0].base).kind == Base::Kind::group;
      if (!alone) {
        all.push_back(term);
        continue;
      }
      for (Term inner : (*this)[base_at(term.factors[0].base).a].terms) {
        if (term.c.up < 0) inner.c = -inner.c;
        all.push_back(std::move(inner));
      }
    }
  }
  return intern({std::move(all)});
}

int Forms::product(int x, int y) {
  if (is_zero(x) || is_zero(y)) return zero();
  return intern({{product(as_term(x, true), as_term(y, true))}});
}

int Forms::power(int x, const Rational& exponent) {
  if (exponent.is_zero()) return constant({1, 1});
  if (exponent.is(1)) return x;
  if (is_zero(x)) {
    if (exponent.up > 0) return x;
    return of_base(base({Base::Kind::group, Op::number, x, -1, {}}), exponent);  // 1/0 is not finite when evaluated
  }
  if (exponent.is_whole()) {
    Term term = as_term(x, true);
    bool fits = true;
    for (const Factor& f : term.factors) fits = fits && formula::product(f.exponent, exponent).has_value();
    const auto c = formula::power(term.c, exponent.up);
    if (c && fits) {
      term.c = *c;
      for (Factor& f : term.factors) f.exponent = *formula::product(f.exponent, exponent);
      return intern({{std::move(term)}});
    }
  }
  // sqrt(x^2) is not x, so exponents are only multiplied for a single base with exponent 1.
  const Form& f = (*this)[x];
  const bool simple = f.terms.size() == 1 && f.terms[0].c.is(1) && f.terms[0].factors.size() == 1;
  if (simple) {
    const Factor& only = f.terms[0].factors[0];
    if (only.exponent.is(1) || (!only.exponent.is_whole() && !exponent.is_whole())) {
      if (const auto total = formula::product(only.exponent, exponent)) return of_base(only.base, *total);
    }
  }
  return of_base(base({Base::Kind::group, Op::number, x, -1, {}}), exponent);
}

int Forms::general_power(int x, int exponent) {
  const Form& e = (*this)[exponent];
  if (e.terms.empty()) return constant({1, 1});
  if (e.terms.size() == 1 && e.terms[0].factors.empty()) return power(x, e.terms[0].c);
  return of_base(base({Base::Kind::power, Op::power, x, exponent, {}}));
}

int Forms::function(Op op, int x, int y) {
  if (op == Op::sqrt) return power(x, {1, 2});
  return of_base(base({Base::Kind::function, op, x, y, {}}));
}

int Forms::of_number(int node) {
  if (const auto c = fraction_of(graph_.text(graph_[node]))) return constant(*c);
  return of_base(base({Base::Kind::number, Op::number, node, -1, {}}));
}

/// Flattens a - b + c to {a, -b, c}, so that a long sum is one form instead of one for each partial sum.
std::vector<std::pair<int, bool>> Forms::summands(int node) const {
  std::vector<std::pair<int, bool>> all;
  int left = node;
  while (graph_[left].op == Op::add || graph_[left].op == Op::subtract) {
    all.emplace_back(graph_[left].b, graph_[left].op == Op::subtract);
    left = graph_[left].a;
  }
  all.emplace_back(left, false);
  std::reverse(all.begin(), all.end());
  return all;
}

/// Makes the form of a node. It does so for all nodes that the node needs in ascending order, without recursion,
/// because operands have lower numbers than their operations.
int Forms::of_node(int node) {
  std::vector<int> open{node};
  while (!open.empty()) {
    const int i = open.back();
    if (of_nodes_.contains(i)) {
      open.pop_back();
      continue;
    }
    const Node& n = graph_[i];
    std::vector<int> operands;
    if (n.op == Op::add || n.op == Op::subtract) {
      for (const auto& [part, negative] : summands(i)) operands.push_back(part);
    } else if (!is_leaf(n.op)) {
      operands.push_back(n.a);
      if (n.b >= 0) operands.push_back(n.b);
    }
    bool ready = true;
    for (const int operand : operands) {
      if (of_nodes_.contains(operand)) continue;
      ready = false;
      open.push_back(operand);
    }
    if (!ready) continue;
    open.pop_back();
    of_nodes_.emplace(i, made(i));
  }
  return of_nodes_.at(node);
}

int Forms::made(int node) {
  const Node& n = graph_[node];
  switch (n.op) {
    case Op::number:
      return of_number(node);
    case Op::pi:
      return of_base(base({Base::Kind::pi, Op::pi, -1, -1, {}}));
    case Op::symbol:
      return symbol(n.a);
    case Op::negate:
      return scaled({-1, 1}, of_nodes_.at(n.a));
    case Op::add:
    case Op::subtract: {
      std::vector<int> parts;
      for (const auto& [part, negative] : summands(node)) {
        parts.push_back(negative ? scaled({-1, 1}, of_nodes_.at(part)) : of_nodes_.at(part));
      }
      return sum(parts);
    }
    case Op::multiply:
      return product(of_nodes_.at(n.a), of_nodes_.at(n.b));
    case Op::divide:
      return product(of_nodes_.at(n.a), power(of_nodes_.at(n.b), {-1, 1}));
    case Op::power:
      return general_power(of_nodes_.at(n.a), of_nodes_.at(n.b));
    default:
      return function(n.op, of_nodes_.at(n.a), n.b < 0 ? -1 : of_nodes_.at(n.b));
  }
}

int Forms::derivative(int form, int symbol) {
  if (!depends(form, symbol)) return zero();
  if (const auto known = derivatives_.find({form, symbol}); known != derivatives_.end()) return known->second;
  if (++depth_ > deepest) throw Error("found functions nested more than 1000 deep; allowed at most 1000");
  std::vector<int> parts;
  const Form whole = (*this)[form];  // a copy, because adding forms moves them in memory
  for (const Term& term : whole.terms) {
    for (std::size_t k = 0; k < term.factors.size(); ++k) {
      const Factor& f = term.factors[k];
      const std::vector<int>& in = base_at(f.base).variables;
      if (!std::binary_search(in.begin(), in.end(), symbol)) continue;
      Term rest = term;
      // c e base^(e - 1) times the other factors
      const auto lower = formula::sum(f.exponent, {-1, 1});
      if (!lower) throw Error("found an exponent of " + f.exponent.key() + "; allowed smaller ones, below 2^53");
      rest.factors[k].exponent = *lower;
      std::erase_if(rest.factors, [](const Factor& g) { return g.exponent.is_zero(); });
      rest = product(Term{f.exponent, {}}, rest);
      parts.push_back(product(intern({{rest}}), derivative_of_base(f.base, symbol)));
    }
  }
  const int all = sum(parts);
  --depth_;
  derivatives_.emplace(std::pair{form, symbol}, all);
  return all;
}

/// A form with the arithmetic of a number, for the rules of derivatives.
struct FormNumber {
  Forms* forms;
  int form;

  friend FormNumber operator+(const FormNumber& a, const FormNumber& b) {
    return {a.forms, a.forms->sum({a.form, b.form})};
  }
  friend FormNumber operator-(const FormNumber& a, const FormNumber& b) {
    return {a.forms, a.forms->difference(a.form, b.form)};
  }
  friend FormNumber operator-(const FormNumber& a) { return {a.forms, a.forms->scaled({-1, 1}, a.form)}; }
  friend FormNumber operator*(const FormNumber& a, const FormNumber& b) {
    return {a.forms, a.form == b.form ? a.forms->power(a.form, {2, 1}) : a.forms->product(a.form, b.form)};
  }
  friend FormNumber sqrt(const FormNumber& a) { return {a.forms, a.forms->function(Op::sqrt, a.form)}; }
#define HAMFLOW_FORM_FUNCTION(name, symmetry, rule, series) \
  friend FormNumber name(const FormNumber& a) { return {a.forms, a.forms->function(Op::name, a.form)}; }
  HAMFLOW_FUNCTIONS(HAMFLOW_FORM_FUNCTION)
#undef HAMFLOW_FORM_FUNCTION
};

int Forms::derivative_of_base(int index, int symbol) {
  const Base b = base_at(index);
  if (b.kind == Base::Kind::symbol) return constant({1, 1});
  if (b.kind == Base::Kind::group) return derivative(b.a, symbol);
  if (const auto known = base_derivatives_.find({index, symbol}); known != base_derivatives_.end())
    return known->second;
  const int self = of_base(index);
  const int by_a = derivative(b.a, symbol);
  const int one = constant({1, 1});
  const auto square = [&](int x) { return power(x, {2, 1}); };
  int result = -1;
  if (b.kind == Base::Kind::power) {  // a^b (b a'/a + b' log a)
    const int lower = general_power(b.a, difference(b.b, one));
    result = product(product(b.b, lower), by_a);
    if (depends(b.b, symbol)) {
      result = sum({result, product(product(self, function(Op::log, b.a)), derivative(b.b, symbol))});
    }
  } else if (b.op == Op::atan2) {  // atan2(y, x)' = (x y' - y x')/(x^2 + y^2)
    const int y = b.a;
    const int x = b.b;
    const int up = difference(product(x, by_a), product(y, derivative(x, symbol)));
    result = product(up, power(sum({square(x), square(y)}), {-1, 1}));
  } else {
    const FormNumber x{this, b.a};
    const FormNumber y{this, self};
    if (b.op == Op::abs) {  // the derivative is the sign of a
      result = product(product(b.a, power(self, {-1, 1})), by_a);
    } else {
      const DerivativeRule<FormNumber> rule = derivative_rule(b.op, x, y, FormNumber{this, one});
      result = product(rule.divides ? power(rule.by.form, {-1, 1}) : rule.by.form, by_a);
    }
  }
  base_derivatives_.emplace(std::pair{index, symbol}, result);
  return result;
}

}  // namespace hamflow::formula
