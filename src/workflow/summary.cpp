#include "summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <variant>

#include "bounce_names.hpp"
#include "certificate_json.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/core/text_place.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/methods/step_control.hpp"
#include "hamflow/problems/support/container.hpp"
#include "hamflow/run/fitting_methods.hpp"
#include "hamflow/run/gas.hpp"
#include "hamflow/run/large_steps.hpp"
#include "hamflow/run/wall_failures.hpp"
#include "hamflow/run/walls.hpp"
#include "hamflow/verify/state_units.hpp"
#include "json_text.hpp"
#include "measures/measures.hpp"
#include "number_text.hpp"
#include "orbit_digits.hpp"
#include "run_description.hpp"
#include "warnings.hpp"

namespace hamflow {

namespace {
using Json = nlohmann::ordered_json;

Json excursion(const Excursion& e) { return {{"initial", e.initial}, {"final", e.final}, {"max_error", e.max_error}}; }

/// @param exponent what that of the walls is called
void add_walls(const Walls& walls, const std::string& exponent, Json& parameters) {
  const WallKeys& keys = wall_keys();
  Json all = Json::array();
  for (const Walls::Interval& wall : walls.intervals) {
    Json interval{{keys.coordinate.name, wall.coordinate}};
    if (!wall.min.empty()) interval[keys.min.name] = number_value(wall.min);
    if (!wall.max.empty()) interval[keys.max.name] = number_value(wall.max);
    all.push_back(interval);
  }
  parameters[keys.walls.name] = all;
  parameters[keys.wall_rule.name] = wall_rules()[static_cast<std::size_t>(walls.rule)];
  if (walls.hard()) return;
  parameters[keys.strength.name] = number_value(walls.strength);
  parameters[exponent] = number_value(walls.exponent);
}

bool has_parameter(const ProblemEntry& problem, const std::string& name) {
  const std::vector<ParameterInfo>& all = problem.info.parameters;
  return std::any_of(all.begin(), all.end(), [&](const ParameterInfo& parameter) { return parameter.name == name; });
}

Json parameters_of(const Scenario& scenario) {
  Json parameters = Json::object();
  const std::optional<FormulaStructure>& structure = scenario.problem->structure;
  const std::map<std::string, std::string> choices(scenario.problem->info.variant.begin(),
                                                   scenario.problem->info.variant.end());
  const auto without = without_walls(choices);
  for (const auto& [key, value] : scenario.problem->info.variant) {
    if (!without.contains(key)) continue;
    // Those of the problem `formula` are its texts, which the scenario has; the values of parameters stand below.
    if (scenario.problem->info.name == FormulaKeys::problem || key == FormulaKeys::parameters) continue;
    const bool is_number = !value.empty() && std::all_of(value.begin(), value.end(), is_digit);  // dimension = 3
    parameters[key] = is_number ? Json(std::stoi(value)) : Json(value);
  }
  if (const auto walls = walls_among(scenario.request.variant)) {
    if (scenario.request.problem == GasKeys::problem && without.at(GasKeys::container) == ContainerNames::box) {
      parameters[wall_keys().wall_rule.name] =
          wall_rules()[static_cast<std::size_t>(walls->rule)];  // the box says the rest
    } else {
      // A gas in a soft circle has an exponent of its own, that of its container.
      const std::string& exponent = wall_keys().exponent.name;
      add_walls(*walls, has_parameter(*scenario.problem, exponent) ? "wall_" + exponent : exponent, parameters);
    }
  }
  const Parameters<double> values(scenario.request.parameters);
  for (const ParameterInfo& parameter : scenario.problem->info.parameters) {
    if (!values.has(parameter.name)) continue;
    const std::vector<double>& list = values.list(parameter.name);
    const bool single =
        parameter.type == OptionType::number || (parameter.type == OptionType::number_or_list && list.size() == 1);
    parameters[parameter.name] = single && parameter.range.whole ? Json(static_cast<std::int64_t>(list[0]))
                                 : single                        ? Json(list[0])
                                                                 : Json(list);
  }
  if (!scenario.problem->info.frame.name.empty()) {
    parameters[scenario.problem->info.frame.name] =
        scenario.request.start.barycentric ? StartFrames::barycentric : StartFrames::given;
  }
  if (structure) {
    parameters["structure"] = {{"separable", structure->separable},
                               {"quadratic_kinetic", structure->quadratic_kinetic},
                               {"time", structure->time}};
  }
  return parameters;
}

/// The least and largest of each over every step, with the time at the end of that step.
Json diagnostics_of(const StepDiagnostics& d, double dt) {
  const auto extremes = [&](const StepDiagnostics::Extremes& e) -> Json {
    if (!(e.least <= e.most)) return nullptr;  // no step yet
    return {{"min", e.least},
            {"t_min", static_cast<double>(e.step_of_least) * dt},
            {"max", e.most},
            {"t_max", static_cast<double>(e.step_of_most) * dt}};
  };
  return {{"condition_tangent", extremes(d.of_condition_tangent)},
          {"determinant_tangent", extremes(d.of_determinant_tangent)},
          {"condition_inverse_mass", extremes(d.of_condition_inverse_mass)}};
}

/// The two bodies in space, from the planar state.
Json bodies_of(const Scenario& scenario, const Frame& frame) {
  const auto& to_plane = scenario.problem->to_reference;
  const Frame planar = to_plane ? to_plane(scenario.request.parameters, frame.q, frame.p) : frame;
  const auto [first, second] = scenario.bodies->at(frame.time, {planar.q[0], planar.q[1]}, {planar.p[0], planar.p[1]});
  Json all = Json::array();
  for (const Body& body : {first, second}) {
    all.push_back({{"mass", body.mass},
                   {"position", std::vector<double>(body.position.begin(), body.position.end())},
                   {"velocity", std::vector<double>(body.velocity.begin(), body.velocity.end())}});
  }
  return all;
}

/// The state that follows from the energy of a start, in the digits of the run.
Json start_of(const Scenario& scenario) {
  if (digits_beyond_double(scenario.request.arithmetic) == 0) {
    return {{"q", scenario.start_q}, {"p", scenario.start_p}};
  }
  Frame frame;
  make_simulation(scenario.request)->look(frame);
  return {{"q", frame.digits.q}, {"p", frame.digits.p}};
}

/// phi is known up to whole turns: the one next to another value is meant.
double next_to(double other, const Scenario& scenario, std::size_t i, double x) {
  const double turn = 2 * pi_value<double>();
  const auto& coordinates = scenario.problem->info.coordinates;
  return i < coordinates.size() && coordinates[i] == "phi" ? x + turn * std::round((other - x) / turn) : x;
}

/// Each number of the parameters moved by one unit, one at a time.
std::vector<Texts> moved_parameters(const Texts& parameters) {
  std::vector<Texts> all;
  for (const auto& [name, text] : parameters) {
    const bool is_list = text.starts_with("[");
    std::vector<std::string> parts = is_list ? list_parts(text) : std::vector<std::string>{text};
    for (std::string& part : parts) {
      const std::string kept = part;
      try {
        part = shortest(std::nextafter(evaluate_number<double>(part), std::numeric_limits<double>::infinity()));
      } catch (const Error&) {
        continue;  // a word
      }
      all.push_back(parameters);
      all.back()[name] = is_list ? "[" + joined(parts) + "]" : part;
      part = kept;
    }
  }
  return all;
}

/// Bounds the error of the closed form, computed in double, for a run with more digits: one bound for each group of
/// numbers with the same unit. It adds what one rounding of each parameter, of the start, of the time and of the result
/// changes.
std::vector<double> uncertainty_of_exact(const Scenario& scenario, double t, const Frame& exact,
                                         const UnitGroups& groups) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> sum(2 * groups.count());
  const auto add = [&](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p, double time,
                       double unknown) {
    const auto moved = scenario.problem->exact(parameters, q, p, time);
    std::vector<double> most(sum.size(), moved ? 0 : unknown);
    for (std::size_t k = 0; moved && k < exact.q.size(); ++k) {
      double& of_q = most[groups.group(k)];
      double& of_p = most[groups.count() + groups.group(k)];
      of_q = std::max(of_q, std::abs(next_to(exact.q[k], scenario, k, moved->q[k]) - exact.q[k]));
      of_p = std::max(of_p, std::abs(moved->p[k] - exact.p[k]));
    }
    for (std::size_t g = 0; g < sum.size(); ++g) sum[g] += most[g];
  };
  // Where it is not known a rounding away, it is not known here how well it is.
  const auto add_moved = [&](const std::vector<double>& q, const std::vector<double>& p, double time) {
    add(scenario.request.parameters, q, p, time, infinity);
  };
  add_moved(scenario.start_q, scenario.start_p, std::nextafter(t, infinity));
  for (std::size_t i = 0; i < exact.q.size(); ++i) {
    std::vector<double> q = scenario.start_q;
    std::vector<double> p = scenario.start_p;
    q[i] = std::nextafter(q[i], infinity);
    p[i] = std::nextafter(p[i], infinity);
    add_moved(q, scenario.start_p, t);
    add_moved(scenario.start_q, p, t);
    constexpr double rounding = std::numeric_limits<double>::epsilon();
    sum[groups.group(i)] += rounding * std::abs(exact.q[i]);
    sum[groups.count() + groups.group(i)] += rounding * std::abs(exact.p[i]);
  }
  for (const Texts& parameters : moved_parameters(complete(scenario.problem->info, scenario.request.parameters))) {
    // An exponent has no rounding, nor a closed form beside it.
    add(parameters, scenario.start_q, scenario.start_p, t, 0);
  }
  return sum;
}

/// The sizes of the numbers of the exact motion up to a time. Where all of a kind are 0 at both ends, it is looked up
/// at two times between them that are in step with no oscillation that both ends are in step with.
StateSizes sizes_of_exact(const Scenario& scenario, const Frame& end) {
  StateSizes sizes;
  sizes.include(scenario.start_q, scenario.start_p);
  sizes.include(end.q, end.p);
  const auto is_0 = [](double x) { return x == 0; };
  if (!std::ranges::all_of(sizes.q, is_0) && !std::ranges::all_of(sizes.p, is_0)) return sizes;
  for (const double part : {0.3819660112501051, 0.7236067977499790}) {
    const auto between =
        scenario.problem->exact(scenario.request.parameters, scenario.start_q, scenario.start_p, part * end.time);
    if (between) sizes.include(between->q, between->p);
  }
  return sizes;
}

/// The exact state at the time reached, and how far the run is from it, by groups of numbers with one unit. It is known
/// in double: of a run in more digits that is no further off nothing is said but how well it is known.
std::optional<Json> exact_of(const Scenario& scenario, const Frame& frame) {
  auto exact = scenario.problem->exact(scenario.request.parameters, scenario.start_q, scenario.start_p, frame.time);
  if (!exact) return std::nullopt;
  Frame reached;  // in double
  reached.q = frame.q;
  reached.p = frame.p;
  for (std::size_t i = 0; i < frame.q.size(); ++i) exact->q[i] = next_to(frame.q[i], scenario, i, exact->q[i]);
  const UnitGroups groups = unit_groups(*scenario.problem, frame.q.size());
  const std::vector<GroupDistance> distances =
      group_distances(groups, sizes_of_exact(scenario, *exact), reached, *exact);
  std::size_t furthest = 0;  // beside its size
  Json differences = Json::object();
  for (std::size_t g = 0; g < distances.size(); ++g) {
    differences[distances[g].name] = distances[g].distance.value;
    if (!(distances[g].relative.value <= distances[furthest].relative.value)) furthest = g;
  }
  Json found{{"q", exact->q},
             {"p", exact->p},
             {"max_difference", distances[furthest].distance.value},
             {"relative_difference", distances[furthest].relative.value},
             {"differences", differences}};
  if (frame.digits.q.empty()) return found;
  const std::vector<double> uncertainty = uncertainty_of_exact(scenario, frame.time, *exact, groups);
  for (const double x : uncertainty) {
    if (!std::isfinite(x)) return std::nullopt;
  }
  found["uncertainty"] = uncertainty[furthest];
  return found;
}

}  // namespace

