#include "hamflow/formula/formula.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <optional>

#include "core/text_place.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/syntax.hpp"

namespace hamflow {

namespace formula {

namespace {

/// The meaning of a name inside a let or a sum.
struct Local {
  std::string_view word;
  int node = -1;
  std::optional<std::int64_t> whole;  // the value, if it is the index of a sum
};

/// Resolves names and makes the graph from the syntax tree. It expands sums; each use of a let shares one node.
class NameResolver {
 public:
  NameResolver(Graph& graph, const Syntax& syntax, const FormulaSymbols& symbols, std::set<std::string>* whole)
      : graph_(graph), syntax_(syntax), symbols_(symbols), whole_used_(whole) {
    for (std::size_t i = 0; i < symbols.names.size(); ++i) numbers_.emplace(symbols.names[i], static_cast<int>(i));
  }

  int read() { return node_of(syntax_.root); }

 private:
  using Kind = SyntaxPart::Kind;

  [[noreturn]] void refuse(std::size_t at, const std::string& what, const std::string& allowed,
                           const std::string& meant = "") const {
    refuse_at(syntax_.text, at, what, allowed, meant);
  }

  /// Makes the node of an expression. Left operands are processed without recursion, because a chain 1 + 2 + ... is as
  /// deep on its left side as it is long.
  int node_of(int root) {
    std::vector<int> chain;
    int part = root;
    while (syntax_[part].kind == Kind::operation && syntax_[part].b >= 0) {
      chain.push_back(part);
      part = syntax_[part].a;
    }
    int node = single(part);
    for (; !chain.empty(); chain.pop_back()) {
      const SyntaxPart& p = syntax_[chain.back()];
      node = operation(p, node, node_of(p.b));
    }
    return node;
  }

  int single(int i) {
    const SyntaxPart& part = syntax_[i];
    switch (part.kind) {
      case Kind::number:
        return checked(part, graph_.number(part.word), std::strtold(std::string(part.word).c_str(), nullptr));
      case Kind::pi:
        return checked(part, graph_.node(Op::pi), pi_value<long double>());
      case Kind::name:
        return named(part);
      case Kind::operation:
        return operation(part, node_of(part.a), -1);
      case Kind::let: {
        refuse_second(part);
        locals_.push_back({part.word, node_of(part.a), std::nullopt});
        const int body = node_of(part.b);
        locals_.pop_back();
        return body;
      }
      case Kind::sum:
        return sum(part);
    }
    return -1;
  }
  void refuse_second(const SyntaxPart& part) const {
    for (const Local& local : locals_) {
      if (local.word == part.word) {
        refuse(part.at, "the name " + std::string(part.word) + " within its own let or sum", "another name");
      }
    }
  }

  // ---- constants have to stay finite ----

  std::optional<long double>& value_of(int node) {
    if (values_.size() <= static_cast<std::size_t>(node)) values_.resize(static_cast<std::size_t>(node) + 1);
    return values_[static_cast<std::size_t>(node)];
  }
  int checked(const SyntaxPart& part, int node, long double value) {
    if (!(std::abs(value) <= static_cast<long double>(DBL_MAX))) {
      syntax_.refuse_value(part, value == value);
    }
    value_of(node) = value;
    return node;
  }
  int operation(const SyntaxPart& part, int a, int b) {
    if (++terms_ > FormulaLimits::terms)
      refuse(part.at, "more than 300000 operations", "at most 300000, all terms of sums counted");
    const int node = graph_.node(part.op, a, b);
    if (graph_.size() > FormulaLimits::nodes)
      refuse(part.at, "more than 200000 different operations", "at most 200000");
    const std::optional<long double> x = value_of(a);
    const std::optional<long double> y = b < 0 ? x : value_of(b);
    if (part.op == Op::divide && y == 0.0L) syntax_.refuse_division_by_zero(part);
    return x && y ? checked(part, node, hamflow::applied<long double>(part.op, *x, *y)) : node;
  }

  // ---- sums and indices ----

