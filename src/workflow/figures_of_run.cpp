#include "hamflow/workflow/figures_of_run.hpp"

#include <algorithm>

#include "figure.hpp"
#include "figure_data.hpp"
#include "page_size.hpp"
#include "terminal.hpp"

namespace hamflow {

namespace {

/// Checks the options that can be checked before a run is read.
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

/// Returns whether the kind draws a path. Then all of the first steps are drawn, because samples may be far apart.
bool draws_path(const std::string& kind) { return kind == "orbit" || kind == "phase"; }

}  // namespace

void draw_figure(const FigureRequest& request) {
  Figure figure{{}, options_of(request)};
  std::vector<RunForFigure> runs;
  for (const std::filesystem::path& run : request.runs) runs.push_back(read_for_figure(run, {request.kind}));
  for (std::size_t i = 0; request.note && i < runs.size(); ++i) {
    for (const std::string& note : runs[i].notes) request.note(request.runs[i].string() + ": " + note);
  }
  set_titles_and_labels(runs);
  const std::string kind = !request.kind.empty() ? request.kind : usual_figure(facts_of(runs.at(0).data));
  for (RunForFigure& run : runs) {
    if (draws_path(kind)) run.data.first_steps = first_steps_of(run);
    add_start(run, figure.options.at);
    figure.runs.push_back(std::move(run.data));
  }
  write_figure(figure, kind, request.file);
  for (const std::string& note : notes_on_times(figure)) {
    if (request.note) request.note(note);
  }
}

figures::Page figure_page(const Scenario& scenario, const RunTables& tables, const FigureRequest& request) {
  Figure figure{{}, {.x = request.x, .y = request.y, .at = request.at}};
  const std::vector<std::string> kinds =
      request.kind.empty() ? std::vector<std::string>() : std::vector<std::string>{request.kind};
  std::vector<RunForFigure> runs;
  runs.push_back(for_figure(scenario, tables, "run", kinds));
  set_titles_and_labels(runs);
  const std::string kind = !request.kind.empty() ? request.kind : usual_figure(facts_of(runs[0].data));
  if (draws_path(kind)) runs[0].data.first_steps = first_steps_of(runs[0]);
  add_start(runs[0], figure.options.at);
  figure.runs.push_back(std::move(runs[0].data));
  return page_of(figure, kind);
}

void draw_figure(const std::filesystem::path& run, const std::string& kind, const std::filesystem::path& file) {
  draw_figure({.runs = {run}, .kind = kind, .file = file});
}

std::vector<std::string> draw_figures(const Scenario& scenario, const std::filesystem::path& folder,
                                      const RunTables* tables) {
  std::vector<std::string> missing;
  if (scenario.figures.empty()) return missing;
  std::filesystem::create_directories(folder / "figures");
  std::vector<RunForFigure> run;
  run.push_back(tables != nullptr ? for_figure(scenario, *tables, folder, scenario.figures)
                                  : read_for_figure(folder, scenario.figures));
  set_titles_and_labels(run);
  const bool has_path = std::any_of(scenario.figures.begin(), scenario.figures.end(), draws_path);
  const FigureSamples first_steps = has_path ? first_steps_of(run[0]) : FigureSamples{};
  Figure figure{{std::move(run[0].data)}};
  std::vector<figures::Drawing> drawings;
  for (const std::string& kind : scenario.figures) {
    try {
      figure.runs[0].first_steps = draws_path(kind) ? first_steps : FigureSamples{};
      figures::Drawing& drawing = drawings.emplace_back(figures::Drawing{page_of(figure, kind), {}});
      for (const char* format : {".svg", ".pdf", ".png"}) {
        const std::filesystem::path& file = drawing.files.emplace_back(folder / "figures" / (kind + format));
        // A symbolic link in the folder of a run is replaced; its target is kept.
        std::error_code none;
        if (std::filesystem::is_symlink(file, none)) std::filesystem::remove(file, none);
      }
    } catch (const Error& error) {  // the run is complete, and the other figures can be drawn
      missing.push_back("the figure " + kind + " was not drawn: " + std::string(error.what()));
    }
  }
  figures::draw(drawings);
  return missing;
}

}  // namespace hamflow
