#include "toml_table.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "hamflow/core/number.hpp"

namespace hamflow {

namespace {
constexpr const char* number_forms = "a finite number, or a text such as \"0.1\", \"1/3\", \"2*pi/100\"";

std::string shown(const toml::node& node) {
  std::ostringstream out;
  if (const auto* text = node.as_string()) {
    constexpr std::size_t most = 60;
    const std::string& value = text->get();
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
}  // namespace

std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

std::string suggestion(const std::string& name, const std::vector<std::string>& candidates) {
  const std::string near = nearest(name, candidates);
  return near.empty() ? "" : "; did you mean " + near + "?";
}

std::string Complaint::text() const {
  // One line each, whatever a key or a string holds; and nothing that a terminal would obey.
  const auto plain = [](const std::string& raw) {
    std::string out;
    for (const char c : raw) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte >= 0x20 && byte != 0x7f) {
        out += c;
      } else {
        constexpr const char* digits = "0123456789abcdef";
        out += c == '\n' ? "\\n" : c == '\t' ? "\\t" : std::string("\\x") + digits[byte >> 4] + digits[byte & 15];
      }
    }
    return out;
  };
  const std::string where = line > 0 ? file + ":" + std::to_string(line) + ":" + std::to_string(column) : "--set";
  return plain(where + ": error: " + key + ": " + message);
}

TomlTable::TomlTable(const toml::table* table, std::string path, std::string file, std::vector<Complaint>& complaints)
    : table_(table), path_(std::move(path)), file_(std::move(file)), complaints_(&complaints) {}

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
    complain_at(table_->get(key)->source(), key, message);
  } else if (table_ != nullptr && table_->source().begin.line > 0) {
    complain_at(table_->source(), key, message);
  } else {
    complaints_->push_back({file_, 1, 1, full(key), message});
  }
}

std::string TomlTable::found(const std::string& key) const {
  return has(key) ? "found " + shown(*table_->get(key)) : "found nothing";
}

void TomlTable::missing(const std::string& key, const std::string& allowed) {
  complain(key, "found nothing; allowed " + allowed);
}

std::optional<std::string> TomlTable::string(const std::string& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (const auto* text = node->as_string()) return text->get();
  complain(key, "found " + shown(*node) + "; allowed a string");
  return std::nullopt;
}

std::optional<std::string> TomlTable::choice(const std::string& key, const std::vector<std::string>& allowed) {
  auto text = string(key);
  if (!text) return text;
  for (const std::string& word : allowed) {
    if (*text == word) return text;
  }
  complain(key, "found \"" + *text + "\"; allowed " + joined(allowed) + suggestion(*text, allowed));
  return std::nullopt;
}

std::optional<Number> TomlTable::number_of(const toml::node& node, const std::string& key) {
  // At the node itself: an entry of an array has its own place.
  const auto wrong = [&] { complain_at(node.source(), key, "found " + shown(node) + "; allowed " + number_forms); };
  Number number;
  if (const auto* integer = node.as_integer()) {
    number = {std::to_string(integer->get()), static_cast<double>(integer->get())};
  } else if (const auto* real = node.as_floating_point()) {
    number = {std::isfinite(real->get()) ? shortest(real->get()) : "", real->get()};
  } else if (const auto* text = node.as_string()) {
    try {
      number = {text->get(), evaluate_number<double>(text->get())};
    } catch (const Error&) {
      wrong();
      return std::nullopt;
    }
  } else {
    wrong();
    return std::nullopt;
  }
  if (!std::isfinite(number.value)) {
    wrong();
    return std::nullopt;
  }
  return number;
}

std::optional<Number> TomlTable::number(const std::string& key) {
  const toml::node* node = find(key);
  return node == nullptr ? std::nullopt : number_of(*node, key);
}

std::optional<bool> TomlTable::boolean(const std::string& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (const auto* value = node->as_boolean()) return value->get();
  complain(key, "found " + shown(*node) + "; allowed true, false");
  return std::nullopt;
}

