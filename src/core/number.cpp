#include "hamflow/core/number.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "hamflow/core/text.hpp"
#include "hamflow/core/text_place.hpp"

namespace hamflow {

namespace detail {

namespace {

constexpr std::size_t longest = 1'000'000;       // characters: a literal of mp(100000) has 10^5 digits
constexpr std::size_t most_operations = 10'000;  //
constexpr int deepest = 200;                     // each level is a few frames of the stack

constexpr std::array<std::pair<std::string_view, NumberAction>, 14> functions{{{"sqrt", NumberAction::sqrt},
                                                                               {"exp", NumberAction::exp},
                                                                               {"log", NumberAction::log},
                                                                               {"sin", NumberAction::sin},
                                                                               {"cos", NumberAction::cos},
                                                                               {"tan", NumberAction::tan},
                                                                               {"asin", NumberAction::asin},
                                                                               {"acos", NumberAction::acos},
                                                                               {"atan", NumberAction::atan},
                                                                               {"atan2", NumberAction::atan2},
                                                                               {"sinh", NumberAction::sinh},
                                                                               {"cosh", NumberAction::cosh},
                                                                               {"tanh", NumberAction::tanh},
                                                                               {"abs", NumberAction::abs}}};
constexpr const char* operators = "an operator (+ - * / ^)";
constexpr const char* operands = "a number, pi, a function such as sqrt(2), or '('";

const NumberAction* find_function(std::string_view word) {
  for (const auto& [name, action] : functions) {
    if (name == word) return &action;
  }
  return nullptr;
}

/// sum := product (('+'|'-') product)*, product := unary (('*'|'/') unary)*, unary := ('+'|'-') unary | power,
/// power := atom (('^'|'**') unary)?
class NumberReader {
 public:
  explicit NumberReader(std::string_view text) : formula_{text, {}} {}

  NumberFormula read() {
    if (text().size() > longest) refuse_at(text(), longest, "more than 10^6 characters", "at most 10^6");
    (void)sum();
    skip_space();
    if (at_ < text().size()) fail_after_number("the end");
    return std::move(formula_);
  }

 private:
  struct Span {
    std::size_t begin;
    std::size_t end;
  };

  std::string_view text() const { return formula_.text; }
  char here() const { return at_ < text().size() ? text()[at_] : '\0'; }

  // ---- what is wrong ----

  /// The character here, or "the end".
  std::string found_here() const { return character_at(text(), at_); }
  [[noreturn]] void fail_before_number() const {
    refuse_at(text(), at_, found_here() + " where a number has to be", operands);
  }
  /// The text goes on after a complete formula: mostly a forgotten sign of multiplication.
  [[noreturn]] void fail_after_number(const char* where_it_ends) {
    const std::size_t at = at_;
    const char last = trimmed(text().substr(0, at)).back();
    const std::string go_on = operators + std::string(" or ") + where_it_ends;
    if (here() == ')') refuse_at(text(), at, "')' without its '('", go_on);
    if (here() == ',' && is_digit(last) && at + 1 < text().size() && is_digit(text()[at + 1])) {
      refuse_at(text(), at, "',' in a number", "a point before decimals", with(at, at + 1, "."));
    }
    const bool factor = here() == '(' || is_letter(here()) || is_digit(here());
    if (!factor) refuse_at(text(), at, found_here() + " after a complete number", go_on);
    const std::string_view next = word();
    const bool exponent = lower(next).starts_with('e') && is_digit(last) && !is_blank(text()[at - 1]);
    const bool known = next == "pi" || next == "Pi" || find_function(next) != nullptr;
    const bool times = known || text()[at] == '(' || (is_digit(text()[at]) && !is_digit(last) && last != '.');
    std::size_t gap = at;
    while (gap > 0 && is_blank(text()[gap - 1])) --gap;
    refuse_at(text(), at, "no operator before " + (next.empty() ? shown(text().substr(at, 1)) : std::string(next)),
              operators + std::string(exponent ? ", or an exponent such as 2e-3" : ""),
              times && text().size() < 60 ? with(gap, at, "*") : "");
  }
  /// The text with [begin, end) replaced.
  std::string with(std::size_t begin, std::size_t end, const char* replacement) const {
    return std::string(text().substr(0, begin)) + replacement + std::string(text().substr(end));
  }

