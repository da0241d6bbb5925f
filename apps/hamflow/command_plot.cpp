// hamflow plot: a figure of a run, finished, running or cut short.
#include "commands.hpp"
#include "guarded.hpp"
#include "hamflow/workflow/figures_of_run.hpp"
#include "progress.hpp"

namespace hamflow::app {

int plot_command(const PlotOptions& options) {
  return guarded(false, [&] {
    catch_interrupts();
    draw_figure(options.run, options.kind, options.file);
    return exit_done;
  });
}

}  // namespace hamflow::app