  int sum(const SyntaxPart& part) {
    refuse_second(part);
    const std::int64_t first = whole(part.a, "a limit of a sum");
    const std::int64_t last = whole(part.b, "a limit of a sum");
    int total = -1;
    locals_.push_back({part.word, -1, 0});
    for (std::int64_t i = first; i <= last; ++i) {
      if (++terms_ > FormulaLimits::terms)
        refuse(part.at, "more than 300000 operations", "at most 300000, all terms of sums counted");
      locals_.back().whole = i;
      locals_.back().node = -1;
      const int term = node_of(part.c);
      total = total < 0 ? term
                        : operation({.kind = Kind::operation,
                                     .op = Op::add,
                                     .a = part.c,
                                     .b = part.c,
                                     .at = part.at,
                                     .begin = part.begin,
                                     .end = part.end},
                                    total, term);
    }
    locals_.pop_back();
    return total < 0 ? checked(part, graph_.number("0"), 0) : total;
  }
  int whole_node(std::int64_t value) {
    const int node = graph_.number(std::to_string(value < 0 ? -value : value));
    value_of(node) = static_cast<long double>(value < 0 ? -value : value);
    if (value >= 0) return node;
    const int negative = graph_.node(Op::negate, node);
    value_of(negative) = static_cast<long double>(value);
    return negative;
  }

  /// Evaluates an expression of indices, numbers and parameters that has to be a whole number.
  std::int64_t whole(int i, const char* where, int depth = 0) const {
    constexpr std::int64_t most = std::int64_t{1} << 53;
    const SyntaxPart& part = syntax_[i];
    if (depth > deepest_expression) refuse(part.at, "more than 200 operations in " + std::string(where), "at most 200");
    std::int64_t value = 0;
    bool lost = false;
    if (part.kind == Kind::number) {
      const long double x = std::strtold(std::string(part.word).c_str(), nullptr);
      if (!(x <= static_cast<long double>(most))) refuse_whole(part, "beyond 2^53");
      value = static_cast<std::int64_t>(x);
      if (static_cast<long double>(value) < x) refuse_whole(part, "not whole");
    } else if (part.kind == Kind::name) {
      value = whole_name(part, where);
    } else if (part.kind == Kind::operation && part.op == Op::negate) {
      value = -whole(part.a, where, depth + 1);
    } else if (part.kind == Kind::operation && part.b >= 0 && part.op != Op::atan2) {
      const std::int64_t x = whole(part.a, where, depth + 1);
      const std::int64_t y = whole(part.b, where, depth + 1);
      switch (part.op) {
        case Op::add:
          value = x + y;
          break;
        case Op::subtract:
          value = x - y;
          break;
        case Op::multiply:
          lost = __builtin_mul_overflow(x, y, &value);
          break;
        case Op::divide:
          if (y == 0) {
            refuse(part.at,
                   syntax_.shown_part(syntax_[part.a]) + " divided by " + syntax_.shown_part(syntax_[part.b]) +
                       ", which is 0",
                   "a divisor other than 0");
          }
          if (x % y != 0) refuse_whole(part, "not whole");
          value = x / y;
          break;
        default:
          if (y < 0) refuse_whole(part, "not whole");
          value = 1;
          for (std::int64_t k = 0; k < y && !lost && value != 0 && !(k > 1 && x == 1); ++k) {
            if (x == -1) {
              value = y % 2 == 0 ? 1 : -1;
              break;
            }
            lost = __builtin_mul_overflow(value, x, &value) || value > most || value < -most;
          }
      }
    } else {
      refuse(part.at, syntax_.shown_part(part) + " in " + where,
             "whole expressions (+ - * / ^) of indices, numbers and parameters");
    }
    if (lost || value > most || value < -most) refuse_whole(part, "beyond 2^53");
    return value;
  }
  [[noreturn]] void refuse_whole(const SyntaxPart& part, const char* what) const {
    refuse(part.at, syntax_.shown_part(part) + ", which is " + what, "whole numbers from -2^53 to 2^53");
  }
  std::int64_t whole_name(const SyntaxPart& part, const char* where) const {
    const std::string name = full_name(part);
    for (const Local& local : locals_) {
      if (local.word != name) continue;
      if (local.whole) return *local.whole;
      refuse(part.at, name + " in " + where + ", a name defined by let",
             "whole expressions (+ - * / ^) of indices, numbers and parameters");
    }
    const auto known = symbols_.known.find(name);
    if (known == symbols_.known.end()) {
      if (numbers_.contains(name)) {
        refuse(part.at, name + " in " + where + ": its value is not known before the run",
               "whole expressions of indices, numbers and parameters");
      }
      refuse_name(part, name);
    }
    const double value = known->second;
    if (!(std::abs(value) <= 0x1p53))
      refuse(part.at, name + ", which is " + shortest(value), "whole numbers from -2^53 to 2^53");
    if (value != std::nearbyint(value))
      refuse(part.at, name + ", which is " + shortest(value) + " and not whole", "whole numbers");
    if (whole_used_ != nullptr) whole_used_->insert(name);
    return static_cast<std::int64_t>(value);
  }

  // ---- names ----

