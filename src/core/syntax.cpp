#include "hamflow/detail/core/syntax.hpp"

#include <algorithm>

#include "hamflow/core/text.hpp"
#include "text_place.hpp"

namespace hamflow {

bool is_keyword(std::string_view word) { return word == "let" || word == "in" || word == "sum"; }

bool names_something(std::span<const std::string> names, std::string_view word) {
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return name.starts_with(word) && (name.size() == word.size() || name[word.size()] == '[');
  });
}

std::string refused_formula_name(const std::string& name) {
  if (find_function(name) != nullptr) return "the name " + name + ", which is a function";
  if (is_keyword(name)) return "the name " + name + ", which is a keyword of formulas";
  if (name == "pi" || name == "Pi") return "the name " + name + ", which is a number";
  if (name == "t") return "the name t, which is the time";
  const bool word = !name.empty() && is_letter(name[0]) &&
                    std::all_of(name.begin(), name.end(), [](char c) { return is_letter(c) || is_digit(c); });
  return word ? "" : "the name \"" + shown(name) + "\", which is not a word of letters, digits and _";
}

std::string Syntax::shown_part(const SyntaxPart& part) const {
  return shown(trimmed(text.substr(part.begin, part.end - part.begin)));
}

void Syntax::refuse_division_by_zero(const SyntaxPart& division) const {
  const std::string divisor = shown_part((*this)[division.b]);
  refuse_at(text, division.at,
            shown_part((*this)[division.a]) + " divided by " + divisor + (divisor == "0" ? "" : ", which is 0"),
            "a divisor other than 0");
}

void Syntax::refuse_value(const SyntaxPart& part, bool infinite) const {
  refuse_at(text, part.at, shown_part(part) + (infinite ? " is infinite or too large" : " is not a real number"),
            "finite real numbers");
}

namespace {

constexpr const char* operators = "an operator (+ - * / ^)";

/// "10^5" for a power of ten.
std::string power_of_ten(std::size_t number) {
  int digits = 0;
  for (; number >= 10; number /= 10) ++digits;
  return "10^" + std::to_string(digits);
}

class SyntaxReader {
 public:
  SyntaxReader(std::string_view text, const SyntaxRules& rules) : rules_(rules), syntax_{text} {}

  Syntax read() {
    if (text().size() > rules_.characters) {
      const std::string most = power_of_ten(rules_.characters);
      refuse(rules_.characters, "more than " + most + " characters", "at most " + most);
    }
    syntax_.root = expression();
    skip_space();
    if (at_ < text().size()) fail_after_operand("the end");
    return std::move(syntax_);
  }

 private:
  std::string_view text() const { return syntax_.text; }
  char here() const { return at_ < text().size() ? text()[at_] : '\0'; }
  char behind(std::size_t more) const { return at_ + more < text().size() ? text()[at_ + more] : '\0'; }

  [[noreturn]] void refuse(std::size_t at, const std::string& what, const std::string& allowed,
                           const std::string& meant = "") const {
    refuse_at(text(), at, what, allowed, meant);
  }
  std::string operands() const {
    return std::string("a number, ") + (rules_.only_numbers ? "pi" : "a name") + ", a function such as sqrt(2), or '('";
  }
  [[noreturn]] void fail_before_operand() const {
    refuse(at_, "a number is missing before " + character_at(text(), at_), operands());
  }
  /// The text continues after a complete operand, most often because a multiplication sign is missing.
  [[noreturn]] void fail_after_operand(const char* where_it_ends) {
    const std::size_t at = at_;
    std::size_t gap = at;
    while (gap > 0 && is_space(text()[gap - 1])) --gap;
    const char last = gap > 0 ? text()[gap - 1] : '\0';
    const std::string go_on = operators + std::string(" or ") + where_it_ends;
    if (here() == ')') refuse(at, "')' without its '('", go_on);
    if (here() == ']' && !rules_.only_numbers) refuse(at, "']' without its '['", go_on);
    if (here() == ',' && is_digit(last) && is_digit(behind(1))) {
      refuse(at, "',' in a number", "a point before decimals", with(at, at + 1, "."));
    }
    if (here() == '[' && !rules_.only_numbers)
      refuse(at, "'[' without a name before it", "an index after a name, as in x[1]");
    if (here() == '=' && !rules_.only_numbers) refuse(at, "'=' after a complete formula", "let name = ... in ...");
    if (here() != '(' && !is_letter(here()) && !is_digit(here())) {
      refuse(at, character_at(text(), at) + " after a complete number", go_on);
    }
    const std::string_view next = word();
    const bool exponent = lower(next).starts_with('e') && is_digit(last) && gap == at;
    const bool known = next == "pi" || next == "Pi" || (next == "sum" && !rules_.only_numbers) ||
                       find_function(next) != nullptr || (!next.empty() && names_something(rules_.names, next));
    const bool times = known || text()[at] == '(' || (is_digit(text()[at]) && !is_digit(last) && last != '.');
    refuse(at, "no operator before " + (next.empty() ? std::string(text().substr(at, 1)) : std::string(next)),
           operators + std::string(exponent ? ", or an exponent such as 2e-3" : ""),
           times && text().size() < 60 ? with(gap, at, "*") : "");
  }
  /// The text with [begin, end) replaced.
  std::string with(std::size_t begin, std::size_t end, const char* replacement) const {
    return std::string(text().substr(0, begin)) + replacement + std::string(text().substr(end));
  }

