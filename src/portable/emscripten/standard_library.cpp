// What standard_library.hpp declares.
#include "portable/emscripten/standard_library.hpp"

#include <fmt/format.h>

#include <cmath>

namespace std {

/// The shortest text that reads back as x, with an exponent if that is shorter.
to_chars_result to_chars(char* first, char* last, double x) {
  string text;
  if (x != x || x > __DBL_MAX__ || x < -__DBL_MAX__) {
    text = x != x ? (signbit(x) ? "-nan" : "nan") : x > 0 ? "inf" : "-inf";
  } else {
    // The digits of fmt's shortest text, without their point and outer zeros.
    const string shortest = fmt::format("{}", x < 0 || signbit(x) ? -x : x);
    string digits;
    int exponent = 0;  // of ten, for a point behind the first digit
    const size_t e = shortest.find('e');
    const string mantissa = shortest.substr(0, e);
    const size_t point = mantissa.find('.');
    for (const char c : mantissa) {
      if (c != '.') digits += c;
    }
    exponent = static_cast<int>(point == string::npos ? mantissa.size() : point) - 1;
    if (e != string::npos) exponent += atoi(shortest.c_str() + e + 1);
    const size_t zeros = digits.find_first_not_of('0');
    if (zeros == string::npos) {
      digits = "0";
      exponent = 0;
    } else {
      digits.erase(0, zeros);
      exponent -= static_cast<int>(zeros);
      digits.erase(digits.find_last_not_of('0') + 1);
    }
    const int count = static_cast<int>(digits.size());
    string with_exponent = digits.substr(0, 1);
    if (count > 1) with_exponent += "." + digits.substr(1);
    with_exponent += fmt::format("e{}{:02}", exponent < 0 ? '-' : '+', exponent < 0 ? -exponent : exponent);
    string without;
    if (exponent < 0) {
      without = "0." + string(static_cast<size_t>(-exponent - 1), '0') + digits;
    } else if (exponent + 1 >= count) {  // a whole number, with all its digits
      without = fmt::format("{:.0f}", x < 0 || signbit(x) ? -x : x);
    } else {
      without =
          digits.substr(0, static_cast<size_t>(exponent + 1)) + "." + digits.substr(static_cast<size_t>(exponent + 1));
    }
    text = (signbit(x) ? "-" : "") + (with_exponent.size() < without.size() ? with_exponent : without);
  }
  if (static_cast<size_t>(last - first) < text.size()) return {last, errc::value_too_large};
  memcpy(first, text.data(), text.size());
  return {first + text.size(), errc()};
}

}  // namespace std
