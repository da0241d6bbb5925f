#include "toml_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "hamflow/core/problem_info.hpp"
#include "suggested_names.hpp"
#include "toml_path.hpp"

namespace hamflow {

namespace {
constexpr const char* number_forms = "; numbers may be texts such as \"0.1\", \"1/3\", \"2*pi/100\"";

std::string shown(const toml::node& node) {
  std::ostringstream out;
  if (const auto* text = node.as_string()) {
    constexpr std::size_t most = 60;
    const std::string& value = text->get();
    // A whole number beyond 64 bits is not valid TOML, so --set reads it as a text.
    std::int64_t whole = 0;
    const char* const end = value.data() + value.size();
    const auto [behind, error] = std::from_chars(value.data(), end, whole);
    if (error == std::errc::result_out_of_range && behind == end && value.size() <= most) {
      return value + " (beyond 64 bits)";
    }
    out << '"' << value.substr(0, most) << (value.size() > most ? "..." : "") << "\" (a string)";
  } else if (const auto* integer = node.as_integer()) {
    out << integer->get();
  } else if (const auto* real = node.as_floating_point()) {
    out << (std::isfinite(real->get()) ? shortest(real->get())
            : std::isnan(real->get())  ? "nan"
            : real->get() < 0          ? "-inf"
                                       : "inf");
  } else if (const auto* boolean = node.as_boolean()) {
    out << (boolean->get() ? "true" : "false") << " (a boolean)";
  } else if (node.is_array()) {
    out << "an array";
  } else if (node.is_table()) {
    out << "a table";
  } else {
    out << "a date or time";
  }
  return out.str();
}

/// Returns the position of a node in the file; no position if a part of it was set from outside.
toml::source_region place_of(const toml::node& node) { return touched(node) ? toml::source_region{} : node.source(); }
}  // namespace

TomlTable::TomlTable(const toml::table* table, std::string path, std::string file, std::vector<Complaint>& complaints)
    : table_(table), path_(std::move(path)), file_(std::move(file)), complaints_(&complaints) {
  if (table_ != nullptr) known_.reserve(32);
}

const toml::table& TomlTable::node() const {
  static const toml::table none;
  return table_ == nullptr ? none : *table_;
}

bool TomlTable::has_any(const std::string& key) const {
  if (!has(key)) return false;
  const toml::array* const list = table_->get(key)->as_array();
  return list == nullptr || !list->empty();
}

bool TomlTable::is_set(const std::string& key) const { return has(key) && hamflow::is_set(*table_->get(key)); }

const toml::node* TomlTable::find(const std::string& key) {
  know(key);
  return table_ == nullptr ? nullptr : table_->get(key);
}

void TomlTable::complain_at(const toml::source_region& where, const std::string& key, const std::string& message) {
  complaints_->push_back(
      {file_, static_cast<int>(where.begin.line), static_cast<int>(where.begin.column), full(key), message});
}

void TomlTable::complain(const std::string& key, const std::string& message) {
  if (has(key)) {
    complain_at(place_of(*table_->get(key)), key, message);
  } else if (table_ != nullptr) {  // a position without a line means --set
    complain_at(table_->source(), key, message);
  } else {
    complaints_->push_back({file_, 1, 1, full(key), message});
  }
}

void TomlTable::complain_in(const std::string& part, const std::string& message) {
  // Finds the position of the value, or of the nearest enclosing value that exists.
  std::string there = part;
  std::optional<toml::source_region> where;
  while (table_ != nullptr && !where && !there.empty()) {
    if (const toml::node* node = table_->at_path(there).node()) where = place_of(*node);
    const std::size_t last = there.find_last_of(".[");
    there = last == std::string::npos ? "" : there.substr(0, last);
  }
  if (where) {  // a position without a line means --set
    complain_at(*where, part, message);
  } else {
    complain(part, message);
  }
}

template <class Wanted>
std::vector<std::string> TomlTable::keys_where(const Wanted& wanted) const {
  std::vector<std::pair<toml::source_position, std::string>> placed;
  for (const auto& [key, value] : node()) {
    if (wanted(key.str())) placed.emplace_back(key.source().begin, key.str());
  }
  std::stable_sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> all;
  for (auto& [where, key] : placed) all.push_back(std::move(key));
  return all;
}

std::vector<std::string> TomlTable::keys() const {
  return keys_where([](std::string_view) { return true; });
}

std::vector<std::string> TomlTable::unknown_keys() const {
  return keys_where(
      [this](std::string_view key) { return std::find(known_.begin(), known_.end(), key) == known_.end(); });
}

std::optional<std::vector<std::string>> TomlTable::texts(const std::string& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto* array = node->as_array();
  if (array == nullptr || array->empty()) {
    complain(key, "found " + (array == nullptr ? shown(*node) : "an empty array") +
                      "; allowed an array of texts, at least one");
    return std::nullopt;
  }
  std::vector<std::string> all;
  for (const toml::node& entry : *array) {
    const auto* text = entry.as_string();
    if (text == nullptr || text->get().empty()) {
      complain_at(entry.source(), key, "found an array with " + shown(entry) + "; allowed an array of texts");
      return std::nullopt;
    }
    all.push_back(text->get());
  }
  return all;
}

std::string TomlTable::found(const std::string& key) const {
  return has(key) ? "found " + shown(*table_->get(key)) : "missing";
}

void TomlTable::missing(const std::string& key, const std::string& allowed) {
  complain(key, "missing; allowed " + allowed);
}

std::optional<std::string> TomlTable::plain_string(const std::string& key) {
  const toml::node* node = find(key);
  return node == nullptr ? std::nullopt : node->value<std::string>();
}

std::optional<std::string> TomlTable::text(const OptionInfo& option, const std::string& behind) {
  const toml::node* node = find(option.name);
  const Allowed allowed = [&] { return "; allowed " + allowed_text(option) + behind; };
  if (node == nullptr) {
    if (option.required) complain(option.name, "missing" + allowed());
    return std::nullopt;
  }
  switch (option.type) {
    case OptionType::number:
      return number_text(*node, option, allowed);
    case OptionType::list:
      return list_text(*node, option, allowed);
    case OptionType::number_or_list:
      return node->is_array() ? list_text(*node, option, allowed) : number_text(*node, option, allowed);
    case OptionType::word:
    case OptionType::text:
    case OptionType::yes_no:
      return word_text(*node, option, allowed);
    case OptionType::word_list:
    case OptionType::table:
      break;
  }
  throw std::logic_error("hamflow: " + option.name + " has no text");
}

std::optional<double> TomlTable::number(const OptionInfo& option) {
  const auto found = text(option);
  return found ? std::optional(number_value(*found)) : std::nullopt;
}

std::optional<std::int64_t> TomlTable::whole(const OptionInfo& option) {
  const auto found = number(option);
  return found ? std::optional(static_cast<std::int64_t>(*found)) : std::nullopt;
}

std::optional<std::vector<std::string>> TomlTable::numbers(const OptionInfo& option) {
  const toml::node* node = find(option.name);
  const Allowed allowed = [&] { return "; allowed " + allowed_text(option); };
  if (node == nullptr && option.required) complain(option.name, "missing" + allowed());
  return node == nullptr ? std::nullopt : list_entries(*node, option, allowed);
}

std::optional<bool> TomlTable::yes_no(const OptionInfo& option) {
  const auto found = text(option);
  return found ? std::optional(*found == "true") : std::nullopt;
}

std::optional<std::string> TomlTable::number_text(const toml::node& node, const OptionInfo& option,
                                                  const Allowed& allowed) {
  // Complains at the node itself, because an entry of an array has its own position.
  const auto refuse = [&](const std::string& message) {
    complain_at(node.source(), option.name, message);
    return std::nullopt;
  };
  const bool in_array = table_->get(option.name) != &node;
  const auto found = [&] { return "found " + std::string(in_array ? "an array with " : "") + shown(node); };
  if (const auto* boolean = node.as_boolean()) {
    std::string word = boolean->get() ? "true" : "false";
    if (std::find(option.words.begin(), option.words.end(), word) != option.words.end()) return word;
  }
  if (const auto* word = node.as_string()) {
    OptionInfo one = option;
    if (in_array) one.type = OptionType::number;
    if (refused_value(one, word->get()).empty()) return word->get();
    // The error message of a wrong formula gives the position in the text.
    const bool meant_as_word = !option.words.empty() && word->get().find_first_of("0123456789") == std::string::npos;
    if (meant_as_word) return refuse(found() + allowed() + suggestion(word->get(), option.words));
    try {
      (void)number_value(word->get());
    } catch (const Error& error) {
      return refuse(error.what());
    }
    return refuse(found() + allowed());
  }
  constexpr std::int64_t exact_in_double = std::int64_t{1} << 53;
  if (const auto* integer = node.as_integer()) {
    const std::int64_t value = integer->get();
    const bool is_rounded = option.range.whole && (value > exact_in_double || value < -exact_in_double);
    if (!is_rounded && option.range.contains(static_cast<double>(value))) return std::to_string(value);
    return refuse(found() + allowed());
  }
  if (const auto* real = node.as_floating_point()) {
    if (option.range.contains(real->get())) return shortest(real->get());
    return refuse(found() + allowed());
  }
  return refuse(found() + allowed() + number_forms);
}

std::optional<std::string> TomlTable::list_text(const toml::node& node, const OptionInfo& option,
                                                const Allowed& allowed) {
  const auto all = list_entries(node, option, allowed);
  return all ? std::optional("[" + joined(*all) + "]") : std::nullopt;
}

std::optional<std::vector<std::string>> TomlTable::list_entries(const toml::node& node, const OptionInfo& option,
                                                                const Allowed& allowed) {
  const auto* array = node.as_array();
  if (array == nullptr) {
    complain(option.name, "found " + shown(node) + allowed());
    return std::nullopt;
  }
  if (array->empty() || (option.length > 0 && array->size() != option.length)) {
    complain(option.name,
             "found " + std::to_string(array->size()) + (array->size() == 1 ? " entry" : " entries") + allowed());
    return std::nullopt;
  }
  std::vector<std::string> all;
  for (const toml::node& entry : *array) {
    auto text = number_text(entry, option, allowed);
    if (!text) return std::nullopt;
    all.push_back(std::move(*text));
  }
  return all;
}

std::optional<std::string> TomlTable::word_text(const toml::node& node, const OptionInfo& option,
                                                const Allowed& allowed) {
  if (option.type == OptionType::yes_no) {
    if (const auto* value = node.as_boolean()) return value->get() ? "true" : "false";
    complain(option.name, "found " + shown(node) + allowed());
    return std::nullopt;
  }
  if (const auto* whole = node.as_integer()) {  // as in dimension = 3
    const std::string digits = std::to_string(whole->get());
    if (std::find(option.words.begin(), option.words.end(), digits) != option.words.end()) return digits;
  }
  const auto* word = node.as_string();
  if (word == nullptr) {
    complain(option.name, "found " + shown(node) + allowed());
    return std::nullopt;
  }
  if (refused_value(option, word->get()).empty()) return word->get();
  complain(option.name, "found \"" + word->get() + "\"" + allowed() + suggestion(word->get(), option.words));
  return std::nullopt;
}

std::optional<std::vector<std::string>> TomlTable::words(const OptionInfo& option) {
  const toml::node* node = find(option.name);
  if (node == nullptr) return std::nullopt;
  std::vector<std::string> all;
  const auto take = [&](const toml::node& entry) {
    const auto* word = entry.as_string();
    if (word == nullptr) {
      complain(option.name, "found " + shown(entry) + "; allowed " + allowed_text(option));
      return false;
    }
    all.push_back(word->get());
    if (std::find(option.words.begin(), option.words.end(), word->get()) != option.words.end()) return true;
    complain(option.name,
             "found \"" + word->get() + "\"; allowed " + joined(option.words) + suggestion(word->get(), option.words));
    return false;
  };
  const auto* array = node->as_array();
  if (array == nullptr) return take(*node) ? std::optional(all) : std::nullopt;
  bool good = true;
  for (const toml::node& entry : *array) good = take(entry) && good;
  return good ? std::optional(all) : std::nullopt;
}

std::optional<std::vector<TomlTable>> TomlTable::tables(const std::string& key, std::size_t count) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto* array = node->as_array();
  const bool any = count == 0;
  if (any && array != nullptr) count = array->size();
  const bool fits = array != nullptr && array->size() == count &&
                    std::all_of(array->begin(), array->end(), [](const toml::node& entry) { return entry.is_table(); });
  if (!fits) {
    complain(key, (array == nullptr ? "found " + shown(*node) : "found " + std::to_string(array->size()) + " entries") +
                      "; allowed an array of " + (any ? std::string() : std::to_string(count) + " ") + "tables");
    return std::nullopt;
  }
  std::vector<TomlTable> all;
  for (std::size_t i = 0; i < count; ++i) {
    all.emplace_back(array->get(i)->as_table(), full(key) + "[" + std::to_string(i) + "]", file_, *complaints_);
  }
  return all;
}

