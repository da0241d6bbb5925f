#include "option_text.hpp"

#include "hamflow/core/text.hpp"

namespace hamflow {

std::string explained(const OptionInfo& option) {
  std::string text = option.meaning;
  const std::string allowed = allowed_text(option);
  if (!allowed.empty() && allowed != text) text += "; " + allowed;
  if (!option.condition.empty()) text += "; " + option.condition;
  if (!option.unit.empty()) text += "; in units of " + option.unit;
  return text;
}

std::string explained_with_default(const OptionInfo& option) {
  const std::string text = explained(option);
  if (option.required) return text + "; required";
  if (!option.default_value.empty()) return text + "; default " + option.default_value;
  if (!option.unset.empty()) return text + "; by default " + option.unset;
  return option.condition.empty() ? text + "; not given by default" : text;
}

std::string example_text(const OptionInfo& option) {
  // an example is declared, or the table has no declared keys
  const bool own = !option.example.empty() || option.keys.empty();
  if (option.type == OptionType::table && own) return option.example;
  if (option.type == OptionType::table) {
    std::vector<OptionInfo> keys = option.keys;
    std::erase_if(keys, [](const OptionInfo& key) { return key.condition.starts_with("in place of"); });
    return "{ " + joined(keys, [](const OptionInfo& key) { return key.name + " = " + example_text(key); }) + " }";
  }
  if (!option.example.empty()) return toml_text(option, option.example);
  if (!option.default_value.empty()) return toml_text(option, option.default_value);
  if (option.type == OptionType::word && !option.words.empty()) return toml_text(option, option.words.front());
  return option.type == OptionType::list ? "[1]" : "1";
}

}  // namespace hamflow
