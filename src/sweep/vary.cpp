#include "vary.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "hamflow/core/number.hpp"
#include "run_keys.hpp"

namespace hamflow {

namespace {

constexpr std::size_t most_values = 10'000'000;
constexpr const char* forms =
    "allowed PATH=a:b:n, n values from a to b, PATH=v1,v2,..., or PATH=FORMULA of other varied keys";

/// Splits at each `separator` outside parentheses, brackets and quotes.
std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '(' || c == '[' || c == '{') {
      ++depth;
    } else if (c == ')' || c == ']' || c == '}') {
      --depth;
    } else if (c == separator && depth == 0) {
      parts.emplace_back();
      continue;
    }
    parts.back() += c;
  }
  return parts;
}

std::string trimmed(const std::string& text) {
  const auto begin = text.find_first_not_of(" \t");
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// Returns the value of a number, which may be in quotes.
std::optional<double> number_in(std::string text) {
  if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front()) {
    text = text.substr(1, text.size() - 2);
  }
  try {
    const double x = evaluate_number<double>(text);
    if (std::isfinite(x)) return x;
  } catch (const Error&) {  // NOLINT: no number is an answer
  }
  return std::nullopt;
}

/// Returns an end of a range as --set accepts it. A number that a double cannot hold, such as 1/3 or a number with more
/// digits, stays as it was typed, so that every arithmetic reads its own digits.
std::string exact_end(const std::string& text, double x) {
  constexpr std::size_t held_by_double = 16;  // length of a decimal with 15 digits
  const bool plain = text.find_first_not_of("0123456789.eE+-") == std::string::npos;
  return plain && text.size() <= held_by_double ? shortest(x) : text;
}

double range_end(const std::string& text, const std::string& whole) {
  const auto x = number_in(text);
  if (!x) throw Error("found \"" + text + "\" in " + whole + ", which is not a finite number; " + forms);
  return *x;
}

}  // namespace

std::vector<NamedPath> paths_in(const std::string& formula) {
  constexpr const char* letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";
  const auto is_letter = [&](char c) {
    return c != '\0' && std::string_view(letters).find(c) != std::string_view::npos;
  };
  std::vector<NamedPath> all;
  for (std::size_t at = 0; at < formula.size();) {
    if (!is_letter(formula[at])) {
      ++at;
      continue;
    }
    std::size_t end = std::min(formula.find_first_not_of(letters, at), formula.size());
    const std::string table = formula.substr(at, end - at);
    const bool starts_path = table == "problem" || table == "method" || table == run_table || table == output_table;
    if (starts_path && end < formula.size() && formula[end] == '.') {
      // A path continues with dots and names, or with indices in brackets.
      while (end < formula.size()) {
        const bool goes_on = formula[end] == '.' && end + 1 < formula.size() && is_letter(formula[end + 1]);
        const std::size_t close = formula[end] == '[' ? formula.find(']', end) : std::string::npos;
        if (goes_on) {
          end = std::min(formula.find_first_not_of(letters, end + 1), formula.size());
        } else if (close != std::string::npos) {
          end = close + 1;
        } else {
          break;
        }
      }
      all.push_back({formula.substr(at, end - at), at});
    }
    at = end;
  }
  return all;
}

std::size_t count_of_range(const std::string& text) {
  const auto equals = text.find('=');
  const std::vector<std::string> range = split(text.substr(equals == std::string::npos ? 0 : equals + 1), ':');
  const auto count = range.size() == 3 ? number_in(trimmed(range[2])) : std::nullopt;
  return count && *count >= 1 && *count <= static_cast<double>(most_values) ? static_cast<std::size_t>(*count) : 1;
}

double ValueRange::number(std::size_t i) const {
  if (i == 0) return first;
  if (i + 1 == count) return last;
  const auto k = static_cast<double>(i);
  const auto intervals = static_cast<double>(count - 1);
  const double step = (last - first) / intervals;
  const bool is_whole = first == std::floor(first) && step == std::floor(step);
  return is_whole ? first + step * k : first + (last - first) * (k / intervals);
}

std::string ValueRange::text(std::size_t i) const {
  return i == 0 ? first_text : i + 1 == count ? last_text : shortest(number(i));
}

Vary parse_vary(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw Error("found \"" + text + "\"; " + forms);
  }
  Vary vary{trimmed(text.substr(0, equals)), {}, {}};
  if (vary.path == run_path(run_keys().functions)) {
    throw Error("found " + vary.path + "; allowed any other key, because a process computes with one set of functions");
  }
  const std::string values = text.substr(equals + 1);
  const std::vector<std::string> range = split(values, ':');
  if (range.size() == 1) {
    const bool quoted = without_quotes(trimmed(values)) != trimmed(values);
    if (!quoted && !paths_in(values).empty()) {
      vary.formula = trimmed(values);
      return vary;
    }
    for (const std::string& part : split(values, ',')) {
      vary.texts.push_back(trimmed(part));
      if (vary.texts.back().empty()) throw Error("found an empty value in \"" + text + "\"; " + forms);
    }
    for (const std::string& value : vary.texts) {
      const auto x = number_in(value);
      if (!x) {
        vary.numbers.clear();
        break;
      }
      vary.numbers.push_back(*x);
    }
    return vary;
  }
  if (range.size() != 3) throw Error("found " + std::to_string(range.size()) + " parts in \"" + text + "\"; " + forms);
  const double a = range_end(trimmed(range[0]), text);
  const double b = range_end(trimmed(range[1]), text);
  const double count = range_end(trimmed(range[2]), text);
  if (!(count >= 1) || count != std::floor(count) || count > static_cast<double>(most_values)) {
    throw Error("found n = " + trimmed(range[2]) + " in \"" + text + "\"; allowed a whole number from 1 to 10000000");
  }
  vary.range = {a, b, static_cast<std::size_t>(count), exact_end(trimmed(range[0]), a),
                exact_end(trimmed(range[1]), b)};
  if (vary.range->count > 2 && !std::isfinite(vary.range->number(vary.range->count / 2))) {
    throw Error("found a range too wide for double in \"" + text + "\"");
  }
  return vary;
}

std::string without_quotes(const std::string& text) {
  const bool quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
  return quoted ? text.substr(1, text.size() - 2) : text;
}

}  // namespace hamflow
