#include "summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <variant>

#include "bounce_names.hpp"
#include "core/text_place.hpp"
#include "element_columns.hpp"
#include "engine/large_steps.hpp"
#include "engine/planetary_steps.hpp"
#include "engine/wall_failures.hpp"
#include "gas/container.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/detail/run/fitting_methods.hpp"
#include "hamflow/detail/verify/state_units.hpp"
#include "hamflow/formula/problem_texts.hpp"
#include "hamflow/methods/step_control.hpp"
#include "hamflow/run/gas.hpp"
#include "hamflow/run/walls.hpp"
#include "measures/measures.hpp"
#include "number_text.hpp"
#include "orbit_digits.hpp"
#include "run_description.hpp"
#include "run_keys.hpp"
#include "warnings.hpp"

namespace hamflow {

namespace {

/// Sets the value with this name, or appends it if there is none.
void set(Value::Table& table, const std::string& name, Value value) {
  const auto found = std::find_if(table.begin(), table.end(), [&](const auto& each) { return each.first == name; });
  if (found == table.end()) {
    table.emplace_back(name, std::move(value));
  } else {
    found->second = std::move(value);
  }
}

/// @param exponent key of the exponent of the walls
void add_walls(const Walls& walls, const std::string& exponent, Value::Table& parameters) {
  const WallKeys& keys = wall_keys();
  Value::List all;
  for (const Walls::Interval& wall : walls.intervals) {
    Value::Table interval{{keys.coordinate.name, wall.coordinate}};
    if (!wall.min.empty()) set(interval, keys.min.name, number_value(wall.min));
    if (!wall.max.empty()) set(interval, keys.max.name, number_value(wall.max));
    all.emplace_back(std::move(interval));
  }
  set(parameters, keys.walls.name, std::move(all));
  set(parameters, keys.wall_rule.name, wall_rules()[static_cast<std::size_t>(walls.rule)]);
  if (walls.hard()) return;
  set(parameters, keys.strength.name, number_value(walls.strength));
  set(parameters, exponent, number_value(walls.exponent));
}

bool has_parameter(const ProblemEntry& problem, const std::string& name) {
  const std::vector<ParameterInfo>& all = problem.info.parameters;
  return std::any_of(all.begin(), all.end(), [&](const ParameterInfo& parameter) { return parameter.name == name; });
}

Value::Table parameters_of(const Scenario& scenario) {
  Value::Table parameters;
  const std::optional<FormulaStructure>& structure = scenario.problem->structure;
  const auto is_free = [](const std::string& key) { return is_free_on_resume("problem." + key); };
  for (const auto& [key, value] : scenario.problem->info.variant) {
    if (is_free(key)) continue;
    // The choices of the problem `formula` are formulas, which are in the scenario. The parameters follow below.
    if (has_typed_hamiltonian(*scenario.problem) || key == FormulaKeys::parameters) continue;
    const bool is_number = !value.empty() && std::all_of(value.begin(), value.end(), is_digit);  // as in dimension = 3
    set(parameters, key, is_number ? Value(std::stoi(value)) : Value(value));
  }
  if (const auto& walls = scenario.request.walls) {
    if (scenario.problem->container == ContainerNames::box) {
      // The parameters of the box define the walls.
      set(parameters, wall_keys().wall_rule.name, wall_rules()[static_cast<std::size_t>(walls->rule)]);
    } else {
      // A gas in a soft circle already has an exponent, that of its container.
      const std::string& exponent = wall_keys().exponent.name;
      add_walls(*walls, has_parameter(*scenario.problem, exponent) ? "wall_" + exponent : exponent, parameters);
    }
  }
  const Parameters<double> values(scenario.request.parameters);
  for (const ParameterInfo& parameter : scenario.problem->info.parameters) {
    if (!values.has(parameter.name) || is_free(parameter.name)) continue;
    const std::vector<double>& list = values.list(parameter.name);
    const bool single =
        parameter.type == OptionType::number || (parameter.type == OptionType::number_or_list && list.size() == 1);
    set(parameters, parameter.name,
        single && parameter.range.whole ? Value(static_cast<std::int64_t>(list[0]))
        : single                        ? Value(list[0])
                                        : Value(list));
  }
  if (!scenario.problem->info.frame.name.empty()) {
    set(parameters, scenario.problem->info.frame.name,
        scenario.request.start.barycentric ? StartFrames::barycentric : StartFrames::given);
  }
  if (structure) {
    set(parameters, "structure",
        Value::Table{{"separable", structure->separable},
                     {"quadratic_kinetic", structure->quadratic_kinetic},
                     {"time", structure->time}});
  }
  return parameters;
}

/// Returns the smallest and the largest value of each quantity over all steps, with the times at the ends of those
/// steps.
DiagnosticsSummary diagnostics_of(const StepDiagnostics& d, double dt) {
  const auto range = [&](const StepDiagnostics::Extremes& e) -> std::optional<DiagnosticRange> {
    if (!(e.least <= e.most)) return std::nullopt;  // no step yet
    return DiagnosticRange{e.least, static_cast<double>(e.step_of_least) * dt, e.most,
                           static_cast<double>(e.step_of_most) * dt};
  };
  return {range(d.of_condition_tangent), range(d.of_determinant_tangent), range(d.of_condition_inverse_mass)};
}

/// Returns the two bodies in space, computed from the planar state.
std::vector<Body> bodies_of(const Scenario& scenario, const Frame& frame) {
  const auto& to_plane = scenario.problem->to_reference;
  const Frame planar = to_plane ? to_plane(scenario.request.parameters, frame.q, frame.p) : frame;
  const auto [first, second] = scenario.bodies->at(frame.time, {planar.q[0], planar.q[1]}, {planar.p[0], planar.p[1]});
  return {first, second};
}

Value::Table elements_summary(const Scenario& scenario, const Frame& frame) {
  const auto elements = elements_at(scenario, frame);
  Value::Table all;
  for (const std::size_t body : bodies_with_elements(scenario)) {
    Value::Table of_body;
    for (const ElementColumn& column : element_columns()) {
      of_body.emplace_back(column.name, (*elements[body]).*column.value);
    }
    all.emplace_back(body_name(scenario, body), std::move(of_body));
  }
  return all;
}

/// Returns the start that was computed from an energy, in the digits of the run.
StateSummary start_of(const Scenario& scenario) {
  if (digits_beyond_double(scenario.request.arithmetic) == 0) return {scenario.start_q, scenario.start_p};
  Frame frame;
  make_simulation(scenario.request)->look(frame);
  return {frame.q, frame.p, frame.digits};
}

/// Adds whole turns to phi, so that it is as near as possible to another value. Other coordinates are not changed.
double next_to(double other, const Scenario& scenario, std::size_t i, double x) {
  const double turn = 2 * pi_value<double>();
  const auto& coordinates = scenario.problem->info.coordinates;
  return i < coordinates.size() && coordinates[i] == "phi" ? x + turn * std::round((other - x) / turn) : x;
}

/// Returns copies of the parameters, in each of which one number is moved by one unit in the last place.
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
        continue;  // it is a word
      }
      all.push_back(parameters);
      all.back()[name] = is_list ? "[" + joined(parts) + "]" : part;
      part = kept;
    }
  }
  return all;
}

