// A scenario's text with some of its keys changed.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hamflow {

/// A dotted path gets a TOML value (text that is none becomes a string); without value the key goes.
struct ScenarioEdit {
  std::string path;
  std::optional<std::string> value;
};

/// The scenario written anew with the edits applied. Comments are lost.
/// @param text a scenario that can be read
std::string edited_scenario(const std::string& text, const std::vector<ScenarioEdit>& edits);
/// "[1, 2.5]", as few digits as read back the same.
std::string toml_list(const std::vector<double>& numbers);

}  // namespace hamflow
