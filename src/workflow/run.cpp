#include "hamflow/workflow/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>

#include "gnuplot.hpp"
#include "hamflow/core/stop_question.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/run/socket.hpp"
#include "hamflow/workflow/figures_of_run.hpp"
#include "resume.hpp"
#include "run_identity.hpp"
#include "run_keys.hpp"
#include "scenario_edit.hpp"
#include "summary.hpp"

namespace hamflow {

namespace {

namespace fs = std::filesystem;

void note(const RunSettings& settings, const std::string& text) {
  if (settings.note) settings.note(text);
}

/// Returns the scenario with the spacing of samples that the run had when it began.
Scenario with_spacing_of(const Checkpoint& checkpoint, Scenario scenario, const RunSettings& settings) {
  if (scenario.record_every != checkpoint.record_every && scenario.record.empty()) {
    scenario.record_every = checkpoint.record_every;
    scenario.text =
        edited_scenario(scenario.text, {{run_path(run_keys().record_every), std::to_string(checkpoint.record_every)}});
    note(settings, fmt::format("samples are still recorded every {} {}, as when the run began", checkpoint.record_every,
                               checkpoint.record_every == 1 ? "step" : "steps"));
  }
  return scenario;
}

void restore(Simulation& simulation, const Checkpoint& checkpoint) {
  try {
    simulation.restore(checkpoint.simulation);
  } catch (const Error& error) {
    throw FileError(std::string("the checkpoint cannot be used: ") + error.what());
  }
}

constexpr double grace = 0.4;  // grace period after Ctrl-C in seconds, for the certificate and then for the figures

/// Draws the figures. After an interrupt they are drawn only if that takes no longer than the grace period.
/// @param stop_was_requested whether a stop was requested   @param tables tables of the run; null: they are read from
/// its folder
void draw(const Scenario& scenario, const RunSettings& settings, std::int64_t step, bool stop_was_requested,
          const RunTables* tables, RunReport& report) {
  const auto begin = std::chrono::steady_clock::now();
  const figures::StopDrawingScope watch([&] {
    if (!stop_was_requested) return !settings.pulse || settings.pulse(step);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() < grace;
  });
  try {
    for (const std::string& missing : draw_figures(scenario, settings.folder, tables)) note(settings, missing);
  } catch (const figures::DrawingStopped& stopped) {
    report.file_error = stopped.what();
    report.drawing_stopped = true;
  }
}

bool has_its_figures(const Scenario& scenario, const fs::path& folder) {
  return std::all_of(scenario.figures.begin(), scenario.figures.end(), [&](const std::string& kind) {
    return fs::exists(folder / "figures" / (kind + ".svg")) && fs::exists(folder / "figures" / (kind + ".pdf")) &&
           fs::exists(folder / "figures" / (kind + ".png"));
  });
}

/// A run, from its start or from a checkpoint to its end.
class ScenarioRun {
 public:
  /// @param folder null: nothing is written   @param last checkpoint in the folder; null: the folder is made
  ScenarioRun(const Scenario& scenario, const RunSettings& settings, WorkFolder* folder, const Checkpoint* last)
      : scenario_(scenario),
        settings_(settings),
        folder_(folder),
        simulation_(timed_simulation()),
        turns_(scenario.dt, takes_equal_steps(simulation_->method())) {
    const Checkpoint* const from = last != nullptr && !has_no_step(*last) ? last : nullptr;
    if (from != nullptr) {
      restore(*simulation_, *from);
      seconds_before_ = from->wall_seconds;
    }
    if (writes()) {
      // an observer without archive() throws now instead of at the first checkpoint
      for (Observer* observer : settings.observers) {
        Writer probe;
        observer->archive(probe);
      }
      folder_->prepare(scenario);
      if (last == nullptr) {  // marks the folder as that of this run, in case it is killed early
        begin_.emplace(first_checkpoint(scenario_, new_identity()));
        write_checkpoint(settings.folder / "checkpoint.bin", *begin_);
        last = &*begin_;
      } else {
        check_summary(summary_json(summary_of(scenario_, *simulation_, RunResult{})), settings.folder);
      }
      recorder_ = std::make_unique<Recorder>(scenario_, settings.folder, last->identity, from,
                                             [this] { simulation_->restart_energy_range(); });
    } else if (settings.samples && last == nullptr) {
      recorder_ = std::make_unique<Recorder>(scenario_, fs::path(), std::string(), nullptr,
                                             [this] { simulation_->restart_energy_range(); });
    }
    if (recorder_) simulation_->on_bounce([this](const Bounce& bounce) { recorder_->append(bounce); });
    measures_.emplace(scenario_, *simulation_, recorder_.get());
    std::vector<NamedObserver> archived = measures_->observers();
    archived.push_back({"energy_blocks", &blocks_});
    archived.push_back({"turns", &turns_});
    for (std::size_t i = 0; i < settings.observers.size(); ++i) {
      archived.push_back({"observer " + std::to_string(i + 1), settings.observers[i]});
    }
    if (from != nullptr) restore_observers(*from, archived);
    for (const NamedObserver& each : archived) observers_.push_back(each.observer);
    if (!writes()) {
      if (recorder_) observers_.push_back(recorder_.get());
      return;
    }
    folder_->remove("summary.json");  // belongs to the previous part
    checkpoints_ = std::make_unique<CheckpointWriter>(scenario_, *simulation_, *recorder_, std::move(archived),
                                                      settings.folder, *last);
    observers_.push_back(recorder_.get());
    observers_.push_back(checkpoints_.get());  // last, so that a checkpoint includes all observations of its step
  }