/// Bounds the error of the closed form, computed in double, for a run with more digits: one bound for each group of
/// numbers with the same unit. The bound adds the changes by one rounding of each parameter, of the start, of the time
/// and of the result.
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
  // If the exact state is unknown one rounding away, its uncertainty is unknown.
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
    // There is no closed form for a moved exponent. But exponents are exact, so they contribute nothing.
    add(parameters, scenario.start_q, scenario.start_p, t, 0);
  }
  return sum;
}

/// Returns the sizes of q and p along the exact motion until a time. If all numbers of a kind are 0 at both ends, two
/// times in between are added, chosen so that an oscillation with zeros at both ends is not zero there.
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

/// Returns the exact state at the time reached, and the distance of the run from it for each group of numbers with one
/// unit. The closed form is computed in double; for a run with more digits its uncertainty is added.
std::optional<ExactSummary> exact_of(const Scenario& scenario, const Frame& frame) {
  auto exact = scenario.problem->exact(scenario.request.parameters, scenario.start_q, scenario.start_p, frame.time);
  if (!exact) return std::nullopt;
  Frame reached;  // rounded to double
  reached.q = frame.q;
  reached.p = frame.p;
  for (std::size_t i = 0; i < frame.q.size(); ++i) exact->q[i] = next_to(frame.q[i], scenario, i, exact->q[i]);
  const UnitGroups groups = unit_groups(*scenario.problem, frame.q.size());
  const std::vector<GroupDistance> distances =
      group_distances(groups, sizes_of_exact(scenario, *exact), reached, *exact);
  std::size_t furthest = 0;  // group with the largest relative distance
  Named<double> differences;
  for (std::size_t g = 0; g < distances.size(); ++g) {
    differences.emplace_back(distances[g].name, distances[g].distance.value);
    if (!(distances[g].relative.value <= distances[furthest].relative.value)) furthest = g;
  }
  ExactSummary found{.q = exact->q,
                     .p = exact->p,
                     .max_difference = distances[furthest].distance.value,
                     .relative_difference = distances[furthest].relative.value,
                     .differences = std::move(differences),
                     .uncertainty = {}};
  if (frame.digits.q.empty()) return found;
  const std::vector<double> uncertainty = uncertainty_of_exact(scenario, frame.time, *exact, groups);
  for (const double x : uncertainty) {
    if (!std::isfinite(x)) return std::nullopt;
  }
  found.uncertainty = uncertainty[furthest];
  return found;
}

}  // namespace

