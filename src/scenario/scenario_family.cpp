#include "scenario_family.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

#include "scenario_reader.hpp"
#include "toml_path.hpp"

namespace hamflow {

struct ScenarioFamily::Impl {
  std::string name;
  std::string text;
  toml::table root;
  std::vector<toml::table> values;
  std::vector<Complaint> complaints;
};

ScenarioFamily::ScenarioFamily(const std::string& text, const std::string& name, const std::vector<std::string>& sets)
    : impl_(std::make_unique<Impl>()) {
  impl_->name = name;
  impl_->text = text;
  try {
    impl_->root = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    impl_->complaints.push_back({name, static_cast<int>(error.source().begin.line),
                                 static_cast<int>(error.source().begin.column), "syntax",
                                 "found no valid TOML: " + std::string(error.description())});
    return;
  }
  for (const std::string& set : sets) {
    impl_->text += "# --set " + set + "\n";
    const auto [path, wrong] = apply_set(impl_->root, set);
    if (!wrong.empty()) impl_->complaints.push_back({name, 0, 0, path, wrong});
  }
  drop_excluded(impl_->root);
}

ScenarioFamily::~ScenarioFamily() = default;

const std::vector<Complaint>& ScenarioFamily::complaints() const { return impl_->complaints; }
const std::string& ScenarioFamily::text() const { return impl_->text; }

std::size_t ScenarioFamily::add_value(const std::string& text) {
  impl_->values.push_back(parsed_value(text));
  return impl_->values.size() - 1;
}

Reading ScenarioFamily::read(const std::vector<std::string>& paths, const std::vector<std::size_t>& values) {
  Reading reading;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::string wrong = assign(impl_->root, paths[i], *impl_->values[values[i]].get("value"));
    if (!wrong.empty()) reading.complaints.push_back({impl_->name, 0, 0, paths[i], wrong});
  }
  if (!reading.complaints.empty()) return reading;
  drop_excluded(impl_->root);  // the same keys for every member
  Scenario scenario = ScenarioReader(impl_->root, impl_->name, reading.complaints).read();
  if (reading.complaints.empty()) reading.scenario = std::move(scenario);
  return reading;
}

std::string scenario_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file)) throw FileError("cannot read the scenario " + file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace hamflow
