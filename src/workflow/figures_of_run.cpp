#include "hamflow/workflow/figures_of_run.hpp"

#include <fmt/format.h>

#include "figure.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "run_file.hpp"

namespace hamflow {

namespace {

/// The scenario that a run.h5 carries.
Scenario scenario_of(const RunSamples& samples, const std::filesystem::path& file) {
  const std::string& text = samples.description.scenario;
  const Reading reading = read_scenario_text(text, file.string(), {});
  if (!reading.scenario)
    throw FileError("the scenario in " + file.string() + " is damaged: " + reading.complaints.front().text());
  return *reading.scenario;
}

}  // namespace

void draw_figure(const std::filesystem::path& run, const std::string& kind, const std::filesystem::path& file) {
  const std::filesystem::path source = std::filesystem::is_directory(run) ? run / "run.h5" : run;
  RunSamples samples = read_run_file(source);
  if (samples.t.empty()) throw FileError(source.string() + " holds no samples");
  const Scenario scenario = scenario_of(samples, source);
  const ProblemEntry& problem = *scenario.problem;
  const Texts& parameters = scenario.request.parameters;
  FigureData data;
  data.title = fmt::format("{}, {}, dt = {}", scenario.request.problem, describe(scenario.request.method).name,
                           scenario.request.dt);
  data.coordinates = problem.info.coordinates;
  data.t = std::move(samples.t);
  data.q = std::move(samples.q);
  data.p = std::move(samples.p);
  data.energy = std::move(samples.energy);
  data.energy_scale = make_simulation(scenario.request)->energy_scale();
  if (problem.exact_radius) {
    const auto radius = problem.exact_radius(parameters, scenario.start_q, scenario.start_p);
    if (radius) sample_polar_curve(radius, data);
  }
  data.diagnostics = std::move(samples.diagnostics);
  for (const InvariantInfo& invariant : problem.info.invariants) {
    if (problem.dimension > 0 || invariant.components != Components::space) continue;
    const auto sizes = problem.invariant_sizes(parameters, scenario.start_q.size());
    data.space = sizes[static_cast<std::size_t>(&invariant - problem.info.invariants.data())];
  }
  if (problem.dimension == 0 && data.space == 0) {  // a chain: q1, ..., qn
    data.coordinates.clear();
    for (std::size_t i = 1; i <= data.q.size(); ++i) data.coordinates.push_back("q" + std::to_string(i));
  }
  if (problem.dimension == 1) {
    data.hamiltonian_1d = [&problem, &parameters](double q, double p) { return problem.energy(parameters, {q}, {p}); };
  }
  if (scenario.section && samples.description.section && data.q.size() >= 2) {
    const Section& section = *scenario.section;
    const std::size_t shown = (section.coordinate + 1) % data.q.size();
    data.section_q = std::move(samples.section_q[shown]);
    data.section_p = std::move(samples.section_p[shown]);
    data.section_coordinate = data.coordinates.size() == data.q.size() ? data.coordinates[shown] : "q";
  }
  write_figure(data, !kind.empty() ? kind : usual_figure(facts_of(data)), file);
}

void draw_figures(const Scenario& scenario, const std::filesystem::path& folder) {
  if (scenario.figures.empty()) return;
  std::filesystem::create_directories(folder / "figures");
  for (const std::string& kind : scenario.figures) {
    for (const char* format : {".svg", ".pdf", ".png"}) draw_figure(folder, kind, folder / "figures" / (kind + format));
  }
}

}  // namespace hamflow