/// The iteration by which steps are solved where nothing was said and it is not newton; else empty.
static std::string chosen_iteration(const Request& request) {
  const MethodSpec taken = method_taken(request);
  return taken.options == request.method.options ? "" : taken.options.at("iteration");
}

/// The hint of the outcome, and what method and problem add to it.
std::string hint_for(const Request& request, bool differentiated, Outcome outcome, std::string_view failure) {
  if (outcome == Outcome::wall && failure.ends_with(no_other_momentum)) {
    return "no dt helps: it is H that has a single root in that momentum, so that no hard wall throws it back; allowed "
           "an H with two, such as p^2/2, or no wall there";
  }
  if (outcome == Outcome::not_converged) {
    const std::string solved = hint_after_divergence(request, differentiated);
    const MethodInfo method = describe(request.method);
    if (!method.varies_steps) return solved;
    // Steps of varying length end so, too, where their density leaves the positive numbers: nothing diverged then.
    const ProblemEntry& problem = find_problem(request.problem, request.variant);
    const auto monitor = request.method.options.find(monitor_option);
    const bool follows_distance = monitor != request.method.options.end() && monitor->second == distance_monitor_name;
    const std::string other = problem.has_distance && !follows_distance
                                  ? fmt::format(" or method.{} = \"{}\"", monitor_option, distance_monitor_name)
                                  : "";
    const std::string of_density = "try a smaller dt" + other;
    return method.explicit_step
               ? of_density
               : "where the density of steps is at fault, " + of_density + "; where a step was not solved, " + solved;
  }
  std::string text(hint(outcome));
  if (outcome == Outcome::lattice_overflow) {
    text += fmt::format(", e.g. {{ position = \"2^{}\", momentum = \"2^{}\" }}", std::ilogb(request.position_unit) + 8,
                        std::ilogb(request.momentum_unit) + 8);
    const ProblemEntry& problem = find_problem(request.problem, request.variant);
    const auto has = [&](const char* name) {
      return std::any_of(problem.info.parameters.begin(), problem.info.parameters.end(),
                         [&](const ParameterInfo& each) { return each.name == name; });
    };
    if (problem.has_pairwise_forces) {  // a kick is refused long before it is as large as what it is added to
      text += has(GasKeys::exponent) ? "; if two bodies met or one came near the soft wall, whose kick was too large, "
                                     : "; if two bodies met, whose kick was too large, ";
      text += has("softening") ? "a smaller dt or a softening" : "a smaller dt";
    }
  }
  return text;
}

