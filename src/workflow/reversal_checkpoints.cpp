#include "reversal_checkpoints.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "hamflow/detail/core/hash.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "resume.hpp"
#include "run_identity.hpp"
#include "run_keys.hpp"

namespace hamflow {

namespace {

namespace fs = std::filesystem;

constexpr const char* reversal_file = "reversal.bin";
constexpr const char* reversal_record = "reversal";
constexpr const char* first_half_record = "there";  // record of the first half, for warnings
constexpr double seconds_between = 10;

std::uint64_t hash_of_text(const std::string& text) { return fnv1a(std::as_bytes(std::span(text))); }

ReversalProgress progress_in(const Checkpoint& checkpoint) {
  ReversalProgress progress;
  for (const ObserverRecord& record : checkpoint.observers) {
    if (record.name != reversal_record) continue;
    Reader ar(record.bytes);
    progress.archive(ar);
    ar.finish();
  }
  return progress;
}

template <class Archive>
void archive_forward(Archive& ar, ReversalProgress& progress, TurningPointObserver& turns) {
  Excursion& energy = progress.forward_energy;
  ar(energy.initial, energy.final, energy.max_error, energy.scale_at_start, energy.exchanged);
  turns.archive(ar);
}

}  // namespace

std::optional<Checkpoint> kept_reversal(const Scenario& scenario, const fs::path& folder) {
  if (!fs::exists(folder / reversal_file)) return std::nullopt;
  Checkpoint checkpoint = read_checkpoint(folder / reversal_file);
  std::vector<Complaint> complaints = differences(scenario, checkpoint);
  try {
    // A short reversal saves no state, but may be complete.
    const bool turned = progress_in(checkpoint).turned || checkpoint.summary_hash != 0;
    if (turned && scenario.steps != checkpoint.steps && complaints.empty()) {
      const std::string by_time = run_path(run_keys().t_end);
      const std::string steps = scenario.settings.contains(by_time) ? by_time : run_path(run_keys().steps);
      const auto given = scenario.settings.find(steps);
      const Setting where = given == scenario.settings.end() ? Setting{{}, 1, 1} : given->second;
      complaints.push_back({scenario.file, where.line, where.column, steps,
                            "found " + std::to_string(scenario.steps) + " steps; allowed with " +
                                option_name("resume") + " " + std::to_string(checkpoint.steps) +
                                ", after which the momenta were negated"});
    }
  } catch (const Error& error) {
    throw FileError("the checkpoint " + (folder / reversal_file).string() + " cannot be used: " + error.what());
  }
  if (!complaints.empty()) throw Rejection(std::move(complaints));
  return checkpoint;
}

std::optional<std::string> complete_reversal(const Checkpoint& checkpoint, const fs::path& folder) {
  if (checkpoint.summary_hash == 0) return std::nullopt;
  std::ifstream in(folder / "reverse.json", std::ios::binary);
  if (!in) return std::nullopt;
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  return hash_of_text(text) == checkpoint.summary_hash ? std::optional(std::move(text)) : std::nullopt;
}

ReversalCheckpoints::ReversalCheckpoints(const Scenario& scenario, Simulation& simulation, const fs::path& folder,
                                         const Checkpoint* from)
    : simulation_(simulation),
      file_(folder / reversal_file),
      every_(scenario.checkpoint_every),
      checkpoint_(first_checkpoint(scenario, from != nullptr ? from->identity : new_identity())),
      turns_(scenario.dt, takes_equal_steps(simulation.method())) {
  if (from != nullptr && !has_no_step(*from)) {
    try {
      simulation.restore(from->simulation);
      progress_ = progress_in(*from);
      for (const ObserverRecord& record : from->observers) {
        if (record.name != first_half_record) continue;
        Reader ar(record.bytes);
        archive_forward(ar, progress_, turns_);
        ar.finish();
      }
    } catch (const Error& error) {
      throw FileError("the checkpoint " + file_.string() + " cannot be used: " + error.what());
    }
    checkpoint_.simulation = from->simulation;
    checkpoint_.observers = from->observers;
    checkpoint_.step = from->step;
  }
  write_checkpoint(file_, checkpoint_);  // marks the folder as that of this reversal, in case it is killed early
}

std::int64_t ReversalCheckpoints::next_due(std::int64_t step) const {
  return every_ == 0 ? never : std::max((step + every_ - 1) / every_ * every_, every_);
}

Verdict ReversalCheckpoints::observe(const Frame&) {
  write();
  return Verdict::go_on;
}

void ReversalCheckpoints::write_if_due() {
  if (every_ == 0 && std::chrono::duration<double>(Clock::now() - last_).count() > seconds_between) write();
}

void ReversalCheckpoints::write() {
  checkpoint_.step = progress_.turned ? checkpoint_.steps : simulation_.step();
  checkpoint_.simulation = simulation_.save();
  Writer ar;
  progress_.archive(ar);
  Writer there;
  archive_forward(there, progress_, turns_);
  checkpoint_.observers = {{reversal_record, ar.take()}, {first_half_record, there.take()}};
  write_checkpoint(file_, checkpoint_);
  last_ = Clock::now();
}

void ReversalCheckpoints::complete(const std::string& json) {
  checkpoint_.summary_hash = hash_of_text(json);
  if (checkpoint_.simulation.empty()) {  // a short reversal, for which --resume only compares the scenario
    checkpoint_.step = checkpoint_.steps;
  }
  write_checkpoint(file_, checkpoint_);
}

}  // namespace hamflow
