#include "command_line.hpp"

#include <algorithm>

#include "hamflow/core/text.hpp"

namespace hamflow::app {

CLI::Validator whole_number(double least, double most) {
  const OptionInfo number{.name = "", .range = Range::whole_from(least, most)};
  const auto check = [number](std::string& text) {
    std::string refused = refused_value(number, text);
    if (refused.empty()) text = std::to_string(static_cast<long long>(number_value(text)));
    return refused;
  };
  return {check, "", ""};
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  const OptionInfo option{.name = "", .type = OptionType::word, .words = words};
  return {[option](std::string& text) { return refused_value(option, text); }, "", ""};
}

void reject_unknown_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(sub->get_name());
  }
  if (std::find(names.begin(), names.end(), argv[1]) != names.end()) return;
  throw CLI::ValidationError(
      std::string("found the command '") + argv[1] + "'; allowed " + joined(names) + suggestion(argv[1], names),
      CLI::ExitCodes::InvalidError);
}

std::string message_of(const CLI::App& app, const CLI::ParseError& error) {
  std::string message;
  for (const CLI::App* sub : app.get_subcommands()) {
    std::vector<std::string> names;
    for (const CLI::Option* option : sub->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    for (const std::string& word : sub->remaining()) {
      if (!word.starts_with("-")) continue;
      const std::string name = word.substr(0, word.find('='));
      message += (message.empty() ? "" : "\n") + sub->get_name() + ": found the option " + name + "; allowed " +
                 joined(names) + suggestion(name, names);
    }
  }
  return message.empty() || error.get_exit_code() != static_cast<int>(CLI::ExitCodes::ExtrasError) ? error.what()
                                                                                                   : message;
}

}  // namespace hamflow::app
