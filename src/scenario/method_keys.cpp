#include "method_keys.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/methods/step_control.hpp"
#include "scenario_reader.hpp"
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
                    .meaning = "name of the method, optionally followed by options, as in \"cg(1,5)\"",
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

std::string method_named_in(const toml::table& root) {
  const auto text = root["method"][method_name_key().name].value<std::string>();
  if (!text) return {};
  const auto end = text->find_last_not_of(" \t", text->find('(') - 1);
  return end == std::string::npos ? "" : text->substr(0, end + 1);
}

bool same_option(const OptionInfo& a, const OptionInfo& b) {
  return a.name == b.name && a.meaning == b.meaning && a.type == b.type && a.words == b.words &&
         a.range.least == b.range.least && a.range.most == b.range.most;
}

namespace {
/// Returns whether [method] has a monitor for steps of varying size, although --set asks for equal steps, which do
/// not use it.
bool has_replaced_monitor(const toml::table& method, const Texts& options_of_set_name) {
  if (!method.contains(monitor_option)) return false;
  const auto in_name = options_of_set_name.find(step_control_option);
  if (in_name != options_of_set_name.end()) return in_name->second == fixed_steps;
  const toml::node* const control = method.get(step_control_option);
  return control != nullptr && is_set(*control) && control->value<std::string>() == fixed_steps;
}
}  // namespace

std::vector<std::string> replaced_method_keys(const toml::table& method, const std::string& file_method) {
  const toml::node* name = method.get(method_name_key().name);
  if (name == nullptr) return {};
  if (!is_set(*name)) {
    return has_replaced_monitor(method, {}) ? std::vector<std::string>{monitor_option} : std::vector<std::string>{};
  }
  MethodSpec spec;
  try {
    spec = parse_method(name->value_or(std::string()));
  } catch (const Error&) {
    return {};  // the reader of scenarios reports this error
  }
  const std::vector<OptionInfo>& own = find_method(spec.name).family->options;
  const bool is_known = contains(method_name_key().words, file_method);
  const std::vector<OptionInfo>& meant = is_known ? find_method(file_method).family->options : own;
  const auto applies = [&](const std::string& option) {
    const OptionInfo* const here = find_option(own, option);
    const OptionInfo* const there = find_option(meant, option);
    return here != nullptr && (there == nullptr || same_option(*here, *there));
  };
  std::vector<std::string> replaced;
  for (const auto& [key, node] : method) {
    const std::string option(key.str());
    if (is_set(node) || !contains(all_method_keys(), option)) continue;
    if (!applies(option) || spec.options.contains(option)) replaced.push_back(option);
  }
  if (has_replaced_monitor(method, spec.options) && !contains(replaced, monitor_option)) {
    replaced.push_back(monitor_option);
  }
  return replaced;
}

namespace {
constexpr const char* in_its_name = "its name contains it";
constexpr const char* in_its_rows = "it differs between its rows, unless its name contains it";

/// Returns the reason why one or several methods do not use a key.
std::string why_unused(const std::string& why, std::size_t methods, bool one_row_each) {
  const bool several = methods > 1;
  if (why == in_its_name) return several ? "their names contain it" : why;
  if (why != in_its_rows) return why;
  const std::string unless = several ? ", unless their names contain it" : ", unless its name contains it";
  if (one_row_each) return (several ? "their rows have the default" : "its row has the default") + unless;
  return (several ? "it differs between their rows" : "it differs between its rows") + unless;
}
}  // namespace

struct SharedMethodKeys::Impl {
  std::optional<Document> document;
  std::map<std::string, Setting> settings;
  std::vector<std::pair<std::string, std::string>> unused{};  // keys and reasons, in order of occurrence
  std::map<std::pair<std::string, std::string>, std::vector<std::string>> methods{};  // methods that do not use the key
};

SharedMethodKeys::SharedMethodKeys(const std::string& text, const std::vector<std::string>& sets)
    : impl_(std::make_unique<Impl>()) {
  std::vector<Complaint> ignored_complaints;
  impl_->document = parsed_document(text, "", sets, ignored_complaints);
  if (impl_->document) impl_->settings = settings_of(impl_->document->root);
}

SharedMethodKeys::~SharedMethodKeys() = default;

void SharedMethodKeys::add_to(MethodSpec& method, const std::string& spelled) {
  toml::table* const table = impl_->document ? impl_->document->root["method"].as_table() : nullptr;
  if (table == nullptr) return;
  const std::string& name_key = method_name_key().name;
  table->insert_or_assign(name_key, spelled);
  const std::vector<std::string> replaced = replaced_method_keys(*table, impl_->document->file_method);
  const MethodSpec own = method;
  const std::vector<OptionInfo>& options = find_method(own.name).family->options;
  const auto why_not = [&](const std::string& key) -> std::string {
    if (own.options.contains(key)) return in_its_name;
    const OptionInfo* const option = find_option(options, key);
    if (option == nullptr) return "no such option";
    if (key == diagnostics_option) return "a comparison does not show it, and it takes time";
    if (key == tolerance_option && describe(own).own_substeps) return in_its_rows;
    if (!contains(replaced, key)) return "";
    return key == monitor_option ? "steps of equal size have no monitor" : "it has another meaning there";
  };
  for (const auto& [path, setting] : impl_->settings) {
    const std::string head = "method.";
    if (!path.starts_with(head)) continue;
    const std::string key = path.substr(head.size());
    if (key == name_key || !contains(all_method_keys(), key)) continue;
    const std::string why = why_not(key);
    if (why.empty()) {
      // texts without their quotes
      method.options[key] = table->get(key)->value_exact<std::string>().value_or(setting.text);
      continue;
    }
    const std::pair<std::string, std::string> entry{path + (setting.line > 0 ? "" : " of " + option_name("set")), why};
    if (!impl_->methods.contains(entry)) impl_->unused.push_back(entry);
    impl_->methods[entry].push_back(spelled);
  }
}

std::vector<std::string> SharedMethodKeys::unknown() const {
  const toml::table* const table = impl_->document ? impl_->document->root["method"].as_table() : nullptr;
  std::vector<std::string> all;
  if (table == nullptr) return all;
  for (const auto& [key, node] : *table) {
    const std::string name(key.str());
    if (name != method_name_key().name && !contains(all_method_keys(), name)) all.push_back(name);
  }
  return all;
}

std::vector<std::string> SharedMethodKeys::notes(bool one_row_each) const {
  std::vector<std::pair<std::string, std::string>> parts;  // keys, and a text with the methods and the reason
  for (const auto& entry : impl_->unused) {
    const auto& [key, why] = entry;
    const std::vector<std::string>& methods = impl_->methods.at(entry);
    const std::string rest = " not used by " + joined(methods) + ": " + why_unused(why, methods.size(), one_row_each);
    const auto same = std::find_if(parts.begin(), parts.end(), [&](const auto& part) { return part.second == rest; });
    if (same == parts.end()) {
      parts.emplace_back(key, rest);
    } else {
      same->first += ", " + key;
    }
  }
  std::vector<std::string> all;
  for (const auto& [keys, rest] : parts)
    all.push_back(keys + (keys.find(", ") == std::string::npos ? " is" : " are") + rest);
  return all;
}

void drop_replaced_method_keys(toml::table& root, const std::string& file_method) {
  toml::table* const method = root["method"].as_table();
  if (method == nullptr) return;
  for (const std::string& key : replaced_method_keys(*method, file_method)) method->erase(key);
}

}  // namespace hamflow
