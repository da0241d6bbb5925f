// hamflow compare: measures error and cost of several methods with several step sizes on one scenario.
#include <fmt/format.h>

#include <iostream>
#include <optional>

#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/scenario/rejection.hpp"
#include "hamflow/workflow/compare.hpp"
#include "progress.hpp"

namespace hamflow::app {

namespace {

ComparisonReport carry_out(const ComparisonRequest& request, const CompareOptions& options) {
  catch_interrupts();
  std::optional<Preparation> preparation(std::in_place, "the reference solution", options.json, options.quiet);
  Progress progress(0, 0, options.quiet);
  return compare_methods(request, [&](const ComparisonProgress& now) {
    if (now.done > 0) preparation.reset();
    progress.show(now.part, now.seconds_left, fmt::format("{} of {} runs", now.done, now.runs));
    return !interrupted();
  });
}

int compare(const CompareOptions& options) {
  ComparisonReading reading =
      read_comparison({.text = scenario_text(options.scenario),
                       .name = options.scenario,
                       .sets = options.sets,
                       .methods = split_list(options.methods),
                       .dts = options.dts.empty() ? std::vector<std::string>() : split_list(options.dts)});
  if (!options.figure.empty()) {
    const std::string why_not = refused_comparison_figure(options.figure);
    if (!why_not.empty()) reading.complaints.push_back({"", 0, 0, "--figure", why_not});
  }
  if (!reading.complaints.empty()) throw Rejection(reading.complaints);
  print_notes(reading.notes, options.quiet);
  require_folder_of(options.figure);
  require_folder_of(options.csv);
  const bool writes = !options.out.empty() && options.out != "none";
  std::optional<WorkFolder> folder;
  if (writes) {
    folder.emplace(options.out, comparison_folder(), options.force ? Existing::replace : Existing::refuse);
    folder->prepare();
  }
  const ComparisonReport report = carry_out(reading.request, options);
  std::cout << (options.json ? report.json : report.text);
  print_warnings(report.warnings);
  if (report.status == "failed") print_error(report.message, report.hint);
  const int written = write_after_report([&] {
    if (!options.csv.empty()) write_file(options.csv, report.csv);
    if (folder) write_comparison(report, *folder);
    if (report.status == "done" && !options.figure.empty()) draw_comparison(report.comparison, options.figure);
  });
  if (written != exit_done) return written;
  if (report.status != "failed" && writes && !options.json && !options.quiet) {
    std::cout << fmt::format("\nwritten to {}\n", options.out);
  }
  return exit_status(report.status);
}

}  // namespace

int compare_command(const CompareOptions& options) {
  return guarded(
      options.json, [&] { return compare(options); }, "comparison");
}

}  // namespace hamflow::app