/// Returns the iteration that was chosen automatically; empty if it was requested or is newton.
static std::string chosen_iteration(const Request& request) {
  const MethodSpec taken = method_taken(request);
  return taken.options == request.method.options ? "" : taken.options.at("iteration");
}

std::string hint_for(const Request& request, bool differentiated, Outcome outcome, std::string_view failure) {
  if (outcome == Outcome::wall && failure.ends_with(no_other_momentum)) {
    return "a smaller dt does not help: H = E has only one root in this momentum, so a hard wall cannot reflect it; "
           "use an H with two roots, such as p^2/2, or remove the wall";
  }
  if (outcome == Outcome::not_converged) {
    const std::string solved = hint_after_divergence(request, differentiated);
    const MethodInfo method = describe(request.method);
    if (!method.varies_steps) return solved;
    // Steps of varying size also fail in this way if their density is no longer positive. Then no iteration failed to
    // converge.
    const auto problem_entry = find_problem(request);
    const ProblemEntry& problem = *problem_entry;
    const auto monitor = request.method.options.find(monitor_option);
    const bool follows_distance = monitor != request.method.options.end() && monitor->second == distance_monitor_name;
    const std::string other = problem.has_distance && !follows_distance
                                  ? fmt::format(" or method.{} = \"{}\"", monitor_option, distance_monitor_name)
                                  : "";
    const std::string of_density = "try a smaller dt" + other;
    return method.explicit_step
               ? of_density
               : "if the density of steps failed, " + of_density + "; if a step was not solved, " + solved;
  }
  std::string text(hint(outcome));
  if (outcome == Outcome::lattice_overflow) {
    text += fmt::format(", e.g. {{ position = \"2^{}\", momentum = \"2^{}\" }}", std::ilogb(request.position_unit) + 8,
                        std::ilogb(request.momentum_unit) + 8);
    const auto problem_entry = find_problem(request);
    const ProblemEntry& problem = *problem_entry;
    const auto has = [&](const char* name) {
      return std::any_of(problem.info.parameters.begin(), problem.info.parameters.end(),
                         [&](const ParameterInfo& each) { return each.name == name; });
    };
    if (problem.has_pairwise_forces) {  // a kick overflows long before it is as large as the momentum
      text += problem.container == ContainerNames::circle
                  ? "; if two bodies, or a body and the soft wall, came too close, try "
                  : "; if two bodies came too close, try ";
      text += has("softening") ? "a smaller dt or a softening" : "a smaller dt";
    }
  }
  return text;
}

