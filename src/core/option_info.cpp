#include "hamflow/detail/core/option_info.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/core/number.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/core/text.hpp"

namespace hamflow {

namespace {

bool is_yes_no(const std::string& word) { return word == "true" || word == "false"; }

bool is_word(const OptionInfo& option, const std::string& text) {
  return std::find(option.words.begin(), option.words.end(), text) != option.words.end();
}

/// A word as it is written where numbers are allowed too.
std::string quoted(const std::string& word) { return is_yes_no(word) ? word : "\"" + word + "\""; }

std::string list_text(const OptionInfo& option) {
  const std::string of_each = option.range.whole ? "whole " : "";
  const std::string count = option.length > 0 ? std::to_string(option.length) + " " : "";
  const std::string range = range_text(option.range);
  return "an array of " + count + of_each + (option.length == 1 ? "number" : "numbers") +
         (range.empty() ? "" : ", each " + range);
}

std::string number_text(const OptionInfo& option) {
  const std::string range = range_text(option.range);
  if (option.range.least == option.range.most) return range;
  if (option.range.whole) return "a whole number" + (range.empty() ? "" : " " + range);
  if (range == "positive") return "a positive number";
  return "a number" + (range.empty() ? "" : (range.starts_with("not") ? ", " : " ") + range);
}

std::string found(const OptionInfo& option, const std::string& text) {
  return "found '" + text + "'; allowed " + allowed_text(option);
}

/// Whether TOML reads the text as a number: "12", "-0.5", "1e6". Formulas such as "1-2" are strings in TOML.
bool is_toml_number(const std::string& text) {
  std::size_t at = 0;
  const auto digits = [&] {
    const std::size_t begin = at;
    while (at < text.size() && text[at] >= '0' && text[at] <= '9') ++at;
    return at - begin;
  };
  const auto take = [&](const char* any_of) {
    const bool there = at < text.size() && std::string(any_of).find(text[at]) != std::string::npos;
    at += there ? 1 : 0;
    return there;
  };
  (void)take("+-");
  const bool leading_zero = at < text.size() && text[at] == '0';
  const std::size_t before_point = digits();
  if (before_point == 0 || (leading_zero && before_point > 1)) return false;
  if (take(".") && digits() == 0) return false;
  if (take("eE")) {
    (void)take("+-");
    if (digits() == 0) return false;
  }
  return at == text.size();
}

std::string refused_number(const OptionInfo& option, const std::string& text, const std::string& whole_text) {
  // A text without a digit or a function call was meant as a word, if the option has words; it is no formula.
  const bool meant_as_word = text != "pi" && text.find_first_of("0123456789(") == std::string::npos;
  if (meant_as_word) return found(option, whole_text) + suggestion(text, option.words);
  try {
    const long double x = option.beyond_double ? wide_number_value(text) : evaluate_number<double>(text);
    return option.range.contains(x) ? "" : found(option, whole_text);
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace

bool Range::contains(long double x) const {
  if (!std::isfinite(x) || (whole && x != std::floor(x)) || (not_zero && x == 0)) return false;
  return open ? least < x && x < most : least <= x && x <= most;
}

std::string range_text(const Range& range) {
  const bool from = std::isfinite(range.least);
  const bool to = std::isfinite(range.most);
  const auto text = [&](double x) -> std::string {
    if (x == 0x1p53) return "2^53";  // a double holds every whole number up to here
    return range.whole && std::abs(x) < 0x1p63 ? std::to_string(static_cast<long long>(x)) : shortest(x);
  };
  if (from && to && range.least == range.most) return text(range.least);
  if (from && to)
    return (range.open ? "between " : "from ") + text(range.least) + (range.open ? " and " : " to ") + text(range.most);
  if (from && range.least == 0 && !range.whole) return range.open ? "positive" : "not negative";
  if (from) return (range.open ? "above " : "from ") + text(range.least);
  if (to) return (range.open ? "below " : "up to ") + text(range.most);
  return range.not_zero ? "other than 0" : "";
}

std::string allowed_text(const OptionInfo& option) {
  const std::string or_words = option.words.empty() ? "" : ", or " + joined(option.words, quoted);
  switch (option.type) {
    case OptionType::number:
      return number_text(option) + or_words;
    case OptionType::list:
      return list_text(option) + or_words;
    case OptionType::number_or_list:
      return number_text(option) + " or " + list_text(option) + or_words;
    case OptionType::word:
      return joined(option.words);
    case OptionType::word_list:
      return option.words.empty() ? "an array of texts" : "a list of some of " + joined(option.words);
    case OptionType::yes_no:
      return option.words.empty() ? "true, false" : "true, false, or " + joined(option.words);
    case OptionType::text:
      return "a non-empty text";
    case OptionType::table:
      return option.keys.empty() ? "a table of texts by name" : "a table with " + joined(option_names(option.keys));
  }
  return {};
}

std::string refused_value(const OptionInfo& option, const std::string& text) {
  if (is_word(option, text)) return {};
  switch (option.type) {
    case OptionType::number:
      return refused_number(option, text, text);
    case OptionType::list:
    case OptionType::number_or_list: {
      if (option.type == OptionType::list && !text.starts_with("[")) return found(option, text);
      const std::vector<std::string> parts = list_parts(text);
      if (parts.empty() || (option.length > 0 && parts.size() != option.length)) return found(option, text);
      for (const std::string& part : parts) {
        if (std::string refused = refused_number(option, part, text); !refused.empty()) return refused;
      }
      return {};
    }
    case OptionType::yes_no:
      if (text == "true" || text == "false") return {};
      return found(option, text) + suggestion(text, std::vector<std::string>{"true", "false"});
    case OptionType::text:
      return text.empty() ? found(option, text) : "";
    case OptionType::word_list:
    case OptionType::word:
      return found(option, text) + suggestion(text, option.words);
    case OptionType::table:
      break;
  }
  return {};
}

std::string default_text(const OptionInfo& option) {
  if (option.required) return "[required]";
  if (!option.default_value.empty()) return "[" + option.default_value + "]";
  return option.unset.empty() ? "[unset]" : "[unset: " + option.unset + "]";
}

std::string toml_text(const OptionInfo& option, const std::string& text) {
  const auto number = [](const std::string& part) { return is_toml_number(part) ? part : "\"" + part + "\""; };
  const bool bare = option.type == OptionType::yes_no || is_word(option, text);
  if (bare && is_yes_no(text)) return text;
  if (is_word(option, text) || option.type == OptionType::word || option.type == OptionType::text) {
    return "\"" + text + "\"";
  }
  if (!text.starts_with("[")) return number(text);
  std::vector<std::string> parts;
  for (const std::string& part : list_parts(text)) parts.push_back(number(part));
  return "[" + joined(parts) + "]";
}

const OptionInfo* find_option(std::span<const OptionInfo> options, const std::string& name) {
  const auto found = std::find_if(options.begin(), options.end(), [&](const OptionInfo& o) { return o.name == name; });
  return found == options.end() ? nullptr : &*found;
}

std::vector<std::string> option_names(const std::vector<OptionInfo>& options) {
  std::vector<std::string> names;
  names.reserve(options.size());
  for (const OptionInfo& option : options) names.push_back(option.name);
  return names;
}

double number_value(const std::string& text) { return evaluate_number<double>(text); }

long double wide_number_value(const std::string& text) {
  const auto wide = evaluate_number<long double>(text);
  const auto narrow = static_cast<double>(wide);
  return std::isnormal(narrow) ? number_value(text) : wide;
}

}  // namespace hamflow
