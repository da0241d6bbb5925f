#include "hamflow/workflow/figures_of_run.hpp"

#include "figure.hpp"
#include "figure_data.hpp"
#include "page_size.hpp"

namespace hamflow {

namespace {

/// Options that no run has to be read for.
FigureOptions options_of(const FigureRequest& request) {
  FigureOptions options{
      .x = request.x, .y = request.y, .at = request.at, .page = {.dpi = request.dpi, .title = request.title}};
  std::string wrong = request.size.empty() ? "" : read_page_size(request.size, options.page);
  if (wrong.empty()) wrong = refused_figure_file(request.file);
  if (wrong.empty()) wrong = refused_dpi(request.dpi, request.file, options.page);
  if (!wrong.empty()) throw Error(wrong);
  return options;
}

}  // namespace

namespace {

/// The same figure in several files: a run of many particles is read once.
void draw_into(const FigureRequest& request, const std::vector<std::filesystem::path>& files) {
  Figure figure{{}, options_of(request)};
  std::vector<RunForFigure> runs;
  for (const std::filesystem::path& run : request.runs) runs.push_back(read_for_figure(run, request.kind));
  for (std::size_t i = 0; request.note && i < runs.size(); ++i) {
    for (const std::string& note : runs[i].notes) request.note(request.runs[i].string() + ": " + note);
  }
  tell_apart(runs);
  for (RunForFigure& run : runs) add_start(run, figure.options.at);
  for (RunForFigure& run : runs) figure.runs.push_back(std::move(run.data));
  const std::string kind = !request.kind.empty() ? request.kind : usual_figure(facts_of(figure.runs.at(0)));
  for (std::size_t i = 0; i < request.runs.size(); ++i) {
    if (kind == "orbit" || kind == "phase") figure.runs[i].opening = opening_of(request.runs[i]);
  }
  write_figure(figure, kind, files);
  for (const std::string& note : notes_on_times(figure)) {
    if (request.note) request.note(note);
  }
}

}  // namespace

void draw_figure(const FigureRequest& request) { draw_into(request, {request.file}); }

void draw_figure(const std::filesystem::path& run, const std::string& kind, const std::filesystem::path& file) {
  draw_figure({.runs = {run}, .kind = kind, .file = file});
}

std::vector<std::string> draw_figures(const Scenario& scenario, const std::filesystem::path& folder) {
  std::vector<std::string> missing;
  if (!scenario.figures.empty()) std::filesystem::create_directories(folder / "figures");
  for (const std::string& kind : scenario.figures) {
    std::vector<std::filesystem::path> files;
    for (const char* format : {".svg", ".pdf", ".png"}) files.push_back(folder / "figures" / (kind + format));
    try {
      // In the folder of a run a link is replaced, and what it leads to stays.
      for (const std::filesystem::path& file : files) {
        std::error_code none;
        if (std::filesystem::is_symlink(file, none)) std::filesystem::remove(file, none);
      }
      draw_into({.runs = {folder}, .kind = kind, .file = files.front()}, files);
    } catch (const Error& error) {  // the run is done all the same, and so are the others
      missing.push_back("a figure is not drawn: " + std::string(error.what()));
    }
  }
  return missing;
}

}  // namespace hamflow
