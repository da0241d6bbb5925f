#include "hamflow/detail/core/option_names.hpp"

namespace hamflow {

namespace {
bool is_upper_case(char c) { return c >= 'A' && c <= 'Z'; }

OptionNames& used() {
  static OptionNames names{
      [](std::string_view option) { return (is_upper_case(option.front()) ? "" : "--") + std::string(option); },
      [](const std::string& key, const std::string& value) { return "--set " + key + "=" + value; },
      [](std::string_view words) { return "hamflow " + std::string(words); }};
  return names;
}
}  // namespace

void use_option_names(OptionNames names) { used() = names; }
std::string option_name(std::string_view option) { return used().option(option); }
std::string set_option(const std::string& key, const std::string& value) { return used().set(key, value); }
std::string command_name(std::string_view words) { return used().command(words); }

std::string advice_to_overwrite() {
  return "; choose another " + option_name("out") + ", or overwrite it with " + option_name("force");
}

}  // namespace hamflow
