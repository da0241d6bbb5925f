// Changes some keys in the text of a scenario.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hamflow {

/// Sets a dotted path to a TOML value, or removes the key if there is no value. A text that is not TOML becomes a
/// string.
struct ScenarioEdit {
  std::string path;
  std::optional<std::string> value;
};

/// Returns the text of the scenario with the edits applied, without its comments.
/// @param text a scenario that can be read
std::string edited_scenario(const std::string& text, const std::vector<ScenarioEdit>& edits);
/// Returns "[1, 2.5]", with the fewest digits that read back exactly.
std::string toml_list(const std::vector<double>& numbers);

}  // namespace hamflow