namespace {

/// What was computed is kept; here is how to look at it and how to go on.
Json error_of(const Scenario& scenario, const Simulation& simulation, const RunResult& result) {
  Frame frame;
  simulation.look(frame);
  if (!result.file_trouble.empty()) {
    return {{"kind", "file"},
            {"step", frame.step},
            {"t", frame.time},
            {"message", result.file_trouble},
            {"hint", "make room, or write elsewhere with --out; the samples up to the last flush are kept"}};
  }
  const bool says_more =
      result.outcome == Outcome::not_converged || result.outcome == Outcome::wall || result.outcome == Outcome::outside;
  const bool own_words = says_more && !result.failure.empty();
  const std::int64_t step = frame.step + 1;  // the step that could not be taken
  const std::string text = fmt::format("step {}, from t = {}: {}", step, shortest(frame.time),
                                       own_words ? cause_of(result.failure) : std::string(message(result.outcome)));
  Json error = {
      {"kind", std::string(name(result.outcome))},
      {"step", step},
      {"t", frame.time},
      {"message", text},
      {"hint", hint_for(scenario.request, differentiates_steps(scenario), result.outcome, cause_of(result.failure))}};
  if (const std::string numbers = numbers_of(result.failure); own_words && !numbers.empty()) error["details"] = numbers;
  return error;
}
}  // namespace

