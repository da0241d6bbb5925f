// hamflow run: a scenario becomes a simulation, the simulation samples, the samples a folder and a summary.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iostream>

#include "commands.hpp"
#include "hamflow/workflow/figures_of_run.hpp"
#include "measures.hpp"
#include "progress.hpp"
#include "resume.hpp"
#include "run_folder.hpp"
#include "summary.hpp"

namespace hamflow::app {

namespace {

int file_trouble(const RunOptions& options, const std::string& message) {
  std::cerr << "error: " << message << '\n';
  if (options.json) std::cout << json_text({{"status", "failed"}, {"error", {{"kind", "file"}, {"message", message}}}});
  return exit_file;
}

int rejected(const RunOptions& options, const std::vector<Complaint>& complaints) {
  for (const Complaint& complaint : complaints) std::cerr << complaint.text() << '\n';
  if (options.json) std::cout << json_text(rejection_of(complaints));
  return exit_rejected;
}

void draw_figures(const Scenario& scenario, const std::filesystem::path& folder) {
  if (scenario.figures.empty()) return;
  std::filesystem::create_directories(folder / "figures");
  for (const std::string& kind : scenario.figures) {
    for (const char* format : {".svg", ".pdf", ".png"}) draw_figure(folder, kind, folder / "figures" / (kind + format));
  }
}

/// Takes the steps that are left and tells what they came to.
RunResult take_steps(const Scenario& scenario, const RunOptions& options, Simulation& simulation, Recorder* recorder,
                     CheckpointWriter* checkpoints, EnergyBlocks& blocks, Measures& measures) {
  std::vector<Observer*> observers;
  if (recorder != nullptr)
    observers = {recorder, &blocks, checkpoints};  // in this order: samples of a step belong to it
  if (recorder == nullptr) observers = {&blocks};
  const std::vector<Observer*> measuring = measures.observers();
  observers.insert(observers.begin(), measuring.begin(), measuring.end());
  RunResult result;
  Progress progress(simulation.step(), scenario.steps, options.quiet);
  try {
    result.outcome = run(simulation, scenario.steps, observers, [&](std::int64_t step) {
      progress.show(step);
      if (recorder != nullptr) {
        recorder->flush_if_due();
        checkpoints->write_if_due();
      }
      return !interrupted();
    });
    if (recorder != nullptr) {
      if (const auto time = recorder->failed_at(simulation.step()); time && status_of(result.outcome) == "failed") {
        result.failure = "the partial step to the sample at t = " + *time + " failed";
      }
      recorder->finish(simulation);
      if (status_of(result.outcome) != "failed") checkpoints->write();
    }
  } catch (const FileError& error) {  // a full disk, say: what was computed is still told
    result.file_trouble = error.what();
  }
  if (result.outcome == Outcome::not_converged && result.failure.empty()) result.failure = simulation.failure();
  return result;
}

void say(const RunOptions& options, const std::string& note) {
  if (!options.quiet) std::cerr << "note: " << note << '\n';
}

/// What the run in the folder left to go on from, if it left anything.
std::optional<Checkpoint> checkpoint_in(const std::filesystem::path& folder, const RunOptions& options) {
  if (!options.resume || !std::filesystem::exists(folder)) return std::nullopt;
  if (std::filesystem::exists(folder / "checkpoint.bin")) return read_checkpoint(folder / "checkpoint.bin");
  say(options, "there is no checkpoint in " + folder.string() + ": the run starts from the beginning");
  return std::nullopt;
}

/// The scenario with the samples as they were spaced when the run began.
Scenario with_spacing_of(const Checkpoint& checkpoint, Scenario scenario, const RunOptions& options) {
  if (scenario.record_every != checkpoint.record_every && scenario.record.empty()) {
    scenario.record_every = checkpoint.record_every;
    say(options, fmt::format("samples stay {} steps apart, as when the run began", checkpoint.record_every));
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

int finish_at_once(const std::string& summary, const RunOptions& options) {
  say(options, "the run is complete: there is nothing to do");
  std::cout << (options.json ? summary : readable(nlohmann::ordered_json::parse(summary)));
  return exit_done;
}

int carry_out(const Scenario& asked, const RunOptions& options) {
  const bool writes = options.out != "none";
  for (const std::string& note : asked.notes) say(options, note);
  const std::filesystem::path folder = folder_of(asked, options.out);
  const std::optional<Checkpoint> from = checkpoint_in(folder, options);
  if (from) {
    if (const auto complaints = differences(asked, *from); !complaints.empty()) return rejected(options, complaints);
    if (const auto summary = finished_summary(asked, *from, folder)) return finish_at_once(*summary, options);
    if (const auto complaints = refused_resumption(asked); !complaints.empty()) return rejected(options, complaints);
  }
  const Scenario scenario = from ? with_spacing_of(*from, asked, options) : asked;
  const auto simulation = make_simulation(scenario.request);
  std::optional<FolderLock> lock;
  std::unique_ptr<Recorder> recorder;
  std::unique_ptr<CheckpointWriter> checkpoints;
  EnergyBlocks blocks;
  if (from) {
    restore(*simulation, *from);
    blocks.state() = from->energy_blocks;
  }
  if (writes) {
    if (!from) make_folder(folder, options.force || options.resume);
    lock.emplace(folder);
    recorder = std::make_unique<Recorder>(scenario, folder, from ? &*from : nullptr);
    std::filesystem::remove(folder / "summary.json");  // of a run that was interrupted
    checkpoints = std::make_unique<CheckpointWriter>(scenario, *simulation, *recorder, blocks, folder,
                                                     from ? from->wall_seconds : 0);
  }
  Measures measures(scenario, *simulation, recorder.get());
  catch_interrupts();
  const auto begin = std::chrono::steady_clock::now();
  RunResult result = take_steps(scenario, options, *simulation, recorder.get(), checkpoints.get(), blocks, measures);
  result.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() + (from ? from->wall_seconds : 0);
  result.steps_taken = simulation->step();
  result.measures = measures.summary();

  const RunCertificate certificate =
      certify(scenario.request, *scenario.problem, *simulation, blocks, result.steps_taken);
  const auto summary = summary_of(scenario, *simulation, result, &certificate);
  const bool failed = summary["status"] == "failed";
  std::string late_trouble;
  if (writes) {
    try {
      write_text(folder / "summary.json", json_text(summary));
      checkpoints.reset();
      recorder.reset();  // closes run.h5, from which the figures are drawn
      if (!failed) draw_figures(scenario, folder);
    } catch (const std::exception& error) {  // the run itself is done: say what it came to all the same
      late_trouble = error.what();
    }
  }
  std::cout << (options.json ? json_text(summary) : readable(summary));
  if (writes && !options.json && !options.quiet) {
    std::cout << fmt::format("{:<20}{}\n", "written to", folder.string());
    if (result.outcome == Outcome::stopped)
      std::cout << fmt::format("{:<20}the same command with --resume\n", "to go on");
  }
  if (failed) {
    std::cerr << "error: " << summary["error"]["message"].get<std::string>()
              << "\nhint: " << summary["error"]["hint"].get<std::string>() << '\n';
    if (writes) std::cerr << "what was computed is in " << folder.string() << '\n';
    if (!result.file_trouble.empty()) std::cerr << "the same command with --resume goes on from the last checkpoint\n";
    return result.file_trouble.empty() ? exit_failed : exit_file;
  }
  if (!late_trouble.empty()) {
    std::cerr << "error: " << late_trouble << '\n';
    return exit_file;
  }
  return result.outcome == Outcome::stopped ? exit_interrupted : exit_done;
}

/// What is wrong with the options together; empty if nothing is.
std::string contradiction(const RunOptions& options) {
  if (options.resume && options.force) return "found --resume with --force; allowed one of them";
  if (options.resume && options.out == "none") return "found --resume with --out none; allowed with a folder";
  return {};
}

}  // namespace

int run_scenario(const RunOptions& options) {
  if (const std::string why = contradiction(options); !why.empty()) {
    std::cerr << "error: " << why << '\n';
    if (options.json)
      std::cout << json_text({{"status", "rejected"}, {"errors", {{{"key", "--resume"}, {"message", why}}}}});
    return exit_rejected;
  }
  try {
    const Reading reading = read_scenario(options.scenario, options.sets);
    if (!reading.scenario) return rejected(options, reading.complaints);
    return carry_out(*reading.scenario, options);
  } catch (const FileError& error) {
    return file_trouble(options, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return file_trouble(options, error.what());
  }
}

}  // namespace hamflow::app
