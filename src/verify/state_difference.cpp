#include "state_difference.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "hamflow/arithmetic/mp.hpp"

namespace hamflow {

namespace {
/// Returns the exponent after the e, such as -412; 0 if there is none.
int exponent_of(const std::string& decimal) {
  const auto e = decimal.find_first_of("eE");
  return e == std::string::npos ? 0 : std::atoi(decimal.c_str() + e + 1);
}

Magnitude magnitude_of(const Mp& x) {
  // From this size on a double has all its bits.
  if (x == Mp(0) || !(x < Mp(std::numeric_limits<double>::min()))) return {static_cast<double>(x)};
  return Magnitude(written_digits(x));
}
}  // namespace

Magnitude::Magnitude(const std::string& decimal) {
  const double mantissa = std::strtod(decimal.substr(0, decimal.find_first_of("eE")).c_str(), nullptr);
  const int exponent = exponent_of(decimal);
  value = std::strtod(decimal.c_str(), nullptr);
  log10 = std::log10(mantissa) + exponent;
  if (value >= std::numeric_limits<double>::min() || mantissa == 0) return;
  value = 0;
  text = fmt::format("{:.16f}", mantissa) + fmt::format("e{}", exponent);
}

std::string readable(const Magnitude& x, int digits) {
  if (x.text.empty()) return fmt::format("{:.{}e}", x.value, digits);
  const double exponent = std::floor(x.log10);
  return fmt::format("{:.{}f}e{:.0f}", std::pow(10.0, x.log10 - exponent), digits, exponent);
}

std::string exact_digits(double x) { return fmt::format("{:.45e}", x); }

std::vector<std::string> state_digits(const Frame& frame) {
  std::vector<std::string> all;
  if (!frame.digits.q.empty()) {
    all = frame.digits.q;
    all.insert(all.end(), frame.digits.p.begin(), frame.digits.p.end());
    return all;
  }
  for (const auto* block : {&frame.q, &frame.p}) {
    for (const double x : *block) all.push_back(exact_digits(x));
  }
  return all;
}

Magnitude largest_difference(const std::vector<std::string>& a, const std::vector<std::string>& b,
                             const std::vector<double>& sizes, int digits) {
  const MpDigits scope(digits);
  Mp most(0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Mp difference = abs(parse_decimal<Mp>(a[i]) - parse_decimal<Mp>(b[i])) / Mp(sizes[i]);
    if (!(difference <= most)) most = difference;  // NaN counts as the largest
  }
  return magnitude_of(most);
}

Magnitude relative_difference(const std::string& a, const std::string& b, double scale, int digits) {
  const MpDigits scope(digits);
  return magnitude_of(abs(parse_decimal<Mp>(a) - parse_decimal<Mp>(b)) / Mp(scale));
}

}  // namespace hamflow
