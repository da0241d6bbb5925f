// A document written as TOML.
#pragma once

#include <toml++/toml.h>

#include <string>

namespace hamflow {

/// Reads back as the same document. The tables of a scenario stand in its usual order, keys as they stood in their
/// file, what was set from outside behind them. Comments are lost. A number has as few digits as read back the same.
std::string toml_text(const toml::table& root);

}  // namespace hamflow
