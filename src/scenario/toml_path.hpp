// Values put into a document from outside, by dotted path: problem.mass, problem.initial.q[0], problem.bodies[1].mass.
#pragma once

#include <toml++/toml.h>

#include <string>

namespace hamflow {

/// A TOML value, or, of text that is none, the string; at the key "value" of a table.
toml::table parsed_value(const std::string& text);
/// Puts `value` at `path`. Tables on the way are made, entries of arrays are not.
/// @return what is wrong, as "found ...; allowed ..."; empty if nothing is
std::string assign(toml::table& root, const std::string& path, const toml::node& value);

}  // namespace hamflow
