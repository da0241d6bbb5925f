// hamflow run: runs a scenario, writes its folder and prints the summary.
#include <fmt/format.h>

#include <iostream>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/workflow/run.hpp"
#include "progress.hpp"
#include "resumed_scenario.hpp"

namespace hamflow::app {

namespace {

/// Refuses options that exclude each other.
void check_together(const RunOptions& options) {
  if (options.resume && options.force) throw Rejection("--resume", "found --resume with --force; allowed one of them");
  if (options.resume && options.out == "none")
    throw Rejection("--resume", "found --resume with --out none; allowed with a folder");
}

RunReport carry_out(const Scenario& scenario, const RunOptions& options, KeptWork& kept) {
  RunSettings settings;
  if (options.out != "none") settings.folder = folder_of(scenario, options.out);
  settings.samples = false;  // they are written to the folder and not kept in memory
  settings.existing = options.resume ? Existing::resume : options.force ? Existing::replace : Existing::refuse;
  settings.note = [&](const std::string& note) { print_notes({note}, options.quiet); };
  std::optional<Progress> progress;  // made at the first pulse: a resumed run starts at a later step
  std::optional<Preparation> preparation;
  settings.pulse = [&](std::int64_t step) {
    if (step > 0) preparation.reset();
    if (!progress) progress.emplace(step, scenario.steps, options.quiet);
    progress->show(step);
    kept.folder = settings.folder;
    return !interrupted();
  };
  catch_interrupts();
  preparation.emplace("setting up the run", options.json, options.quiet);
  return run(scenario, settings);
}

int print(const RunReport& report, const std::string& folder, const RunOptions& options) {
  std::cout << (options.json ? report.json : report.text);
  print_warnings(report.warnings);
  if (report.was_complete && report.file_error.empty()) return exit_done;
  if (!folder.empty() && !options.json && !options.quiet) {
    std::cout << fmt::format("{:<20}{}\n", "written to", folder);
    if (report.status == "interrupted")
      std::cout << fmt::format("{:<20}the same command with --resume\n", "to continue");
  }
  const bool failed = report.status == "failed";
  if (failed) {
    print_error(report.message, report.hint, report.details);
    if (!folder.empty()) std::cerr << "the results up to the failure are in " << folder << '\n';
    if (!report.file_error.empty())
      std::cerr << "to continue from the last checkpoint, give the same command with --resume\n";
  } else if (!report.file_error.empty()) {
    print_error(report.file_error);
  }
  if (report.drawing_stopped) return exit_interrupted;
  return report.file_error.empty() ? exit_status(report.status) : exit_file;
}

}  // namespace

int run_command(const RunOptions& options) {
  KeptWork kept{.forced = options.force, .checkpoint = "checkpoint.bin"};
  const auto run = [&] {
    check_together(options);
    const Scenario scenario =
        accepted(options.resume ? read_resumed_scenario(options.scenario, options.sets, options.out)
                                : read_scenario(options.scenario, options.sets));
    print_notes(scenario.notes, options.quiet);
    const RunReport report = carry_out(scenario, options, kept);
    return print(report, options.out == "none" ? "" : folder_of(scenario, options.out).string(), options);
  };
  return guarded(options.json, run, "", &kept);
}

}  // namespace hamflow::app
