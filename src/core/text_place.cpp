#include "text_place.hpp"

#include <algorithm>
#include <utility>

#include "hamflow/core/error.hpp"

namespace hamflow {

std::string shown(std::string_view text, std::size_t at) {
  constexpr std::size_t most = 60;
  if (text.size() <= most) return std::string(text);
  std::size_t begin = std::min(at > most / 2 ? at - most / 2 : 0, text.size() - most);
  std::size_t end = begin + most;
  while (begin > 0 && continues_character(text[begin])) --begin;
  while (end < text.size() && continues_character(text[end])) ++end;
  return (begin > 0 ? "..." : "") + std::string(text.substr(begin, end - begin)) + (end < text.size() ? "..." : "");
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower(std::string_view word) {
  std::string all(word);
  for (char& c : all) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return all;
}

std::string written_here(std::string_view name) {
  static constexpr std::pair<std::string_view, std::string_view> table[] = {{"ln", "log(x)"},
                                                                            {"lg", "log(x)/log(10)"},
                                                                            {"log10", "log(x)/log(10)"},
                                                                            {"log2", "log(x)/log(2)"},
                                                                            {"pow", "x^y"},
                                                                            {"power", "x^y"},
                                                                            {"sqr", "x^2, or sqrt(x)"},
                                                                            {"tg", "tan(x)"},
                                                                            {"square", "x^2"},
                                                                            {"cbrt", "x^(1/3)"},
                                                                            {"hypot", "sqrt(x^2 + y^2)"},
                                                                            {"sec", "1/cos(x)"},
                                                                            {"csc", "1/sin(x)"},
                                                                            {"cot", "1/tan(x)"},
                                                                            {"e", "exp(1), and exp(x) for e^x"},
                                                                            {"asinh", "log(x + sqrt(x^2 + 1))"},
                                                                            {"acosh", "log(x + sqrt(x^2 - 1))"},
                                                                            {"atanh", "log((1 + x)/(1 - x))/2"},
                                                                            {"sgn", "x/abs(x)"},
                                                                            {"sign", "x/abs(x)"},
                                                                            {"fabs", "abs(x)"}};
  const std::string wanted = lower(name);
  for (const auto& [other, here] : table) {
    if (wanted == other) return std::string(here);
  }
  return "";
}

std::string character_at(std::string_view text, std::size_t at) {
  if (at >= text.size()) return "the end";
  std::size_t end = at + 1;
  while (end < text.size() && continues_character(text[end])) ++end;
  return "'" + std::string(text.substr(at, end - at)) + "'";
}

namespace {
/// Replaces control characters: line ends and tabs by a blank, others by an escape such as \\x07.
std::string printable(const std::string& text) {
  static constexpr const char* digits = "0123456789abcdef";
  std::string all;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\n' || c == '\r' || c == '\t') {
      all += ' ';
    } else if (code < 0x20 || code == 0x7f) {
      all += std::string("\\x") + digits[code / 16] + digits[code % 16];
    } else {
      all += c;
    }
  }
  return all;
}
}  // namespace

void refuse_at(std::string_view text, std::size_t at, const std::string& what, const std::string& allowed,
               const std::string& meant) {
  const auto before = text.begin() + static_cast<std::ptrdiff_t>(std::min(at, text.size()));
  const auto column = 1 + std::count_if(text.begin(), before, [](char c) { return !continues_character(c); });
  throw Error(printable("found \"" + shown(text, at) + "\", column " + std::to_string(column) + ": " + what +
                        "; allowed " + allowed + (meant.empty() ? "" : "; did you mean " + meant + "?")));
}

}  // namespace hamflow
