// hamflow sweep: runs a scenario for many values of its keys and writes a table with one row for each member.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <optional>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/workflow/sweep.hpp"
#include "progress.hpp"

namespace hamflow::app {

namespace {

namespace fs = std::filesystem;

fs::path folder_for(const SweepCommandOptions& options) {
  if (!options.merge.empty()) return options.merge;
  if (!options.out.empty()) return options.out;
  return fs::path(options.scenario).stem().string() + ".sweep";
}

/// Refuses options that exclude each other, and a sweep without a scenario.
void check_together(const SweepCommandOptions& options) {
  if (!options.merge.empty()) {
    const std::pair<const char*, bool> others[] = {{"a scenario", !options.scenario.empty()},
                                                   {"--vary", !options.varied.empty()},
                                                   {"--set", !options.sets.empty()},
                                                   {"--zip", options.zip},
                                                   {"--out", !options.out.empty()},
                                                   {"--shard", !options.shard.empty()},
                                                   {"--resume", options.resume},
                                                   {"--force", options.force}};
    for (const auto& [name, is_given] : others) {
      if (!is_given) continue;
      throw Rejection("--merge",
                      fmt::format("found --merge with {}; allowed --merge DIR alone, since the shards in DIR "
                                  "store their scenario",
                                  name));
    }
    return;
  }
  if (options.scenario.empty()) throw Rejection("scenario", "missing; allowed a TOML file, or --merge DIR");
  if (!options.shard.empty() && options.out == "none")
    throw Rejection("--shard", "found --shard with --out none; allowed with a folder, which --merge reads");
  if (!options.shard.empty() && !options.figure.empty())
    throw Rejection("--figure", "found --figure with --shard; allowed with --merge DIR, when the shards are finished");
  if (options.resume && options.force) throw Rejection("--resume", "found --resume with --force; allowed one of them");
  if (options.resume && options.out == "none")
    throw Rejection("--resume", "found --resume with --out none; allowed with a folder");
}

void open_folder(ScenarioSweep& sweep, const SweepCommandOptions& options) {
  const std::size_t printed = sweep.notes().size();
  const bool resumes = options.resume || !options.merge.empty();
  const Existing existing = resumes ? Existing::resume : options.force ? Existing::replace : Existing::refuse;
  const std::vector<Complaint> wrong = sweep.keep_in(folder_for(options), existing);
  if (!wrong.empty()) throw Rejection(wrong);
  print_notes({sweep.notes().begin() + static_cast<std::ptrdiff_t>(printed), sweep.notes().end()}, options.quiet);
}

SweepReport carry_out(ScenarioSweep& sweep, const SweepCommandOptions& options,
                      std::optional<Preparation>& preparation) {
  Progress progress(sweep.steps_before(), sweep.total_steps(), options.quiet);
  return sweep.run([&](std::int64_t steps) {
    if (steps > sweep.steps_before()) preparation.reset();
    progress.show(steps);
    return !interrupted();
  });
}

void print(const ScenarioSweep& sweep, const SweepReport& report, bool writes, const SweepCommandOptions& options) {
  std::cout << (!options.json ? report.text : writes ? report.json : sweep.json_with_rows(report));
  if (writes && !options.json && !options.quiet) {
    std::cout << fmt::format("{:<20}{}\n", "written to", folder_for(options).string());
    if (report.status == "interrupted" && options.merge.empty())
      std::cout << fmt::format("{:<20}the same command with --resume\n", "to continue");
  }
  print_warnings(report.warnings);
  std::vector<std::string> notes = report.failures;
  if (!report.hint.empty()) notes.push_back("hint: " + report.hint);
  if (report.status != "failed") return print_notes(notes, options.quiet);
  for (const std::string& failure : report.failures)
    print_error(failure, &failure == &report.failures.back() ? report.hint : "");
}

void print_missing(const ScenarioSweep& sweep, const SweepCommandOptions& options) {
  const std::vector<std::string> missing = sweep.missing_shards();
  if (missing.empty()) return;
  print_notes({"members are missing from the shards " + joined(missing) +
               "; run these shards with --resume, or all missing members with --resume and without --shard"},
              options.quiet);
}

SweepRequest request_of(const SweepCommandOptions& options) {
  return {.text = scenario_text(options.scenario),
          .name = options.scenario,
          .sets = options.sets,
          .varied = options.varied,
          .zip = options.zip,
          .threads = options.threads,
          .lanes = options.lanes,
          .shard = options.shard.empty() ? SweepShard() : shard_named(options.shard)};
}

/// Refuses options of a figure, because no figure was asked for.
void refuse_colour(const std::string& colour, bool mean) {
  if (mean) throw Rejection("--mean", "found --mean without --figure; allowed with --figure FILE");
  if (!colour.empty()) throw Rejection("--colour", "found " + colour + " without --figure; allowed with --figure FILE");
}

}  // namespace

int sweep_command(const SweepCommandOptions& options) {
  KeptWork kept{.forced = options.force};
  const auto run = [&] {
    check_together(options);
    catch_interrupts();
    std::optional<Preparation> preparation(std::in_place, "setting up the sweep", options.json, options.quiet);
    const bool merges = !options.merge.empty();
    ScenarioSweep sweep(merges ? stored_sweep(options.merge) : request_of(options));
    if (!merges) print_notes(sweep.notes(), options.quiet);
    if (!sweep.complaints().empty()) throw Rejection(sweep.complaints());
    const bool draws = !options.figure.empty();
    if (draws) {
      sweep.check_figure(options.figure, options.colour, options.mean);
    } else {
      refuse_colour(options.colour, options.mean);
    }
    require_folder_of(options.figure);
    const bool writes = options.out != "none";
    if (writes) {
      open_folder(sweep, options);
      kept.folder = folder_for(options);
    }
    const SweepReport report = merges ? sweep.report() : carry_out(sweep, options, preparation);
    preparation.reset();
    print(sweep, report, writes, options);
    if (merges) print_missing(sweep, options);
    // To merge what there is succeeds, also while shards are missing.
    const int status = merges && report.status == "interrupted" ? exit_done : exit_status(report.status);
    if (!draws || report.status == "failed") return status;
    const int drawn = write_after_report([&] { sweep.draw(options.figure, options.colour, options.mean); });
    return drawn != exit_done ? drawn : status;
  };
  return guarded(options.json, run, "", &kept);
}

}  // namespace hamflow::app
