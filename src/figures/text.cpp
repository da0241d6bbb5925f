#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

namespace hamflow::figures {

namespace {
const char* const replacement = "\uFFFD";

/// Returns the number of bytes of the well-formed UTF-8 character at `at`; 0 if there is none.
std::size_t character_length(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t k) {
    return at + k < text.size() ? static_cast<unsigned>(static_cast<unsigned char>(text[at + k])) : 0U;
  };
  const unsigned lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4) return 0;
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(k) & 0xC0U) != 0x80U) return 0;
  }
  const unsigned second = byte(1);
  const bool too_long = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool no_character = (lead == 0xED && second > 0x9F) || (lead == 0xF4 && second > 0x8F);
  return too_long || no_character ? 0 : length;
}

/// Returns the characters of a text, made printable.
std::vector<std::string> characters(const std::string& text) {
  std::vector<std::string> result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text, at);
    if (length == 0) {
      result.emplace_back(replacement);
      ++at;
      continue;
    }
    const bool control = length == 1 && (static_cast<unsigned char>(text[at]) < 0x20 || text[at] == 0x7F);
    result.push_back(control ? " " : text.substr(at, length));
    at += length;
  }
  return result;
}

const std::map<std::string, std::string>& greek() {
  static const std::map<std::string, std::string> letters{
      {"alpha", "α"}, {"beta", "β"},  {"gamma", "γ"},  {"delta", "δ"}, {"epsilon", "ε"}, {"zeta", "ζ"}, {"eta", "η"},
      {"theta", "θ"}, {"kappa", "κ"}, {"lambda", "λ"}, {"mu", "μ"},    {"nu", "ν"},      {"xi", "ξ"},   {"rho", "ρ"},
      {"sigma", "σ"}, {"tau", "τ"},   {"phi", "φ"},    {"chi", "χ"},   {"psi", "ψ"},     {"omega", "ω"}};
  return letters;
}

/// A name split into its letters and its index, which follows with or without an underscore, or is empty.
struct Name {
  std::string base;
  std::string index;
};

Name cut(const std::string& name) {
  std::size_t end = 0;
  while (end < name.size() && std::isalpha(static_cast<unsigned char>(name[end]))) ++end;
  Name result{name.substr(0, end), name.substr(end)};
  if (result.index.size() > 1 && result.index[0] == '_') result.index.erase(0, 1);
  // The momentum of theta_1 is p_theta_1. Within the index theta_1 the underscore is removed.
  const std::size_t digits = result.index.find_last_not_of("0123456789") + 1;
  if (digits > 1 && digits < result.index.size() && result.index[digits - 1] == '_') result.index.erase(digits - 1, 1);
  const auto plain = [](unsigned char c) { return std::isalnum(c) != 0; };
  if (!std::all_of(result.index.begin(), result.index.end(), plain)) return {};  // it is a text instead of a name
  return result;
}

std::string letter(const std::string& base) {
  const auto found = greek().find(base);
  return found == greek().end() ? base : found->second;
}

/// Writes an index such as phi1 as the Greek letter and its number.
std::string greek_index(const std::string& index) {
  const Name parts = cut(index);
  return parts.base.empty() ? index : letter(parts.base) + parts.index;
}

std::string italic(const std::string& base) {
  const std::string text = letter(base);
  const bool one_letter = text != base || text.size() == 1;
  return one_letter ? fmt::format("{{/:Italic {}}}", text) : escaped(text);
}
}  // namespace

std::string printable(const std::string& text) {
  std::string result;
  for (const std::string& c : characters(text)) result += c;
  return result;
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const std::string& c : characters(text)) result += c == "'" ? "''" : c;
  return result + "'";
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const std::string& c : characters(text)) {
    if (c.find_first_of("\\{}^_@&~") != std::string::npos) result += '\\';
    result += c;
  }
  return result;
}

