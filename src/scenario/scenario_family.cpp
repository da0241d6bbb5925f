#include "scenario_family.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <utility>

#include "method_keys.hpp"
#include "scenario_reader.hpp"
#include "toml_path.hpp"

namespace hamflow {

struct ScenarioFamily::Impl {
  std::string name;
  std::string text;
  std::map<std::string, Setting> settings;
  Document document;
  std::vector<toml::table> values;
  std::vector<Complaint> complaints;
  bool is_read = false;
};

ScenarioFamily::ScenarioFamily(const std::string& text, const std::string& name, const std::vector<std::string>& sets)
    : impl_(std::make_unique<Impl>()) {
  impl_->name = name;
  if (auto document = parsed_document(text, name, sets, impl_->complaints)) impl_->document = std::move(*document);
  std::vector<Complaint> the_same;
  // parsed again, because a copy loses the order of keys
  if (auto common = parsed_document(text, name, sets, the_same)) {
    drop_replaced_method_keys(common->root, common->file_method);
    impl_->settings = settings_of(common->root);
    impl_->text = effective_text(text, sets, common->root);
  }
}

ScenarioFamily::~ScenarioFamily() = default;

const std::vector<Complaint>& ScenarioFamily::complaints() const { return impl_->complaints; }
const std::string& ScenarioFamily::text() const { return impl_->text; }
const std::map<std::string, Setting>& ScenarioFamily::settings() const { return impl_->settings; }

std::size_t ScenarioFamily::add_value(const std::string& text) {
  impl_->values.push_back(parsed_value(text));
  return impl_->values.size() - 1;
}

void ScenarioFamily::replace_value(std::size_t number, const std::string& text) {
  impl_->values[number] = parsed_value(text);
}

Reading ScenarioFamily::read(const std::vector<std::string>& paths, const std::vector<std::size_t>& values) {
  Reading reading;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::string wrong = assign(impl_->document.root, paths[i], *impl_->values[values[i]].get("value"));
    if (!wrong.empty()) reading.complaints.push_back({impl_->name, 0, 0, paths[i], wrong});
  }
  if (!reading.complaints.empty()) return reading;
  if (!std::exchange(impl_->is_read, true)) drop_excluded(impl_->document.root);  // all members drop the same keys
  ScenarioReader reader(impl_->document, impl_->name, reading.complaints);
  Scenario scenario = reader.read();
  reading.no_start = reader.no_start();
  if (reading.complaints.empty()) {
    reading.scenario = std::move(scenario);
  } else if (reading.complaints.size() == 1 && !reading.no_start.empty()) {
    const std::size_t size = scenario.request.start.q.size();
    scenario.start_q.assign(size, std::numeric_limits<double>::quiet_NaN());
    scenario.start_p = scenario.start_q;
    reading.scenario_without_start = std::move(scenario);
  }
  return reading;
}

std::string scenario_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (std::filesystem::is_directory(file)) {
    throw FileError("cannot read the scenario " + file + ": found a folder; allowed a TOML file");
  }
  if (!in) throw FileError("cannot read the scenario " + file + ": " + std::strerror(errno));
  std::ostringstream text;
  text << in.rdbuf();
  std::string found = text.str();
  if (found.starts_with("\x89HDF\r\n")) {
    throw FileError("cannot read the scenario " + file +
                    ": found an HDF5 file, the data of a run or sweep; allowed a TOML file");
  }
  return found;
}

}  // namespace hamflow