std::optional<std::int64_t> TomlTable::whole(const std::string& key, std::int64_t least, std::int64_t most) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto value = number_of(*node, key);
  if (!value) return std::nullopt;
  if (const auto* integer = node->as_integer()) {  // beyond 2^53 the double would hide what was written
    if (integer->get() >= least && integer->get() <= most) return integer->get();
  }
  const bool fits = !node->is_integer() && value->value == std::floor(value->value) &&
                    value->value >= static_cast<double>(least) && value->value <= static_cast<double>(most);
  if (fits) return static_cast<std::int64_t>(value->value);
  complain(key, "found " + shown(*node) + "; allowed a whole number from " + std::to_string(least) + " to " +
                    std::to_string(most));
  return std::nullopt;
}

std::optional<std::vector<Number>> TomlTable::numbers(const std::string& key, std::size_t count) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto* array = node->as_array();
  const std::string allowed =
      "allowed an array of " + (count == 0 ? "" : std::to_string(count) + " ") + (count == 1 ? "number" : "numbers");
  if (array == nullptr) {
    complain(key, "found " + shown(*node) + "; " + allowed);
    return std::nullopt;
  }
  if (array->empty() || (count > 0 && array->size() != count)) {
    complain(key, "found " + std::to_string(array->size()) + " entries; " + allowed);
    return std::nullopt;
  }
  std::vector<Number> all;
  for (const toml::node& entry : *array) {
    const auto value = number_of(entry, key);
    if (!value) return std::nullopt;
    all.push_back(*value);
  }
  return all;
}

std::optional<std::vector<Number>> TomlTable::number_or_numbers(const std::string& key) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (node->is_array()) return numbers(key, 0);
  const auto value = number_of(*node, key);
  return value ? std::optional(std::vector<Number>{*value}) : std::nullopt;
}

std::optional<std::vector<TomlTable>> TomlTable::tables(const std::string& key, std::size_t count) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const auto* array = node->as_array();
  const bool fits = array != nullptr && array->size() == count &&
                    std::all_of(array->begin(), array->end(), [](const toml::node& entry) { return entry.is_table(); });
  if (!fits) {
    complain(key, (array == nullptr ? "found " + shown(*node) : "found " + std::to_string(array->size()) + " entries") +
                      "; allowed an array of " + std::to_string(count) + " tables");
    return std::nullopt;
  }
  std::vector<TomlTable> all;
  for (std::size_t i = 0; i < count; ++i) {
    all.emplace_back(array->get(i)->as_table(), full(key) + "[" + std::to_string(i) + "]", file_, *complaints_);
  }
  return all;
}

std::optional<std::vector<std::string>> TomlTable::choices(const std::string& key,
                                                           const std::vector<std::string>& allowed) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  std::vector<std::string> words;
  const auto take = [&](const toml::node& entry) {
    const auto* text = entry.as_string();
    if (text == nullptr) {
      complain(key, "found " + shown(entry) + "; allowed a list out of " + joined(allowed));
      return false;
    }
    for (const std::string& word : allowed) {
      if (text->get() == word) {
        words.push_back(word);
        return true;
      }
    }
    complain(key, "found \"" + text->get() + "\"; allowed " + joined(allowed) + suggestion(text->get(), allowed));
    return false;
  };
  if (const auto* array = node->as_array()) {
    bool good = true;
    for (const toml::node& entry : *array) good = take(entry) && good;
    return good ? std::optional(words) : std::nullopt;
  }
  return take(*node) ? std::optional(words) : std::nullopt;
}

TomlTable TomlTable::table(const std::string& key) {
  const toml::node* node = find(key);
  if (node != nullptr && !node->is_table()) complain(key, "found " + shown(*node) + "; allowed a table");
  return {node == nullptr ? nullptr : node->as_table(), full(key), file_, *complaints_};
}

void TomlTable::finish() {
  if (table_ == nullptr) return;
  std::vector<std::string> distinct;
  for (const std::string& key : known_) {
    if (std::find(distinct.begin(), distinct.end(), key) == distinct.end()) distinct.push_back(key);
  }
  known_ = distinct;
  for (const auto& [key, node] : *table_) {
    const std::string name(key.str());
    bool is_known = false;
    for (const std::string& known : known_) is_known = is_known || known == name;
    if (is_known) continue;
    const toml::source_region& where = key.source().begin.line > 0 ? key.source() : node.source();
    complain_at(where, name, "found an unknown key; allowed " + joined(known_) + suggestion(name, known_));
  }
}

}  // namespace hamflow