/// Returns the error of a failed run, with a hint how to look at the results and how to continue.
RunError error_of(const Scenario& scenario, const Simulation& simulation, const RunResult& result) {
  Frame frame;
  simulation.look(frame);
  if (!result.file_error.empty()) {
    return {"file",
            frame.step,
            frame.time,
            result.file_error,
            "free disk space, or choose another folder with " + option_name("out") +
                "; samples written before the failure are kept",
            {}};
  }
  if (!result.client_error.empty()) {
    return {"client",
            frame.step + 1,
            frame.time,
            fmt::format("step {}, from t = {}: {}", frame.step + 1, shortest(frame.time), result.client_error),
            "start the client again, and continue from the step before with " + option_name("resume"),
            {}};
  }
  const bool says_more =
      result.outcome == Outcome::not_converged || result.outcome == Outcome::wall || result.outcome == Outcome::outside;
  const bool has_message = says_more && !result.failure.empty();
  const std::int64_t step = frame.step + 1;
  return {std::string(name(result.outcome)),
          step,
          frame.time,
          fmt::format("step {}, from t = {}: {}", step, shortest(frame.time),
                      has_message ? cause_of(result.failure) : std::string(message(result.outcome))),
          hint_for(scenario.request, differentiates_steps(scenario), result.outcome, cause_of(result.failure)),
          has_message ? numbers_of(result.failure) : std::string()};
}

std::string status_of(Outcome outcome) { return is_failure(outcome) ? "failed" : std::string(name(outcome)); }

OrbitSummary orbit_of(const Scenario& scenario) {
  const OrbitFacts facts =
      scenario.problem->describe_orbit(scenario.request.parameters, scenario.start_q, scenario.start_p);
  const auto take = [&]<class T>(std::string_view name, T& x) {
    for (const auto& [key, value] : facts) {
      const T* const found = key == name ? std::get_if<T>(&value) : nullptr;
      if (found == nullptr) continue;
      x = *found;
      return true;
    }
    return false;
  };
  OrbitSummary orbit;
  take("type", orbit.type);
  take("conic", orbit.conic);
  take("r_min", orbit.r_min.value);
  take("r_max", orbit.r_max.value);
  take("circular_radius", orbit.circular_radius.value);
  if (bool stable = false; take("circular_stable", stable)) orbit.circular_stable = stable;
  take("apsidal_angle", orbit.apsidal_angle.value);
  take("radial_period", orbit.radial_period.value);
  take("closed", orbit.closed);
  take("revolutions", orbit.revolutions);
  take("radial_periods", orbit.radial_periods);
  take("falls_into_centre", orbit.falls_into_centre);
  if (digits_beyond_double(scenario.request.arithmetic) > 0) add_orbit_digits(scenario, orbit);
  return orbit;
}

StateAtTime state_at(double t, std::vector<double> q, std::vector<double> p, FrameDigits digits) {
  return {{std::move(q), std::move(p), std::move(digits)}, t};
}

StopSummary stop_summary(const std::string& name, const MemberStop& stop) {
  return {state_at(stop.t, stop.q, stop.p, stop.digits), name};
}

InvariantSummary invariant_summary(const InvariantInfo& info, InvariantExcursion seen) {
  const bool one =
      info.components == Components::one || (info.components == Components::rotations && seen.initial.size() == 1);
  return {info.name, !one, std::move(seen)};
}

std::optional<LongNumber> InvariantSummary::max_error() const {
  // The largest deviation ignores values that are not finite, so it is unknown if there were any.
  const auto is_number = [](double x) { return std::isfinite(x); };
  const bool known = std::ranges::all_of(seen.initial, is_number) && std::ranges::all_of(seen.final, is_number);
  return known ? std::optional(largest_error(seen)) : std::nullopt;
}

static EnergySummary energy_of(const Scenario& scenario, const Excursion& seen, const FrameDigits& digits,
                               const RunCertificate* certificate) {
  const double scale = seen.scale();
  EnergySummary energy{with_digits(seen.initial, digits.initial_energy), with_digits(seen.final, digits.energy),
                       seen.max_error, scale, LongNumber(seen.max_error / scale)};
  // If H is 0 at the start, or only rounding, there is no scale for a relative error.
  const bool is_zero = scale == 0 || (certificate != nullptr && std::isnan(certificate->energy_level.value));
  if (is_zero) energy.max_relative_error = seen.max_error == 0 ? std::optional(LongNumber(0)) : std::nullopt;
  if (scenario.map) {
    energy.scale = std::nullopt;
    energy.max_relative_error = std::nullopt;
  }
  if (certificate != nullptr && seen.max_error == 0 && !certificate->energy_level.text.empty()) {
    // The error is below the smallest double, so the text from the certificate is used.
    energy.max_relative_error = certificate->energy_level;
    energy.max_error = times(scale, certificate->energy_level.text);
  }
  return energy;
}

