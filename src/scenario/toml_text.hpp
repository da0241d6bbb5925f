// Writes a document as TOML.
#pragma once

#include <toml++/toml.h>

#include <string>

namespace hamflow {

/// Returns TOML that reads back as the same document. The tables have the usual order of a scenario. The keys have the
/// order of the file, followed by keys that were set from outside. Comments are lost. Numbers have the fewest digits
/// that read back exactly.
std::string toml_text(const toml::table& root);

}  // namespace hamflow
