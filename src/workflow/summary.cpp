#include "summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "certificate_json.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/numerics/inverse_cube.hpp"

namespace hamflow {

namespace {
using Json = nlohmann::ordered_json;

Json excursion(const Excursion& e) { return {{"initial", e.initial}, {"final", e.final}, {"max_error", e.max_error}}; }

Json parameters_of(const Scenario& scenario) {
  Json parameters = Json::object();
  for (const auto& [key, value] : scenario.problem->info.variant) parameters[key] = value;
  const Parameters<double> values(scenario.request.parameters);
  for (const ParameterInfo& parameter : scenario.problem->info.parameters) {
    if (!values.has(parameter.name)) continue;
    const std::vector<double>& list = values.list(parameter.name);
    const bool single = parameter.type == OptionType::number ||
                        (parameter.type == OptionType::number_or_list && list.size() == 1);
    parameters[parameter.name] = single && parameter.range.whole ? Json(static_cast<std::int64_t>(list[0]))
                                 : single                        ? Json(list[0])
                                                                 : Json(list);
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
  const Frame planar = to_plane ? to_plane(frame.q, frame.p) : frame;
  const auto [first, second] = scenario.bodies->at(frame.time, {planar.q[0], planar.q[1]}, {planar.p[0], planar.p[1]});
  Json all = Json::array();
  for (const Body& body : {first, second}) {
    all.push_back({{"mass", body.mass},
                   {"position", std::vector<double>(body.position.begin(), body.position.end())},
                   {"velocity", std::vector<double>(body.velocity.begin(), body.velocity.end())}});
  }
  return all;
}

/// What the effective potential tells of the start.
Json orbit_of(const Scenario& scenario) {
  Json facts = Json::object();
  for (const auto& [name, value] :
       scenario.problem->describe_orbit(scenario.request.parameters, scenario.start_q, scenario.start_p)) {
    std::visit([&, key = name](const auto& x) { facts[key] = x; }, value);
  }
  return facts;
}

/// The exact state at the time reached, and how far the run is from it, coordinate by coordinate at most.
std::optional<Json> exact_of(const Scenario& scenario, const Frame& frame) {
  auto exact = scenario.problem->exact(scenario.request.parameters, scenario.start_q, scenario.start_p, frame.time);
  if (!exact) return std::nullopt;
  const auto& coordinates = scenario.problem->info.coordinates;
  double distance = 0;
  for (std::size_t i = 0; i < frame.q.size(); ++i) {
    if (i < coordinates.size() && coordinates[i] == "phi") {  // known up to whole turns: the nearest is meant
      exact->q[i] += 2 * pi_value<double>() * std::round((frame.q[i] - exact->q[i]) / (2 * pi_value<double>()));
    }
    distance = std::max({distance, std::abs(frame.q[i] - exact->q[i]), std::abs(frame.p[i] - exact->p[i])});
  }
  return Json{{"q", exact->q}, {"p", exact->p}, {"max_difference", distance}};
}

/// The hint of the outcome, and what method and problem add to it.
std::string hint_for(const Request& request, Outcome outcome) {
  if (outcome == Outcome::not_converged) return hint_after_divergence(request.method);
  std::string text(hint(outcome));
  if (outcome == Outcome::lattice_overflow) {
    text += fmt::format(", e.g. {{ position = \"2^{}\", momentum = \"2^{}\" }}", std::ilogb(request.position_unit) + 8,
                        std::ilogb(request.momentum_unit) + 8);
    if (find_problem(request.problem, request.variant).has_pairwise_forces) {
      text += "; if two bodies met, a smaller dt or a softening";
    }
  }
  return text;
}

/// What was computed is kept; here is how to look at it and how to go on.
Json error_of(const Request& request, const Simulation& simulation, const RunResult& result) {
  Frame frame;
  simulation.look(frame);
  if (!result.file_trouble.empty()) {
    return {{"kind", "file"},
            {"step", frame.step},
            {"t", frame.time},
            {"message", result.file_trouble},
            {"hint", "make room, or write elsewhere with --out; the samples up to the last flush are kept"}};
  }
  const bool own_words = result.outcome == Outcome::not_converged && !result.failure.empty();
  const std::int64_t step = frame.step + 1;  // the step that could not be taken
  const std::string text = fmt::format("step {}, from t = {}: {}", step, shortest(frame.time),
                                       own_words ? result.failure : std::string(message(result.outcome)));
  return {{"kind", std::string(name(result.outcome))},
          {"step", step},
          {"t", frame.time},
          {"message", text},
          {"hint", hint_for(request, result.outcome)}};
}
}  // namespace

std::string status_of(Outcome outcome) { return is_failure(outcome) ? "failed" : std::string(name(outcome)); }

Json summary_of(const Scenario& scenario, const Simulation& simulation, const RunResult& result,
                const RunCertificate* certificate) {
  Frame frame;
  simulation.look(frame);
  const Effort effort = simulation.effort();
  const Excursion energy = simulation.energy();
  const double scale = simulation.energy_scale();
  Json s;
  s["status"] = result.file_trouble.empty() ? status_of(result.outcome) : "failed";
  s["problem"] = scenario.request.problem;
  s["method"] = describe(scenario.request.method).name;
  s["arithmetic"] = scenario.request.arithmetic;
  s["kernel"] = scenario.request.kernel;
  if (scenario.request.kernel == "fast") s["instruction_set"] = std::string(name(fast_kernel_instruction_set()));
  if (scenario.request.arithmetic == "lattice") {
    s["lattice"] = {{"position", scenario.request.position_unit}, {"momentum", scenario.request.momentum_unit}};
  }
  s["parameters"] = parameters_of(scenario);
  s["dt"] = scenario.dt;
  s["steps"] = simulation.step();
  s["final"] = {{"t", frame.time}, {"q", frame.q}, {"p", frame.p}};
  s["energy"] = excursion(energy);
  s["energy"]["scale"] = scale;
  s["energy"]["max_relative_error"] = scale > 0 ? energy.max_error / scale : energy.max_error;
  if (!frame.digits.q.empty()) {  // more digits than a JSON number may be read with: texts; errors need no more
    s["final"] = {{"t", frame.digits.time}, {"q", frame.digits.q}, {"p", frame.digits.p}};
    s["energy"]["initial"] = frame.digits.initial_energy;
    s["energy"]["final"] = frame.digits.energy;
  }
  s["invariants"] = Json::object();
  const std::vector<InvariantExcursion> invariants = simulation.invariants();
  for (std::size_t i = 0; i < invariants.size(); ++i) {
    const InvariantInfo& info = scenario.problem->info.invariants[i];
    const bool one = info.components == Components::one ||
                     (info.components == Components::rotations && invariants[i].initial.size() == 1);
    s["invariants"][info.name] = {{"initial", one ? Json(invariants[i].initial[0]) : Json(invariants[i].initial)},
                                  {"final", one ? Json(invariants[i].final[0]) : Json(invariants[i].final)},
                                  {"max_error", invariants[i].max_error}};
  }
  if (describe(scenario.request.method).diagnostics) {
    s["diagnostics"] = diagnostics_of(simulation.diagnostics(), scenario.dt);
  }
  if (scenario.bodies) s["bodies"] = bodies_of(scenario, frame);
  if (scenario.problem->describe_orbit) s["orbit"] = orbit_of(scenario);
  if (scenario.problem->exact) {
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
  }
  s["events"] = Json::object();
  if (effort.halved > 0) s["events"]["halved"] = effort.halved;
  for (const auto& [key, value] : result.measures.items()) s[key] = value;
  s["certificate"] = certificate != nullptr ? certificate_json(*certificate) : Json(nullptr);
  s["wall_seconds"] = result.wall_seconds;
  s["steps_per_second"] = result.wall_seconds > 0 ? static_cast<double>(result.steps_taken) / result.wall_seconds : 0.0;
  if (s["status"] == "failed") s["error"] = error_of(scenario.request, simulation, result);
  return s;
}

Json rejection_of(const std::vector<Complaint>& complaints) {
  Json errors = Json::array();
  for (const Complaint& c : complaints) {
    errors.push_back({{"file", c.file}, {"line", c.line}, {"column", c.column}, {"key", c.key}, {"message", c.text()}});
  }
  return {{"status", "rejected"}, {"errors", errors}};
}

std::string json_text(const Json& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

namespace {
std::string orbit_text(const Json& orbit) {
  std::string text = orbit["type"].get<std::string>();
  if (orbit.contains("conic")) text += " (" + orbit["conic"].get<std::string>() + ")";
  text += fmt::format(", r = {:.6g} .. {:.6g}, apsidal angle {:.6g}", orbit["r_min"].get<double>(),
                      orbit["r_max"].get<double>(), orbit["apsidal_angle"].get<double>());
  if (orbit["falls_into_centre"].get<bool>()) text += ", falls into the centre";
  return text;
}
}  // namespace

namespace {
std::string shown_number(const Json& x, const char* form) {
  return x.is_null() || std::isnan(x.get<double>()) ? std::string("nan")
                                                    : fmt::format(fmt::runtime(form), x.get<double>());
}

/// The largest of some numbers, without sign.
double largest_of(const Json& xs) {
  double largest = 0;
  for (const Json& x : xs) largest = x.is_null() ? largest : std::max(largest, std::abs(x.get<double>()));
  return largest;
}

std::string lyapunov_text(const Json& found) {
  constexpr std::size_t most_shown = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(found["exponents"].size(), most_shown); ++i) {
    text += (i > 0 ? ", " : "") + shown_number(found["exponents"][i], "{:.6g}") + " +- " +
            shown_number(found["standard_errors"][i], "{:.2g}");
  }
  if (found["exponents"].size() > most_shown) text += ", ...";
  if (!found["pair_sums"].empty()) text += fmt::format("; pairs sum to at most {:.2g}", largest_of(found["pair_sums"]));
  return text;
}

std::string eigenvalues_text(const Json& found) {
  if (found["values"].is_null()) return found["message"].get<std::string>();
  constexpr std::size_t most_shown = 6;
  std::string text;
  for (std::size_t i = 0; i < std::min(found["values"].size(), most_shown); ++i) {
    const double imaginary = found["values"][i][1].get<double>();
    text += (i > 0 ? ", " : "") + fmt::format("{:.6g}", found["values"][i][0].get<double>()) +
            (imaginary != 0 ? fmt::format("{:+.6g}i", imaginary) : "");
  }
  if (found["values"].size() > most_shown) text += ", ...";
  return text + fmt::format("; products of pairs {:.2g} off 1, {:.2g} off symplectic",
                            found["pair_defect"].get<double>(), found["symplectic_defect"].get<double>());
}
}  // namespace

std::string readable(const Json& s) {
  const auto row = [](std::string_view label, const std::string& text) {
    return fmt::format("{:<20}{}\n", label, text);
  };
  const auto number = [](const Json& x) {
    if (x.is_string()) return x.get<std::string>();
    return x.is_null() ? std::string("nan") : fmt::format("{:.17g}", x.get<double>());
  };
  const auto list = [&](const Json& xs) { return joined(xs, number); };
  const auto shown = [&](const Json& x) { return x.is_array() ? "[" + list(x) + "]" : number(x); };
  const auto watched = [&](const Json& x) {
    return fmt::format("{} -> {}, at most {:.3g} off", shown(x["initial"]), shown(x["final"]),
                       x["max_error"].is_null() ? 0.0 : x["max_error"].get<double>());
  };
  std::string text = row("status", s["status"].get<std::string>());
  text += row("problem", s["problem"].get<std::string>());
  text += row("method", fmt::format("{}, dt = {:g}, {} arithmetic", s["method"].get<std::string>(),
                                    s["dt"].get<double>(), s["arithmetic"].get<std::string>()));
  text += row("steps", fmt::format("{}, t = {}", s["steps"].get<std::int64_t>(), number(s["final"]["t"])));
  text += row("final q", list(s["final"]["q"]));
  text += row("final p", list(s["final"]["p"]));
  text += row("energy", watched(s["energy"]) + fmt::format(" ({:.3g} of its scale)",
                                                           s["energy"]["max_relative_error"].is_null()
                                                               ? 0.0
                                                               : s["energy"]["max_relative_error"].get<double>()));
  for (const auto& [key, watch] : s["invariants"].items()) text += row(key, watched(watch));
  if (s.contains("exact")) {
    text += row("exact", fmt::format("at most {:.3g} off the exact state", s["exact"]["max_difference"].get<double>()));
  }
  if (s.contains("orbit")) text += row("orbit", orbit_text(s["orbit"]));
  if (s.contains("bodies")) {
    for (const Json& body : s["bodies"]) {
      text += row("body", fmt::format("mass {}, at [{}], velocity [{}]", number(body["mass"]), list(body["position"]),
                                      list(body["velocity"])));
    }
  }
  if (s.contains("diagnostics")) {
    for (const auto& [key, x] : s["diagnostics"].items()) {
      if (x.is_null()) continue;
      text += row(key == "condition_inverse_mass" ? "condition_M^-1" : key,
                  fmt::format("{:.6g} (t = {:g}) .. {:.6g} (t = {:g})", x["min"].get<double>(),
                              x["t_min"].get<double>(), x["max"].get<double>(), x["t_max"].get<double>()));
    }
  }
  text +=
      row("evaluations",
          fmt::format("force {}, gradient {}, Hessian {}, linear solves {}", s["evaluations"]["force"].get<long long>(),
                      s["evaluations"]["gradient"].get<long long>(), s["evaluations"]["hessian"].get<long long>(),
                      s["evaluations"]["linear_solves"].get<long long>()));
  if (!s["newton"].is_null()) {
    text += row("Newton per step",
                fmt::format("min {}, mean {:.4g}, max {}, stagnated {}", s["newton"]["min"].get<long long>(),
                            s["newton"]["mean"].get<double>(), s["newton"]["max"].get<long long>(),
                            s["newton"]["stagnated"].get<long long>()));
  }
  for (const auto& [key, value] : s["events"].items()) text += row("event " + key, value.dump());
  if (s.contains("lyapunov")) text += row("Lyapunov exponents", lyapunov_text(s["lyapunov"]));
  if (s.contains("eigenvalues")) text += row("eigenvalues", eigenvalues_text(s["eigenvalues"]));
  if (s.contains("section")) {
    text += row("section", fmt::format("{} points, at most {:.2g} off it", s["section"]["points"].get<std::int64_t>(),
                                       s["section"]["max_residual"].get<double>()));
  }
  if (s.contains("certificate") && !s["certificate"].is_null()) {
    text += row("certificate", certificate_text(s["certificate"]));
  }
  text += row("wall time", fmt::format("{:.3g} s, {:.4g} steps/s", s["wall_seconds"].get<double>(),
                                       s["steps_per_second"].get<double>()));
  return text;
}

}  // namespace hamflow