  static bool is_space(char c) { return is_blank(c) || c == '\n' || c == '\r'; }
  void skip_space() {
    while (is_space(here())) ++at_;
  }
  bool take(std::string_view token) {
    skip_space();
    if (text().substr(at_, token.size()) != token) return false;
    at_ += token.size();
    return true;
  }
  /// Letters, digits, and points before letters: problem.initial.
  std::string_view word() {
    const std::size_t begin = at_;
    while (is_letter(here()) || (at_ > begin && (is_digit(here()) || (here() == '.' && is_letter(behind(1)))))) ++at_;
    return text().substr(begin, at_ - begin);
  }
  bool take_word(std::string_view wanted) {
    skip_space();
    const std::size_t before = at_;
    if (word() == wanted) return true;
    at_ = before;
    return false;
  }
  int add(SyntaxPart part) {
    if (syntax_.parts.size() >= 2 * rules_.operations) {
      const std::string most = power_of_ten(rules_.operations);
      refuse(part.at, "more than " + most + " operations", "at most " + most);
    }
    syntax_.parts.push_back(part);
    return static_cast<int>(syntax_.parts.size()) - 1;
  }
  std::size_t end_of(int part) const { return syntax_[part].end; }
  std::size_t begin_of(int part) const { return syntax_[part].begin; }
  int binary(Operation op, std::size_t sign, int x, int y) {
    return add({.kind = SyntaxPart::Kind::operation,
                .op = op,
                .a = x,
                .b = y,
                .at = sign,
                .begin = begin_of(x),
                .end = end_of(y)});
  }

  /// Counts the nesting depth: one level while this object exists.
  class Level {
   public:
    explicit Level(SyntaxReader& reader) : reader_(reader) {
      if (++reader_.depth_ > deepest_expression) {
        const char* const nested =
            reader_.rules_.only_numbers ? "signs, powers and parentheses" : "signs, powers, parentheses and let";
        reader_.refuse(reader_.at_, std::string("more than 200 nested ") + nested, "at most 200");
      }
    }
    ~Level() { --reader_.depth_; }
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;

   private:
    SyntaxReader& reader_;
  };

  int expression() {
    if (rules_.only_numbers) return sum_of_products();
    const Level level(*this);
    skip_space();
    const std::size_t begin = at_;
    if (!take_word("let")) return sum_of_products();
    return bindings(begin);
  }
  /// name = value, name = value in body
  int bindings(std::size_t begin) {
    const Level level(*this);
    const std::size_t named = (skip_space(), at_);
    const std::string_view name = new_name("after let");
    if (!take("=")) refuse(at_, character_at(text(), at_) + " after let " + std::string(name), "let name = ... in ...");
    const int value = expression();
    skip_space();
    int body = -1;
    if (take(",")) {
      body = bindings(at_);
    } else if (take_word("in")) {
      body = expression();
    } else {
      if (at_ >= text().size())
        refuse(at_, "the end before the 'in' of let " + std::string(name), "let name = ... in ...");
      fail_after_operand("'in'");
    }
    return add({.kind = SyntaxPart::Kind::let,
                .word = name,
                .a = value,
                .b = body,
                .at = named,
                .begin = begin,
                .end = end_of(body)});
  }
  /// Reads a name that is defined here.
  std::string_view new_name(const char* where) {
    skip_space();
    const std::size_t begin = at_;
    const std::string_view name = word();
    if (name.empty())
      refuse(begin, "a name is missing " + std::string(where) + ", before " + character_at(text(), begin),
             "a name such as r");
    if (const std::string why = refused_formula_name(std::string(name)); !why.empty())
      refuse(begin, why, "another name");
    if (names_something(rules_.names, name)) {
      refuse(begin, "the name " + std::string(name) + " a second time: it is one of the " + std::string(rules_.what),
             "another name");
    }
    return name;
  }

