#include "hamflow/formula/tex.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace hamflow {

namespace {

constexpr std::size_t longest_formula = 2000;
constexpr std::array greek{"alpha",  "beta",   "gamma", "delta", "epsilon", "zeta",  "eta",   "theta",
                           "kappa",  "lambda", "mu",    "nu",    "xi",      "pi",    "rho",   "sigma",
                           "tau",    "phi",    "chi",   "psi",   "omega",   "Gamma", "Delta", "Theta",
                           "Lambda", "Xi",     "Pi",    "Sigma", "Phi",     "Psi",   "Omega"};
constexpr std::array known{"sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "log"};  // commands of LaTeX
constexpr std::array other_functions{"asin", "acos", "atan", "atan2", "abs"};

bool is_among(const auto& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Translates a formula from left to right. A quotient becomes a fraction of the operands before and after it.
class TexWriter {
 public:
  explicit TexWriter(std::string_view text) : text_(text) {}

  /// Translates up to one of the closing characters, or to the end.
  std::string sequence(std::string_view closing) {
    std::string all;
    bool behind_operand = false;  // whether the next operand is a factor
    while (at_ < text_.size() && closing.find(text_[at_]) == std::string_view::npos) {
      const char c = text_[at_];
      if (begins_operand(c)) {
        const bool is_argument = c == '(' && at_ > 0 && is_letter(text_[at_ - 1]);  // V(r)
        if (behind_operand && !is_argument) all += is_digit(c) ? " \\cdot " : " \\, ";
        all += quotient();
        behind_operand = true;
        continue;
      }
      ++at_;
      if (c == ' ') continue;
      if (c == '*') {
        behind_operand = true;
        continue;
      }
      behind_operand = false;
      all += c == ',' ? ",\\; " : c == '<' ? " < " : std::string(" ") + plain(c) + " ";
    }
    return all;
  }

 private:
  struct Operand {
    std::string tex;
    std::string inside{};  // an operand in parentheses, without them; a fraction does not need them
  };

  bool begins_operand(char c) const {
    if (c == '|') return text_.find('|', at_ + 1) != std::string_view::npos && !in_bars_;
    return is_letter(c) || is_digit(c) || c == '(' || c == '[' || c == '{' || c == '.';
  }
  /// Escapes a character that has a meaning in LaTeX.
  static std::string plain(char c) {
    constexpr std::string_view special = "#$%&_{}";
    if (special.find(c) != std::string_view::npos) return std::string("\\") + c;
    return c == '\\' ? "\\backslash" : c == '~' ? "\\sim" : c == '^' ? "\\wedge" : std::string(1, c);
  }
  void skip_blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool takes(char c) {
    const std::size_t before = at_;
    skip_blanks();
    if (at_ < text_.size() && text_[at_] == c) {
      ++at_;
      return true;
    }
    at_ = before;
    return false;
  }

  std::string quotient() {
    Operand above = power();
    while (takes('/')) {
      skip_blanks();
      const Operand below = at_ < text_.size() && begins_operand(text_[at_]) ? power() : Operand{"\\;"};
      above = {"\\frac{" + without_parentheses(above) + "}{" + without_parentheses(below) + "}"};
    }
    return above.tex;
  }
  static const std::string& without_parentheses(const Operand& x) { return x.inside.empty() ? x.tex : x.inside; }

  Operand power() {
    Operand base = primary();
    if (!takes('^')) return base;
    skip_blanks();
    std::string sign;
    if (at_ < text_.size() && (text_[at_] == '-' || text_[at_] == '+')) sign = text_[at_++];
    skip_blanks();
    if (at_ >= text_.size() || !begins_operand(text_[at_])) return {base.tex + "^{" + sign + "}"};
    return {base.tex + "^{" + sign + without_parentheses(power()) + "}"};
  }

  Operand primary() {
    const char c = text_[at_];
    if (is_digit(c) || c == '.') return {number()};
    if (is_letter(c)) return named();
    ++at_;
    if (c == '|') {
      in_bars_ = true;
      const std::string inside = sequence("|");
      in_bars_ = false;
      takes('|');
      return {"\\left|" + inside + "\\right|"};
    }
    const char end = c == '(' ? ')' : c == '[' ? ']' : '}';
    const bool in_bars = std::exchange(in_bars_, false);
    const std::string inside = sequence(std::string_view(&end, 1));
    in_bars_ = in_bars;
    takes(end);
    if (c == '(') return {"\\left(" + inside + "\\right)", inside};
    if (c == '[') return {"\\left[" + inside + "\\right]"};
    return {"{" + inside + "}"};
  }

  std::string number() {
    const std::size_t first = at_;
    while (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) ++at_;
    const std::string digits(text_.substr(first, at_ - first));
    std::size_t end = at_;
    if (end >= text_.size() || (text_[end] != 'e' && text_[end] != 'E')) return digits;
    ++end;
    const std::size_t exponent = end;
    if (end < text_.size() && (text_[end] == '-' || text_[end] == '+')) ++end;
    if (end >= text_.size() || !is_digit(text_[end])) return digits;
    while (end < text_.size() && is_digit(text_[end])) ++end;
    at_ = end;
    return digits + "\\cdot 10^{" + std::string(text_.substr(exponent, end - exponent)) + "}";
  }

  /// Translates a name, or a function with its argument. In a name, the part after the first underscore or after the
  /// last letter becomes an index.
  Operand named() {
    const std::size_t first = at_;
    while (at_ < text_.size() && is_letter(text_[at_])) ++at_;
    std::string name(text_.substr(first, at_ - first));
    if (name == "atan" && at_ < text_.size() && text_[at_] == '2') name += text_[at_++];
    const bool has_argument = at_ < text_.size() && text_[at_] == '(';
    if (name == "sqrt" && has_argument) return {"\\sqrt{" + without_parentheses(primary()) + "}"};
    if (name == "sum") name = "\\sum";
    if (is_among(known, name)) return {"\\" + name + (has_argument ? primary().tex : " ")};
    if (is_among(other_functions, name) && has_argument) return {"\\operatorname{" + name + "}" + primary().tex};
    std::string base = is_among(greek, name) ? "\\" + name
                       : name == "eps"       ? "\\epsilon"
                       : name == "\\sum"     ? name
                       : name.size() > 1     ? "\\mathrm{" + name + "}"
                                             : name;
    std::string index;
    while (at_ < text_.size() &&
           (is_digit(text_[at_]) || text_[at_] == '_' || (is_letter(text_[at_]) && !index.empty()))) {
      if (text_[at_] == '_' && at_ + 1 < text_.size() && text_[at_ + 1] == '{') {
        ++at_;
        index += primary().tex;
        break;
      }
      index += text_[at_++];
    }
    if (index.starts_with('_')) index.erase(0, 1);
    if (index.empty()) return {base};
    if (is_among(greek, index)) index = "\\" + index;
    for (std::size_t i = index.find('_'); i != std::string::npos; i = index.find('_', i + 2)) index.insert(i, "\\");
    base += "_{" + index + "}";
    return {base};
  }

  std::string_view text_;
  std::size_t at_ = 0;
  bool in_bars_ = false;
};

}  // namespace

std::string tex_of(const std::string& formula) {
  if (formula.size() > longest_formula) return {};
  return TexWriter(formula).sequence({});
}

}  // namespace hamflow
