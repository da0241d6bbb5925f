#include "method_keys.hpp"

#include <algorithm>

#include "toml_path.hpp"

namespace hamflow {

namespace {
bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}
}  // namespace

const OptionInfo& method_name_key() {
  static const OptionInfo key = [] {
    OptionInfo name{.name = "name",
                    .meaning = "of the method, with or without options behind it, as in \"cg(1,5)\"",
                    .type = OptionType::word,
                    .required = true};
    for (const MethodEntry& entry : methods()) name.words.push_back(entry.name);
    return name;
  }();
  return key;
}

const std::vector<std::string>& all_method_keys() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names;
    for (const MethodFamily& family : method_families()) {
      for (const OptionInfo& option : family.options) {
        if (!contains(names, option.name)) names.push_back(option.name);
      }
    }
    return names;
  }();
  return all;
}

bool names_method_with_options(const std::string& text) {
  const auto open = text.find('(');
  if (open == std::string::npos) return false;
  const auto end = text.find_last_not_of(" \t", open == 0 ? 0 : open - 1);
  return contains(method_name_key().words, end == std::string::npos ? "" : text.substr(0, end + 1));
}

std::vector<std::string> replaced_method_keys(const toml::table& method) {
  const toml::node* name = method.get(method_name_key().name);
  if (name == nullptr || !is_set(*name)) return {};
  MethodSpec spec;
  try {
    spec = parse_method(name->value_or(std::string()));
  } catch (const Error&) {
    return {};  // the reader complains about it
  }
  const std::vector<std::string> own = option_names(find_method(spec.name).family->options);
  std::vector<std::string> replaced;
  for (const auto& [key, node] : method) {
    const std::string option(key.str());
    if (is_set(node) || !contains(all_method_keys(), option)) continue;
    if (!contains(own, option) || spec.options.contains(option)) replaced.push_back(option);
  }
  return replaced;
}

void drop_replaced_method_keys(toml::table& root) {
  toml::table* const method = root["method"].as_table();
  if (method == nullptr) return;
  for (const std::string& key : replaced_method_keys(*method)) method->erase(key);
}

}  // namespace hamflow
