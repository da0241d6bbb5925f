// Values put into a document from outside, by dotted path: problem.mass, problem.initial.q[0], problem.bodies[1].mass.
// Everything that changes a scenario (--set, --vary, hamflow shell, hamflow convert) goes through here.
#pragma once

#include <toml++/toml.h>

#include <string>
#include <string_view>
#include <utility>

namespace hamflow {

/// A TOML value, or, of text that is none, the string; at the key "value" of a table.
toml::table parsed_value(const std::string& text);
/// Puts `value` at `path`. Tables on the way are made, entries of arrays are not.
/// @return what is wrong, as "found ...; allowed ..."; empty if nothing is
std::string assign(toml::table& root, const std::string& path, const toml::node& value);
/// Removes the key or the entry at `path`; nothing happens where there is none.
void erase(toml::table& root, const std::string& path);
/// The path and the text of the value of "PATH=VALUE"; without '=' or PATH the path is empty.
std::pair<std::string, std::string> parsed_set(const std::string& set);
/// Carries out --set PATH=VALUE. @return the path, and what is wrong; empty if nothing is
std::pair<std::string, std::string> apply_set(toml::table& root, const std::string& set);
/// Whether one of two paths is the other or leads to it: problem.orbit and problem.orbit.r0.
bool is_part_of_other(const std::string& a, const std::string& b);
/// Removes the keys of the file that a key set from outside excludes: t_end where steps is set, and so on.
void drop_excluded(toml::table& root);

/// Whether a value was set from outside: then it stands nowhere in the file.
inline bool is_set(const toml::node& node) { return node.source().begin.line == 0; }
/// Whether it, or a part of it, was.
bool touched(const toml::node& node);

}  // namespace hamflow
