// hamflow plot: a figure of runs, finished, running or cut short.
#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/workflow/figures_of_run.hpp"
#include "progress.hpp"

namespace hamflow::app {

int plot_command(const PlotOptions& options) {
  return guarded(false, [&] {
    catch_interrupts();
    draw_figure({.runs = {options.runs.begin(), options.runs.end()},
                 .kind = options.kind,
                 .file = options.file,
                 .x = options.x,
                 .y = options.y.empty() ? std::vector<std::string>{} : split_list(options.y),
                 .size = options.size,
                 .dpi = options.dpi,
                 .title = !options.no_title});
    return exit_done;
  });
}

}  // namespace hamflow::app
