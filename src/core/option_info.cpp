#include "hamflow/core/option_info.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/core/number.hpp"
#include "hamflow/core/problem_info.hpp"
#include "hamflow/core/text.hpp"

namespace hamflow {

namespace {

bool is_word(const OptionInfo& option, const std::string& text) {
  return std::find(option.words.begin(), option.words.end(), text) != option.words.end();
}

/// The words as they have to be written beside numbers.
std::string quoted(const std::vector<std::string>& words) {
  std::vector<std::string> all;
  for (const std::string& word : words) all.push_back("\"" + word + "\"");
  return joined(all);
}

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

/// What is wrong with one number, beginning with "; " or ": ".
std::string wrong_number(const OptionInfo& option, const std::string& text) {
  const std::string allowed = "; allowed " + allowed_text(option);
  try {
    if (option.range.contains(evaluate_number<double>(text))) return {};
    return allowed;
  } catch (const Error& error) {
    if (text.find_first_of("0123456789(") == std::string::npos) return allowed + suggestion(text, option.words);
    return std::string(", ") + error.what() + allowed;
  }
}

}  // namespace

bool Range::contains(double x) const {
  if (!std::isfinite(x) || (whole && x != std::floor(x))) return false;
  return open ? least < x && x < most : least <= x && x <= most;
}

std::string range_text(const Range& range) {
  const bool from = std::isfinite(range.least);
  const bool to = std::isfinite(range.most);
  const auto text = [&](double x) {
    return range.whole && std::abs(x) < 0x1p63 ? std::to_string(static_cast<long long>(x)) : shortest(x);
  };
  if (from && to && range.least == range.most) return text(range.least);
  if (from && to)
    return (range.open ? "between " : "from ") + text(range.least) + (range.open ? " and " : " to ") + text(range.most);
  if (from && range.least == 0 && !range.whole) return range.open ? "positive" : "not negative";
  if (from) return (range.open ? "above " : "from ") + text(range.least);
  if (to) return (range.open ? "below " : "up to ") + text(range.most);
  return {};
}

std::string allowed_text(const OptionInfo& option) {
  const std::string or_words = option.words.empty() ? "" : ", or " + quoted(option.words);
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
      return "a list out of " + joined(option.words);
    case OptionType::yes_no:
      return option.words.empty() ? "true, false" : "true, false, or " + joined(option.words);
    case OptionType::text:
      return "a text that is not empty";
    case OptionType::table:
      return "a table with " + joined(option_names(option.keys));
  }
  return {};
}

std::string wrong_value(const OptionInfo& option, const std::string& text) {
  if (is_word(option, text)) return {};
  const std::string allowed = "; allowed " + allowed_text(option);
  switch (option.type) {
    case OptionType::number:
      return wrong_number(option, text);
    case OptionType::list:
    case OptionType::number_or_list: {
      if (option.type == OptionType::list && !text.starts_with("[")) return allowed;
      const std::vector<std::string> parts = list_parts(text);
      if (parts.empty() || (option.length > 0 && parts.size() != option.length)) return allowed;
      for (const std::string& part : parts) {
        if (const std::string wrong = wrong_number(option, part); !wrong.empty()) return wrong;
      }
      return {};
    }
    case OptionType::yes_no:
      if (text == "true" || text == "false") return {};
      return allowed + suggestion(text, std::vector<std::string>{"true", "false"});
    case OptionType::text:
      return text.empty() ? allowed : "";
    case OptionType::word_list:
    case OptionType::word:
      return allowed + suggestion(text, option.words);
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
  const auto number = [](const std::string& part) {
    const bool plain = !part.empty() && part.find_first_not_of("+-.0123456789eE") == std::string::npos &&
                       part.find_first_of("0123456789") != std::string::npos && part.front() != '.' &&
                       part.back() != '.';
    return plain ? part : "\"" + part + "\"";
  };
  if (option.type == OptionType::yes_no && (text == "true" || text == "false")) return text;
  if (is_word(option, text) || option.type == OptionType::word || option.type == OptionType::text) {
    return "\"" + text + "\"";
  }
  if (!text.starts_with("[")) return number(text);
  std::vector<std::string> parts;
  for (const std::string& part : list_parts(text)) parts.push_back(number(part));
  return "[" + joined(parts) + "]";
}

const OptionInfo* find_option(const std::vector<OptionInfo>& options, const std::string& name) {
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

}  // namespace hamflow
