#include "scenario_edit.hpp"

#include "hamflow/core/error.hpp"
#include "hamflow/core/number.hpp"
#include "hamflow/core/text.hpp"
#include "toml_path.hpp"
#include "toml_text.hpp"

namespace hamflow {

std::string edited_scenario(const std::string& text, const std::vector<ScenarioEdit>& edits) {
  toml::table root = toml::parse(text);
  for (const ScenarioEdit& edit : edits) {
    if (edit.value) {
      const std::string wrong = assign(root, edit.path, *parsed_value(*edit.value).get("value"));
      if (!wrong.empty()) throw Error(edit.path + ": " + wrong);
    } else {
      erase(root, edit.path);
    }
  }
  return toml_text(root);
}

std::string toml_list(const std::vector<double>& numbers) { return "[" + joined(numbers, shortest) + "]"; }

}  // namespace hamflow
