// Numbers as people write them: "0.1", "1/3", "2*pi/100", read in any arithmetic to its full precision.
#pragma once

#include <charconv>
#include <cstdlib>
#include <string>
#include <string_view>

#include "hamflow/core/error.hpp"
#include "hamflow/core/math.hpp"

namespace hamflow {

/// The nearest R to a decimal literal.
template <class R>
R parse_decimal(std::string_view text);
template <>
inline double parse_decimal<double>(std::string_view text) {
  return std::strtod(std::string(text).c_str(), nullptr);
}
template <>
inline long double parse_decimal<long double>(std::string_view text) {
  return std::strtold(std::string(text).c_str(), nullptr);
}

/// pi in R; types with more digits bring their own.
template <class R>
R pi_value() {
  return parse_decimal<R>("3.14159265358979323846264338327950288419716939937510582097494459");
}

namespace detail {

/// sum := product (('+'|'-') product)*, product := power (('*'|'/') power)*, power := unary (('^'|'**') power)?
template <class R>
class NumberReader {
 public:
  explicit NumberReader(std::string_view text) : text_(text) {}

  R read() {
    const R value = sum();
    skip_space();
    if (at_ != text_.size()) fail("an operator or the end");
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& wanted) const {
    throw Error("not a number: \"" + std::string(text_) + "\", column " + std::to_string(at_ + 1) + ": expected " +
                wanted);
  }
  void skip_space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  bool take(std::string_view token) {
    skip_space();
    if (text_.substr(at_, token.size()) != token) return false;
    at_ += token.size();
    return true;
  }
  R sum() {
    R value = product();
    for (;;) {
      if (take("+")) {
        value = value + product();
      } else if (take("-")) {
        value = value - product();
      } else {
        return value;
      }
    }
  }
  R product() {
    R value = unary();
    for (;;) {
      skip_space();
      if (text_.substr(at_, 2) == "**") return value;
      if (take("*")) {
        value = value * unary();
      } else if (take("/")) {
        value = value / unary();
      } else {
        return value;
      }
    }
  }
  R unary() {
    if (++depth_ > 200) fail("fewer nested signs and parentheses");
    R value{};
    if (take("-")) {
      value = -unary();
    } else if (take("+")) {
      value = unary();
    } else {
      value = power();
    }
    --depth_;
    return value;
  }
  R power() {
    const R base = atom();
    if (take("**") || take("^")) return pow(base, unary());  // right-associative, and 2^-3 is allowed
    return base;
  }
  R atom() {
    skip_space();
    if (take("(")) {
      const R value = sum();
      if (!take(")")) fail("')'");
      return value;
    }
    if (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) return literal();
    const std::size_t begin = at_;
    std::string word;
    while (at_ < text_.size() && (is_letter(text_[at_]) || (!word.empty() && is_digit(text_[at_]))))
      word += text_[at_++];
    if (word == "pi" || word == "Pi") return pi_value<R>();
    if (!word.empty() && take("(")) return function_of(word, begin);
    at_ = begin;
    fail("a number, pi, a function such as sqrt(2), or '('");
  }
  /// What follows "word(".
  R function_of(const std::string& word, std::size_t begin) {
    const auto close = [this](const R& value) {
      if (!take(")")) fail("')'");
      return value;
    };
    const R x = sum();
    if (word == "atan2") {
      if (!take(",")) fail("',': atan2 takes two numbers");
      const R y = sum();
      return close(atan2(x, y));
    }
    if (word == "sqrt") return close(sqrt(x));
    if (word == "exp") return close(exp(x));
    if (word == "log") return close(log(x));
    if (word == "sin") return close(sin(x));
    if (word == "cos") return close(cos(x));
    if (word == "tan") return close(tan(x));
    if (word == "asin") return close(asin(x));
    if (word == "acos") return close(acos(x));
    if (word == "atan") return close(atan(x));
    if (word == "sinh") return close(sinh(x));
    if (word == "cosh") return close(cosh(x));
    if (word == "tanh") return close(tanh(x));
    if (word == "abs") return close(abs(x));
    at_ = begin;
    fail("one of sqrt, exp, log, sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, abs");
  }
  R literal() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) ++at_;
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      std::size_t after = at_ + 1;
      if (after < text_.size() && (text_[after] == '+' || text_[after] == '-')) ++after;
      if (after < text_.size() && is_digit(text_[after])) {
        at_ = after;
        while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
      }
    }
    const std::string_view digits = text_.substr(begin, at_ - begin);
    if (digits.find_first_of("0123456789") == std::string_view::npos || digits.find('.') != digits.rfind('.')) {
      fail("a decimal number");
    }
    return parse_decimal<R>(digits);
  }
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace detail

/// The value of a number expression in R. @throws Error naming the column where it stops making sense
template <class R>
R evaluate_number(std::string_view text) {
  return detail::NumberReader<R>(text).read();
}

/// The shortest decimal that reads back as the same double.
inline std::string shortest(double x) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, x).ptr;
  return {buffer, end};
}

}  // namespace hamflow
