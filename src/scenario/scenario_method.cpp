// Reads [method]: the name, and the options that the family of the method declares.
#include <algorithm>

#include "engine/large_steps.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/detail/run/fitting_methods.hpp"
#include "hamflow/methods/step_control.hpp"
#include "method_keys.hpp"
#include "scenario_reader.hpp"

namespace hamflow {

void ScenarioReader::read_method(TomlTable& table) {
  MethodSpec& spec = scenario_.request.method;
  if (!read_method_name(table)) {
    spec.name.clear();
    table.know_all(all_method_keys());  // without a method no key can be called wrong
    table.finish();
    return;
  }
  const std::vector<std::string> dropped = replaced_method_keys(table.node(), file_method_);
  for (const std::string& key : dropped) {
    table.know(key);
    if (key == monitor_option && find_option(find_method(spec.name).family->options, key) != nullptr) {
      scenario_.notes.push_back(table.full(key) + " is not used: steps of equal size have no monitor");
      continue;
    }
    scenario_.notes.push_back(
        table.full(key) + " of the file is not used: " + table.full(method_name_key().name) + " is set to " +
        spec.name +
        (find_option(find_method(spec.name).family->options, key) != nullptr && !spec.options.contains(key)
             ? ", for which it has another meaning"
             : ""));
  }
  const Texts in_name = spec.options;
  for (const OptionInfo& option : find_method(spec.name).family->options) {
    if (std::find(dropped.begin(), dropped.end(), option.name) != dropped.end()) continue;
    const auto text = table.text(option);
    if (table.has(option.name) && in_name.contains(option.name)) {
      table.complain(option.name, "given here and in " + table.full(method_name_key().name) + "; allowed once");
    } else if (text) {
      spec.options[option.name] = *text;
    }
  }
  if (const auto refused = refused_option(spec)) {
    const bool of_symmetry = refused->name == step_control_option && refused->message.ends_with("symmetric method");
    const std::string which = of_symmetry ? with_fitting_methods({"verlet", "stv4", "cg"}, scenario_.problem.get(),
                                                                 scenario_.request.arithmetic)
                                          : "";
    table.complain(table.has(refused->name) ? refused->name : method_name_key().name, refused->message + which);
  }
  if (scenario_.problem != nullptr) {
    const std::string why_not = refusal(spec, *scenario_.problem);
    if (!why_not.empty() && !complain_of_soft_walls()) complain_of_method(table, why_not);
  }
  table.finish(scenario_.problem.get(), spec.name);
}

/// Complains at the option that the message names ("monitor: found ...") if [method] has it, otherwise at the name.
void ScenarioReader::complain_of_method(TomlTable& table, const std::string& why_not) {
  for (const OptionInfo& option : find_method(scenario_.request.method.name).family->options) {
    const std::string head = option.name + ": ";
    if (!why_not.starts_with(head) || !table.has(option.name)) continue;
    return table.complain(option.name, why_not.substr(head.size()));
  }
  const std::string& key = method_name_key().name;
  table.complain(key, table.found(key) + "; " + why_not);
}

/// Refuses options that a step with this many unknowns does not allow, and notes options that were replaced.
void ScenarioReader::check_method_for_size(TomlTable& table) {
  if (!has_method() || scenario_.problem == nullptr || refused_option(scenario_.request.method)) return;
  const MethodSpec& spec = scenario_.request.method;
  const std::size_t coordinates = scenario_.start_q.size();
  if (const auto refused = refused_option(spec, coordinates)) {
    table.complain(table.has(refused->name) ? refused->name : method_name_key().name, refused->message);
  }
  for (const ReplacedOption& replaced : replaced_options(spec, coordinates)) {
    scenario_.notes.push_back(table.full(replaced.name) + " = " + replaced.message);
  }
}

/// Reads the name; returns false if there is no known method.
bool ScenarioReader::read_method_name(TomlTable& table) {
  const OptionInfo& key = method_name_key();
  const auto text = table.plain_string(key.name);
  const auto allowed = [&] {
    const std::vector<std::string> first = first_methods();
    return joined(first) + " and " + std::to_string(key.words.size() - first.size()) + " others (" +
           command_name("list methods") + ")";
  };
  if (!table.has(key.name)) {
    table.missing(key.name, allowed());
    return false;
  }
  if (text && !names_method_with_options(*text) && !refused_value(key, *text).empty()) {
    table.complain(key.name, "found \"" + *text + "\"; allowed " + allowed() +
                                 suggestion(text->substr(0, text->find('(')), key.words));
    return false;
  }
  if (!text || !names_method_with_options(*text)) {
    const auto name = table.text(key);
    if (name) scenario_.request.method.name = *name;
    return name.has_value();
  }
  try {
    scenario_.request.method = parse_method(*text);
    return true;
  } catch (const Error& error) {
    table.complain(key.name, error.what());
    return false;
  }
}

}  // namespace hamflow
