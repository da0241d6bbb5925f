#include "hamflow/scenario/scenario.hpp"

#include <algorithm>
#include <sstream>

#include "method_keys.hpp"
#include "resumed_scenario.hpp"
#include "scenario_family.hpp"
#include "scenario_reader.hpp"
#include "toml_depth.hpp"
#include "toml_path.hpp"
#include "toml_text.hpp"

namespace hamflow {

namespace {

void list_settings(const toml::table& table, const std::string& path, std::map<std::string, Setting>& settings) {
  for (const auto& [key, node] : table) {
    const std::string name = path + std::string(key.str());
    if (const auto* inner = node.as_table()) {
      list_settings(*inner, name + ".", settings);
    } else {
      std::ostringstream text;
      if (const auto* number = node.as_floating_point()) {
        text << shortest(number->get());
      } else {
        node.visit([&](const auto& value) { text << value; });
      }
      const toml::source_position where = node.source().begin;
      settings[name] = {text.str(), static_cast<int>(where.line), static_cast<int>(where.column)};
    }
  }
}

/// Returns advice for errors of the TOML parser whose messages contain none.
std::string hint_to(std::string_view description) {
  const auto says = [&](std::string_view part) { return description.find(part) != std::string_view::npos; };
  if (says("could not determine value type")) {
    return "; allowed a number, true, false, a list, a table, or a text in quotes";
  }
  if (says("parsing decimal integer") || says("parsing floating-point")) {
    return "; allowed numbers such as 0.5 and 1e-3, and formulas in quotes, \"2*pi/100\"";
  }
  if (says("parsing inline table")) return "; allowed a table in { } on one line, or a table [in.brackets] on many";
  return "";
}

}  // namespace

std::map<std::string, Setting> settings_of(const toml::table& root) {
  std::map<std::string, Setting> settings;
  list_settings(root, "", settings);
  return settings;
}

std::int64_t sample_count(std::int64_t steps, std::int64_t record_every) {
  return steps / record_every + 1 + (steps % record_every != 0 ? 1 : 0);
}

std::int64_t sample_count(const Scenario& scenario) {
  return scenario.record.empty() ? sample_count(scenario.steps, scenario.record_every)
                                 : static_cast<std::int64_t>(scenario.record.size());
}

std::int64_t default_record_every(std::int64_t steps, std::size_t coordinates) {
  constexpr std::int64_t most_numbers = (std::int64_t{1} << 30) / sizeof(double);  // 1 GiB
  const auto numbers = static_cast<std::int64_t>(std::max<std::size_t>(1, 2 * coordinates));
  const std::int64_t most_samples = std::clamp<std::int64_t>(most_numbers / numbers, 3, 10000);
  const std::int64_t intervals = most_samples - 1;  // the start is a sample, too
  return std::max<std::int64_t>(1, steps / intervals + (steps % intervals != 0 ? 1 : 0));
}

std::optional<Document> parsed_document(const std::string& text, const std::string& name,
                                        const std::vector<std::string>& sets, std::vector<Complaint>& complaints) {
  Document document;
  toml::table& root = document.root;
  if (const auto deep = too_deep(text)) {
    complaints.push_back({name, deep->line, deep->column, "syntax", deep->message});
    return std::nullopt;
  }
  try {
    root = toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    complaints.push_back({name, static_cast<int>(error.source().begin.line),
                          static_cast<int>(error.source().begin.column), "syntax",
                          "not valid TOML: " + std::string(error.description()) + hint_to(error.description())});
    return std::nullopt;
  }
  document.file_method = method_named_in(root);
  for (const std::string& set : sets) {
    const auto [path, wrong] = apply_set(root, set);
    if (!wrong.empty()) complaints.push_back({name, 0, 0, path, wrong});
  }
  drop_excluded(root);
  return document;
}

std::string effective_text(const std::string& text, const std::vector<std::string>& sets, const toml::table& root) {
  return sets.empty() ? text : toml_text(root);
}

namespace {
Reading read_text(const std::string& text, const std::string& name, const std::vector<std::string>& sets,
                  const std::optional<std::string>& resumed_in) {
  Reading reading;
  std::optional<Document> document = parsed_document(text, name, sets, reading.complaints);
  if (!document) return reading;
  document->resumed_in = resumed_in;
  Scenario scenario = ScenarioReader(*document, name, reading.complaints).read();
  drop_replaced_method_keys(document->root, document->file_method);  // the reader has already noted them
  scenario.text = effective_text(text, sets, document->root);
  scenario.settings = settings_of(document->root);
  // Complaints are listed in the order of the file.
  std::stable_sort(reading.complaints.begin(), reading.complaints.end(),
                   [](const Complaint& a, const Complaint& b) { return a.line < b.line; });
  if (reading.complaints.empty()) reading.scenario = std::move(scenario);
  return reading;
}

}  // namespace

Reading read_scenario_text(const std::string& text, const std::string& name, const std::vector<std::string>& sets) {
  return read_text(text, name, sets, std::nullopt);
}

Reading read_resumed_scenario(const std::filesystem::path& file, const std::vector<std::string>& sets,
                              const std::string& folder) {
  return read_text(scenario_text(file.string()), file.string(), sets, folder);
}

Reading read_scenario(const std::filesystem::path& file, const std::vector<std::string>& sets) {
  return read_scenario_text(scenario_text(file.string()), file.string(), sets);
}

}  // namespace hamflow