  // ---- reading ----

  void skip_space() {
    while (is_blank(here())) ++at_;
  }
  bool take(std::string_view token) {
    skip_space();
    if (text().substr(at_, token.size()) != token) return false;
    at_ += token.size();
    return true;
  }
  std::string_view word() {
    const std::size_t begin = at_;
    while (is_letter(here()) || (at_ > begin && is_digit(here()))) ++at_;
    return text().substr(begin, at_ - begin);
  }
  Span add(NumberAction action, std::size_t at, Span span) {
    if (formula_.steps.size() == most_operations) {
      refuse_at(text(), at, "more than 10^4 operations", "at most 10^4");
    }
    formula_.steps.push_back({action, at, span.begin, span.end});
    return span;
  }
  /// x op y, where x has been read and y stands here.
  template <class Operand>
  Span joined(NumberAction action, std::size_t sign, Span x, Operand operand) {
    const Span y = operand();
    return add(action, sign, {x.begin, y.end});
  }

  Span sum() {
    Span x = product();
    for (;;) {
      skip_space();
      const std::size_t sign = at_;
      if (take("+")) {
        x = joined(NumberAction::add, sign, x, [this] { return product(); });
      } else if (take("-")) {
        x = joined(NumberAction::subtract, sign, x, [this] { return product(); });
      } else {
        return x;
      }
    }
  }
  Span product() {
    Span x = unary();
    for (;;) {
      skip_space();
      const std::size_t sign = at_;
      if (take("*")) {  // no "**": a power has read it
        x = joined(NumberAction::multiply, sign, x, [this] { return unary(); });
      } else if (take("/")) {
        x = joined(NumberAction::divide, sign, x, [this] { return unary(); });
      } else {
        return x;
      }
    }
  }
  Span unary() {
    skip_space();
    if (++depth_ > deepest) {
      refuse_at(text(), at_, "more than 200 nested signs, powers and parentheses", "at most 200");
    }
    const std::size_t sign = at_;
    Span x{};
    if (take("-")) {
      x = add(NumberAction::negate, sign, {sign, unary().end});
    } else if (take("+")) {
      x = {sign, unary().end};
    } else {
      x = power();
    }
    --depth_;
    return x;
  }
  Span power() {
    const Span base = atom();
    skip_space();
    const std::size_t sign = at_;
    if (!take("**") && !take("^")) return base;
    return joined(NumberAction::power, sign, base, [this] { return unary(); });  // to the right, and 2^-3 is allowed
  }
  /// The ')' that belongs to a '('.
  std::size_t closed(std::size_t opened) {
    skip_space();
    if (here() == ')') return ++at_;
    if (at_ == text().size())
      refuse_at(text(), at_, "the end before the ')' of " + shown(text().substr(opened)), "')'");
    fail_after_number("')'");
  }
  Span atom() {
    skip_space();
    const std::size_t begin = at_;
    if (take("(")) {
      (void)sum();
      return {begin, closed(begin)};
    }
    if (is_digit(here()) || here() == '.') return literal();
    const std::string_view name = word();
    if (name.empty()) fail_before_number();
    if (name == "pi" || name == "Pi") return add(NumberAction::pi, begin, {begin, at_});
    skip_space();
    if (here() != '(') fail_at_symbol(name, begin);
    return function(name, begin);
  }
  [[noreturn]] void fail_at_symbol(std::string_view name, std::size_t begin) const {
    const std::string word(name);
    if (find_function(name) != nullptr) {
      refuse_at(text(), begin, "the function " + word + " without parentheses",
                word + (name == "atan2" ? "(y, x)" : "(x)"));
    }
    // Short words are near everything: at least a letter has to be the same.
    const std::vector<std::string> symbols{"pi"};
    const std::string near = nearest(lower(name), symbols);
    const bool alike = near.find_first_of(lower(name)) != std::string::npos;
    refuse_at(text(), begin, "the unknown symbol " + word, "numbers, pi, functions such as sqrt(2)",
              alike ? near : written_here(name));
  }
  Span function(std::string_view name, std::size_t begin) {
    const std::size_t opened = at_;
    const NumberAction* const action = find_function(name);
    if (action == nullptr) {
      std::vector<std::string> names;
      for (const auto& [known, its_action] : functions) names.emplace_back(known);
      const std::string here = written_here(name);
      refuse_at(text(), begin, "the unknown function " + std::string(name), hamflow::joined(names),
                here.empty() ? nearest(lower(name), names) : here);
    }
    const bool two = *action == NumberAction::atan2;
    take("(");
    (void)sum();
    skip_space();
    if (two) {
      if (here() == ')') refuse_at(text(), at_, "atan2 of one number", "atan2(y, x)");
      if (!take(",")) (void)closed(opened);
      (void)sum();
      skip_space();
    }
    if (here() == ',') {
      refuse_at(text(), at_, std::string(name) + " of more than " + (two ? "two numbers" : "one number"),
                std::string(name) + (two ? "(y, x)" : "(x)"));
    }
    const std::size_t end = closed(opened);
    return add(*action, begin, {begin, end});
  }
  Span literal() {
    const std::size_t begin = at_;
    bool point = false;
    bool digits = false;
    for (; is_digit(here()) || here() == '.'; ++at_) {
      if (here() == '.' && point) refuse_at(text(), at_, "a second point in a number", "a decimal number such as 0.1");
      (here() == '.' ? point : digits) = true;
    }
    if (!digits) refuse_at(text(), begin, "'.' without digits", "a decimal number such as 0.1");
    if (here() == 'e' || here() == 'E') {
      std::size_t after = at_ + 1;
      if (after < text().size() && (text()[after] == '+' || text()[after] == '-')) ++after;
      if (after < text().size() && is_digit(text()[after])) {
        at_ = after;
        while (is_digit(here())) ++at_;
      }
    }
    return add(NumberAction::literal, begin, {begin, at_});
  }