  /// Operands with one of two operators between them, from left to right.
  template <class Next>
  int chain(const char* first, Operation if_first, const char* second, Operation if_second, const Next& next) {
    int x = next();
    for (;;) {
      skip_space();
      const std::size_t sign = at_;
      if (take(first)) {
        x = binary(if_first, sign, x, next());
      } else if (take(second)) {
        x = binary(if_second, sign, x, next());
      } else {
        return x;
      }
    }
  }
  int sum_of_products() {
    return chain("+", Operation::add, "-", Operation::subtract, [this] { return product(); });
  }
  int product() {  // "**" cannot occur here: unary() has read it
    return chain("*", Operation::multiply, "/", Operation::divide, [this] { return unary(); });
  }
  int unary() {
    const Level level(*this);
    skip_space();
    const std::size_t sign = at_;
    if (take("-")) {
      const int x = unary();
      return add({.kind = SyntaxPart::Kind::operation,
                  .op = Operation::negate,
                  .a = x,
                  .at = sign,
                  .begin = sign,
                  .end = end_of(x)});
    }
    if (take("+")) return unary();
    const int base = atom();
    skip_space();
    const std::size_t power = at_;
    if (!take("**") && !take("^")) return base;
    return binary(Operation::power, power, base, unary());  // right-associative; 2^-3 is allowed
  }
  /// Finds the closing bracket for an opening one. @return the place after it
  std::size_t closed(std::size_t opened, char bracket) {
    skip_space();
    if (here() == bracket) return ++at_;
    const std::string wanted{'\'', bracket, '\''};
    if (at_ == text().size()) {
      refuse(at_, "the end before the " + wanted + " of " + shown(text().substr(opened)), wanted);
    }
    fail_after_operand(wanted.c_str());
  }
  int atom() {
    skip_space();
    const std::size_t begin = at_;
    if (take("(")) {
      const int inside = expression();
      syntax_.parts[static_cast<std::size_t>(inside)].end = closed(begin, ')');
      syntax_.parts[static_cast<std::size_t>(inside)].begin = begin;
      return inside;
    }
    if (is_digit(here()) || here() == '.') return literal();
    const std::string_view name = word();
    if (name.empty()) fail_before_operand();
    if (name == "pi" || name == "Pi")
      return add({.kind = SyntaxPart::Kind::pi, .at = begin, .begin = begin, .end = at_});
    skip_space();
    if (rules_.only_numbers && find_function(name) == nullptr && here() != '(') fail_at_name(name, begin);
    if (rules_.only_numbers && find_function(name) == nullptr) fail_at_function(name, begin);
    if (name == "let")
      refuse(begin, "let within an expression", "let at its beginning, or in parentheses: (let ... in ...)");
    if (name == "in") refuse(begin, "'in' without its let", operands());
    if (name == "sum") return sum(begin);
    if (const Operation* const function = find_function(name)) return call(*function, name, begin);
    if (here() == '(') fail_at_function(name, begin);
    at_ = begin + name.size();
    return name_parts(begin, begin + name.size());
  }
  /// Reads the indices after a word, and the rest of the name after them. @param end the end of the word
  int name_parts(std::size_t begin, std::size_t end) {
    const Level level(*this);
    SyntaxPart part{.kind = SyntaxPart::Kind::name,
                    .word = text().substr(begin, end - begin),
                    .at = begin,
                    .begin = begin,
                    .end = end};
    at_ = end;
    skip_space();
    if (here() != '[') {
      at_ = end;
      return add(part);
    }
    const std::size_t opened = at_++;
    part.a = expression();
    part.end = closed(opened, ']');
    const std::size_t more = at_;
    if (here() == '[' || (here() == '.' && is_letter(behind(1)))) {
      if (here() == '.') {
        ++at_;
        (void)word();
      }
      part.b = name_parts(more, at_);
      part.end = end_of(part.b);
    }
    return add(part);
  }
  /// Refuses a name in a text that may hold numbers only. A proposal must share a letter with it, since a short word is
  /// near any other.
  [[noreturn]] void fail_at_name(std::string_view name, std::size_t begin) const {
    const std::string near = nearest(lower(name), std::vector<std::string>{"pi"});
    const bool alike = near.find_first_of(lower(name)) != std::string::npos;
    refuse(begin, "the unknown symbol " + std::string(name), "numbers, pi, functions such as sqrt(2)",
           alike ? near : written_here(name));
  }
  [[noreturn]] void fail_at_function(std::string_view name, std::size_t begin) const {
    if (names_something(rules_.names, name)) {
      refuse(at_, "no operator between " + std::string(name) + " and '('", operators,
             text().size() < 60 ? with(begin + name.size(), at_, "*") : "");
    }
    std::vector<std::string> names;
    if (!rules_.only_numbers) names.emplace_back("sum");
    for (const NamedFunction& f : named_functions()) names.emplace_back(f.name);
    const std::string here = written_here(name);
    refuse(begin, "the unknown function " + std::string(name), joined(names),
           here.empty() ? nearest(lower(name), names) : here);
  }
  int call(Operation function, std::string_view name, std::size_t begin) {
    const std::string word(name);
    const bool two = takes_two(function);
    const std::string usual = word + (two ? "(y, x)" : "(x)");
    if (here() != '(') refuse(begin, "the function " + word + " without parentheses", usual);
    const std::size_t opened = at_++;
    SyntaxPart part{.kind = SyntaxPart::Kind::operation, .op = function, .at = begin, .begin = begin};
    part.a = expression();
    skip_space();
    if (two) {
      if (here() == ')') refuse(at_, "atan2 with one argument", usual);
      if (!take(",")) (void)closed(opened, ')');
      part.b = expression();
      skip_space();
    }
    if (here() == ',') refuse(at_, word + " with more than " + (two ? "two arguments" : "one argument"), usual);
    part.end = closed(opened, ')');
    return add(part);
  }
  int sum(std::size_t begin) {
    static constexpr const char* usual = "sum(i, 1, n, x[i]^2)";
    if (here() != '(') refuse(begin, "sum without parentheses", usual);
    const std::size_t opened = at_++;
    skip_space();
    SyntaxPart part{.kind = SyntaxPart::Kind::sum, .at = begin, .begin = begin};
    part.word = new_name("in sum");
    int* const operand[]{&part.a, &part.b, &part.c};
    for (int k = 0; k < 3; ++k) {
      skip_space();
      if (!take(",")) {
        if (here() == ')' || at_ == text().size()) {
          refuse(at_, character_at(text(), at_) + " before all four parts of the sum", usual);
        }
        if (k == 0) refuse(at_, character_at(text(), at_) + " after the index of a sum", usual);
        fail_after_operand("','");
      }
      *operand[k] = expression();
    }
    skip_space();
    if (here() == ',') refuse(at_, "a sum with more than four parts", usual);
    part.end = closed(opened, ')');
    return add(part);
  }
  int literal() {
    const std::size_t begin = at_;
    bool point = false;
    bool digits = false;
    for (; is_digit(here()) || here() == '.'; ++at_) {
      if (here() == '.' && point) refuse(at_, "a second point in a number", "a decimal number such as 0.1");
      (here() == '.' ? point : digits) = true;
    }
    if (!digits) refuse(begin, "'.' without digits", "a decimal number such as 0.1");
    if (here() == 'e' || here() == 'E') {
      const std::size_t sign = behind(1) == '+' || behind(1) == '-' ? 2 : 1;
      if (is_digit(behind(sign))) {
        at_ += sign;
        while (is_digit(here())) ++at_;
      }
    }
    const std::string_view number = text().substr(begin, at_ - begin);
    return add({.kind = SyntaxPart::Kind::number, .word = number, .at = begin, .begin = begin, .end = at_});
  }

  const SyntaxRules& rules_;
  Syntax syntax_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

Syntax read_syntax(std::string_view text, const SyntaxRules& rules) { return SyntaxReader(text, rules).read(); }

}  // namespace hamflow
