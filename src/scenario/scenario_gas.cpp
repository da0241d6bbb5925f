// Reads [problem] for the gas: the words that choose its entry of the catalogue, its parameters, and the initial
// particles.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <span>

#include "engine/large_steps.hpp"
#include "gas/container.hpp"
#include "gas/cutoff.hpp"
#include "gas_checks.hpp"
#include "gas_start.hpp"
#include "hamflow/detail/core/hash.hpp"
#include "hamflow/detail/run/fitting_methods.hpp"
#include "hamflow/methods/itoh_abe.hpp"
#include "hamflow/run/gas.hpp"
#include "hamflow/run/state_names.hpp"
#include "scenario_reader.hpp"
#include "toml_path.hpp"

namespace hamflow {

namespace {

/// Complains about keys that the gas has in another table, and names the right table.
/// @param own path of the table, with a final dot
void name_right_tables(TomlTable& table, const std::string& own) {
  const GasOptions& o = gas_options();
  const WallKeys& walls = wall_keys();
  std::vector<OptionInfo> direct = all_gas_options();
  direct.insert(direct.end(), {walls.walls, walls.wall_rule, walls.strength, walls.exponent});
  const std::pair<std::string, std::vector<OptionInfo>> tables[] = {
      {"problem.container.", o.container.keys}, {"problem.cutoff.", o.cutoff.keys}, {"problem.", direct}};
  for (const std::string& key : table.keys()) {
    if (table.knows(key)) continue;
    std::vector<std::string> places;
    bool is_own = own == "problem." + key + ".";  // the key is the name of its own table
    for (const auto& [path, keys] : tables) {
      if (find_option(keys, key) == nullptr) continue;
      is_own = is_own || path == own;
      places.push_back(path + key);
    }
    if (is_own || places.empty()) continue;
    table.complain(key, table.found(key) + "; allowed as " + joined(places, " or "));
    table.know(key);
  }
}

/// Reads { kind, radius, exponent } or { kind, size }; the default is a circle.
void read_container(TomlTable& table, Choices& choices, Texts& parameters) {
  const GasOptions& o = gas_options();
  choices[GasKeys::container] = ContainerNames::circle;
  table.know(o.container.name);
  if (!table.has(o.container.name)) return;
  TomlTable container = table.table(o.container.name);
  if (!container.exists()) return;
  const std::string kind = container.text(o.of_container.kind).value_or(ContainerNames::circle);
  choices[GasKeys::container] = kind;
  const auto take = [&](const OptionInfo& option, bool belongs) {
    if (!belongs && container.has(option.name)) {
      container.complain(option.name,
                         container.found(option.name) + " with kind = \"" + kind + "\"; allowed " + option.condition);
      container.know(option.name);
    } else if (const auto text = container.text(option); text && belongs) {
      parameters[option.name] = *text;
    }
  };
  take(o.of_container.radius, kind == ContainerNames::circle);
  take(o.of_container.exponent, kind == ContainerNames::circle);
  const bool has_edges = kind == ContainerNames::box || kind == ContainerNames::periodic;
  take(o.of_container.size, has_edges);
  if (has_edges && !container.has(o.of_container.size.name)) {
    container.missing(o.of_container.size.name, "a list of the edges of the box");
  }
  if (const std::string& walls = wall_keys().walls.name; kind == ContainerNames::box && container.has(walls)) {
    container.complain(walls, container.found(walls) +
                                  "; not allowed, because the walls of a box are at +-size/2; problem." +
                                  wall_keys().wall_rule.name + " defines what happens there");
    container.know(walls);
  }
  name_right_tables(container, "problem.container.");
  container.finish();
}

/// Reads a number, or { radius, kind, inner, skin }.
void read_cutoff(TomlTable& table, Choices& choices, Texts& parameters) {
  const GasOptions& o = gas_options();
  choices[GasKeys::cutoff_kind] = CutoffNames::none;
  table.know(o.cutoff.name);
  const toml::node* const node = table.node().get(o.cutoff.name);
  if (node == nullptr) return;
  choices[GasKeys::cutoff_kind] = CutoffNames::shifted;
  if (!node->is_table()) {
    const OptionInfo number{.name = o.cutoff.name, .range = Range::positive};
    parameters[GasKeys::cutoff] = table.text(number, ", or a table with radius, kind, inner, skin").value_or("1");
    return;
  }
  TomlTable cutoff = table.table(o.cutoff.name);
  parameters[GasKeys::cutoff] = cutoff.text(o.of_cutoff.radius).value_or("1");
  const std::string kind = cutoff.text(o.of_cutoff.kind).value_or(CutoffNames::shifted);
  choices[GasKeys::cutoff_kind] = kind;
  const bool smooth = kind == CutoffNames::smooth;
  const bool has_inner = cutoff.has(o.of_cutoff.inner.name);
  if (const auto inner = cutoff.text(o.of_cutoff.inner); inner && smooth) parameters[GasKeys::inner] = *inner;
  if (smooth && !has_inner) {
    cutoff.missing(o.of_cutoff.inner.name, "a number below radius, from which phi is reduced smoothly to 0");
  } else if (!smooth && has_inner) {
    cutoff.complain(o.of_cutoff.inner.name,
                    cutoff.found(o.of_cutoff.inner.name) + "; allowed " + o.of_cutoff.inner.condition);
  }
  if (const auto skin = cutoff.text(o.of_cutoff.skin)) parameters[GasKeys::skin] = *skin;
  name_right_tables(cutoff, "problem.cutoff.");
  cutoff.finish();
}

/// Returns the number of coordinates in `initial`; 0 if it is missing or wrong, which another check reports.
std::size_t size_of_initial(const TomlTable& table) {
  const toml::node* const initial = table.node().get("initial");
  const toml::table* const state = initial != nullptr ? initial->as_table() : nullptr;
  const toml::node* const q = state != nullptr ? state->get("q") : nullptr;
  return q != nullptr && q->is_array() ? q->as_array()->size() : 0;
}

/// Returns the dimension of space; 2 if it is missing or wrong.
std::size_t space_of(const Texts& parameters) {
  const auto given = parameters.find(GasKeys::dimension);
  return given != parameters.end() && number_value(given->second) == 3 ? 3 : 2;
}

/// Returns the edges of a box that a lattice can fill; empty if the container is not a box, or the box is wrong.
std::vector<std::string> edges_of_box(const Choices& choices, const Texts& parameters, std::size_t space) {
  const auto container = choices.find(GasKeys::container);
  const auto size = parameters.find(GasKeys::size);
  if (container == choices.end() || size == parameters.end()) return {};
  if (container->second != ContainerNames::box && container->second != ContainerNames::periodic) return {};
  std::vector<std::string> edges = list_parts(size->second);
  const bool usable = edges.size() == space && std::all_of(edges.begin(), edges.end(), [](const std::string& edge) {
                        return number_value(edge) > 0;
                      });
  return usable ? edges : std::vector<std::string>{};
}

}  // namespace

void ScenarioReader::read_gas(TomlTable& table) {
  const GasOptions& o = gas_options();
  Request& request = scenario_.request;
  const std::size_t before = complaints_.size();
  Texts parameters;
  const auto take = [&](const OptionInfo& option) {
    if (const auto text = table.text(option)) parameters[option.name] = *text;
  };
  take(o.dimension);
  take(o.masses);
  request.variant[GasKeys::pair] = table.text(o.pair).value_or(o.pair.default_value);
  if (request.variant[GasKeys::pair] == GasKeys::typed) {
    read_typed_pair(table, parameters);
  } else {
    for (const OptionInfo* key : {&o.phi, &o.parameters}) {
      table.know(key->name);
      if (table.has(key->name)) table.complain(key->name, table.found(key->name) + "; allowed " + key->condition);
    }
  }
  name_right_tables(table, "problem.");
  read_container(table, request.variant, parameters);
  if (const std::string& e = wall_keys().exponent.name; table.has(e) && !table.has(wall_keys().walls.name) &&
                                                        request.variant[GasKeys::container] == ContainerNames::circle) {
    table.complain(e, table.found(e) + "; allowed as problem.container." + e + ", or with " + wall_keys().walls.name);
    table.know(e);
  }
  read_cutoff(table, request.variant, parameters);
  const std::int64_t n = table.whole(o.particles_per_side).value_or(0);
  GasStart start = read_gas_start(table, n, space_of(parameters), parameters);
  if (!start.masses.empty()) {
    if (table.has(o.masses.name)) {
      table.complain(o.masses.name, table.found(o.masses.name) + " and masses in the file; allowed one of them");
    }
    parameters[GasKeys::masses] = "[" + joined(start.masses) + "]";
  }
  start_lines_ = std::move(start.lines);
  const std::size_t size = table.has("initial") ? size_of_initial(table) : start.q.size();
  read_scale(table, n, size, parameters);
  if (!table.has("initial")) {
    request.start.q = std::move(start.q);
    request.start.p = std::move(start.p);
  }
  if (complaints_.size() != before) {
    for (const OptionInfo& option : all_gas_options()) table.know(option.name);
    table.know_all({"name", "initial", wall_keys().wall_rule.name, wall_keys().walls.name, wall_keys().strength.name,
                    wall_keys().exponent.name});
    table.finish();
    return;
  }
  try {
    scenario_.problem = find_problem(request.problem, request.variant);
  } catch (const Error& error) {
    table.complain(GasKeys::pair, error.what());
    return;
  }
  for (const ParameterInfo& parameter : scenario_.problem->info.parameters) {
    const auto is_own = [&](const char* name) { return parameter.name == name; };
    const bool own = is_own(GasKeys::masses) || is_own(GasKeys::dimension) || is_own(GasKeys::scale) ||
                     is_own(GasKeys::radius) || is_own(GasKeys::exponent) || is_own(GasKeys::size) ||
                     is_own(GasKeys::cutoff) || is_own(GasKeys::inner) || is_own(GasKeys::skin);
    if (!own && !parameters.contains(parameter.name)) {
      if (const auto text = table.text(parameter)) parameters[parameter.name] = *text;
    }
  }
  request.parameters = complete(scenario_.problem->info, parameters);
}

namespace {
/// Returns the column, counted from 1, at which a formula contains the time t; 0 if it does not.
std::size_t column_of_time(const std::string& formula) {
  const auto in_name = [&](std::size_t i) {
    return i < formula.size() && (std::isalnum(static_cast<unsigned char>(formula[i])) != 0 || formula[i] == '_');
  };
  for (std::size_t i = 0; i < formula.size(); ++i) {
    if (formula[i] == 't' && !in_name(i + 1) && (i == 0 || !in_name(i - 1))) return i + 1;
  }
  return 0;
}
}  // namespace

/// Reads phi = "..." and its parameters.
void ScenarioReader::read_typed_pair(TomlTable& table, Texts& parameters) {
  const GasOptions& o = gas_options();
  if (!table.has(o.phi.name)) table.missing(o.phi.name, "phi of r and the parameters, such as \"r^-9 - r^-6\"");
  const auto phi = table.text(o.phi);
  const Texts typed = read_typed_parameters(table);
  if (!phi) return;
  for (const auto& [name, text] : typed) {
    const auto taken = [&name = name](const OptionInfo& option) { return option.name == name; };
    for (const OptionInfo& option : all_gas_options()) {
      if (taken(option) || name == GasKeys::radius || name == GasKeys::exponent || name == GasKeys::size ||
          name == GasKeys::inner || name == GasKeys::skin) {
        table.complain_in(std::string(GasKeys::parameters) + "." + name,
                          "found the name " + name + ", which is a key of the gas; allowed another name");
        return;
      }
    }
  }
  try {
    if (const std::size_t column = column_of_time(*phi); column > 0 && !typed.contains("t")) {
      throw FormulaError(FormulaKeys::central_potential,
                         "found \"" + *phi + "\", column " + std::to_string(column) +
                             ": the time t; allowed r, parameters and numbers, because a pair law cannot depend on t");
    }
    const Choices field = central_formula_choices(*phi, typed, "cartesian", {.owner = "a pair law", .has_time = false});
    scenario_.request.variant[GasKeys::phi] = *phi;
    scenario_.request.variant[GasKeys::parameters] = field.at(FormulaKeys::parameters);
    parameters.insert(typed.begin(), typed.end());
    FormulaTexts texts;
    texts.potential = *phi;
    texts.parameters = typed;
    refuse_unused_parameters(table, texts);
  } catch (const FormulaError& error) {
    table.complain_in(error.key == FormulaKeys::central_potential ? GasKeys::phi : error.key, error.what());
  }
}

namespace {
std::uint64_t hash_of(const GasStart& start) {
  std::uint64_t hash = fnv1a_of_nothing;
  for (const auto* texts : {&start.q, &start.p, &start.masses}) {
    for (const std::string& text : *texts) {
      hash = fnv1a(std::as_bytes(std::span(text)), hash);
      hash = fnv1a(std::as_bytes(std::span(",")), hash);
    }
    hash = fnv1a(std::as_bytes(std::span(";")), hash);
  }
  return hash;
}
}  // namespace

/// Notes the keys of the start that are not used because `initial` overrides them.
void ScenarioReader::note_unused_start(const TomlTable& table) {
  const GasOptions& o = gas_options();
  const toml::node* const scale = table.node().get(o.scale.name);
  const bool scaled = scale != nullptr && scale->value<std::string>() != GasScales::per_side;
  std::vector<std::string> unused;
  for (const OptionInfo* key : {&o.start, &o.file, &o.seed}) {
    if (table.has(key->name)) unused.push_back(table.full(key->name));
  }
  if (scaled && table.has(o.particles_per_side.name)) unused.push_back(table.full(o.particles_per_side.name));
  if (unused.empty()) return;
  scenario_.notes.push_back(joined(unused) + (unused.size() == 1 ? " is" : " are") +
                            " not used, because initial gives the start of the particles");
}

/// Returns the run.h5 of a resumed run, which contains the start. Empty if there is none, or if the start has more
/// digits than double.
std::filesystem::path ScenarioReader::resumed_run() {
  if (!resumed_in_) return {};
  const std::string arithmetic =
      root_.table(run_table).plain_string(run_keys().arithmetic.name).value_or(run_keys().arithmetic.default_value);
  if (arithmetic != "double" && arithmetic != "lattice") return {};
  std::filesystem::path folder = *resumed_in_;
  if (folder.empty()) folder = root_.table(output_table).plain_string(output_keys().folder.name).value_or("");
  if (folder.empty()) folder = std::filesystem::path(scenario_.file).stem().string() + ".run";
  return is_in_run_file(folder / "run.h5") ? folder / "run.h5" : std::filesystem::path();
}

/// Removes the masses from a start that was read from a run.h5 if the scenario gives them. A run.h5 always has masses,
/// and both agree.
GasStart ScenarioReader::without_own_masses(const TomlTable& table, GasStart start) {
  if (table.has(gas_options().masses.name)) start.masses.clear();
  return start;
}

GasStart ScenarioReader::read_gas_start(TomlTable& table, std::int64_t n, std::size_t space, const Texts& parameters) {
  const GasOptions& o = gas_options();
  const std::string kind = table.text(o.start).value_or(o.start.default_value);
  const auto file = table.text(o.file);
  const auto seed = table.whole(o.seed);
  if (table.has("initial")) {
    note_unused_start(table);
    return {};
  }
  if (seed && kind != GasStarts::lattice) {
    scenario_.notes.push_back(table.full(o.seed.name) + " is not used, because " + o.start.name + " = \"" + kind +
                              "\" has no random momenta");
  }
  if (kind == GasStarts::file) {
    if (!file) {
      if (!table.has(o.file.name)) table.missing(o.file.name, o.file.meaning);
      return {};
    }
    try {
      // A scenario stored in a run.h5 has the start of that run. Its CSV file may no longer exist.
      if (is_in_run_file(scenario_.file)) {
        GasStart began = without_own_masses(table, gas_from_run(scenario_.file, space, RunState::start));
        scenario_.start_contents = hash_of(began);
        return began;
      }
      const std::filesystem::path path = std::filesystem::path(scenario_.file).parent_path() / *file;
      if (const std::filesystem::path run = resumed_run(); !run.empty() && !std::ifstream(path).good()) {
        scenario_.notes.push_back(table.full(o.file.name) + ": cannot read the file " + path.string() +
                                  "; the start is read from " + run.string());
        return without_own_masses(table, gas_from_run(run, space, RunState::start));
      }
      GasStart there = path.extension() == ".h5" ? gas_from_run(path, space) : gas_from_file(path, space);
      if (path.extension() == ".h5" && n == 0 && !table.has(o.scale.name)) {
        scenario_.notes.push_back(table.full(o.scale.name) + " is not given, so it is 1; if the run of " +
                                  path.string() + " had another " + o.scale.name + ", give the same value");
      }
      const double particles = static_cast<double>(there.q.size() / space);
      if (n > 0 && std::pow(static_cast<double>(n), static_cast<double>(space)) != particles) {
        table.complain(o.particles_per_side.name, table.found(o.particles_per_side.name) + " but " + *file + " has " +
                                                      std::to_string(there.q.size() / space) +
                                                      " particles; allowed a matching number, or leave out this key");
      }
      scenario_.start_contents = hash_of(there);
      return there;
    } catch (const Error& error) {
      table.complain(o.file.name, error.what());
      return {};
    }
  }
  if (table.has(o.file.name)) {
    table.complain(o.file.name, table.found(o.file.name) + "; allowed " + o.file.condition);
  }
  if (n == 0) {
    if (!table.has(o.particles_per_side.name)) {
      table.missing(o.particles_per_side.name, "a whole number from 2, or start = \"file\", or initial = { q, p }");
    }
    return {};
  }
  constexpr double most_particles = 2e7;
  if (std::pow(static_cast<double>(n), static_cast<double>(space)) > most_particles) {
    table.complain(o.particles_per_side.name,
                   table.found(o.particles_per_side.name) + "; allowed at most 2e7 particles in total");
    return {};
  }
  if (kind == GasStarts::corner) return gas_in_corner(n, space);
  return gas_on_lattice(n, space, static_cast<std::uint64_t>(seed.value_or(1)),
                        edges_of_box(scenario_.request.variant, parameters, space));
}

/// Reads the scale S as a text that every arithmetic reads with its digits.
void ScenarioReader::read_scale(TomlTable& table, std::int64_t n, std::size_t size, Texts& parameters) {
  const GasOptions& o = gas_options();
  const std::string word = table.text(o.scale).value_or(n == 0 ? "1" : GasScales::per_side);
  const bool corner = table.plain_string(o.start.name) == GasStarts::corner && !table.has("initial");
  if (word == GasScales::per_side) {
    if (n == 0 && !table.has(o.particles_per_side.name)) {  // another check reports a wrong value
      table.complain(o.scale.name, table.found(o.scale.name) + "; allowed with particles_per_side, else \"" +
                                       GasScales::listing + "\" or a number");
    }
    const std::vector<std::string> edges = edges_of_box(scenario_.request.variant, parameters, space_of(parameters));
    if (corner) {
      parameters[GasKeys::scale] = std::to_string(n - 1);
    } else if (edges.empty() || table.plain_string(o.start.name) == GasStarts::file || table.has("initial")) {
      parameters[GasKeys::scale] = std::to_string(n - 1) + "/2";
    } else {
      const auto less = [](const std::string& a, const std::string& b) { return number_value(a) < number_value(b); };
      parameters[GasKeys::scale] = std::to_string(n) + "/(" + *std::min_element(edges.begin(), edges.end(), less) + ")";
    }
  } else if (word == GasScales::listing) {
    const std::size_t particles = size / space_of(parameters);
    if (particles == 1)
      table.complain(o.scale.name, table.found(o.scale.name) + " with one particle; allowed a number");
    parameters[GasKeys::scale] = std::to_string(particles > 1 ? particles - 1 : 1) + "/2";
  } else {
    parameters[GasKeys::scale] = word;
  }
}

/// Checks the number of masses of a gas whose start is generated. The number of particles is then known, so the masses
/// are wrong if the numbers disagree.
bool ScenarioReader::check_masses(TomlTable& table) {
  const Request& request = scenario_.request;
  const std::size_t size = request.start.q.size();
  if (scenario_.problem->refused_size(request.parameters, size).empty()) return true;
  const auto space = static_cast<std::size_t>(number_value(request.parameters.at(GasKeys::dimension)));
  table.complain(GasKeys::masses, "found " + std::to_string(list_parts(request.parameters.at(GasKeys::masses)).size()) +
                                      " numbers; allowed one, or " + std::to_string(size / space) +
                                      ", one for each particle");
  return false;
}

/// Complains at the key that gives the start of the particles. For a CSV file it adds the lines of the particles in the
/// message.
void ScenarioReader::complain_of_particles(TomlTable& table, const std::string& usual, const StartRefusal& refusal) {
  const GasOptions& gas = gas_options();
  // The container is the cause if the start is generated, or if --set only changed the container.
  const std::string start = table.has("initial") ? "initial" : gas.start.name;
  std::string message = "found " + refusal.message;
  // A gas has the walls of its container, or those of the scenario.
  const bool is_of_scenario = refusal.key == wall_keys().walls.name && table.has(refusal.key);
  const std::string size = refusal.key == wall_keys().walls.name ? gas.of_container.size.name : refusal.key;
  const std::string edge = refusal.key.empty() || is_of_scenario ? refusal.key : gas.container.name + "." + size;
  const std::string holder = edge.substr(0, edge.find('.'));
  const auto is_outside = [&](const std::string& key) { return table.has(key) && touched(*table.node().get(key)); };
  if (!edge.empty() && (!table.has(start) || (is_outside(holder) && !is_outside(start)))) {
    return table.complain_in(edge, message);
  }
  if (table.has("initial")) return table.complain(usual, message);
  if (table.plain_string(gas.start.name) != GasStarts::file) return table.complain(gas.start.name, message);
  std::vector<std::string> lines;
  for (const std::size_t particle : refusal.particles) {
    if (particle > 0 && particle <= start_lines_.size()) lines.push_back(std::to_string(start_lines_[particle - 1]));
  }
  if (!lines.empty()) {
    const std::filesystem::path file =
        std::filesystem::path(scenario_.file).parent_path() / table.plain_string(gas.file.name).value_or("");
    message.insert(std::min(message.find("; allowed"), message.size()),
                   std::string(lines.size() == 1 ? ", in line " : ", in lines ") + joined(lines, " and ") + " of " +
                       file.string());
  }
  table.complain(gas.file.name, message);
}

/// Rounds the edges of a periodic box to whole units of the lattice, so that the images of a particle are on the
/// lattice, too. An edge that would become 0 is refused.
void ScenarioReader::round_edges(TomlTable& table) {
  Request& request = scenario_.request;
  const auto& refused = scenario_.problem->refused_parameters;
  if (!refused(request.parameters).second.empty()) return;  // another check reports this
  const std::string& key = run_keys().lattice.name;
  const bool given = table.has(key) && table.table(key).has(lattice_keys().position.name);
  const auto complain = [&](const std::string& message) {
    if (!given) return table.complain(key, message);
    table.table(key).complain(lattice_keys().position.name, message);
  };
  const double unit = request.position_unit;
  const std::vector<std::string> typed = list_parts(request.parameters.at(GasKeys::size));
  std::vector<std::string> edges;
  double moved = 0;
  for (const std::string& text : typed) {
    const double edge = number_value(text);
    const double rounded = std::nearbyint(edge / unit) * unit;
    const double by = std::abs(rounded - edge);
    if (rounded == 0) {
      complain("found the grid spacing " + shortest(unit) + (given ? "" : ", the default for this start,") +
               " for a periodic box whose edge " + text + " is " + shortest(edge / unit) +
               " spacings and would be rounded to 0; allowed spacings far below the edges, such as \"2^-52\"");
      return;
    }
    moved = std::max(moved, by);
    edges.push_back(shortest(rounded));
  }
  if (moved == 0) return;
  Texts parameters = request.parameters;
  parameters[GasKeys::size] = "[" + joined(edges) + "]";
  if (const auto [wrong, message] = refused(parameters); !message.empty()) {
    complain("found the grid spacing " + shortest(unit) + ", which rounds the edges to " + joined(edges) +
             ", too short for problem." + wrong + " = " + request.parameters.at(GasKeys::cutoff) + "; " + message);
    return;
  }
  request.parameters = std::move(parameters);
  scenario_.notes.push_back("the edges of the periodic box are rounded to whole grid spacings, by up to " +
                            shortest(moved));
}

/// Makes hard walls at +-size/2 for every coordinate. The default rule is `mirror`, because with `event` the bounce of
/// one particle would split the step of all.
void ScenarioReader::read_box(TomlTable& table) {
  const WallKeys& keys = wall_keys();
  OptionInfo rule = keys.wall_rule;
  rule.default_value = wall_rules()[static_cast<std::size_t>(WallRule::mirror)];
  rule.words = {wall_rules()[0], wall_rules()[1], wall_rules()[2]};  // the rules of hard walls
  const std::string word = table.text(rule).value_or(rule.default_value);
  for (const OptionInfo* key : {&keys.walls, &keys.strength, &keys.exponent}) {
    table.know(key->name);
    if (table.has_any(key->name)) {
      table.complain(key->name, table.found(key->name) + " with a box; allowed container = { kind = ... } with " +
                                    ContainerNames::none + ", " + ContainerNames::circle + " or " +
                                    ContainerNames::periodic);
    }
  }
  const Texts& parameters = scenario_.request.parameters;
  const std::size_t size = scenario_.request.start.q.size();
  const std::vector<std::string> edges = list_parts(parameters.at(GasKeys::size));
  if (size == 0 || !scenario_.problem->refused_size(parameters, size).empty()) return;
  if (!scenario_.problem->refused_parameters(parameters).second.empty()) return;  // another check reports this
  Walls walls;
  for (std::size_t k = 0; k < wall_rules().size(); ++k) {
    if (wall_rules()[k] == word) walls.rule = static_cast<WallRule>(k);
  }
  const std::vector<std::string> names = state_names(*scenario_.problem, parameters, size).q;
  for (std::size_t i = 0; i < size; ++i) {
    const std::string half = "(" + edges[i % edges.size()] + ")/2";
    walls.intervals.push_back({names[i], i, "-" + half, half});
  }
  scenario_.request.walls = walls;
  scenario_.problem = find_problem(scenario_.request);
}

namespace {
/// Explains why an option that needs the Hessian is refused for many particles: the matrix does not fit into memory.
std::string without_hessian(const Request& request, std::size_t coordinates, const std::string& above) {
  if (request.problem != GasKeys::problem || coordinates <= most_gas_coordinates_with_hessian) return {};
  return "with " + std::to_string(coordinates) + " coordinates, but it needs the Hessian; allowed with at most " +
         std::to_string(most_gas_coordinates_with_hessian) + " coordinates" + (above.empty() ? "" : "; or " + above);
}
}  // namespace

std::string refused_by_size(const Request& request, std::size_t coordinates) {
  const std::string& name = request.method.name;
  const auto other_method = [&](std::initializer_list<std::string_view> candidates) {
    return "another method" + with_fitting_methods(candidates, find_problem(request).get(), request.arithmetic);
  };
  if (name == "itoh-abe" && coordinates > ItohAbe::most_coordinates) {
    const bool has_hessian = request.problem != GasKeys::problem || coordinates <= most_gas_coordinates_with_hessian;
    return "with " + std::to_string(coordinates) + " coordinates; allowed at most " +
           std::to_string(ItohAbe::most_coordinates) +
           ", because it evaluates H once for each coordinate and a step would take minutes; use " +
           (has_hessian ? other_method({"discrete-gradient", "cg"}) : other_method({"cg", "stv4"}));
  }
  if (name != "chin4a" && name != "chin4b" && name != "discrete-gradient") return {};
  return without_hessian(request, coordinates, other_method({"stv4", "blanes-moan-s6", "cg"}));
}

/// Checks that a typed formula has derivatives of every order, which taylor needs. Only recording the formula shows
/// this, and taylor records it when its simulation is made.
void ScenarioReader::check_branches() {
  const Request& request = scenario_.request;
  const bool typed =
      request.variant.contains(GasKeys::phi) || (scenario_.problem != nullptr && scenario_.problem->structure);
  if (!complaints_.empty() || !typed || !has_method() || request.method.name != "taylor") return;
  try {
    (void)make_simulation(request);
  } catch (const Error& error) {
    root_.table("method").complain("name", "found taylor: " + std::string(error.what()));
  }
}

void ScenarioReader::check_gas() {
  const Request& request = scenario_.request;
  const std::size_t size = scenario_.start_q.size();
  if (has_method()) {
    const std::string why_not = refused_by_size(request, size);
    if (!why_not.empty()) root_.table("method").complain("name", "found " + request.method.name + " " + why_not);
  }
  check_branches();
  const std::string no_measures = without_hessian(request, size, "");
  if (no_measures.empty()) return;
  TomlTable run = root_.table(run_table);
  if (scenario_.lyapunov > 0) run.complain(run_keys().lyapunov.name, "requested " + no_measures);
  if (scenario_.eigenvalues) run.complain(run_keys().eigenvalues.name, "requested " + no_measures);
}

}  // namespace hamflow
