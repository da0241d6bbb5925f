// hamflow plot: a figure of a run, finished, running or cut short.
#include <iostream>

#include "commands.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/workflow/figures_of_run.hpp"

namespace hamflow::app {

int plot_run(const PlotOptions& options) {
  try {
    draw_figure(options.run, options.kind, options.file);
    return exit_done;
  } catch (const FileError& error) {
    std::cerr << "error: " << error.what() << '\n';
    return exit_file;
  } catch (const Error& error) {
    std::cerr << "error: " << error.what() << '\n';
    return exit_rejected;
  }
}

}  // namespace hamflow::app