std::string quantity(const std::string& name) {
  const Name parts = cut(name);
  const bool one_letter = letter(parts.base) != parts.base || parts.base.size() == 1;
  if (!parts.base.empty() && (one_letter || parts.index.size() < 4)) return symbol(name);
  std::string words = name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return escaped(words);
}

std::string without_brackets(const std::string& name) {
  const std::size_t open = name.find('[');
  const std::size_t digits = name.find_first_not_of("0123456789", open + 1);
  const bool numbered = open != std::string::npos && open > 0 && digits > open + 1 && digits + 1 == name.size();
  return numbered && name.back() == ']' ? name.substr(0, open) + name.substr(open + 1, digits - open - 1) : name;
}

std::string symbol(const std::string& typed) {
  const std::string name = without_brackets(typed);
  const Name parts = cut(name);
  if (parts.base.empty()) return escaped(name);
  return parts.index.empty() ? italic(parts.base)
                             : fmt::format("{}_{{{}}}", italic(parts.base), escaped(greek_index(parts.index)));
}

std::string power_of_ten(int exponent) {
  return fmt::format("10^{{{}{}}}", exponent < 0 ? "\u2212" : "", std::abs(exponent));
}

std::string short_number(double x) {
  if (!std::isfinite(x)) return "not finite";
  if (x == 0) return "0";
  const std::string digits = fmt::format("{:.1e}", x);
  const std::size_t e = digits.find('e');
  return digits.substr(0, e) + "·" + power_of_ten(std::stoi(digits.substr(e + 1)));
}

std::string short_value(double x) {
  std::string text = fmt::format("{:.4g}", x);
  if (std::isfinite(x) && (std::abs(x) >= 1e4 || text.find('e') != std::string::npos)) {
    const std::string digits = fmt::format("{:.3e}", x);
    const std::size_t e = digits.find('e');
    std::string front = digits.substr(0, e);
    front.erase(front.find_last_not_of('0') + 1);
    if (front.ends_with('.')) front.pop_back();
    const std::string power = power_of_ten(std::stoi(digits.substr(e + 1)));
    text = front == "1" ? power : front == "-1" ? "-" + power : front + "·" + power;
  }
  if (text.starts_with('-')) text.replace(0, 1, "\u2212");
  return text;
}

std::size_t printed_length(const std::string& enhanced) {
  static const std::string italic_begins = "{/:Italic ";
  std::size_t count = 0;
  for (std::size_t at = 0; at < enhanced.size(); ++at) {
    const char c = enhanced[at];
    if (enhanced.compare(at, italic_begins.size(), italic_begins) == 0) at += italic_begins.size() - 1;
    if (c == '^' || c == '_' || c == '{' || c == '}') continue;
    if (c == '\\') ++at;
    const bool continues = (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;  // not the first byte of a character
    if (!continues) ++count;
  }
  return count;
}

std::vector<std::string> shortened(const std::vector<std::string>& texts, std::size_t most) {
  std::vector<std::vector<std::string>> all;
  for (const std::string& text : texts) all.push_back(characters(text));
  const auto is_long = [&](const auto& text) { return text.size() > most; };
  const auto first = std::find_if(all.begin(), all.end(), is_long);
  if (first == all.end()) return texts;
  std::size_t common = first->size();  // number of characters with which all long texts begin
  for (const auto& text : all) {
    if (!is_long(text) || text == *first) continue;
    const auto differ = std::mismatch(first->begin(), first->end(), text.begin(), text.end()).first;
    common = std::min(common, static_cast<std::size_t>(differ - first->begin()));
  }
  std::vector<std::string> result;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& text = all[i];
    std::size_t begin = 0;
    std::size_t end = text.size();
    if (is_long(text)) {
      if (common < text.size() && common > most / 2) begin = std::min(common - most / 4, text.size() - most + 1);
      end = std::min(text.size(), begin + most - (begin > 0 ? 1 : 0));
      if (end < text.size()) --end;
    }
    std::string part = begin > 0 ? "…" : "";
    for (std::size_t k = begin; k < end; ++k) part += text[k];
    result.push_back(part + (end < text.size() ? "…" : ""));
  }
  const auto count = [](std::vector<std::string> list) {
    std::sort(list.begin(), list.end());
    return std::unique(list.begin(), list.end()) - list.begin();
  };
  if (count(result) == count(texts)) return result;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = std::to_string(i + 1) + ": " + result[i];
  return result;
}

