#include "portable/emscripten/shortest_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <limits>

namespace hamflow {

std::string shortest_text(double x) {
  const std::string sign = std::signbit(x) ? "-" : "";
  if (x != x) return sign + "nan";
  const double size = std::fabs(x);
  if (size > std::numeric_limits<double>::max()) return sign + "inf";
  // The digits of fmt's shortest text, without their point and outer zeros.
  const std::string shortest = fmt::format("{}", size);
  const std::size_t e = shortest.find('e');
  const std::string mantissa = shortest.substr(0, e);
  const std::size_t point = mantissa.find('.');
  std::string digits;
  for (const char c : mantissa) {
    if (c != '.') digits += c;
  }
  // of ten, for a point behind the first digit
  int exponent = static_cast<int>(point == std::string::npos ? mantissa.size() : point) - 1;
  if (e != std::string::npos) exponent += std::atoi(shortest.c_str() + e + 1);
  const std::size_t zeros = digits.find_first_not_of('0');
  if (zeros == std::string::npos) return sign + "0";
  digits.erase(0, zeros);
  exponent -= static_cast<int>(zeros);
  digits.erase(digits.find_last_not_of('0') + 1);
  const int count = static_cast<int>(digits.size());
  std::string with_exponent = digits.substr(0, 1);
  if (count > 1) with_exponent += "." + digits.substr(1);
  with_exponent += fmt::format("e{}{:02}", exponent < 0 ? '-' : '+', std::abs(exponent));
  std::string without;
  if (exponent < 0) {
    without = "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + digits;
  } else if (exponent + 1 >= count) {  // a whole number, with all its digits
    without = fmt::format("{:.0f}", size);
  } else {
    const auto whole = static_cast<std::size_t>(exponent + 1);
    without = digits.substr(0, whole) + "." + digits.substr(whole);
  }
  return sign + (with_exponent.size() < without.size() ? with_exponent : without);
}

}  // namespace hamflow
