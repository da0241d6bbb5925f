#include "toml_path.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/text_place.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "run_keys.hpp"
#include "toml_depth.hpp"

namespace hamflow {

namespace {

/// A part of a path: a name, or an index of an array.
struct Part {
  std::string name;
  std::size_t index = 0;
  bool is_index = false;
};

/// Returns the parts of a path; empty if the text is not a path.
std::vector<Part> parts_of(const std::string& path) {
  std::vector<Part> parts;
  std::size_t at = 0;
  while (at < path.size()) {
    if (path[at] == '[') {
      const std::size_t close = path.find(']', at);
      if (parts.empty() || close == std::string::npos) return {};
      Part part{"", 0, true};
      const char* const end = path.data() + close;
      const auto read = std::from_chars(path.data() + at + 1, end, part.index);
      if (read.ec != std::errc() || read.ptr != end) return {};
      parts.push_back(part);
      at = close + 1;
      if (at < path.size() && path[at] == '.') ++at;
    } else {
      const std::size_t end = std::min(path.find_first_of(".[", at), path.size());
      if (end == at) return {};
      parts.push_back({path.substr(at, end - at), 0, false});
      at = end < path.size() && path[end] == '.' ? end + 1 : end;
      if (at == path.size() && path.back() == '.') return {};
    }
  }
  return parts;
}

/// The node that contains the last part of a path, or the error in the path.
struct Place {
  toml::node* parent = nullptr;  // an array that has the last index, or a table
  std::string wrong{};
};

Place walk(toml::table& root, const std::vector<Part>& parts, bool make_tables) {
  toml::node* at = &root;
  std::string walked;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    const bool last = i + 1 == parts.size();
    if (part.is_index) {
      const toml::array* const array = at->as_array();
      if (array == nullptr) {
        return {nullptr, walked + " is not an array; allowed an index of an existing array"};
      }
      if (array->empty()) return {nullptr, walked + " is an empty array; allowed " + walked + " = [...] as a whole"};
      if (part.index >= array->size()) {
        return {nullptr, "found index " + std::to_string(part.index) + " of an array of " +
                             std::to_string(array->size()) + "; allowed 0 to " + std::to_string(array->size() - 1)};
      }
      if (last) return {at};
      at = at->as_array()->get(part.index);
      walked += "[" + std::to_string(part.index) + "]";
      continue;
    }
    toml::table* const table = at->as_table();
    if (table == nullptr) {
      return {nullptr, walked + " is a value here, not a table; allowed " + walked + " = { " + part.name + " = ... }"};
    }
    if (last) return {at};
    walked += (walked.empty() ? "" : ".") + part.name;
    if (!table->contains(part.name)) {
      if (parts[i + 1].is_index || !make_tables) {
        return {nullptr, "the array " + walked + " does not exist; allowed an index of an existing array"};
      }
      table->insert(part.name, toml::table{});
    }
    at = table->get(part.name);
  }
  return {nullptr, "not a path"};
}

/// Returns groups of keys of which a scenario may have at most one.
const std::vector<std::pair<std::string, std::vector<std::string>>>& exclusive_keys() {
  static const std::vector<std::pair<std::string, std::vector<std::string>>> all{
      {run_table, {run_keys().steps.name, run_keys().t_end.name}},
      {run_table, {run_keys().record_every.name, run_keys().record.name}},
      {"problem", {"orbit", "initial"}}};
  return all;
}

}  // namespace

bool touched(const toml::node& node) {
  if (is_set(node)) return true;
  if (const auto* table = node.as_table()) {
    return std::any_of(table->begin(), table->end(), [](const auto& entry) { return touched(entry.second); });
  }
  const auto* array = node.as_array();
  return array != nullptr && std::any_of(array->begin(), array->end(), touched);
}