  /// Returns whether a file contains the final state. Samples by steps include it; samples at given times may include
  /// it.
  bool keeps_final_state() const {
    const auto& formats = scenario_.formats;
    if (!writes() || std::find(formats.begin(), formats.end(), "h5") == formats.end()) return false;
    if (scenario_.record.empty()) return true;
    Frame frame;
    simulation_->look(frame);
    return evaluate_number<double>(scenario_.record.back()) == frame.time;
  }

  RunReport carry_out() {
    const auto begin = std::chrono::steady_clock::now();
    const std::int64_t first = simulation_->step();
    RunResult result = take_steps();
    result.wall_seconds =
        seconds_before_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    result.steps_taken = simulation_->step();
    step_seconds_ = (result.wall_seconds - seconds_before_) /
                    static_cast<double>(std::max<std::int64_t>(1, result.steps_taken - first));
    // This happens after the last checkpoint was written, because a longer run that resumes from it does not end here.
    Frame end;
    simulation_->look(end);
    measures_->observe_end(end);
    RunReport report;
    std::optional<RunCertificate> certificate;
    if (!scenario_.map && result.client_error.empty()) {
      // Without a certificate only the sizes of energies are needed, so no further steps are taken.
      const ContinueQuestion no_steps = [] { return false; };
      try {
        certificate =
            certify(scenario_.request, *scenario_.problem, simulation_, blocks_, result.steps_taken,
                    scenario_.certificate ? continue_question(result.outcome == Outcome::stopped, result.steps_taken)
                                          : no_steps);
      } catch (const ClientError& error) {
        throw ClientError(std::string("certificate: ") + error.what() +
                          "; all steps are done: start it again, and continue with " + option_name("resume"));
      }
      const auto& reversal = certificate->reversal;
      certificate_stopped_ = scenario_.certificate && reversal && reversal->was_stopped;
      if (certificate_stopped_) result.outcome = Outcome::stopped;  // the certificate is incomplete
    }
    report.summary =
        summary_of(scenario_, *simulation_, result, certificate ? &*certificate : nullptr, &*measures_, &turns_);
    if (report.summary.final.is_large && !keeps_final_state()) {
      report.summary.final.dataset.clear();
      if (writes()) {
        report.summary.warnings.push_back(
            {"final_state",
             "no file holds the final state, which has too many numbers for a summary: run.h5 is not written, or the "
             "times of run.record end before the run"});
      }
    }
    report.file_error = result.file_error;
    report.outcome = result.outcome;
    report.json = summary_json(report.summary);
    describe(report);
    if (writes()) {
      finish_folder(report);
    } else if (recorder_) {
      report.tables = recorder_->take_tables();
    }
    return report;
  }

  /// Returns the report of a run that was already complete, from its checkpoint and its stored summary.
  RunReport complete(KeptSummary kept) {
    RunReport report;
    report.was_complete = true;
    report.summary = std::move(kept.summary);
    report.json = std::move(kept.json);
    describe(report);
    return report;
  }

 private:
  std::unique_ptr<Simulation> timed_simulation() {
    const auto begin = std::chrono::steady_clock::now();
    auto made = make_simulation(scenario_.request);
    setup_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return made;
  }
  /// Returns a function that tells whether the work after the steps may continue. If a stop was requested, it may take
  /// `grace` seconds: no step and no set-up of a simulation begins that would take longer.
  ContinueQuestion continue_question(bool stop_was_requested, std::int64_t step) const {
    if (!stop_was_requested) return [this, step] { return !settings_.pulse || settings_.pulse(step); };
    return [this, begin = std::chrono::steady_clock::now()] {
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      return seconds + std::max(step_seconds_, setup_seconds_) < grace;
    };
  }
  bool writes() const { return folder_ != nullptr; }

  /// The state is then that after the last complete step, from which the run can be resumed.
  Outcome run_until_client_fails(std::string& client_error) {
    try {
      return run(*simulation_, scenario_.steps, observers_, [&](std::int64_t step) {
        if (recorder_) {
          recorder_->flush_if_due();
          if (checkpoints_) checkpoints_->write_if_due();
          if (!recorder_->records_more_bounces()) simulation_->on_bounce({});  // unreported bounces cost less
        }
        return !settings_.pulse || settings_.pulse(step);
      });
    } catch (const ClientError& error) {
      client_error = error.what();
      return Outcome::stopped;
    }
  }