TomlTable TomlTable::table(const std::string& key) {
  const toml::node* node = find(key);
  if (node != nullptr && !node->is_table()) {
    const bool is_name = node->is_string() && (full(key) == "problem" || full(key) == "method");
    complain(key, "found " + shown(*node) + "; allowed a table" + (is_name ? "; did you mean " + key + ".name?" : ""));
  }
  return {node == nullptr ? nullptr : node->as_table(), full(key), file_, *complaints_};
}

void TomlTable::finish(const ProblemEntry* problem, const std::string& method) {
  if (table_ == nullptr) return;
  bool is_distinct = false;
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    if (!std::exchange(is_distinct, true)) {  // done only for a complaint, because a sweep reads very many scenarios
      std::vector<std::string> distinct;
      for (const std::string& known : known_) {
        if (std::find(distinct.begin(), distinct.end(), known) == distinct.end()) distinct.push_back(known);
      }
      known_ = distinct;
    }
    // A value that was set from outside has no position in the file, even if its key has.
    const bool in_file = key.source().begin.line > 0 && !hamflow::is_set(node);
    const toml::source_region& where = in_file ? key.source() : node.source();
    if (const std::string advice = removed_key(full(name)); !advice.empty()) {
      complain_at(where, name, "this key no longer exists; " + advice);
      continue;
    }
    const std::string near = suggestion(name, known_);
    const std::string meant = near.empty() ? key_elsewhere(full(name), problem, method) : near;
    complain_at(where, name, "found an unknown key; allowed " + joined(known_) + meant);
  }
}

}  // namespace hamflow
