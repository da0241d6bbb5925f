#include "resume.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "csv_file.hpp"
#include "hamflow/core/version.hpp"
#include "hamflow/detail/core/hash.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/run/gas.hpp"
#include "json_text.hpp"
#include "run_identity.hpp"
#include "run_keys.hpp"

namespace hamflow {

namespace {

namespace fs = std::filesystem;

constexpr double checkpoint_seconds = 10;

std::uint64_t hash_of(const std::string& text) { return fnv1a(std::as_bytes(std::span(text))); }

std::string file_key(const Scenario& scenario) { return "problem." + scenario.problem->info.file_key; }
std::string contents_key(const Scenario& scenario) { return file_key(scenario) + ": contents"; }

/// Returns the keys of a run with their values. If the start is read from a file, a further key has the hash of its
/// contents.
std::map<std::string, Setting> settings_of(const Scenario& scenario) {
  std::map<std::string, Setting> all = scenario.settings;
  if (!scenario.start_contents) return all;
  const auto file = all.find(file_key(scenario));
  const Setting where = file == all.end() ? Setting{{}, 1, 1} : file->second;
  all.emplace(contents_key(scenario), Setting{"contents with hash " + fmt::format("{:016x}", *scenario.start_contents),
                                              where.line, where.column});
  return all;
}

/// Writes a value on one line. A long list is shortened to its first and last entries and their number.
std::string shown(const std::string& value) {
  constexpr std::size_t longest = 120, kept = 40;
  std::string line;
  for (const char c : value) {
    const bool blank = c == '\n' || c == '\t' || c == ' ';
    if (c == ']' && line.ends_with(' ')) line.pop_back();
    if (!blank) line += c;
    if (blank && !line.empty() && line.back() != ' ' && line.back() != '[') line += ' ';
  }
  if (line.size() <= longest) return line;
  const bool is_list = line.starts_with('[') && line.find_first_of("[{\"'", 1) == std::string::npos;
  const std::vector<std::string> entries = is_list ? list_parts(line) : std::vector<std::string>();
  if (entries.size() < 8) {
    return line.substr(0, kept) + " ... " + line.substr(line.size() - kept) + " (" + std::to_string(line.size()) +
           " characters)";
  }
  const std::size_t last = entries.size() - 1;
  return "[" + entries[0] + ", " + entries[1] + ", " + entries[2] + ", ..., " + entries[last - 1] + ", " +
         entries[last] + "] (" + std::to_string(entries.size()) + " entries)";
}

std::optional<std::string> text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

std::vector<Complaint> differences(const Scenario& scenario, const Checkpoint& checkpoint) {
  std::vector<Complaint> all;
  const std::map<std::string, Setting> settings = settings_of(scenario);
  const auto complain = [&](const std::string& key, const std::string& message) {
    const auto found = settings.find(key);
    const Setting where = found == settings.end() ? Setting{{}, 1, 1} : found->second;
    all.push_back({scenario.file, where.line, where.column, key, message + advice_to_overwrite()});
  };
  std::map<std::string, std::string> before;
  for (std::size_t i = 0; i < checkpoint.keys.size(); ++i) before[checkpoint.keys[i]] = checkpoint.values[i];
  for (const auto& [key, setting] : settings) {
    if (is_free_on_resume(key)) continue;
    const std::string& value = setting.text;
    const std::string found = shown(value);
    const auto there = before.find(key);
    if (there == before.end()) {
      complain(key, "found " + found + "; allowed with " + option_name("resume") +
                        ": leave this key out, as when the run began");
    } else if (there->second != value) {
      complain(key, "found " + found + "; allowed with " + option_name("resume") + " " + shown(there->second) +
                        ", as when the run began");
    }
  }
  for (const auto& [key, value] : before) {
    // The file no longer exists, so the start is read from run.h5.
    if (key == contents_key(scenario) && !scenario.start_contents) continue;
    if (is_free_on_resume(key) || settings.contains(key)) continue;
    complain(key, "missing; allowed with " + option_name("resume") + " " + shown(value) + ", as when the run began");
  }
  if (scenario.steps < checkpoint.step) {
    const std::string by_time = run_path(run_keys().t_end);
    complain(scenario.settings.contains(by_time) ? by_time : run_path(run_keys().steps),
             "found " + std::to_string(scenario.steps) + " steps; allowed with " + option_name("resume") +
                 " at least " + std::to_string(checkpoint.step) + ", which were taken already");
  }
  if (checkpoint.version != HAMFLOW_VERSION) {
    complain("hamflow", "found version " HAMFLOW_VERSION "; allowed with " + option_name("resume") + " version " +
                            checkpoint.version + ", with which the run began");
  }
  return all;
}

Checkpoint first_checkpoint(const Scenario& scenario, const std::string& identity) {
  Checkpoint checkpoint;
  checkpoint.identity = identity;
  checkpoint.version = HAMFLOW_VERSION;
  for (const auto& [key, setting] : settings_of(scenario)) {
    checkpoint.keys.push_back(key);
    checkpoint.values.push_back(setting.text);
  }
  checkpoint.steps = scenario.steps;
  checkpoint.record_every = scenario.record_every;
  checkpoint.csv_hash = fnv1a_of_nothing;
  return checkpoint;
}

void check_samples(const Scenario& scenario, const Checkpoint& checkpoint, const fs::path& folder) {
  const bool begun = has_no_step(checkpoint);
  const auto check = [&](const char* format, const char* name, const auto& wrong_with) {
    const auto& formats = scenario.formats;
    const bool wanted = std::find(formats.begin(), formats.end(), format) != formats.end();
    const fs::path file = folder / name;
    std::error_code none;
    if (!wanted || (begun && !fs::exists(file, none))) return;
    if (const std::string wrong = wrong_with(file); !wrong.empty()) {
      throw FileError("cannot resume with " + file.string() + ": " + wrong + advice_to_overwrite());
    }
  };
  check("h5", "run.h5",
        [&](const fs::path& file) { return refused_run_file(file, checkpoint.identity, checkpoint.rows); });
  check("csv", "trajectory.csv",
        [&](const fs::path& file) { return refused_csv(file, checkpoint.csv_bytes, checkpoint.csv_hash); });
}

std::optional<KeptSummary> own_summary(const Checkpoint& checkpoint, const fs::path& folder) {
  auto text = text_of(folder / "summary.json");
  if (!text || checkpoint.summary_hash != hash_of(*text)) return std::nullopt;
  Summary summary = read_summary(*text);
  return KeptSummary{std::move(*text), std::move(summary)};
}

bool is_complete(const Scenario& scenario, const Checkpoint& checkpoint, const Summary& own) {
  if (own.status != "done") return false;  // the certificate may be missing
  if (own.stopped_by) return true;         // an event ended the run, so no step follows
  return checkpoint.step == scenario.steps && checkpoint.steps == scenario.steps;
}

void check_summary(const std::string& own, const fs::path& folder) {
  const auto text = text_of(folder / "summary.json");
  if (!text) return;
  const auto refuse = [&](const std::string& why) {
    throw FileError("the file " + (folder / "summary.json").string() + " belongs to another run: " + why +
                    "; move it to another folder" + advice_to_overwrite());
  };
  const auto found = read_json_by_keys(*text);
  if (!found.is_object()) refuse("it is not a JSON object");
  const auto expected = read_json_by_keys(own);
  for (const char* key : {"problem", "method", "arithmetic", "parameters", "dt"}) {
    if (found.contains(key) && found[key] != expected[key]) refuse(std::string(key) + " differs");
  }
  if (!found.contains("problem") && !found.contains("method")) refuse("it has no keys problem and method");
}

void restore_observers(const Checkpoint& checkpoint, const std::vector<NamedObserver>& observers) {
  const auto unusable = [](const std::string& why) { return FileError("the checkpoint cannot be used: " + why); };
  if (checkpoint.observers.size() != observers.size()) {
    throw unusable("found " + std::to_string(observers.size()) + " observers; allowed the " +
                   std::to_string(checkpoint.observers.size()) + " with which the run began");
  }
  for (std::size_t i = 0; i < observers.size(); ++i) {
    const ObserverRecord& record = checkpoint.observers[i];
    if (record.name != observers[i].name) {
      throw unusable("found observer " + observers[i].name + "; allowed " + record.name + ", as when the run began");
    }
    try {
      Reader ar(record.bytes);
      observers[i].observer->archive(ar);
      ar.finish();
    } catch (const Error& error) {
      throw unusable(record.name + ": " + error.what());
    }
  }
}

CheckpointWriter::CheckpointWriter(const Scenario& scenario, const Simulation& simulation, Recorder& recorder,
                                   std::vector<NamedObserver> observers, const fs::path& folder, Checkpoint last)
    : simulation_(simulation),
      recorder_(recorder),
      observers_(std::move(observers)),
      file_(folder / "checkpoint.bin"),
      every_(scenario.checkpoint_every),
      checkpoint_(std::move(last)),
      seconds_before_(checkpoint_.wall_seconds) {
  // Some keys may change when a run is resumed.
  Checkpoint now = first_checkpoint(scenario, checkpoint_.identity);
  if (!scenario.start_contents) {  // the file no longer exists, so the hash from the start of the run is kept
    for (std::size_t i = 0; i < checkpoint_.keys.size(); ++i) {
      if (checkpoint_.keys[i] != contents_key(scenario)) continue;
      now.keys.push_back(checkpoint_.keys[i]);
      now.values.push_back(checkpoint_.values[i]);
    }
  }
  checkpoint_.keys = now.keys;
  checkpoint_.values = now.values;
  checkpoint_.steps = now.steps;
}

void CheckpointWriter::archive_observers() {
  checkpoint_.observers.clear();
  for (const NamedObserver& each : observers_) {
    Writer ar;
    each.observer->archive(ar);
    checkpoint_.observers.push_back({each.name, ar.take()});
  }
}

std::int64_t CheckpointWriter::next_due(std::int64_t step) const {
  if (every_ == 0) return never;
  const std::int64_t next = (step + every_ - 1) / every_ * every_;
  return std::max(next, every_);  // no checkpoint at the start
}

Verdict CheckpointWriter::observe(const Frame&) {
  write();
  return Verdict::go_on;
}

void CheckpointWriter::write_if_due() {
  if (every_ == 0 && std::chrono::duration<double>(Clock::now() - last_).count() > checkpoint_seconds) write();
}

void CheckpointWriter::write() {
  recorder_.mark(checkpoint_);
  checkpoint_.summary_hash = 0;
  checkpoint_.step = simulation_.step();
  checkpoint_.simulation = simulation_.save();
  archive_observers();
  checkpoint_.wall_seconds = seconds_before_ + std::chrono::duration<double>(Clock::now() - begin_).count();
  write_checkpoint(file_, checkpoint_);
  last_ = Clock::now();
}

void CheckpointWriter::expect_summary(const std::string& text) {
  checkpoint_.summary_hash = hash_of(text);
  write_checkpoint(file_, checkpoint_);
}

}  // namespace hamflow