std::vector<std::string> wrapped(const std::string& text, std::size_t width, std::size_t most) {
  std::vector<std::string> lines;
  std::vector<std::string> rest = characters(text);
  while (!rest.empty()) {
    std::size_t length = rest.size();
    if (length > width) {
      length = width;
      std::size_t score = 0;  // a break after a comma and a space is worth twenty characters of width
      for (std::size_t k = std::max<std::size_t>(width / 3, 1); k <= width; ++k) {
        const bool behind_comma = rest[k - 1] == ",";
        const bool at_space = rest[k] == " ";
        const std::size_t worth = k + (behind_comma && at_space ? 20 : 0);
        if ((at_space || behind_comma) && worth > score) {
          score = worth;
          length = k;
        }
      }
    }
    std::string line;
    for (std::size_t k = 0; k < length; ++k) line += rest[k];
    while (length < rest.size() && rest[length] == " ") ++length;
    rest.erase(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(length));
    if (lines.size() + 1 == most && !rest.empty()) {
      lines.push_back(line + "…");
      break;
    }
    lines.push_back(line);
  }
  return lines;
}

namespace {
/// Splits enhanced text into parts that cannot be broken: characters, and groups in braces with their superscripts and
/// subscripts.
std::vector<std::string> unbroken_parts(const std::string& text) {
  std::vector<std::string> parts;
  const auto end_of = [&](std::size_t at) {
    if (at >= text.size()) return text.size();
    if (text[at] == '\\') return std::min(at + 2, text.size());
    if (text[at] != '{') return at + std::max<std::size_t>(character_length(text, at), 1);
    int depth = 0;
    for (; at < text.size(); ++at) {
      if (text[at] == '\\') {
        ++at;
        continue;
      }
      depth += text[at] == '{' ? 1 : text[at] == '}' ? -1 : 0;
      if (depth == 0) return at + 1;
    }
    return text.size();
  };
  for (std::size_t at = 0; at < text.size();) {
    const bool is_script = text[at] == '_' || text[at] == '^';
    const std::size_t end = end_of(is_script ? at + 1 : at);
    const std::string part = text.substr(at, end - at);
    if (is_script && !parts.empty()) {
      parts.back() += part;
    } else {
      parts.push_back(part);
    }
    at = end;
  }
  return parts;
}
}  // namespace

std::vector<std::string> wrapped_enhanced(const std::string& text, std::size_t width, std::size_t most) {
  static const std::string operators = "+-*/,;)=";
  std::vector<std::string> rest = unbroken_parts(text);
  std::vector<std::string> lines;
  while (!rest.empty()) {
    std::size_t length = 0;
    std::size_t printed = 0;
    std::size_t at_space = 0;
    std::size_t behind_operator = 0;
    for (; length < rest.size(); ++length) {
      printed += printed_length(rest[length]);
      if (printed > width) break;
      if (rest[length] == " ") at_space = length;
      if (rest[length].size() == 1 && operators.find(rest[length]) != std::string::npos) behind_operator = length + 1;
    }
    if (length < rest.size()) {
      length = std::max<std::size_t>(length, 1);
      if (at_space > length / 3) {
        length = at_space;
      } else if (behind_operator > length / 3) {
        length = behind_operator;
      }
    }
    std::string line;
    for (std::size_t k = 0; k < length; ++k) line += rest[k];
    while (length < rest.size() && rest[length] == " ") ++length;
    rest.erase(rest.begin(), rest.begin() + static_cast<std::ptrdiff_t>(length));
    lines.push_back(line);
    if (lines.size() == most && !rest.empty()) {
      lines.back() += "…";
      break;
    }
  }
  return lines;
}

}  // namespace hamflow::figures