  NumberFormula formula_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

std::string part(const NumberFormula& formula, std::size_t begin, std::size_t end) {
  return shown(trimmed(formula.text.substr(begin, end - begin)));
}

}  // namespace

bool is_literal(std::string_view text) {
  const auto digits_from = [&](std::size_t at) {
    while (at < text.size() && is_digit(text[at])) ++at;
    return at;
  };
  std::size_t at = digits_from(0);
  if (at == 0 || text.size() > longest) return false;
  if (at < text.size() && text[at] == '.') at = digits_from(at + 1);
  if (at + 1 < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    const std::size_t exponent = at + (text[at + 1] == '-' || text[at + 1] == '+' ? 2 : 1);
    at = digits_from(exponent);
    if (at == exponent) return false;
  }
  return at == text.size();
}

NumberFormula read_number(std::string_view text) { return NumberReader(text).read(); }

void refuse_division_by_zero(const NumberFormula& formula, const NumberStep& step) {
  const std::string divisor = part(formula, step.at + 1, step.end);
  refuse_at(formula.text, step.at,
            part(formula, step.begin, step.at) + " divided by " + divisor + (divisor == "0" ? "" : ", which is 0"),
            "a divisor other than 0");
}

void refuse_value(const NumberFormula& formula, const NumberStep& step, bool infinite) {
  refuse_at(formula.text, step.at,
            part(formula, step.begin, step.end) + (infinite ? " is infinite or too large" : " is not a real number"),
            "finite real numbers");
}

}  // namespace detail

template double evaluate_number<double>(std::string_view);
template long double evaluate_number<long double>(std::string_view);

std::int64_t evaluate_whole(std::string_view text) {
  constexpr long double most = 0x1p53L;
  const auto value = evaluate_number<long double>(text);  // beyond 2^53 a double would hide what is not whole
  if (std::abs(value) <= most && value == std::nearbyint(value)) return static_cast<std::int64_t>(value);
  const bool large = std::abs(value) > most;
  refuse_at(text, 0,
            (large ? std::string("a number") : shortest(static_cast<double>(value))) +
                (large ? " beyond 2^53" : ", which is not whole"),
            "whole numbers from -2^53 to 2^53, such as 1000, 1e6 or 10^6");
}

std::string shortest(double x) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, x).ptr;
  return {buffer, end};
}

}  // namespace hamflow
