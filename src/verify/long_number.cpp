#include "hamflow/verify/long_number.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hamflow/arithmetic/mp.hpp"

namespace hamflow {

namespace {

constexpr int of_results = 40;  // digits of an error; a few would suffice

int digits_of(const std::vector<std::string>& numbers) {
  std::size_t longest = 0;
  for (const std::string& text : numbers) longest = std::max(longest, text.size());
  return static_cast<int>(longest) + 10;
}

LongNumber shown(const Mp& x) {
  LongNumber number(static_cast<double>(x));
  const bool fits = std::abs(number.value) >= std::numeric_limits<double>::min() && std::isfinite(number.value);
  if (fits || x == Mp(0)) return number;
  number.text = scientific_text(x, 15);
  return number;
}

Mp whole(const LongNumber& x) { return x.text.empty() ? Mp(x.value) : parse_decimal<Mp>(x.text); }

}  // namespace

LongNumber times(double x, const std::string& decimal) {
  const MpDigits scope(of_results);
  return shown(Mp(x) * parse_decimal<Mp>(decimal));
}

LongNumber times_power_of_ten(double x, int exponent) { return times(x, "1e" + std::to_string(exponent)); }

LongNumber quotient(const LongNumber& a, const LongNumber& b) {
  if (a.text.empty() && b.text.empty()) {
    const double plain = a.value / b.value;
    if (a.value == 0 || std::abs(plain) >= std::numeric_limits<double>::min()) return plain;
  }
  const MpDigits scope(of_results);
  return shown(whole(a) / whole(b));
}

bool at_most(const LongNumber& a, const LongNumber& b) {
  if (a.text.empty() && b.text.empty()) return a.value <= b.value;
  const MpDigits scope(of_results);
  return whole(a) <= whole(b);
}

LongNumber largest_difference(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  const MpDigits scope(std::max(digits_of(a), digits_of(b)));
  Mp most(0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Mp difference = abs(parse_decimal<Mp>(a[i]) - parse_decimal<Mp>(b[i]));
    if (difference > most) most = difference;
  }
  return shown(most);
}

ScaledDifferences differences_to_first(const std::vector<std::string>& numbers) {
  const MpDigits scope(digits_of(numbers));
  std::vector<Mp> differences;
  Mp most(0);
  for (const std::string& text : numbers) {
    differences.push_back(parse_decimal<Mp>(text) - parse_decimal<Mp>(numbers.front()));
    const Mp size = abs(differences.back());
    if (size > most || size != size) most = size;
  }
  ScaledDifferences found;
  found.unit = written_digits(most);
  for (const Mp& difference : differences) {
    found.values.push_back(most == Mp(0) ? 0 : static_cast<double>(difference / most));
  }
  return found;
}

}  // namespace hamflow
