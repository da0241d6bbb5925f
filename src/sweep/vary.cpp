#include "vary.hpp"

#include <cmath>
#include <optional>

#include "hamflow/core/number.hpp"

namespace hamflow {

namespace {

constexpr std::size_t most_members = 10'000'000;
constexpr const char* forms = "allowed PATH=a:b:n, n values from a to b, or PATH=v1,v2,...";

/// Split where `separator` stands outside of parentheses, brackets and quotes.
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

/// The value of a number, also of one in quotes.
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

double range_end(const std::string& text, const std::string& whole) {
  const auto x = number_in(text);
  if (!x) throw Error("found \"" + text + "\" in " + whole + ", which is not a finite number; " + forms);
  return *x;
}

}  // namespace

Vary parse_vary(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw Error("found \"" + text + "\"; " + forms);
  }
  Vary vary{trimmed(text.substr(0, equals)), {}, {}, false};
  const std::string values = text.substr(equals + 1);
  const std::vector<std::string> range = split(values, ':');
  if (range.size() == 1) {
    vary.is_list = true;
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
  if (!(count >= 1) || count != std::floor(count) || count > static_cast<double>(most_members)) {
    throw Error("found n = " + trimmed(range[2]) + " in \"" + text + "\"; allowed a whole number from 1 to 10000000");
  }
  const auto n = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < n; ++i) {
    // Both ends are met exactly.
    const double part = n > 1 ? static_cast<double>(i) / static_cast<double>(n - 1) : 0;
    const double x = i + 1 == n && n > 1 ? b : a + (b - a) * part;
    if (!std::isfinite(x)) throw Error("found a range too wide for double in \"" + text + "\"");
    vary.numbers.push_back(x);
    vary.texts.push_back(shortest(x));
  }
  return vary;
}

std::string without_quotes(const std::string& text) {
  const bool quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
  return quoted ? text.substr(1, text.size() - 2) : text;
}

std::size_t member_count(const std::vector<Vary>& varied) {
  std::size_t count = 1;
  for (const Vary& vary : varied) {
    if (vary.texts.size() > most_members / count) {
      throw Error("found more than 10000000 members; allowed fewer values for each key");
    }
    count *= vary.texts.size();
  }
  return count;
}

std::vector<std::size_t> values_of_member(const std::vector<Vary>& varied, std::size_t member) {
  std::vector<std::size_t> values(varied.size());
  for (std::size_t k = varied.size(); k-- > 0;) {
    values[k] = member % varied[k].texts.size();
    member /= varied[k].texts.size();
  }
  return values;
}

}  // namespace hamflow
