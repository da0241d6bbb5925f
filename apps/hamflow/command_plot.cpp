// hamflow plot: draws a figure of finished, running or interrupted runs.
#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_info.hpp"
#include "hamflow/workflow/figures_of_run.hpp"
#include "progress.hpp"

namespace hamflow::app {

namespace {

std::vector<double> times_of(const std::string& texts) {
  std::vector<double> times;
  if (texts.empty()) return times;
  for (const std::string& text : split_list(texts)) {
    if (const std::string wrong = refused_value({.name = "--at"}, text); !wrong.empty()) throw Rejection("--at", wrong);
    times.push_back(number_value(text));
  }
  return times;
}

}  // namespace

int plot_command(const PlotOptions& options) {
  return guarded(false, [&] {
    catch_interrupts();
    draw_figure({.runs = {options.runs.begin(), options.runs.end()},
                 .kind = options.kind,
                 .file = options.file,
                 .x = options.x,
                 .y = options.y.empty() ? std::vector<std::string>{} : split_list(options.y),
                 .at = times_of(options.at),
                 .size = options.size,
                 .dpi = options.dpi,
                 .title = !options.no_title,
                 .note = [](const std::string& note) { print_notes({note}, false); }});
    return exit_done;
  });
}

}  // namespace hamflow::app
