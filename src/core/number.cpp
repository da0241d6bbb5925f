#include "hamflow/core/number.hpp"

#include <charconv>
#include <cmath>

#include "text_place.hpp"

namespace hamflow {

bool is_literal(std::string_view text) {
  const auto digits_from = [&](std::size_t at) {
    while (at < text.size() && is_digit(text[at])) ++at;
    return at;
  };
  std::size_t at = digits_from(0);
  if (at == 0 || text.size() > 1'000'000) return false;
  if (at < text.size() && text[at] == '.') at = digits_from(at + 1);
  if (at + 1 < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    const std::size_t exponent = at + (text[at + 1] == '-' || text[at + 1] == '+' ? 2 : 1);
    at = digits_from(exponent);
    if (at == exponent) return false;
  }
  return at == text.size();
}

template double evaluate_number<double>(std::string_view);
template long double evaluate_number<long double>(std::string_view);

std::int64_t evaluate_whole(std::string_view text) {
  constexpr long double most = 0x1p53L;
  const auto value = evaluate_number<long double>(text);  // a double hides fractions beyond 2^53
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
