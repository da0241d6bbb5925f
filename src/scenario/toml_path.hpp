// Sets values of a document by dotted path: problem.mass, problem.initial.q[0], problem.bodies[1].mass. All commands
// that change a scenario (--set, --vary, hamflow shell, hamflow convert) use these functions.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <utility>

namespace hamflow {

/// Returns a table whose key "value" has the TOML value of a text, or the text as a string if it is not a TOML value.
toml::table parsed_value(const std::string& text);
/// Sets `path` to `value`. Missing tables are created, missing entries of arrays are not.
/// @return an error, "found ...; allowed ..."; empty: none
std::string assign(toml::table& root, const std::string& path, const toml::node& value);
/// Removes the key or the entry at `path`, if it exists.
void erase(toml::table& root, const std::string& path);
/// Splits "PATH=VALUE" into the path and the text of the value; without '=' or PATH the path is empty.
std::pair<std::string, std::string> parsed_set(const std::string& set);
/// Applies --set PATH=VALUE. @return the path and an error; an empty error: none
std::pair<std::string, std::string> apply_set(toml::table& root, const std::string& set);
/// Returns whether one of two paths equals the other or is a prefix of it: problem.orbit and problem.orbit.r0.
bool is_part_of_other(const std::string& a, const std::string& b);
/// Removes the keys of the file that exclude a key set from outside, for example t_end if steps is set.
void drop_excluded(toml::table& root);

/// Returns whether a value was set from outside. Such a value has no line in the file.
inline bool is_set(const toml::node& node) { return node.source().begin.line == 0; }
/// Returns whether a value or a part of it was set from outside.
bool touched(const toml::node& node);

}  // namespace hamflow