namespace {

/// Returns whether a text is a decimal with digits on both sides of a point and optionally an exponent. TOML reads it
/// as the same number.
bool is_plain_decimal(const std::string& text) {
  std::size_t at = text.starts_with('-') ? 1 : 0;
  const auto digits = [&] {
    const std::size_t begin = at;
    while (at < text.size() && is_digit(text[at])) ++at;
    return at - begin;
  };
  const bool leading_zero = at < text.size() && text[at] == '0';
  const std::size_t before = digits();
  if (before == 0 || (leading_zero && before > 1) || at == text.size() || text[at] != '.') return false;
  ++at;
  if (digits() == 0) return false;
  if (at == text.size()) return true;
  if (text[at] != 'e') return false;
  ++at;
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
  return digits() > 0 && at == text.size();
}

}  // namespace

toml::table parsed_value(const std::string& text) {
  toml::table value;
  if (is_plain_decimal(text)) {  // for example the numbers of a range; the parser would take ten times as long
    const double number = std::strtod(text.c_str(), nullptr);
    if (std::isfinite(number)) {
      value.insert_or_assign("value", number);
      return value;
    }
  }
  try {
    if (!too_deep(text)) value = toml::parse("value = " + text);
  } catch (const toml::parse_error&) {
    value.clear();
  }
  if (value.size() != 1) {  // not a TOML value, so it is a string
    value.clear();
    value.insert_or_assign("value", text);
  }
  return value;
}

std::string assign(toml::table& root, const std::string& path, const toml::node& value) {
  const std::vector<Part> parts = parts_of(path);
  if (parts.empty()) return "not a path; allowed names separated by dots, and [0], [1], ... for entries of an array";
  if (parts.size() > most_key_parts) {
    return "found a path of " + std::to_string(parts.size()) + " parts; allowed at most " +
           std::to_string(most_key_parts);
  }
  Place place = walk(root, parts, true);
  if (!place.wrong.empty()) return place.wrong;
  const Part& last = parts.back();
  if (last.is_index) {
    toml::array& array = *place.parent->as_array();
    array.replace(array.cbegin() + static_cast<std::ptrdiff_t>(last.index), value);
  } else {
    place.parent->as_table()->insert_or_assign(last.name, value);
  }
  return {};
}

void erase(toml::table& root, const std::string& path) {
  const std::vector<Part> parts = parts_of(path);
  if (parts.empty()) return;
  const Place place = walk(root, parts, false);
  if (!place.wrong.empty()) return;
  const Part& last = parts.back();
  if (last.is_index) {
    toml::array& array = *place.parent->as_array();
    array.erase(array.cbegin() + static_cast<std::ptrdiff_t>(last.index));
  } else {
    place.parent->as_table()->erase(last.name);
  }
}

bool is_part_of_other(const std::string& a, const std::string& b) {
  const std::vector<Part> x = parts_of(a);
  const std::vector<Part> y = parts_of(b);
  const std::size_t common = std::min(x.size(), y.size());
  for (std::size_t i = 0; i < common; ++i) {
    if (x[i].is_index != y[i].is_index || x[i].index != y[i].index || x[i].name != y[i].name) return false;
  }
  return common > 0;
}

std::pair<std::string, std::string> parsed_set(const std::string& set) {
  const auto equals = set.find('=');
  if (equals == std::string::npos) return {};
  return {set.substr(0, equals), set.substr(equals + 1)};
}

std::pair<std::string, std::string> apply_set(toml::table& root, const std::string& set) {
  const auto [path, text] = parsed_set(set);
  if (path.empty()) return {set, "not PATH=VALUE; allowed e.g. " + set_option(run_path(run_keys().dt), "0.05")};
  return {path, assign(root, path, *parsed_value(text).get("value"))};
}

void drop_excluded(toml::table& root) {
  for (const auto& [section, keys] : exclusive_keys()) {
    toml::table* const table = root[section].as_table();
    if (table == nullptr) continue;
    const bool any_set = std::any_of(keys.begin(), keys.end(), [&, table = table](const std::string& key) {
      const toml::node* node = table->get(key);
      return node != nullptr && touched(*node);
    });
    for (const std::string& key : keys) {
      const toml::node* node = any_set ? table->get(key) : nullptr;
      if (node != nullptr && !touched(*node)) table->erase(key);
    }
  }
}

}  // namespace hamflow
