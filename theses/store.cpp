#include "store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

#include "figure_description.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/core/version.hpp"
#include "hamflow/detail/core/hash.hpp"
#include "hamflow/workflow/columns_file.hpp"

namespace hamflow::reproduction {

namespace {
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

double number_in(const Json& json) { return json.is_number() ? json.get<double>() : std::nan(""); }

ClaimVerdict verdict_in(const std::string& word) {
  for (const ClaimVerdict verdict : all_claim_verdicts) {
    if (name(verdict) == word) return verdict;
  }
  throw Error("no verdict: " + word);
}

/// The names of Grounds, in the order of the enumeration.
constexpr const char* names_of_grounds[] = {"program", "ways", "identity"};

/// Adds the limits of the rule and the grounds to the JSON of a claim, so that judge() can check the stored verdict.
Json json_with_bounds(const Claim& claim) {
  Json all = json_of(claim);
  all["low"] = claim.rule.low;  // an infinite limit is stored as null
  all["high"] = claim.rule.high;
  all["grounds"] = names_of_grounds[static_cast<int>(claim.grounds)];
  return all;
}

Claim claim_in(const Json& json) {
  Claim claim{.id = json.at("id"),
              .thesis = json.at("thesis"),
              .page = json.at("page"),
              .statement = json.at("statement"),
              .printed = json.at("printed"),
              .rule = {json.at("rule")}};
  for (const Json& one : json.at("measurements")) {
    claim.measured.push_back({number_in(one.at("value")), number_in(one.at("uncertainty")), one.at("how")});
  }
  // Older files have no limits; the page does not need them.
  if (const Json low = json.value("low", Json()); low.is_number()) claim.rule.low = low;
  if (const Json high = json.value("high", Json()); high.is_number()) claim.rule.high = high;
  const auto grounds = std::find(std::begin(names_of_grounds), std::end(names_of_grounds),
                                 json.value("grounds", std::string(names_of_grounds[0])));
  if (grounds == std::end(names_of_grounds)) throw Error("no grounds of a claim");
  claim.grounds = static_cast<Grounds>(grounds - std::begin(names_of_grounds));
  claim.judgement = {verdict_in(json.at("verdict")), json.at("reason")};
  if (claim.judgement.verdict != ClaimVerdict::nothing_to_test &&
      judge(claim.rule, claim.measured, claim.grounds).verdict != claim.judgement.verdict) {
    throw Error("a verdict that does not follow from its numbers");
  }
  return claim;
}

std::string contents_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}
std::string digest(const std::string& text) { return fmt::format("{:016x}", fnv1a(std::as_bytes(std::span(text)))); }
/// The key of the digest of all other entries of result.json except the seconds, which differ between equal runs. Older
/// files have no digest.
constexpr const char* own_digest = "fnv1a";
std::string digest_of_rest(Json all) {
  all.erase(own_digest);
  all.erase("seconds");
  return digest(text_of(all));
}
/// The file with the digest of each other file. It is separate from result.json, because figures contain the date and
/// result.json has to be the same for equal results.
constexpr const char* digests_of_files = "files.json";
bool is_as_written(const fs::path& folder, const Json& all) {
  if (!all.contains(own_digest)) return true;
  if (all.at(own_digest) != digest_of_rest(all)) return false;
  const Json files = Json::parse(contents_of(folder / digests_of_files), nullptr, false);
  if (!files.is_object()) return false;
  for (const std::string& name : all.at("files").get<std::vector<std::string>>()) {
    if (files.value(name, "") != digest(contents_of(folder / name))) return false;
  }
  return true;
}

void write_csv(const fs::path& file, const Curves& curves) {
  std::string text = joined(
                         curves.columns, [](const auto& column) { return column.first; }, ",") +
                     "\n";
  std::size_t rows = 0;
  for (const auto& [name, numbers] : curves.columns) rows = std::max(rows, numbers.size());
  for (std::size_t row = 0; row < rows; ++row) {
    text += joined(
                curves.columns,
                [row](const auto& column) {
                  return row < column.second.size() ? fmt::format("{:.17g}", column.second[row]) : std::string();
                },
                ",") +
            "\n";
  }
  write_text(file, text);
}

std::string quoted(const std::string& cell) {
  std::string all = "\"";
  for (const char c : cell) all += c == '"' ? std::string("\"\"") : std::string(1, c);
  return all + "\"";
}

void write_table(const fs::path& file, const TextTable& table) {
  std::string text = joined(table.headings, quoted, ",") + "\n";
  for (const auto& row : table.rows) text += joined(row, quoted, ",") + "\n";
  write_text(file, text);
}

/// Makes a column name from a label, without the marks of enhanced text.
std::string plain_label(const std::string& label) {
  std::string name;
  for (std::size_t i = 0; i < label.size(); ++i) {
    if (label.compare(i, 9, "{/:Italic") == 0) {
      i += 8;
    } else if (label[i] == ' ' || label[i] == ',') {
      if (!name.empty() && name.back() != '_') name += '_';
    } else if (std::string("{}^").find(label[i]) == std::string::npos && !(label[i] == '_' && name.empty())) {
      name += label[i];
    }
  }
  return name;
}

/// The curves that the experiment stores or, if it stores none, the curves of its figures.
std::vector<Curves> curves_of(const Study& study) {
  std::vector<Curves> all(study.curves().begin(), study.curves().end());
  if (!all.empty()) return all;
  for (const Drawn& drawn : study.drawn()) {
    Curves curves{drawn.name, {}};
    int number = 0;
    for (const figures::Panel& panel : drawn.page.panels) {
      for (const figures::Series& series : panel.series) {
        const std::string name =
            fmt::format("{}_{}", ++number, series.name.empty() ? std::string("curve") : plain_label(series.name));
        curves.columns.emplace_back(name + "_" + plain_label(panel.x_label), series.curve.x);
        curves.columns.emplace_back(name + "_" + plain_label(panel.y_label), series.curve.y);
      }
    }
    if (!curves.columns.empty()) all.push_back(std::move(curves));
  }
  return all;
}

void write_h5(const fs::path& file, const Study& study, const std::vector<Curves>& all_curves) {
  ColumnsFile contents{.attributes = {{"experiment", study.info().id}}, .texts = {}, .groups = all_curves};
  for (const StoredScenario& scenario : study.scenarios()) {
    contents.texts.emplace_back("scenario_" + scenario.name, scenario.text);
  }
  write_columns(file, contents);
}
}  // namespace