  std::string full_name(const SyntaxPart& part) const {
    std::string name(part.word);
    if (part.a >= 0) name += "[" + std::to_string(whole(part.a, "an index")) + "]";
    return part.b < 0 ? name : name + full_name(syntax_[part.b]);
  }
  int named(const SyntaxPart& part) {
    if (part.a < 0) {
      for (Local& local : locals_) {
        if (local.word != part.word) continue;
        if (local.node < 0) local.node = whole_node(*local.whole);
        return local.node;
      }
    }
    const std::string name = full_name(part);
    const auto found = numbers_.find(name);
    if (found == numbers_.end()) refuse_name(part, name);
    const int node = graph_.symbol(found->second);
    const auto known = symbols_.known.find(name);
    return known == symbols_.known.end() ? node : checked(part, node, static_cast<long double>(known->second));
  }
  /// Finds a declared name that begins with `name`, as p_x does for p.
  std::string name_with_prefix(const std::string& name) const {
    const auto first = std::find_if(symbols_.names.begin(), symbols_.names.end(),
                                    [&](const std::string& other) { return other.starts_with(name + "_"); });
    return first == symbols_.names.end() ? std::string() : *first;
  }
  [[noreturn]] void refuse_name(const SyntaxPart& part, const std::string& name) const {
    // The name is a list without an index, or with an index that is too large.
    const std::string word(part.word);
    const auto is_entry = [&](const std::string& other) {
      return other.size() > word.size() && other.starts_with(word) && other[word.size()] == '[';
    };
    const auto first = std::find_if(symbols_.names.begin(), symbols_.names.end(), is_entry);
    if (first != symbols_.names.end()) {
      const auto last = std::find_if(symbols_.names.rbegin(), symbols_.names.rend(), is_entry);
      const std::string all = *first == *last ? *first : *first + " to " + *last;
      refuse(part.at, part.a < 0 ? word + " without an index" : "there is no " + name, all);
    }
    if (part.a >= 0 && numbers_.contains(word))
      refuse(part.at, "an index after " + word + ", which is one number", word);
    std::vector<std::string> candidates;
    for (const Local& local : locals_) candidates.emplace_back(local.word);
    candidates.insert(candidates.end(), symbols_.names.begin(), symbols_.names.end());
    std::vector<std::string> listed = candidates;
    constexpr std::size_t most = 16;
    if (listed.size() > most) {
      listed.resize(most - 1);
      listed.push_back("... " + candidates.back());
    }
    listed.push_back("numbers, pi, functions such as sqrt(2)");
    candidates.emplace_back("pi");
    for (const NamedFunction& f : named_functions()) candidates.emplace_back(f.name);
    std::string near = name_with_prefix(name);
    if (near.empty()) near = nearest(name, candidates);
    // Every short word is near to every other one, so a proposal has to share a letter with it.
    if (lower(near).find_first_of(lower(name)) == std::string::npos) near = written_here(name);
    refuse(part.at, name == "t" ? "the time t, which is not allowed here" : "the unknown symbol " + name,
           joined(listed), near);
  }

  Graph& graph_;
  const Syntax& syntax_;
  const FormulaSymbols& symbols_;
  std::set<std::string>* whole_used_;
  std::unordered_map<std::string, int> numbers_;
  std::vector<Local> locals_;
  std::vector<std::optional<long double>> values_;
  std::size_t terms_ = 0;
};

}  // namespace

int read_into(Graph& graph, std::string_view text, const FormulaSymbols& symbols, std::set<std::string>* whole) {
  const Syntax syntax = read_syntax(text, {.characters = FormulaLimits::characters,
                                           .operations = FormulaLimits::terms,
                                           .names = symbols.names,
                                           .what = symbols.what});
  return NameResolver(graph, syntax, symbols, whole).read();
}

}  // namespace formula

Formula::Formula() = default;

Formula::Formula(std::shared_ptr<const formula::Graph> graph, int root, std::size_t symbols)
    : graph_(std::move(graph)), root_(root) {
  const std::vector<int> outputs{root};
  code_ = std::make_shared<const formula::Code>(formula::code_of(*graph_, outputs, std::vector<bool>(symbols)));
}

bool Formula::uses(int symbol) const {
  return std::find(code_->symbols.begin(), code_->symbols.end(), symbol) != code_->symbols.end();
}

Formula parse_formula(std::string_view text, const FormulaSymbols& symbols) {
  auto graph = std::make_shared<formula::Graph>();
  const int root = formula::read_into(*graph, text, symbols);
  return {graph, root, symbols.names.size()};
}

}  // namespace hamflow
