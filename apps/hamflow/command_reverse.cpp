// hamflow reverse: tests time reversibility. It integrates forward and back, and compares the end with the start.
#include <iostream>
#include <optional>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "hamflow/workflow/reverse.hpp"
#include "progress.hpp"
#include "unused_keys.hpp"

namespace hamflow::app {

int reverse_command(const ReverseOptions& options) {
  KeptWork kept{.forced = options.force, .checkpoint = "reversal.bin"};
  const auto reverse = [&] {
    const bool writes = !options.out.empty() && options.out != "none";
    if (options.resume && !writes)
      throw Rejection("--resume",
                      "found --resume without a folder; allowed with --out DIR, the folder of the reversal");
    const Scenario scenario = accepted(read_scenario(options.scenario, options.sets));
    print_notes(scenario.notes, options.quiet);
    print_notes(unused_measures(scenario, "a reversal only compares the end with the start"), options.quiet);
    print_notes(unused_figures(scenario, "a reversal draws no figures; use --out DIR and hamflow plot"), options.quiet);
    ReversalSettings settings;
    if (writes) settings.folder = options.out;
    settings.existing = options.resume ? Existing::resume : options.force ? Existing::replace : Existing::refuse;
    settings.note = [&](const std::string& note) { print_notes({note}, options.quiet); };
    catch_interrupts();
    std::optional<Preparation> preparation(std::in_place, "setting up the reversal", options.json, options.quiet);
    Progress progress(0, 2 * scenario.steps, options.quiet);
    settings.pulse = [&](std::int64_t step) {
      if (step > 0) preparation.reset();
      progress.show(step);
      kept.folder = settings.folder;
      return !interrupted();
    };
    const ReversalReport report = reverse_scenario(scenario, settings);
    std::cout << (options.json ? report.json : report.text);
    print_warnings(report.warnings);
    if (report.status == "failed") print_error(report.message, report.hint);
    return exit_status(report.status);
  };
  return guarded(options.json, reverse, "", &kept);
}

}  // namespace hamflow::app
