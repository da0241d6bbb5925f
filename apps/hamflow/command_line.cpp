#include "command_line.hpp"

#include <algorithm>

#include "hamflow/core/text.hpp"
#include "run_keys.hpp"

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
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(sub->get_name());
  }
  const auto refuse = [](const std::string& message) {
    throw CLI::ValidationError(message, CLI::ExitCodes::InvalidError);
  };
  if (argc < 2) refuse("found no command; allowed " + joined(names));
  const std::string word = argv[1];
  if (word.starts_with("-")) {
    const std::vector<std::string> options{"--help", "-h", "--version"};
    const bool known = std::find(options.begin(), options.end(), word) != options.end();
    if (known || argc > 2) return;
    refuse("found the option " + word + "; allowed " + joined(options) + " or a command" + suggestion(word, options));
  }
  if (std::find(names.begin(), names.end(), word) != names.end()) return;
  const std::string meant = word == "help"            ? "; did you mean --help?"
                            : word.ends_with(".toml") ? "; did you mean run " + word + "?"
                                                      : suggestion(word, names);
  refuse("found the command '" + word + "'; allowed " + joined(names) + meant);
}

void reject_missing_value(const CLI::App& app, int argc, char** argv) {
  const auto subs = app.get_subcommands([&](const CLI::App* sub) { return argc > 1 && sub->get_name() == argv[1]; });
  if (subs.empty()) return;
  const CLI::App* const sub = subs.front();
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    const std::string name = word.substr(0, word.find('='));
    const CLI::Option* const option = sub->get_option_no_throw(name);
    if (option == nullptr || !word.starts_with("-") || option->get_items_expected_max() == 0) continue;
    const bool behind_equals = name.size() < word.size();
    const bool empty = behind_equals ? name.size() + 1 == word.size() : i + 1 < argc && argv[i + 1][0] == '\0';
    const bool option_follows = !behind_equals && i + 1 < argc && sub->get_option_no_throw(argv[i + 1]) != nullptr &&
                                std::string(argv[i + 1]).starts_with("-");
    if (!empty && !option_follows) continue;
    throw CLI::ValidationError(name + ": found " + (empty ? "no value" : "the option " + std::string(argv[i + 1])) +
                                   "; allowed " + name + " " + option->get_type_name(),
                               CLI::ExitCodes::InvalidError);
  }
}

namespace {
/// The scenario key whose name was typed as an option: run.steps for --steps. Empty if no key has this name.
std::string key_for_option(const std::string& option) {
  std::string name = option.substr(std::min(option.find_first_not_of('-'), option.size()));
  std::replace(name.begin(), name.end(), '-', '_');
  for (const DeclaredTable& table : declared_tables()) {
    for (const OptionInfo& key : table.keys) {
      if (key.name == name || key.name == name + "s") return table.name + "." + key.name;
    }
  }
  if (name == "problem" || name == "method") return name + ".name";
  return "";
}
}  // namespace

std::vector<Complaint> complaints_of(const CLI::App& app, const CLI::ParseError& error) {
  std::vector<Complaint> all;
  const auto complain = [&](const std::string& key, const std::string& message) {
    all.push_back({"", 0, 0, key, message});
  };
  if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    for (const CLI::App* sub : app.get_subcommands()) {
      std::vector<std::string> names;
      for (const CLI::Option* option : sub->get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
      }
      for (const std::string& word : sub->remaining()) {
        if (!word.starts_with("-") && sub->get_name() == "compare") {
          complain("--methods", "found " + word +
                                    " after a blank; allowed one list separated by commas, e.g. --methods 'verlet," +
                                    word + "'");
        }
        if (!word.starts_with("-")) continue;
        const std::string name = word.substr(0, word.find('='));
        const bool sets = std::find(names.begin(), names.end(), "--set") != names.end();
        const std::string key = sets ? key_for_option(name) : "";
        complain(name, "found the option " + name + "; allowed " + joined(names) +
                           (key.empty() ? suggestion(name, names) : "; did you mean --set " + key + "=...?"));
      }
    }
    if (!all.empty()) return all;
  }
  // CLI11 puts the name of the option before the message of the validator.
  const std::string text = error.what();
  const std::size_t colon = text.find(": ");
  const bool has_name = colon != std::string::npos && text.find_first_of(" '\"") > colon;
  complain(has_name ? text.substr(0, colon) : "", has_name ? text.substr(colon + 2) : text);
  return all;
}

}  // namespace hamflow::app
