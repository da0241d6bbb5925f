// How messages name what a caller can give: the command has options (--out), Python has arguments (out=...).
#pragma once

#include <string>
#include <string_view>

namespace hamflow {

struct OptionNames {
  /// Of an option without its dashes, "out", or of a word of the usage, "METHOD".
  std::string (*option)(std::string_view option);
  /// What sets one key of a scenario.
  std::string (*set)(const std::string& key, const std::string& value);
  /// Of what lists, shows or draws something: "list methods", "plot --kind time --y q1,q2".
  std::string (*command)(std::string_view words);
};

/// Those of the command are used until a program calls this, before it calls anything else.
void use_option_names(OptionNames names);

std::string option_name(std::string_view option);
std::string set_option(const std::string& key, const std::string& value);
std::string command_name(std::string_view words);
/// "; give another --out, or --force to begin anew", where a folder cannot be gone on with.
std::string advice_to_begin_anew();

}  // namespace hamflow