  RunResult take_steps() {
    RunResult result;
    const ContinueQuestion goes_on = [this] { return !settings_.pulse || settings_.pulse(simulation_->step()); };
    const StopQuestion question(goes_on);
    try {
      result.outcome = run_until_client_fails(result.client_error);
      if (result.outcome == Outcome::stopped && measures_->stopped()) result.outcome = Outcome::done;
      if (recorder_) {
        if (const auto time = recorder_->failed_at(simulation_->step());
            time && status_of(result.outcome) == "failed") {
          result.failure = "the partial step to the sample at t = " + *time + " failed";
        }
        recorder_->finish(*simulation_);
        if (checkpoints_ && status_of(result.outcome) != "failed") checkpoints_->write();
      }
    } catch (const FileError& error) {  // for example a full disk; the results are reported nevertheless
      result.file_error = error.what();
    }
    if (is_failure(result.outcome) && result.failure.empty()) result.failure = simulation_->failure();
    return result;
  }

  void describe(RunReport& report) const {
    const Summary& summary = report.summary;
    report.status = summary.status;
    if (summary.error) {
      report.message = summary.error->message;
      report.hint = summary.error->hint;
      report.details = summary.error->details;
    }
    simulation_->look(report.final);
    report.energy = simulation_->energy();
    report.energy_scale = simulation_->energy_scale();
    report.invariants = simulation_->invariants();
    report.certificate = summary.certificate;
    report.wall_seconds = summary.wall_seconds;
    report.warnings = warning_lines(summary.warnings);
    report.text = summary_text(summary);
  }

  void finish_folder(RunReport& report) {
    try {
      checkpoints_->expect_summary(report.json);
      folder_->write("summary.json", report.json);
      checkpoints_.reset();
      recorder_->close();
      if (report.status != "failed") {
        const bool stop_was_requested = report.status == "interrupted" || certificate_stopped_;
        draw(scenario_, settings_, simulation_->step(), stop_was_requested, recorder_->tables(), report);
      }
    } catch (const std::exception& error) {  // the run itself is complete
      report.file_error = error.what();
    }
  }

  const Scenario& scenario_;
  const RunSettings& settings_;
  WorkFolder* folder_;
  double setup_seconds_ = 0;  // time to set up the simulation
  std::unique_ptr<Simulation> simulation_;
  double seconds_before_ = 0;
  double step_seconds_ = 0;  // mean time of a step, including observers
  std::optional<Checkpoint> begin_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<CheckpointWriter> checkpoints_;
  EnergyBlocks blocks_{energy_for_blocks(scenario_.request, *scenario_.problem, scenario_.start_q.size())};
  TurningPointObserver turns_;
  std::optional<Measures> measures_;
  bool certificate_stopped_ = false;
  std::vector<Observer*> observers_;
};

}  // namespace

RunReport run(const Scenario& requested, const RunSettings& settings) {
  std::optional<WorkFolder> place;
  if (!settings.folder.empty()) place.emplace(settings.folder, run_folder(), settings.existing);
  WorkFolder* const folder = place ? &*place : nullptr;
  if (folder != nullptr && !folder->note().empty()) note(settings, folder->note());
  if (folder == nullptr || !folder->resumes()) return ScenarioRun(requested, settings, folder, nullptr).carry_out();
  const std::optional<Checkpoint> from = read_checkpoint(*folder / "checkpoint.bin");
  if (auto complaints = differences(requested, *from); !complaints.empty()) throw Rejection(std::move(complaints));
  check_samples(requested, *from, settings.folder);
  if (has_no_step(*from)) {
    note(settings, "the run was stopped before its first checkpoint, so it starts from the beginning");
    return ScenarioRun(requested, settings, folder, &*from).carry_out();
  }
  std::optional<KeptSummary> kept = own_summary(*from, settings.folder);
  if (kept && is_complete(requested, *from, kept->summary)) {
    RunReport report = ScenarioRun(requested, settings, nullptr, &*from).complete(std::move(*kept));
    if (has_its_figures(requested, settings.folder)) {
      note(settings, "the run is complete already; there is nothing to do");
    } else {
      note(settings, "the run is complete already; only its figures are drawn");
      draw(requested, settings, from->step, false, nullptr, report);
    }
    return report;
  }
  const Scenario scenario = with_spacing_of(*from, requested, settings);
  return ScenarioRun(scenario, settings, folder, &*from).carry_out();
}

fs::path folder_of(const Scenario& scenario, const std::string& out) {
  if (!out.empty()) return out;
  if (!scenario.folder.empty()) return scenario.folder;
  return fs::path(scenario.file).stem().string() + ".run";
}

}  // namespace hamflow
