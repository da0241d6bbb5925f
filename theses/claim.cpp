#include "claim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hamflow {

namespace {
/// One unit of the last printed digit: 0.01 for "-0.25", 1e-18 for "3.747e-15".
double last_place(const std::string& number) {
  const std::size_t e = number.find_first_of("eE");
  const std::string mantissa = number.substr(0, e);
  const std::size_t point = mantissa.find('.');
  const auto decimals = point == std::string::npos ? 0 : static_cast<int>(mantissa.size() - point) - 1;
  const int exponent = e == std::string::npos ? 0 : std::stoi(number.substr(e + 1));
  return std::pow(10.0, exponent - decimals);
}

enum class Place { inside, outside, unclear };

/// Returns the place of the interval value +- uncertainty.
Place place_of(const Rule& rule, const Measured& measured) {
  const double low = measured.value - measured.uncertainty;
  const double high = measured.value + measured.uncertainty;
  if (!(low <= high)) return Place::unclear;  // NaN
  if (low >= rule.low && high <= rule.high) return Place::inside;
  if (high < rule.low || low > rule.high) return Place::outside;
  return Place::unclear;
}

std::string told(const Measured& measured) {
  std::string text = number_text(measured);
  if (measured.uncertainty > 0 && std::isfinite(measured.uncertainty)) {
    text += fmt::format(" +- {:.2g}", measured.uncertainty);
  }
  return measured.how.empty() ? text : text + " (" + measured.how + ")";
}
/// Puts brackets around a negative number, so that it can follow a minus sign.
std::string in_brackets(const std::string& number) { return number.starts_with('-') ? "(" + number + ")" : number; }
}  // namespace

std::string number_text(const Measured& one) {
  if (!(one.uncertainty > 0) || !std::isfinite(one.uncertainty) || one.value == 0)
    return fmt::format("{:.8g}", one.value);
  const double digits = std::ceil(std::log10(std::abs(one.value) / one.uncertainty)) + 1;
  return fmt::format("{:.{}g}", one.value, static_cast<int>(std::clamp(digits, 3.0, 15.0)));
}

Rule as_printed(const std::string& number) {
  const double value = std::stod(number);
  // Half a unit of the last digit, with a margin for the conversion from decimal to double.
  const double half = last_place(number) / 2 * (1 + 1e-9);
  return {"|measured - " + in_brackets(number) + "| at most half a unit of the last digit printed", value - half,
          value + half};
}

Rule at_most(double limit, const std::string& why) {
  Rule rule{fmt::format("measured <= {:.6g}: {}", limit, why)};
  rule.high = limit;
  return rule;
}

Rule at_least(double limit, const std::string& why) {
  Rule rule{fmt::format("measured >= {:.6g}: {}", limit, why)};
  rule.low = limit;
  return rule;
}

Rule within(double expected, double tolerance, const std::string& why) {
  const std::string number = in_brackets(fmt::format("{:.10g}", expected));
  return {fmt::format("|measured - {}| <= {:.3g}: {}", number, tolerance, why), expected - tolerance,
          expected + tolerance};
}

Rule none_of(const std::string& what) {
  Rule rule{"number of " + what + " = 0"};
  rule.high = 0.5;
  return rule;
}

Judgement judge(const Rule& rule, std::span<const Measured> measured, Grounds grounds) {
  if (measured.empty()) return {ClaimVerdict::undecided, "nothing was measured"};
  bool any_inside = false, any_outside = false;
  for (const Measured& one : measured) {
    switch (place_of(rule, one)) {
      case Place::inside:
        any_inside = true;
        break;
      case Place::outside:
        any_outside = true;
        break;
      case Place::unclear:
        return {ClaimVerdict::undecided,
                told(one) + (std::isfinite(one.uncertainty) ? " may lie on either side of the rule"
                                                            : "; the uncertainty is unbounded, so nothing follows")};
    }
  }
  std::string numbers;
  for (const Measured& one : measured) numbers += (numbers.empty() ? "" : ", ") + told(one);
  if (any_inside && any_outside) return {ClaimVerdict::undecided, "the ways of measuring disagree: " + numbers};
  if (any_inside) return {ClaimVerdict::holds, numbers + ", within the rule"};
  if (grounds == Grounds::identity)
    return {ClaimVerdict::cannot_hold, numbers + ", where the rule asks for an identity"};
  if (grounds == Grounds::ways && measured.size() >= 2) {
    return {ClaimVerdict::cannot_hold, numbers + ", beyond the rule in independent measurements"};
  }
  return {ClaimVerdict::differs, numbers + ", beyond the rule"};
}

}  // namespace hamflow
