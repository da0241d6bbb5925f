#include "toml_path.hpp"

#include <charconv>
#include <vector>

namespace hamflow {

namespace {

/// A name, or an index of an array.
struct Part {
  std::string name;
  std::size_t index = 0;
  bool is_index = false;
};

/// The parts of a path; empty where it is none.
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

}  // namespace

toml::table parsed_value(const std::string& text) {
  toml::table value;
  try {
    value = toml::parse("value = " + text);
  } catch (const toml::parse_error&) {
    value.clear();
  }
  if (value.size() != 1) {  // not a TOML value: a string
    value.clear();
    value.insert_or_assign("value", text);
  }
  return value;
}

std::string assign(toml::table& root, const std::string& path, const toml::node& value) {
  const std::vector<Part> parts = parts_of(path);
  if (parts.empty()) return "found no path; allowed names with dots between, and [0], [1], ... for entries of an array";
  toml::node* at = &root;
  std::string walked;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    const bool last = i + 1 == parts.size();
    if (part.is_index) {
      toml::array* const array = at->as_array();
      if (array == nullptr) return "found " + walked + " to be no array; allowed an index of an array that is there";
      if (part.index >= array->size()) {
        return "found index " + std::to_string(part.index) + " of an array of " + std::to_string(array->size()) +
               "; allowed 0 to " + std::to_string(array->size() - 1);
      }
      if (last) {
        array->replace(array->cbegin() + static_cast<std::ptrdiff_t>(part.index), value);
      } else {
        at = array->get(part.index);
      }
      walked += "[" + std::to_string(part.index) + "]";
      continue;
    }
    toml::table* const table = at->as_table();
    if (table == nullptr) return "found " + walked + " to be no table; allowed a path through tables";
    walked += (walked.empty() ? "" : ".") + part.name;
    if (last) {
      table->insert_or_assign(part.name, value);
    } else {
      if (!table->contains(part.name)) {
        if (parts[i + 1].is_index) return "found no array " + walked + "; allowed an index of an array that is there";
        table->insert(part.name, toml::table{});
      }
      at = table->get(part.name);
    }
  }
  return {};
}

}  // namespace hamflow
