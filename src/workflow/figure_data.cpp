#include "figure_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include "gas/container.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/detail/run/digits.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/run/state_names.hpp"
#include "hamflow/run/walls.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "run_description.hpp"
#include "run_file.hpp"
#include "run_keys.hpp"
#include "section_text.hpp"
#include "text.hpp"

namespace hamflow {

namespace {

namespace fs = std::filesystem;

std::string sweep_draws_it() { return "of a sweep: " + command_name("sweep --figure") + " draws it"; }

/// Describes a folder that has no samples to draw; empty if its files do not show what it is.
std::string described_folder(const fs::path& folder) {
  std::error_code none;
  const auto has = [&](const char* name) { return fs::exists(folder / name, none); };
  if (has("sweep.h5") || has("members.bin")) return "the folder " + sweep_draws_it();
  if (has("compare.json")) {
    const fs::path figure = folder / "figures" / "work-precision.svg";
    return "the folder of a comparison" +
           (fs::exists(figure, none) ? "; its figures are " + figure.string() + ", .pdf and .png" : std::string());
  }
  if (has("reversal.bin")) {
    return "an interrupted reversal; continue it with hamflow reverse FILE --out " + folder.string() + " --resume";
  }
  if (has("trajectory.csv") || has("summary.json")) {
    return "a run without run.h5, which figures need; run it with " + output_path(output_keys().formats) +
           " = [\"h5\", ...]";
  }
  return {};
}

/// Returns the dimension of the space of bodies, or of one body with the coordinates x, y, z; otherwise 0.
std::size_t space_of(const Scenario& scenario, std::size_t size) {
  const ProblemEntry& problem = *scenario.problem;
  const Texts& parameters = scenario.request.parameters;
  if (problem.particles) return problem.particles(parameters).space;
  if (problem.info.coordinates == std::vector<std::string>{"x", "y", "z"}) return 3;
  const std::vector<InvariantInfo>& invariants = problem.info.invariants;
  for (std::size_t i = 0; problem.dimension == 0 && i < invariants.size(); ++i) {
    if (invariants[i].components == Components::space) return problem.invariant_sizes(parameters, size).at(i);
  }
  return 0;
}

/// Returns H - H0 computed with all digits, for arithmetic with more digits than double; else empty.
std::vector<double> energy_differences(const Table& samples) {
  const Column* const energy = samples.find("digits/energy");
  if (energy == nullptr) return {};
  std::vector<double> differences;
  for (const long double difference : differences_from_first(energy->texts())) {
    differences.push_back(static_cast<double>(difference));
  }
  return differences;
}

/// Returns the values of a column; empty if there is no such column.
std::vector<double> values_of(const Table& table, const char* name) {
  const Column* const column = table.find(name);
  return column == nullptr ? std::vector<double>() : column->part(0);
}
/// Returns each coordinate of a column of states; empty if there is no such column.
std::vector<std::vector<double>> by_coordinate(const Table& table, const char* name) {
  std::vector<std::vector<double>> all;
  const Column* const column = table.find(name);
  for (std::size_t i = 0; column != nullptr && i < column->info().width; ++i) all.push_back(column->part(i));
  return all;
}
/// Returns the columns of a group: NAME, or NAME_1, NAME_2, ... if a row has several numbers.
std::vector<std::pair<std::string, std::vector<double>>> columns_in(const Table& table, const std::string& group) {
  std::vector<std::pair<std::string, std::vector<double>>> all;
  for (const Column& column : table.columns()) {
    if (!column.name().starts_with(group) || column.info().type != ValueType::number) continue;
    const std::string name = column.name().substr(group.size());
    for (std::size_t i = 0; i < column.info().width; ++i) {
      all.emplace_back(column.info().width == 1 ? name : name + "_" + std::to_string(i + 1), column.part(i));
    }
  }
  return all;
}

void add_section(const Section& section, const StateNames& names, const Table& points, FigureData& data) {
  const std::size_t shown = coordinate_shown(section, data.q.size());
  data.section_q = points["q"].part(shown);
  data.section_p = points["p"].part(shown);
  data.section_coordinate = data.coordinates[shown];
  data.section_momentum = data.momenta[shown];
  data.section_text = section_text(section, names);
}

/// Returns the samples and the bounces, in the order of their times; empty if bounces are not located.
FigureSamples path_of(const Scenario& scenario, const FigureSamples& samples, const Table& bounces) {
  const auto& walls = scenario.request.walls;
  if (!walls || walls->rule != WallRule::event || bounces.rows() == 0) return {};
  const std::span<const double> met = bounces["t"].numbers();
  const std::vector<std::vector<double>> met_q = by_coordinate(bounces, "q");
  const std::size_t n = samples.q.size();
  const double forward = samples.t.back() < samples.t.front() ? -1 : 1;
  FigureSamples path;
  path.q.resize(n);
  const auto add = [&](double t, const std::vector<std::vector<double>>& q, std::size_t k) {
    path.t.push_back(t);
    for (std::size_t i = 0; i < n; ++i) path.q[i].push_back(q[i][k]);
  };
  std::size_t bounce = 0;
  for (std::size_t k = 0; k < samples.t.size(); ++k) {
    for (; bounce < met.size() && forward * met[bounce] < forward * samples.t[k]; ++bounce) {
      add(met[bounce], met_q, bounce);
    }
    add(samples.t[k], samples.q, k);
  }
  return path;
}

std::vector<std::pair<std::string, std::string>> facts_of(const Scenario& scenario) {
  const Request& request = scenario.request;
  std::vector<std::pair<std::string, std::string>> facts{{"problem", problem_text(scenario)}};
  if (const auto walls = request.walls) {
    facts.emplace_back("walls", wall_rules()[static_cast<std::size_t>(walls->rule)]);
  }
  for (const auto& [key, value] : request.variant) {
    // the choices of a typed problem are long formulas
    if (!scenario.problem->structure) facts.emplace_back(key, value);
  }
  const std::vector<std::string> changes = changes_during_run(scenario.text);  // a setting that changed is left out
  const auto sets_length = [](const std::string& change) { return change.starts_with(run_keys().dt.name + " = "); };
  const auto negates = [](const std::string& change) { return change == momenta_negated; };
  const auto is_of_method = [&](const std::string& change) { return !sets_length(change) && !negates(change); };
  if (std::none_of(changes.begin(), changes.end(), is_of_method))
    facts.emplace_back("method", describe(request.method).name);
  if (std::none_of(changes.begin(), changes.end(), sets_length)) facts.emplace_back("dt", request.dt);
  facts.emplace_back("arithmetic", request.arithmetic);
  for (const auto& [key, value] : request.parameters) facts.emplace_back(key, value);
  return facts;
}

/// Returns a text such as "stv4", "dt = 0.1" or "mass = 2".
std::string fact_text(const std::pair<std::string, std::string>& fact) {
  static const std::set<std::string> plain{"problem", "method", "arithmetic", "potential", "coordinates", "model"};
  if (plain.contains(fact.first)) return fact.second;
  return fact.first + " = " + fact.second;
}

/// Returns whether a fact is printed in the title if it is the same for all runs.
bool in_title(const std::pair<std::string, std::string>& fact) {
  if (fact.first == "arithmetic") return fact.second != "double";
  return fact.first == "problem" || fact.first == "method" || fact.first == "dt";
}

/// Returns the particles of a gas, or several bodies in space.
FigureParticles particles_of(const Scenario& scenario, std::size_t space, Positions positions) {
  FigureParticles all;
  if (scenario.problem->dimension != 0 || space < 2) return all;
  const std::size_t size = scenario.start_q.size();
  all.gas = static_cast<bool>(scenario.problem->particles);
  all.space = space;
  all.count = size / space;
  all.positions = std::move(positions);
  if (!all.gas) return all;
  const ParticleFacts particles = scenario.problem->particles(scenario.request.parameters);
  all.container = scenario.problem->container;
  if (particles.radius > 0) all.radius = particles.radius;
  all.edges = particles.edges;
  return all;
}

/// Returns whether a figure needs the energy. For many particles the energy costs as much as a step, so figures of
/// positions skip it.
bool show_energy(const std::vector<std::string>& kinds) {
  return std::any_of(kinds.begin(), kinds.end(), [](const std::string& kind) {
    return kind != "particles" && kind != "tracks" && kind != "radial" && !kind.empty();
  });
}

}  // namespace

fs::path stored_run_in(const fs::path& run) {
  std::error_code none;
  if (run.filename() == "sweep.h5" && fs::exists(run, none)) {
    throw FileError(run.string() + " cannot be read: it is the table " + sweep_draws_it());
  }
  if (!fs::is_directory(run, none)) return run;
  if (fs::exists(run / "run.h5", none)) return run / "run.h5";
  if (fs::exists(run / "reverse.h5", none)) return run / "reverse.h5";
  const std::string other = described_folder(run);
  if (!other.empty())
    throw FileError((run / "run.h5").string() + " cannot be read: the file does not exist; the folder is " + other);
  return run / "run.h5";
}

Scenario scenario_of(const StoredRun& run, const fs::path& file) {
  const std::string& text = run.description.scenario;
  const Reading reading = read_scenario_text(text, file.string(), {});
  if (!reading.scenario)
    throw FileError("the scenario in " + file.string() + " is damaged: " + reading.complaints.front().text());
  check_states(*reading.scenario, run.description, file);
  return *reading.scenario;
}

std::string problem_text(const Scenario& scenario) {
  constexpr std::size_t longest = 60;
  const Request& request = scenario.request;
  if (!scenario.problem->structure) return request.problem;
  const auto potential = request.variant.find(FormulaKeys::central_potential);
  if (has_typed_hamiltonian(*scenario.problem)) return figures::shortened({scenario.problem->info.formula}, longest)[0];
  if (potential == request.variant.end()) return request.problem;
  return request.problem + ", V = " + figures::shortened({potential->second}, longest)[0];
}

RunForFigure for_figure(const Scenario& scenario, const RunTables& tables, const fs::path& run,
                        const std::vector<std::string>& kinds, Positions positions) {
  RunForFigure result;
  result.scenario = scenario;
  const ProblemEntry& problem = *scenario.problem;
  const Texts& parameters = scenario.request.parameters;
  FigureData& data = result.data;
  data.has_time = problem.structure && problem.structure->time;
  const std::size_t size = scenario.start_q.size();
  const Table& samples = tables.samples;
  if (samples.rows() == 0) throw FileError(run.string() + " holds no samples");
  data.t = values_of(samples, "t");
  data.q = by_coordinate(samples, "q");
  data.p = by_coordinate(samples, "p");
  const StateNames names = data.q.empty() ? StateNames{} : state_names(problem, parameters, size);
  data.coordinates = names.q;
  data.momenta = names.p;
  data.angles = problem.info.angles;
  data.space = space_of(scenario, size);
  if (!positions && problem.dimension == 0) {
    positions = [q = samples["q"]](std::size_t sample) { return q.row(sample); };
  }
  data.particles = particles_of(scenario, data.space, std::move(positions));
  data.bodies = scenario.body_names;
  const ColumnUnits units = column_units(scenario);
  data.units = {units.t.empty() ? "" : units.t + "s", units.q, units.p, units.energy};
  data.path = path_of(scenario, data, tables.bounces);
  data.energy = values_of(samples, "energy");
  data.least_difference = values_of(samples, "energy_error_min");
  data.largest_difference = values_of(samples, "energy_error_max");
  data.energy_difference = energy_differences(samples);
  const bool reversal = data.energy.empty();
  data.every_step = !reversal && static_cast<std::int64_t>(data.t.size()) > scenario.steps;
  // Samples at given times may stop before the end of the run.
  if (!scenario.record.empty() && !reversal) data.end = static_cast<double>(scenario.steps) * scenario.dt;
  if (show_energy(kinds) || !data.particles.gas) {
    data.energy_scale = make_simulation(scenario.request)->energy().scale_at_start;
  }
  if (problem.exact_radius) {
    const auto radius = problem.exact_radius(parameters, scenario.start_q, scenario.start_p);
    if (radius) sample_polar_curve(radius, data);
  }
  for (const auto& [name, meaning] : diagnostic_columns) {
    if (const Column* const column = samples.find(name)) {
      data.diagnostics.emplace_back(std::string(name).substr(std::string("solver/").size()), column->part(0));
    }
  }
  data.observables = columns_in(samples, "observables/");
  data.invariants = columns_in(samples, "invariants/");
  // The level curve of H continues behind walls. If H depends on t, it is not a trajectory.
  if (problem.dimension == 1 && !data.has_time && !has_hard_walls(scenario.request)) {
    data.hamiltonian_1d = [&problem, parameters](double q, double p) { return problem.energy(parameters, {q}, {p}); };
  }
  if (scenario.section && !tables.section.empty() && (data.q.size() >= 2 || scenario.section->is_stroboscopic)) {
    add_section(*scenario.section, names, tables.section, data);
  }
  fs::path named = run;
  if (named.filename() == "run.h5" && named.has_parent_path()) named = named.parent_path();
  if (!named.has_filename()) named = named.parent_path();
  result.name = (named.extension() == ".run" ? named.stem() : named.filename()).string();  // not "dt0" of dt0.1
  result.facts = facts_of(scenario);
  return result;
}

RunForFigure read_for_figure(const fs::path& run, const std::vector<std::string>& kinds) {
  const fs::path source = stored_run_in(run);
  StoredRun stored = read_run_file(source, {.most_coordinates = most_named_coordinates, .digits = true});
  RunForFigure result = for_figure(scenario_of(stored, source), stored.tables, run, kinds,
                                   [source](std::size_t sample) { return read_run_positions(source, sample); });
  result.notes = std::move(stored.left_out);
  return result;
}

void add_start(RunForFigure& run, const std::vector<double>& times) {
  FigureData& data = run.data;
  const double first = data.t.front();
  const auto is_before = [&](double t) { return first > 0 ? t >= 0 && t < first : t <= 0 && t > first; };
  if (std::none_of(times.begin(), times.end(), is_before)) return;
  const auto begin_with = [](std::vector<double>& list, double x) {
    if (!list.empty()) list.insert(list.begin(), x);
  };
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  begin_with(data.t, 0);
  for (std::size_t i = 0; i < data.q.size(); ++i) {
    begin_with(data.q[i], run.scenario.start_q[i]);
    begin_with(data.p[i], run.scenario.start_p[i]);
  }
  for (auto* list : {&data.energy, &data.energy_difference, &data.least_difference, &data.largest_difference})
    begin_with(*list, unknown);
  for (auto* columns : {&data.observables, &data.invariants, &data.diagnostics}) {
    for (auto& column : *columns) begin_with(column.second, unknown);
  }
  data.particles.positions = [start = run.scenario.start_q, later = data.particles.positions](std::size_t sample) {
    return sample == 0 ? start : later(sample - 1);
  };
}

FigureSamples first_steps_of(const RunForFigure& run) {
  const FigureData& samples = run.data;
  const Scenario& scenario = run.scenario;
  if (samples.q.empty()) return {};                           // the coordinates of many particles are not read
  if (!changes_during_run(scenario.text).empty()) return {};  // the first steps had other settings
  const double forward = scenario.dt < 0 ? -1 : 1;
  const std::size_t n = samples.q.size();
  const std::int64_t most = digits_beyond_double(scenario.request.arithmetic) > 0 ? 1000 : 20000;
  const std::int64_t steps =
      std::min({most, scenario.steps, std::max<std::int64_t>(200, 400000 / static_cast<std::int64_t>(n * n))});
  const std::unique_ptr<Simulation> simulation = make_simulation(scenario.request);
  FigureSamples first_steps;
  first_steps.q.resize(n);
  first_steps.p.resize(n);
  // The last sample is the end of a run, also of a run that was interrupted or stopped by an event. Samples at given
  // times may end earlier, and so may the samples of a reversal.
  const bool open = !scenario.record.empty() && std::none_of(scenario.events.begin(), scenario.events.end(),
                                                             [](const UserEvent& event) { return event.stops; });
  const double last =
      open || samples.energy.empty() ? std::numeric_limits<double>::infinity() : std::abs(samples.t.back());
  std::size_t sample = 0;
  Frame frame;
  const auto& walls = scenario.request.walls;
  if (walls && walls->rule == WallRule::event) {  // the drawn path has corners at the bounces
    simulation->on_bounce([&](const Bounce& bounce) {
      first_steps.t.push_back(bounce.time);
      for (std::size_t i = 0; i < n; ++i) {
        first_steps.q[i].push_back(bounce.q[i]);
        first_steps.p[i].push_back(bounce.p[i]);
      }
    });
  }
  for (std::int64_t k = 0; k <= steps; ++k) {
    if (k > 0 && simulation->advance(1) != Outcome::done) break;
    simulation->look(frame);
    if (std::abs(frame.time) > last) break;
    while (sample < samples.t.size() && forward * samples.t[sample] < forward * frame.time) ++sample;
    const bool is_sample = sample < samples.t.size() && samples.t[sample] == frame.time;
    for (std::size_t i = 0; i < n; ++i) {
      if (is_sample && (samples.q[i][sample] != frame.q[i] || samples.p[i][sample] != frame.p[i])) return {};
      first_steps.q[i].push_back(frame.q[i]);
      first_steps.p[i].push_back(frame.p[i]);
    }
    first_steps.t.push_back(frame.time);
  }
  return first_steps;
}

void set_titles_and_labels(std::vector<RunForFigure>& runs) {
  const auto is_common = [&](const std::pair<std::string, std::string>& fact) {
    return std::all_of(runs.begin(), runs.end(), [&](const RunForFigure& run) {
      return std::find(run.facts.begin(), run.facts.end(), fact) != run.facts.end();
    });
  };
  const auto have_all = [&](const std::string& key) {
    return std::all_of(runs.begin(), runs.end(), [&](const RunForFigure& run) {
      return std::any_of(run.facts.begin(), run.facts.end(), [&](const auto& fact) { return fact.first == key; });
    });
  };
  for (RunForFigure& run : runs) {
    std::vector<std::string> title;
    std::vector<std::string> label;
    for (const auto& fact : run.facts) {
      const bool common = is_common(fact);
      if (common && in_title(fact)) title.push_back(fact_text(fact));
      if (!common && have_all(fact.first)) label.push_back(fact_text(fact));
    }
    run.data.title = joined(title);
    run.data.label = joined(label);
  }
  std::multiset<std::string> labels;
  for (const RunForFigure& run : runs) labels.insert(run.data.label);
  for (RunForFigure& run : runs) {
    if (labels.count(run.data.label) == 1 && !run.data.label.empty()) continue;
    run.data.label += (run.data.label.empty() ? "" : ", ") + run.name;
  }
  constexpr std::size_t longest = 44;  // fits into one column of a journal
  for (RunForFigure& run : runs) {
    if (run.data.label.size() > longest) run.data.label = run.name;
  }
}

}  // namespace hamflow
