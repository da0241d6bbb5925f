// The keys of [method], as the families of methods declare them.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <vector>

#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// `name`, one of the closed list; in a scenario it may carry options, as in "cg(1,5)".
const OptionInfo& method_name_key();
/// The names of the options of all families, each once.
const std::vector<std::string>& all_method_keys();
/// Whether the text is the name of a method with something in parentheses behind it.
bool names_method_with_options(const std::string& text);
/// The keys of [method] in the file that do not apply because a method was set from outside (--set, --vary): options
/// that it does not have, and options that its name carries.
std::vector<std::string> replaced_method_keys(const toml::table& method);
/// Removes them from the [method] of a document.
void drop_replaced_method_keys(toml::table& root);

}  // namespace hamflow
