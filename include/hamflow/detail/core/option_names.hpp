// The names of options in messages: the command has options (--out), Python has arguments (out=...).
#pragma once

#include <string>
#include <string_view>

namespace hamflow {

struct OptionNames {
  /// The name of an option, given without dashes ("out"), or of a positional argument ("METHOD").
  std::string (*option)(std::string_view option);
  /// The text that sets a key of a scenario.
  std::string (*set)(const std::string& key, const std::string& value);
  /// The call of a command: "list methods", "plot --kind time --y q1,q2".
  std::string (*command)(std::string_view words);
};

/// Sets the names; a program calls this before anything else. The default is the names of the command.
void use_option_names(OptionNames names);

std::string option_name(std::string_view option);
std::string set_option(const std::string& key, const std::string& value);
std::string command_name(std::string_view words);
/// "; choose another --out, or overwrite it with --force", for a folder that cannot be resumed.
std::string advice_to_overwrite();

}  // namespace hamflow