Json json_of(const Claim& claim) {
  Json all{{"id", claim.id},
           {"thesis", claim.thesis},
           {"page", claim.page},
           {"statement", claim.statement},
           {"printed", claim.printed},
           {"measured", claim.measured.empty() ? Json(nullptr) : Json(claim.measured.front().value)},
           {"uncertainty", claim.measured.empty() ? Json(nullptr) : Json(claim.measured.front().uncertainty)},
           {"rule", claim.rule.text},
           {"verdict", std::string(name(claim.judgement.verdict))},
           {"reason", claim.judgement.reason},
           {"measurements", Json::array()}};
  for (const Measured& one : claim.measured) {
    all["measurements"].push_back({{"value", one.value}, {"uncertainty", one.uncertainty}, {"how", one.how}});
  }
  return all;
}

std::string text_of(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

std::string fingerprint(const Experiment& experiment, WorkExtent extent) {
  return std::string(HAMFLOW_VERSION) + " " + name_of(extent) + " " + experiment.source;
}

std::string name_of(WorkExtent extent) {
  constexpr const char* names[] = {"quick", "default", "full"};
  return names[static_cast<int>(extent)];
}

std::string fingerprint_of(const std::string& id, WorkExtent extent) { return fingerprint(experiment_of(id), extent); }

void keep(const fs::path& folder, const Study& study, const std::string& print, double seconds) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError("cannot make the folder " + folder.string() + ": " + error.message());
  Json all{{"fingerprint", print},   {"seconds", seconds},         {"claims", Json::array()},
           {"notes", study.notes()}, {"scenarios", Json::array()}, {"figures", Json::array()},
           {"tables", Json::array()}};
  std::vector<std::string> files;
  for (const Claim& claim : study.claims()) all["claims"].push_back(json_with_bounds(claim));
  for (const StoredScenario& scenario : study.scenarios()) {
    write_text(folder / files.emplace_back(scenario.name + ".toml"), scenario.text);
    all["scenarios"].push_back({{"name", scenario.name}, {"command", scenario.command}});
  }
  const std::vector<Curves> curves = curves_of(study);
  for (const Curves& each : curves) write_csv(folder / files.emplace_back(each.name + ".csv"), each);
  if (!curves.empty()) write_h5(folder / files.emplace_back("curves.h5"), study, curves);
  std::vector<figures::Drawing> drawings;
  for (const Drawn& drawn : study.drawn()) {
    figures::Drawing& drawing = drawings.emplace_back(figures::Drawing{drawn.page, {}});
    for (const char* const format : {"svg", "pdf", "png"}) {
      drawing.files.push_back(folder / files.emplace_back(drawn.name + "." + format));
    }
    all["figures"].push_back({drawn.name, drawn.caption, words_of(drawn.page)});
  }
  figures::draw(drawings);
  for (const TextTable& table : study.tables()) {
    write_table(folder / files.emplace_back(table.name + ".csv"), table);
    all["tables"].push_back(
        {{"name", table.name}, {"caption", table.caption}, {"headings", table.headings}, {"rows", table.rows}});
  }
  all["files"] = files;
  Json digests = Json::object();
  for (const std::string& file : files) digests[file] = digest(contents_of(folder / file));
  write_text(folder / digests_of_files, text_of(digests));
  all[own_digest] = digest_of_rest(all);
  write_text(folder / "result.json", text_of(all));
}

std::optional<StoredResults> read_stored_results(const fs::path& folder, const std::string& print) {
  std::ifstream in(folder / "result.json");
  if (!in) return {};
  std::stringstream text;
  text << in.rdbuf();
  const Json all = Json::parse(text.str(), nullptr, false);
  if (all.is_discarded() || !all.is_object() || all.value("fingerprint", "") != print) return {};
  try {
    if (!is_as_written(folder, all)) return {};
    StoredResults kept;
    for (const Json& claim : all.at("claims")) kept.claims.push_back(claim_in(claim));
    kept.notes = all.at("notes").get<std::vector<std::string>>();
    for (const Json& scenario : all.at("scenarios")) {
      kept.scenarios.push_back({.name = scenario.at("name"), .text = {}, .command = scenario.at("command")});
    }
    for (const Json& figure : all.at("figures")) kept.drawings.push_back({figure.at(0), figure.at(1), figure.at(2)});
    for (const Json& table : all.at("tables")) {
      kept.tables.push_back({table.at("name"), table.at("caption"), table.at("headings"), table.at("rows")});
    }
    kept.seconds = all.at("seconds");
    return kept;
  } catch (const std::exception&) {  // an unknown format: the experiment runs again
    return {};
  }
}

std::optional<StoredExperiment> read_stored_experiment(const Experiment& experiment, const fs::path& folder) {
  for (const WorkExtent extent : {WorkExtent::full, WorkExtent::usual, WorkExtent::quick}) {
    if (auto kept = read_stored_results(folder, fingerprint(experiment, extent)))
      return StoredExperiment{*std::move(kept), extent};
  }
  return {};
}

}  // namespace hamflow::reproduction