Summary summary_of(const Scenario& scenario, const Simulation& simulation, const RunResult& result,
                   const RunCertificate* certificate, const Measures* measures, const TurningPointObserver* turns) {
  const Request& request = scenario.request;
  const ProblemEntry& problem = *scenario.problem;
  const MethodInfo method = describe(request.method);
  Frame frame;
  simulation.look(frame);
  Summary s;
  s.status = result.file_error.empty() && result.client_error.empty() ? status_of(result.outcome) : "failed";
  s.problem = request.problem;
  s.method = method.name;
  s.arithmetic = request.arithmetic;
  if (request.arithmetic == "lattice") s.lattice = {request.position_unit, request.momentum_unit};
  s.parameters = parameters_of(scenario);
  s.dt = scenario.dt;
  s.steps = simulation.step();
  if (!request.start.energy.empty()) s.start = start_of(scenario);
  s.energy = energy_of(scenario, simulation.energy(), frame.digits, certificate);
  const auto* const planets = dynamic_cast<const PlanetarySteps*>(&simulation);
  if (planets != nullptr && !planets->watches_every_step()) s.energy.of = "recorded states";
  if (scenario.hamiltonian) {  // the energy above is H minus the work of the drive
    Frame start;
    start.q = scenario.start_q;
    start.p = scenario.start_p;
    s.hamiltonian = {scenario.hamiltonian->expression(start), scenario.hamiltonian->expression(frame)};
  }
  s.final.is_large = frame.q.size() > most_named_coordinates;
  if (s.final.is_large) {
    s.final.t = frame.time;
    s.final.digits.time = frame.digits.time;
    s.final.dataset = problem.particles ? "/particles/all" : "/q, /p";
  } else {
    s.final = state_at(frame.time, frame.q, frame.p, frame.digits);
  }
  for (std::size_t i = 0; InvariantExcursion & seen : simulation.invariants()) {
    s.invariants.push_back(invariant_summary(problem.info.invariants[i++], std::move(seen)));
  }
  s.constraints = simulation.constraints();
  if (method.diagnostics) s.diagnostics = diagnostics_of(simulation.diagnostics(), scenario.dt);
  if (scenario.bodies) s.bodies = bodies_of(scenario, frame);
  if (scenario.elements) s.elements = elements_summary(scenario, frame);
  if (problem.describe_orbit && !scenario.map) s.orbit = orbit_of(scenario);
  if (problem.exact && !scenario.map) s.exact = exact_of(scenario, frame);
  s.effort = simulation.effort();
  if (!method.explicit_step) {
    const double mean =
        s.effort.steps > 0 ? static_cast<double>(s.effort.linear_solves) / static_cast<double>(s.effort.steps) : 0;
    s.newton = {s.effort.solves_min, mean, s.effort.solves_max, s.effort.stagnated, chosen_iteration(request)};
  }
  const std::vector<std::string> walls = bounce_names(scenario);
  for (std::size_t k = 0; const WallCount& wall : simulation.wall_counts()) {  // walls with one name share a count
    const std::string& name = walls.at(k++);
    const auto found = std::ranges::find(s.events, name, &std::pair<std::string, std::int64_t>::first);
    (found != s.events.end() ? found->second : s.events.emplace_back(name, 0).second) += wall.bounces;
  }
  if (method.halves_steps) s.events.emplace_back("halved", s.effort.halved);
  if (measures != nullptr) measures->add_to(s);
  s.warnings = warnings_of(scenario, s, simulation, turns,
                           certificate != nullptr ? certificate->typically_exchanged : std::nullopt);
  if (measures != nullptr) measures->add_warnings(s.warnings);
  if (certificate != nullptr && scenario.certificate) s.certificate = *certificate;
  s.wall_seconds = result.wall_seconds;
  s.steps_per_second = result.wall_seconds > 0 ? static_cast<double>(result.steps_taken) / result.wall_seconds : 0.0;
  if (s.status == "failed") s.error = error_of(scenario, simulation, result);
  return s;
}

}  // namespace hamflow