std::string status_of(Outcome outcome) { return is_failure(outcome) ? "failed" : std::string(name(outcome)); }

Json orbit_of(const Scenario& scenario) {
  Json facts = Json::object();
  for (const auto& [name, value] :
       scenario.problem->describe_orbit(scenario.request.parameters, scenario.start_q, scenario.start_p)) {
    std::visit([&, key = name](const auto& x) { facts[key] = x; }, value);
    if (name == "type") facts["conic"] = nullptr;  // where none follows
  }
  if (digits_beyond_double(scenario.request.arithmetic) > 0) add_orbit_digits(scenario, facts);
  return facts;
}

Json summary_of(const Scenario& scenario, const Simulation& simulation, const RunResult& result,
                const RunCertificate* certificate, const Measures* measures, const TurnWatch* turns) {
  Frame frame;
  simulation.look(frame);
  const Effort effort = simulation.effort();
  const Excursion energy = simulation.energy();
  const double scale = energy.scale();
  Json s;
  s["status"] = result.file_trouble.empty() ? status_of(result.outcome) : "failed";
  s["problem"] = scenario.request.problem;
  s["method"] = describe(scenario.request.method).name;
  s["arithmetic"] = scenario.request.arithmetic;
  s["kernel"] = scenario.request.kernel;
  if (scenario.request.kernel == "fast") s["instruction_set"] = std::string(fast_instruction_set(scenario.request));
  if (scenario.request.arithmetic == "lattice") {
    s["lattice"] = {{"position", scenario.request.position_unit}, {"momentum", scenario.request.momentum_unit}};
  }
  s["parameters"] = parameters_of(scenario);
  s["dt"] = scenario.dt;
  s["steps"] = simulation.step();
  if (!scenario.request.start.energy.empty()) s["start"] = start_of(scenario);
  s["final"] = {{"t", frame.time}, {"q", frame.q}, {"p", frame.p}};
  s["energy"] = excursion(energy);
  s["energy"]["scale"] = scale;
  s["energy"]["max_relative_error"] = energy.max_error / scale;
  // Where H is 0 at the start, or nothing but rounding, there is nothing that an error could be a part of.
  const bool is_zero = scale == 0 || (certificate != nullptr && std::isnan(certificate->energy_level.value));
  if (is_zero) s["energy"]["max_relative_error"] = energy.max_error == 0 ? Json(0.0) : Json(nullptr);
  if (scenario.map) s["energy"]["scale"] = s["energy"]["max_relative_error"] = nullptr;
  if (!frame.digits.q.empty()) {  // more digits than a JSON number may be read with: texts; errors need no more
    s["final"] = {{"t", frame.digits.time}, {"q", frame.digits.q}, {"p", frame.digits.p}};
    s["energy"]["initial"] = frame.digits.initial_energy;
    s["energy"]["final"] = frame.digits.energy;
  }
  if (scenario.hamiltonian) {  // the energy above is H less the work of the drive
    Frame start;
    start.q = scenario.start_q;
    start.p = scenario.start_p;
    s["hamiltonian"] = {{"initial", scenario.hamiltonian->expression(start)},
                        {"final", scenario.hamiltonian->expression(frame)}};
  }
  if (frame.q.size() > most_named_coordinates) {
    const bool gas = scenario.request.problem == GasKeys::problem;
    s["final"] = {{"t", s["final"]["t"]}, {"dataset", gas ? "/particles/all" : "/q, /p"}};
  }
  if (certificate != nullptr && energy.max_error == 0 && !certificate->energy_level.text.empty()) {
    // No double is so small: what the certificate found.
    const LongNumber& level = certificate->energy_level;
    s["energy"]["max_relative_error"] = level.text;
    s["energy"]["max_error"] = json_of(times(scale, level.text));
  }
  s["invariants"] = Json::object();
  const std::vector<InvariantExcursion> invariants = simulation.invariants();
  for (std::size_t i = 0; i < invariants.size(); ++i) {
    const InvariantInfo& info = scenario.problem->info.invariants[i];
    s["invariants"][info.name] = invariant_json(info, invariants[i]);
  }
  if (const auto residuals = simulation.constraints()) {
    s["constraints"] = {{"position", residuals->position}, {"velocity", residuals->velocity}};
  }
  if (describe(scenario.request.method).diagnostics) {
    s["diagnostics"] = diagnostics_of(simulation.diagnostics(), scenario.dt);
  }
  if (scenario.bodies) s["bodies"] = bodies_of(scenario, frame);
  if (scenario.problem->describe_orbit && !scenario.map) s["orbit"] = orbit_of(scenario);
  if (scenario.problem->exact && !scenario.map) {
    if (const auto exact = exact_of(scenario, frame)) s["exact"] = *exact;
  }
  s["evaluations"] = {{"force", effort.force},
                      {"gradient", effort.gradient},
                      {"hessian", effort.hessian},
                      {"linear_solves", effort.linear_solves}};
  if (describe(scenario.request.method).explicit_step) {
    s["newton"] = nullptr;
  } else {
    const double mean =
        effort.steps > 0 ? static_cast<double>(effort.linear_solves) / static_cast<double>(effort.steps) : 0;
    s["newton"] = {
        {"min", effort.solves_min}, {"mean", mean}, {"max", effort.solves_max}, {"stagnated", effort.stagnated}};
    if (const std::string iteration = chosen_iteration(scenario.request); !iteration.empty()) {
      s["newton"]["iteration"] = iteration;
    }
  }
  s["events"] = Json::object();
  const std::vector<std::string> walls = bounce_names(scenario);
  std::map<std::string, std::int64_t> together;
  for (std::size_t k = 0; const WallCount& wall : simulation.wall_counts()) {
    const std::string& name = walls.at(k++);
    s["events"][name] = together[name] += wall.bounces;
  }
  if (describe(scenario.request.method).halves_steps) s["events"]["halved"] = effort.halved;
  if (measures != nullptr) measures->add_to(s);
  s["warnings"] = warnings_of(scenario, s, simulation, turns,
                              certificate != nullptr ? certificate->typically_exchanged : std::nullopt);
  if (measures != nullptr) measures->add_warnings(s["warnings"]);
  s["certificate"] = certificate != nullptr && scenario.certificate ? certificate_json(*certificate) : Json(nullptr);
  s["wall_seconds"] = result.wall_seconds;
  s["steps_per_second"] = result.wall_seconds > 0 ? static_cast<double>(result.steps_taken) / result.wall_seconds : 0.0;
  if (s["status"] == "failed") s["error"] = error_of(scenario, simulation, result);
  return s;
}

Json invariant_json(const InvariantInfo& info, const InvariantExcursion& seen) {
  const bool one =
      info.components == Components::one || (info.components == Components::rotations && seen.initial.size() == 1);
  const auto entry = [one](const std::vector<double>& numbers, const std::vector<std::string>& digits) {
    if (digits.empty()) return one ? Json(numbers[0]) : Json(numbers);
    return one ? Json(digits[0]) : Json(digits);  // more digits than a JSON number may be read with: texts
  };
  // The largest deviation is one of those that are numbers: of what was none it says nothing.
  const auto is_number = [](double x) { return std::isfinite(x); };
  const bool known = std::all_of(seen.initial.begin(), seen.initial.end(), is_number) &&
                     std::all_of(seen.final.begin(), seen.final.end(), is_number);
  return {{"initial", entry(seen.initial, seen.initial_digits)},
          {"final", entry(seen.final, seen.final_digits)},
          {"max_error", known ? json_of(largest_error(seen)) : Json(nullptr)}};
}

std::string json_text(const Json& json) { return written_json(json, 2) + "\n"; }

}  // namespace hamflow
