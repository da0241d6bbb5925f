// hamflow run: a scenario becomes a simulation, the simulation samples, the samples a folder and a summary.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <iostream>

#include "commands.hpp"
#include "csv_file.hpp"
#include "figures_of_run.hpp"
#include "progress.hpp"
#include "run_file.hpp"
#include "run_folder.hpp"
#include "summary.hpp"

namespace hamflow::app {

namespace {

/// Keeps the start, every n-th step and the last one.
class Recorder final : public Observer {
 public:
  Recorder(const Scenario& scenario, const std::filesystem::path& folder) : scenario_(scenario) {
    const auto wants = [&](const char* format) {
      return std::find(scenario.formats.begin(), scenario.formats.end(), format) != scenario.formats.end();
    };
    const std::vector<InvariantInfo>& declared = scenario.problem->info.invariants;
    const std::vector<std::size_t> sizes =
        scenario.problem->invariant_sizes(scenario.request.parameters, scenario.start_q.size());
    std::vector<std::pair<std::string, std::size_t>> invariants;
    for (std::size_t i = 0; i < declared.size(); ++i) invariants.emplace_back(declared[i].name, sizes[i]);
    if (wants("h5")) {
      char host[256] = "";
      (void)gethostname(host, sizeof host - 1);
      h5_ = std::make_unique<RunFile>(
          folder / "run.h5",
          RunDescription{.scenario = scenario.text,
                         .version = HAMFLOW_VERSION,
                         .host = host,
                         .problem = scenario.request.problem,
                         .method = describe(scenario.request.method).name,
                         .arithmetic = scenario.request.arithmetic,
                         .kernel = scenario.request.kernel,
                         .dimension = scenario.start_q.size(),
                         .invariants = invariants,
                         .diagnostics = scenario.request.method.cg.diagnostics,
                         .samples = static_cast<std::size_t>(sample_count(scenario.steps, scenario.record_every))});
    }
    if (wants("csv"))
      csv_ = std::make_unique<CsvFile>(folder / "trajectory.csv", scenario.start_q.size(), invariants);
  }

  std::int64_t next_due(std::int64_t step) const override {
    const std::int64_t every = scenario_.record_every;
    const std::int64_t next = step % every == 0 ? step : step + (every - step % every);
    return step <= scenario_.steps ? std::min(next, scenario_.steps) : never;
  }
  Verdict observe(const Frame& frame) override {
    if (h5_) h5_->append(frame);
    if (csv_) csv_->append(frame);
    last_ = frame.step;
    return Verdict::go_on;
  }
  /// The state in which a run ended early is a sample too.
  void finish(const Simulation& simulation) {
    if (last_ != simulation.step()) {
      Frame frame;
      simulation.look(frame);
      (void)observe(frame);
    }
    if (h5_) h5_->flush();
    if (csv_) csv_->flush();
  }
  void flush_if_due() {
    if (h5_) h5_->flush_if_due();
  }

 private:
  const Scenario& scenario_;
  std::unique_ptr<RunFile> h5_;
  std::unique_ptr<CsvFile> csv_;
  std::int64_t last_ = -1;
};

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

int carry_out(const Scenario& scenario, const RunOptions& options) {
  const bool writes = options.out != "none";
  if (!options.quiet) {
    for (const std::string& note : scenario.notes) std::cerr << "note: " << note << '\n';
  }
  const std::filesystem::path folder = folder_of(scenario, options.out);
  std::unique_ptr<Recorder> recorder;
  if (writes) {
    make_folder(folder, options.force);
    recorder = std::make_unique<Recorder>(scenario, folder);
  }
  const auto simulation = make_simulation(scenario.request);
  std::vector<Observer*> observers;
  if (recorder) observers.push_back(recorder.get());

  RunResult result;
  catch_interrupts();
  const auto begin = std::chrono::steady_clock::now();
  {
    Progress progress(scenario.steps, options.quiet);
    try {
      result.outcome = run(*simulation, scenario.steps, observers, [&](std::int64_t step) {
        progress.show(step);
        if (recorder) recorder->flush_if_due();
        return !interrupted();
      });
    } catch (const FileError& error) {  // a full disk, say: what was computed is still told
      result.file_trouble = error.what();
    }
  }
  result.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  result.steps_taken = simulation->step();
  if (result.outcome == Outcome::not_converged) result.failure = simulation->failure();
  try {
    if (recorder && result.file_trouble.empty()) recorder->finish(*simulation);
  } catch (const FileError& error) {
    result.file_trouble = error.what();
  }

  const auto summary = summary_of(scenario, *simulation, result);
  const bool failed = summary["status"] == "failed";
  std::string late_trouble;
  if (writes) {
    try {
      write_text(folder / "summary.json", json_text(summary));
      recorder.reset();  // closes run.h5, from which the figures are drawn
      if (!failed) draw_figures(scenario, folder);
    } catch (const std::exception& error) {  // the run itself is done: say what it came to all the same
      late_trouble = error.what();
    }
  }
  std::cout << (options.json ? json_text(summary) : readable(summary));
  if (writes && !options.json && !options.quiet) std::cout << fmt::format("{:<20}{}\n", "written to", folder.string());
  if (failed) {
    std::cerr << "error: " << summary["error"]["message"].get<std::string>()
              << "\nhint: " << summary["error"]["hint"].get<std::string>() << '\n';
    if (writes) std::cerr << "what was computed is in " << folder.string() << '\n';
    return result.file_trouble.empty() ? exit_failed : exit_file;
  }
  if (!late_trouble.empty()) {
    std::cerr << "error: " << late_trouble << '\n';
    return exit_file;
  }
  return result.outcome == Outcome::stopped ? exit_interrupted : exit_done;
}

}  // namespace

int run_scenario(const RunOptions& options) {
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
