// hamflow reverse: forward, negate the momenta, forward again, negate: what came back.
#include <iostream>
#include <optional>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "hamflow/workflow/reverse.hpp"
#include "progress.hpp"

namespace hamflow::app {

namespace {

ReversalReport carry_out(const Scenario& scenario, const ReverseOptions& options) {
  catch_interrupts();
  Progress progress(0, 2 * scenario.steps, options.quiet);
  return reverse_scenario(scenario, [&](std::int64_t step) {
    progress.show(step);
    return !interrupted();
  });
}

}  // namespace

int reverse_command(const ReverseOptions& options) {
  return guarded(options.json, [&] {
    const Scenario scenario = accepted(read_scenario(options.scenario, options.sets));
    print_notes(scenario.notes, options.quiet);
    note_unused_measures(scenario, "a reversal takes every step and asks what came back", options.quiet);
    std::optional<ReversalFolder> folder;
    if (!options.out.empty() && options.out != "none") folder.emplace(options.out, options.force);
    const ReversalReport report = carry_out(scenario, options);
    if (folder) folder->keep(scenario, report);
    std::cout << (options.json ? report.json : report.text);
    if (report.status == "failed") print_error(report.message, report.hint);
    return exit_status(report.status);
  });
}

}  // namespace hamflow::app
