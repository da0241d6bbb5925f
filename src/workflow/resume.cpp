#include "resume.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "hamflow/numerics/inverse_cube.hpp"
#include "run_keys.hpp"

namespace hamflow {

namespace {

constexpr double checkpoint_seconds = 10;

std::string instruction_set() { return std::string(name(fast_kernel_instruction_set())); }

}  // namespace

std::vector<Complaint> differences(const Scenario& scenario, const Checkpoint& checkpoint) {
  std::vector<Complaint> all;
  const auto complain = [&](const std::string& key, const std::string& message) {
    const auto found = scenario.settings.find(key);
    const Setting where = found == scenario.settings.end() ? Setting{{}, 1, 1} : found->second;
    all.push_back({scenario.file, where.line, where.column, key,
                   message + "; give --out another folder, or --force to begin anew"});
  };
  std::map<std::string, std::string> before;
  for (std::size_t i = 0; i < checkpoint.keys.size(); ++i) before[checkpoint.keys[i]] = checkpoint.values[i];
  for (const auto& [key, setting] : scenario.settings) {
    if (is_free_on_resume(key)) continue;
    const std::string& value = setting.text;
    const auto there = before.find(key);
    if (there == before.end()) {
      complain(key, "found " + value + "; allowed with --resume nothing, as when the run began");
    } else if (there->second != value) {
      complain(key, "found " + value + "; allowed with --resume " + there->second + ", as when the run began");
    }
  }
  for (const auto& [key, value] : before) {
    if (is_free_on_resume(key) || scenario.settings.contains(key)) continue;
    complain(key, "found nothing; allowed with --resume " + value + ", as when the run began");
  }
  if (scenario.steps < checkpoint.step) {
    const std::string by_time = run_path(run_keys().t_end);
    complain(scenario.settings.contains(by_time) ? by_time : run_path(run_keys().steps),
             "found " + std::to_string(scenario.steps) + " steps; allowed with --resume at least the " +
                 std::to_string(checkpoint.step) + " that were taken");
  }
  if (checkpoint.version != HAMFLOW_VERSION) {
    complain("hamflow", std::string("found version " HAMFLOW_VERSION "; allowed with --resume version ") +
                            checkpoint.version + ", with which the run began");
  }
  if (scenario.request.kernel == "fast" && checkpoint.instruction_set != instruction_set()) {
    complain(run_path(run_keys().kernel), "found \"fast\" with the instruction set " + instruction_set() +
                                              "; allowed with --resume the instruction set " +
                                              checkpoint.instruction_set + ", with which the run began");
  }
  return all;
}

std::optional<std::string> finished_summary(const Scenario& scenario, const Checkpoint& checkpoint,
                                            const std::filesystem::path& folder) {
  if (checkpoint.step != scenario.steps || checkpoint.steps != scenario.steps) return std::nullopt;
  std::ifstream in(folder / "summary.json");
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto summary = nlohmann::json::parse(text, nullptr, false);
  const bool done = summary.is_object() && summary.value("status", "") == "done" &&
                    summary.value("steps", std::int64_t{-1}) == scenario.steps;
  return done ? std::optional(text) : std::nullopt;
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
                                   std::vector<NamedObserver> observers, const std::filesystem::path& folder,
                                   double seconds_before)
    : simulation_(simulation),
      recorder_(recorder),
      observers_(std::move(observers)),
      file_(folder / "checkpoint.bin"),
      every_(scenario.checkpoint_every),
      seconds_before_(seconds_before) {
  checkpoint_.version = HAMFLOW_VERSION;
  checkpoint_.instruction_set = instruction_set();
  for (const auto& [key, setting] : scenario.settings) {
    checkpoint_.keys.push_back(key);
    checkpoint_.values.push_back(setting.text);
  }
  checkpoint_.steps = scenario.steps;
  checkpoint_.record_every = scenario.record_every;
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
  return std::max(next, every_);  // there is nothing to save at the start
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
  checkpoint_.step = simulation_.step();
  checkpoint_.simulation = simulation_.save();
  archive_observers();
  checkpoint_.wall_seconds = seconds_before_ + std::chrono::duration<double>(Clock::now() - begin_).count();
  write_checkpoint(file_, checkpoint_);
  last_ = Clock::now();
}

}  // namespace hamflow
