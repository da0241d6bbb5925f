#include "bits_cases.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <set>
#include <sstream>

#include "../support/measured_request.hpp"
#include "../support/member_family.hpp"
#include "../support/walled_request.hpp"
#include "hamflow/hamflow.hpp"

namespace hamflow::test {
namespace {

/// Lines of names and numbers. Doubles are hexadecimal, with the decimal value beside them.
class Lines {
 public:
  void add(const std::string& name, double x) {
    char text[64];
    if (std::isnan(x)) {
      std::snprintf(text, sizeof text, "nan");  // its sign is no result
    } else {
      std::snprintf(text, sizeof text, "%a  %.17g", x, x);
    }
    add(name, std::string(text));
  }
  void add(const std::string& name, long long n) { add(name, std::to_string(n)); }
  void add(const std::string& name, const std::string& text) {
    if (!text.empty()) all_ += name + " " + text + "\n";
  }
  void add(const std::string& name, std::span<const double> numbers) {
    for (std::size_t i = 0; i < numbers.size(); ++i) add(name + "[" + std::to_string(i) + "]", numbers[i]);
  }
  void add(const std::string& name, std::span<const std::string> texts) {
    for (std::size_t i = 0; i < texts.size(); ++i) add(name + "[" + std::to_string(i) + "]", texts[i]);
  }
  std::string text() const { return all_; }

 private:
  std::string all_;
};

void add_invariants(Lines& lines, const std::vector<InvariantExcursion>& invariants) {
  for (const InvariantExcursion& invariant : invariants) {
    lines.add("invariant.final", invariant.final);
    lines.add("invariant.max_error", invariant.max_error);
  }
}

void add_effort(Lines& lines, const Effort& effort) {
  lines.add("evaluations.force", effort.force);
  lines.add("evaluations.gradient", effort.gradient);
  lines.add("evaluations.hessian", effort.hessian);
  lines.add("linear_solves", effort.linear_solves);
  lines.add("implicit_steps", effort.steps);
  lines.add("solves_min", effort.solves_min);
  lines.add("solves_max", effort.solves_max);
  lines.add("stagnated", effort.stagnated);
  lines.add("halved", effort.halved);
}

void add_frame(Lines& lines, const Frame& frame) {
  lines.add("step", static_cast<long long>(frame.step));
  lines.add("time", frame.time);
  lines.add("q", frame.q);
  lines.add("p", frame.p);
  lines.add("digits.time", frame.digits.time);
  lines.add("digits.q", frame.digits.q);
  lines.add("digits.p", frame.digits.p);
  lines.add("digits.energy", frame.digits.energy);
}

std::string hexadecimal(std::span<const std::byte> bytes) {
  std::string text;
  char two[3];
  for (const std::byte b : bytes) {
    std::snprintf(two, sizeof two, "%02x", static_cast<unsigned>(b));
    text += two;
  }
  return text;
}

std::string numbers_of(const Simulation& simulation, Outcome outcome) {
  Lines lines;
  lines.add("outcome", std::string(name(outcome)));
  Frame frame;
  simulation.look(frame);
  add_frame(lines, frame);
  lines.add("bits", hexadecimal(simulation.bits()));
  const Excursion energy = simulation.energy();
  lines.add("energy.initial", energy.initial);
  lines.add("energy.final", energy.final);
  lines.add("energy.max_error", energy.max_error);
  lines.add("energy.scale", energy.scale());
  add_invariants(lines, simulation.invariants());
  if (const auto residuals = simulation.constraints()) {
    lines.add("residual.position", residuals->position);
    lines.add("residual.velocity", residuals->velocity);
  }
  add_effort(lines, simulation.effort());
  for (const WallCount& wall : simulation.wall_counts()) {
    lines.add("bounces[" + std::to_string(wall.coordinate) + "," + std::to_string(wall.side) + "]",
              static_cast<long long>(wall.bounces));
  }
  return lines.text();
}

/// The numbers, or the kind of error where the request is refused. What a message says is no matter of bits.
std::string or_refusal(const Maker& numbers) {
  try {
    return numbers();
  } catch (const Rejection& rejection) {
    std::string keys;
    for (const Complaint& complaint : rejection.complaints) keys += " " + complaint.key;
    return "refused: Rejection" + keys + "\n";
  } catch (const NoStart&) {
    return "refused: NoStart\n";
  } catch (const Error&) {
    return "refused: Error\n";
  }
}

enum class Split { none, calls, restored };

/// The whole run in one call, in three calls, or saved and restored in another simulation after a part of it.
std::string numbers_of(const Request& request, std::int64_t steps, Split split = Split::none) {
  return or_refusal([&] {
    auto simulation = make_simulation(request);
    const std::int64_t first = split == Split::none ? 0 : std::max<std::int64_t>(1, steps * 3 / 7);
    Outcome outcome = first > 0 ? simulation->advance(first) : Outcome::done;
    if (outcome == Outcome::done && split == Split::restored) {
      auto other = make_simulation(request);
      other->restore(simulation->save());
      simulation = std::move(other);
    }
    if (outcome == Outcome::done && split == Split::calls) outcome = simulation->advance(1);
    const std::int64_t rest = steps - simulation->step();
    if (outcome == Outcome::done && rest > 0) outcome = simulation->advance(rest);
    return numbers_of(*simulation, outcome);
  });
}

std::string text_of(const Request& request, std::int64_t steps) {
  Lines lines;
  lines.add("problem", request.problem);
  for (const auto& [key, value] : request.variant) lines.add("variant." + key, value);
  for (const auto& [key, value] : request.parameters) lines.add("parameter." + key, value);
  lines.add("start.q", joined(request.start.q));
  lines.add("start.p", joined(request.start.p));
  lines.add("method", describe(request.method).name);
  for (const auto& [key, value] : request.method.options) lines.add("option." + key, value);
  lines.add("dt", request.dt);
  lines.add("arithmetic", request.arithmetic);
  lines.add("threads", static_cast<long long>(request.threads));
  lines.add("steps", static_cast<long long>(steps));
  return lines.text();
}

bool has_digits(const Request& request) { return digits_beyond_double(request.arithmetic) > 0; }

/// A run by name, with the variants that every simulation has.
Case case_of(const std::string& name, const Request& request, std::int64_t steps) {
  Case one{name, text_of(request, steps), [=] { return numbers_of(request, steps); }};
  one.variants.push_back({"saved and restored", [=] { return numbers_of(request, steps, Split::restored); }});
  if (has_digits(request)) return one;
  one.variants.push_back({"in three calls", [=] { return numbers_of(request, steps, Split::calls); }});
  Request unrecorded = request;
  unrecorded.record = false;
  one.variants.push_back({"not recorded", [=] { return numbers_of(unrecorded, steps); }});
  return one;
}

/// Options of implicit methods beside what their names alone stand for.
const std::vector<std::string>& more_methods() {
  static const std::vector<std::string> all{"cg(1,1)",
                                            "cg(1,5)",
                                            "cg(2,2)",
                                            "cg(2,6)",
                                            "cg(2,auto)",
                                            "cg(3,4)",
                                            "cg(4,auto)",
                                            "gauss(1)",
                                            "gauss(3)",
                                            "gauss(5)",
                                            "lobatto-3a-3b(3)",
                                            "lobatto-3a-3b(4)",
                                            "avf(5)",
                                            "eg(2)",
                                            "eg(3)",
                                            "cg(1,5,criterion=seed)",
                                            "cg(2,4,iteration=simplified)",
                                            "cg(2,4,iteration=fixed-point)",
                                            "gauss(3,iteration=fixed-point)",
                                            "gauss(2,iteration=simplified)",
                                            "cg(1,5,tolerance=1e-9)",
                                            "cg(2,auto,diagnostics=true,on_divergence=halve)",
                                            "cg(1,auto,step_control=reversible)",
                                            "verlet(step_control=reversible)",
                                            "stv4-dkd(step_control=reversible,monitor=distance)",
                                            "tao2(step_control=reversible)",
                                            "taylor(order=20)",
                                            "dop853(1e-9)"};
  return all;
}

/// Methods that are run in every arithmetic: one for each kind of step. Tables of one family differ in coefficients.
bool is_of_each_kind(const std::string& name) {
  static const std::set<std::string> each{"verlet",
                                          "stv4-dkd",
                                          "euler-b",
                                          "chin4a",
                                          "rk4",
                                          "boris",
                                          "cg",
                                          "eg",
                                          "gauss",
                                          "avf",
                                          "implicit-midpoint",
                                          "lobatto-3a-3b",
                                          "discrete-gradient",
                                          "itoh-abe",
                                          "dop853",
                                          "taylor",
                                          "tao4",
                                          "rattle",
                                          "rkn8-s19"};
  return each.contains(name);
}

std::string name_of(const ProblemEntry& problem) {
  std::string name = problem.info.name;
  for (const auto& [key, value] : problem.info.variant) name += "-" + value;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}

std::int64_t steps_in(const std::string& arithmetic, std::size_t size) {
  if (arithmetic == "double-double") return size > 12 ? 4 : 20;
  if (digits_beyond_double(arithmetic) > 0) return size > 12 ? 2 : 8;
  return 300;
}

const std::vector<std::string>& ledger_arithmetics() {
  static const std::vector<std::string> all{"double", "compensated", "lattice", "double-double", "quad", "mp(40)"};
  return all;
}

/// One request in every arithmetic that the method and the problem have.
void add_arithmetics(std::vector<Case>& cases, const std::string& place, Request request, const std::string& method,
                     const ProblemEntry& problem) {
  const std::size_t size = request.start.q.size();
  for (const std::string& arithmetic : ledger_arithmetics()) {
    const MethodSpec spec = parse_method(method);
    if (!refusal(spec, arithmetic).empty() || !refusal(spec, problem).empty()) continue;
    const bool is_slow = digits_beyond_double(arithmetic) > 0;
    if (is_slow && size > 20) continue;
    if (arithmetic != "double" && !is_of_each_kind(method)) continue;
    request.method = with_few_sub_steps(spec, arithmetic);
    request.arithmetic = arithmetic;
    cases.push_back(case_of(place + "/" + method + "/" + arithmetic, request, steps_in(arithmetic, size)));
  }
}

/// Every problem of the catalogue, where it is measured, with every method.
void add_catalogue(std::vector<Case>& cases) {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods()) names.push_back(entry.name);
  names.insert(names.end(), more_methods().begin(), more_methods().end());
  for (const ProblemEntry& problem : problems()) {
    const Request request = measured_request(problem);
    for (const std::string& method : names) {
      if (!is_bound(parse_method(method), problem)) continue;
      add_arithmetics(cases, "catalogue/" + name_of(problem), request, method, problem);
    }
  }
}

/// A typed Hamiltonian of one kind, with a start.
struct TypedShape {
  const char* name;
  FormulaTexts texts;
  std::vector<std::string> q, p;
  const char* dt;
};

const std::vector<TypedShape>& typed_shapes() {
  static const std::vector<TypedShape> all{
      {"natural",
       {.coordinates = {"x", "y"},
        .hamiltonian = "(p_x^2 + p_y^2)/2 + x^2/2 + y^2 + a*x^2*y",
        .parameters = {{"a", "0.3"}}},
       {"0.3", "0.2"},
       {"0.1", "0.4"},
       "0.05"},
      {"quartic", {.coordinates = {"x"}, .hamiltonian = "p_x^2/2 + x^4/4"}, {"1"}, {"0.3"}, "0.1"},
      {"kepler",
       {.coordinates = {"x", "y"}, .hamiltonian = "(p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2)"},
       {"1", "0"},
       {"0", "1.1"},
       "0.05"},
      {"polar",
       {.coordinates = {"r", "phi"}, .hamiltonian = "p_r^2/2 + p_phi^2/(2*r^2) - k/r", .parameters = {{"k", "1"}}},
       {"1", "0"},
       {"0", "1.1"},
       "0.05"},
      {"pendulum", {.coordinates = {"q"}, .hamiltonian = "p^2/2 - cos(q)"}, {"1.2"}, {"0.1"}, "0.1"},
      {"toda",
       {.coordinates = {"q1", "q2", "q3"},
        .hamiltonian = "(p1^2 + p2^2 + p3^2)/2 + exp(q1 - q2) + exp(q2 - q3) + exp(q3 - q1) - 3"},
       {"0.5", "0", "-0.1"},
       {"0", "0.5", "-0.5"},
       "0.05"},
      {"separable", {.coordinates = {"x"}, .hamiltonian = "p_x^4/4 + p_x^2/2 + x^4/4"}, {"1"}, {"0.3"}, "0.05"},
      {"full-mass",
       {.coordinates = {"x", "y"}, .hamiltonian = "p_x^2/2 + p_x*p_y/4 + p_y^2/2 + (x^2 + y^2)/2 + x^2*y^2"},
       {"0.2", "0.4"},
       {"0.5", "-0.3"},
       "0.05"},
      {"coupled", {.coordinates = {"x"}, .hamiltonian = "p_x^2*(1 + x^2/5)/2 + x^4/4"}, {"1"}, {"0.5"}, "0.03"},
      {"product",
       {.coordinates = {"x", "y"}, .hamiltonian = "(p_x^2 + p_y^2)*(1 + x^2 + y^2)/4 + x*p_y/7 - y*p_x/7"},
       {"0.5", "0.1"},
       {"0.2", "0.6"},
       "0.03"},
      {"pieces", {.coordinates = {"x"}, .hamiltonian = "p_x^2/2 + abs(x)^3"}, {"0.7"}, {"0.2"}, "0.03"},
      {"driven", {.coordinates = {"x"}, .hamiltonian = "p_x^2/2 + x^4/4 - x*cos(t)/3"}, {"0.3"}, {"0"}, "0.03"},
      {"ramp", {.coordinates = {"x"}, .hamiltonian = "p_x^2/2 + (1 + t/50)*x^2/2"}, {"1"}, {"0"}, "0.1"},
      {"chain",
       {.coordinates = {"x[n]"},
        .hamiltonian = "sum(i, 1, n, p_x[i]^2)/2 + sum(i, 1, n - 1, (x[i+1] - x[i])^2/2 "
                       "+ (x[i+1] - x[i])^4/4) + x[1]^2/2 + x[n]^2/2",
        .parameters = {{"n", "6"}}},
       {"0.1", "0.4", "-0.2", "0.3", "0", "0.1"},
       {"0", "0.1", "0", "-0.2", "0", "0"},
       "0.05"}};
  return all;
}

Request typed_request(const TypedShape& shape) {
  Request request;
  request.problem = FormulaKeys::problem;
  request.variant = formula_choices(shape.texts);
  request.parameters = shape.texts.parameters;
  request.start.q = shape.q;
  request.start.p = shape.p;
  request.dt = shape.dt;
  return request;
}

const std::vector<std::string>& methods_of_typed() {
  static const std::vector<std::string> all{"verlet",
                                            "verlet-dkd",
                                            "stv4",
                                            "kahan-li8",
                                            "euler-b",
                                            "chin4a",
                                            "rkn8-s19",
                                            "rk4",
                                            "dop853",
                                            "taylor",
                                            "tao2",
                                            "tao4",
                                            "cg",
                                            "cg(1,2)",
                                            "cg(1,5)",
                                            "cg(2,6)",
                                            "cg(2,auto)",
                                            "cg(3,3)",
                                            "gauss",
                                            "gauss(1)",
                                            "gauss(3)",
                                            "avf",
                                            "avf(3)",
                                            "implicit-midpoint",
                                            "lobatto-3a-3b",
                                            "lobatto-3a-3b(3)",
                                            "discrete-gradient",
                                            "itoh-abe",
                                            "verlet(step_control=reversible)",
                                            "cg(2,4,iteration=fixed-point)",
                                            "gauss(2,iteration=simplified)"};
  return all;
}

void add_typed(std::vector<Case>& cases) {
  for (const TypedShape& shape : typed_shapes()) {
    const Request request = typed_request(shape);
    const auto problem = find_problem(request.problem, request.variant);
    for (const std::string& method : methods_of_typed()) {
      add_arithmetics(cases, std::string("typed/") + shape.name, request, method, *problem);
    }
  }
}

Request kepler(const std::string& method, const std::string& dt, const std::string& speed) {
  Request request;
  request.problem = "central-force";
  request.variant = {{"potential", "kepler"}, {"coordinates", "cartesian"}};
  request.start.q = {"1", "0"};
  request.start.p = {"0", speed};
  request.method = parse_method(method);
  request.dt = dt;
  return request;
}

/// What an implicit step decides: steps that hardly converge, are halved, end at rounding, or are refused.
void add_hard_steps(std::vector<Case>& cases) {
  const std::vector<std::string> implicit{"cg(1,2)",           "cg(1,5)",  "cg(2,4)",  "cg(2,auto)", "cg(3,auto)",
                                          "gauss(1)",          "gauss(2)", "gauss(4)", "avf(4)",     "lobatto-3a-3b(3)",
                                          "discrete-gradient", "itoh-abe", "eg(2)"};
  const std::vector<std::string> options{"",
                                         "on_divergence=halve",
                                         "criterion=seed",
                                         "iteration=fixed-point",
                                         "iteration=simplified",
                                         "tolerance=1e-6",
                                         "tolerance=1e-17",

                                         "max_iterations=3",
                                         "max_iterations=4",
                                         "diagnostics=true"};
  struct Place {
    std::string name;
    Request request;
  };
  std::vector<Place> places{{"kepler,0.3", kepler("cg", "0.3", "0.3")}, {"kepler,1", kepler("cg", "1", "0.3")}};
  const std::pair<const char*, const char*> typed[] = {{"quartic", "0.5"}, {"quartic", "2"},     {"kepler", "0.5"},
                                                       {"pendulum", "2"},  {"coupled", "0.001"}, {"coupled", "0.5"},
                                                       {"pieces", "0.1"},  {"driven", "0.5"},    {"chain", "0.4"}};
  for (const auto& [name, dt] : typed) {
    for (const TypedShape& shape : typed_shapes()) {
      if (shape.name != std::string(name)) continue;
      Request request = typed_request(shape);
      request.dt = dt;
      places.push_back({std::string("typed-") + name + "," + dt, request});
    }
  }
  Request far = typed_request(typed_shapes()[1]);  // sizes that are tiny beside the start
  far.start.q = {"1e5"};
  far.dt = "1e-7";
  places.push_back({"typed-quartic,far", far});
  for (const auto& [place, given] : places) {
    Request request = given;
    const auto problem = find_problem(request.problem, request.variant);
    for (const std::string& name : implicit) {
      for (const std::string& option : options) {
        std::string text = name;
        if (!option.empty())
          text = name.back() == ')' ? name.substr(0, name.size() - 1) + "," + option + ")" : name + "(" + option + ")";
        MethodSpec method;
        try {
          method = parse_method(text);
        } catch (const Error&) {
          continue;  // the family has no such option
        }
        if (!refusal(method, *problem).empty()) continue;
        request.method = method;
        for (const char* arithmetic : {"double", "compensated", "quad"}) {
          if (!refusal(method, arithmetic).empty()) continue;
          const bool is_slow = arithmetic == std::string("quad");
          if (arithmetic != std::string("double") && !option.empty() && option != "on_divergence=halve") continue;
          request.arithmetic = arithmetic;
          cases.push_back(case_of("hard/" + place + "/" + text + "/" + arithmetic, request, is_slow ? 6 : 250));
        }
      }
    }
  }
}

/// Backwards, and steps whose length is no number of double.
void add_steps(std::vector<Case>& cases) {
  for (const char* problem : {"henon-heiles", "harmonic", "duffing", "n-body", "pendulum"}) {
    const auto entry = usual_problem(problem);
    Request request = measured_request(*entry);
    for (const char* factor : {"-1", "-1/3", "1e-6", "2^-40"}) {
      request.dt = "(" + measured_request(*entry).dt + ")*(" + factor + ")";
      for (const char* method : {"verlet", "stv4", "rk4", "chin4a", "cg", "cg(2,4)", "gauss", "dop853", "taylor",
                                 "tao2", "verlet(step_control=reversible)"}) {
        add_arithmetics(cases, std::string("steps/") + problem + "," + factor, request, method, *entry);
      }
    }
  }
}

std::string numbers_of_member(const MemberFamily& family, std::size_t member, std::int64_t steps) {
  const auto alone = make_simulation(family.alone(family.members[member]));
  const bool is_regular = alone->advance(steps) == Outcome::done;
  Lines lines;
  lines.add("regular", is_regular ? 1LL : 0LL);
  if (!is_regular) return lines.text();
  Frame frame;
  alone->look(frame);
  lines.add("q", frame.q);
  lines.add("p", frame.p);
  lines.add("energy.initial", alone->energy().initial);
  lines.add("energy.max_error", alone->energy().max_error);
  add_invariants(lines, alone->invariants());
  return lines.text();
}

std::string numbers_of_lanes(const MemberFamily& family, LaneSet set, std::int64_t steps) {
  const auto block = make_ensemble_block(family.request, set);
  std::string all;
  const std::span members(family.members);
  if (!block->load(family.shape, members.first(1))) return "refused\n";  // only then its width is known
  for (std::size_t first = 0; first < members.size(); first += block->lanes()) {
    const auto some = members.subspan(first, std::min(members.size() - first, block->lanes()));
    if (!block->load(family.shape, some)) return "refused\n";
    block->advance(steps / 3);
    block->advance(steps - steps / 3);
    for (std::size_t lane = 0; lane < some.size(); ++lane) {
      const MemberEnd end = block->look(lane);
      Lines lines;
      lines.add("regular", end.regular ? 1LL : 0LL);
      if (end.regular) {
        lines.add("q", end.q);
        lines.add("p", end.p);
        lines.add("energy.initial", end.energy.initial);
        lines.add("energy.max_error", end.energy.max_error);
        add_invariants(lines, end.invariants);
      }
      all += lines.text();
    }
  }
  return all;
}

/// Members in lanes, not as many as fill them, against each alone.
void add_lanes(std::vector<Case>& cases) {
  constexpr std::int64_t steps = 120;
  for (const ProblemEntry& problem : problems()) {
    for (const std::string method : {"verlet", "stv4-dkd", "rk4", "chin4a", "cg(1,2)", "cg(1,5)", "cg(2,auto)",
                                     "cg(3,4)", "gauss(2)", "gauss(3)"}) {
      const MethodSpec spec = parse_method(method);
      if (!refusal(spec, problem).empty()) continue;
      for (const char* arithmetic : {"double", "compensated"}) {
        if (!refusal(spec, arithmetic).empty()) continue;
        MemberFamily members(problem, 11);
        members.request.method = spec;
        members.request.arithmetic = arithmetic;
        const auto family = std::make_shared<const MemberFamily>(std::move(members));
        Case one;
        one.name = "lanes/" + name_of(problem) + "/" + method + "/" + arithmetic;
        one.request = text_of(family->alone(family->members[0]), steps) + "members 11\n";
        one.numbers = [=] {
          std::string all;
          for (std::size_t i = 0; i < family->members.size(); ++i) all += numbers_of_member(*family, i, steps);
          return all;
        };
        for (const LaneSet set : {LaneSet::generic, LaneSet::avx2, LaneSet::avx512}) {
          if (set > widest_lanes()) continue;
          const auto block = make_ensemble_block(family->request, set);
          if (block == nullptr || !block->load(family->shape, std::span(family->members).first(1))) continue;
          one.variants.push_back(
              {"in lanes of " + std::string(name(set)), [=] { return numbers_of_lanes(*family, set, steps); }});
        }
        cases.push_back(std::move(one));
      }
    }
  }
}

void add_walls(std::vector<Case>& cases) {
  const std::vector<std::string> methods{
      "verlet",
      "verlet-dkd",
      "stv4",
      "rkn8-s19",
      "chin4a",
      "euler-b",
      "rk4",
      "tao2",
      "cg(1,5)",
      "cg(2,6)",
      "cg(2,auto)",
      "gauss(2)",
      "lobatto-3a-3b(3)",
      "avf(4)",
      "discrete-gradient",
      "dop853",
      "taylor",
  };
  FormulaTexts free;
  free.coordinates = {"x", "y", "z", "u"};
  free.hamiltonian = "(p_x^2 + p_y^2 + p_z^2 + p_u^2)/2 + u^2/2";
  FormulaTexts full;
  full.coordinates = {"x", "y"};
  full.hamiltonian = "p_x^2/2 + p_x*p_y/4 + p_y^2/2 + (x^2 + y^2)/2";
  Request henon{.problem = "henon-heiles", .variant = {}, .parameters = {}, .start = {}, .method = {}};
  henon.start.q = {"0.1", "-0.05"};
  henon.start.p = {"0.3", "0.2"};
  henon.dt = "0.05";
  Request corner{.problem = "formula", .variant = formula_choices(free), .parameters = {}, .start = {}, .method = {}};
  corner.start.q = {"0", "0", "0.25", "1"};
  corner.start.p = {"1", "1", "-0.7", "0"};
  corner.dt = "0.03";
  Request oblique{.problem = "formula", .variant = formula_choices(full), .parameters = {}, .start = {}, .method = {}};
  oblique.start.q = {"0", "0.2"};
  oblique.start.p = {"1", "-0.5"};
  oblique.dt = "0.03";
  for (const WallRule rule : {WallRule::event, WallRule::mirror, WallRule::reject, WallRule::soft}) {
    std::vector<std::pair<std::string, Request>> places{
        {"henon-heiles", behind_walls(henon, {{"q1", 0, "-0.2", "0.2"}}, rule)},
        {"one-side", behind_walls(henon, {{"q2", 1, "-0.1", ""}}, rule)},
        {"corner", behind_walls(corner, {{"x", 0, "-1", "1"}, {"y", 1, "-1", "1"}, {"z", 2, "-0.5", "2"}}, rule)},
        {"oblique", behind_walls(oblique, {{"x", 0, "-0.5", "0.5"}}, rule)}};
    if (rule != WallRule::soft) {
      places.emplace_back("t-tube", t_tube("verlet", rule, "0.01"));
      places.emplace_back("t-tube,fast", t_tube("verlet", rule, "0.05", "-0.6", {"12", "100"}));
    }
    for (const auto& [place, request] : places) {
      const auto problem = find_problem(request.problem, request.variant);
      for (const std::string& method : methods) {
        add_arithmetics(cases, "walls/" + wall_rules()[static_cast<std::size_t>(rule)] + "/" + place, request, method,
                        *problem);
      }
    }
  }
}

std::string numbers_of(const Table& table) {
  Lines lines;
  for (const Column& column : table.columns()) {
    for (std::size_t k = 0; k < column.rows(); ++k) {
      const std::string place = table.name() + column.name() + "[" + std::to_string(k) + "]";
      if (column.info().type == ValueType::text) {
        lines.add(place, joined(column.row_of_texts(k)));
      } else if (column.info().type == ValueType::integer) {
        for (std::size_t i = 0; i < column.info().width; ++i) {
          lines.add(place, static_cast<long long>(column.integers()[k * column.info().width + i]));
        }
      } else {
        lines.add(place, column.row(k));
      }
    }
  }
  return lines.text();
}

std::string numbers_of_run(const std::string& text, const std::vector<std::string>& sets) {
  return or_refusal([&] {
    const RunReport report = run(accepted(read_scenario_text(text, "ledger", sets)));
    Lines lines;
    lines.add("status", report.status);
    lines.add("outcome", std::string(name(report.outcome)));
    add_frame(lines, report.final);
    lines.add("energy.initial", report.energy.initial);
    lines.add("energy.final", report.energy.final);
    lines.add("energy.max_error", report.energy.max_error);
    lines.add("energy.scale", report.energy_scale);
    add_invariants(lines, report.invariants);
    add_effort(lines, report.final.effort);
    if (report.summary.lyapunov) lines.add("lyapunov", report.summary.lyapunov->exponents);
    std::string all = lines.text() + numbers_of(report.tables.samples) + numbers_of(report.tables.section) +
                      numbers_of(report.tables.bounces);
    for (const Table& events : report.tables.events) all += numbers_of(events);
    return all;
  });
}

struct RunText {
  const char* name;
  const char* text;
  bool has_threads = false;
};

const std::vector<RunText>& run_texts() {
  static const std::vector<RunText> all{
      {"henon-heiles",
       "[problem]\nname = 'henon-heiles'\ninitial = { q = [0.18, 0.18], p = [0.18, 0.18] }\n[method]\nname = 'stv4'\n"
       "[run]\ndt = 0.1\nsteps = 400\n"},
      {"kepler",
       "[problem]\nname = 'central-force'\npotential = 'kepler'\nmass = 2\norbit = { kind = 'ellipse', r_per = 1, "
       "r_aph = 3 }\n"
       "[method]\nname = 'cg'\nquadrature = 5\n[run]\ndt = 0.1\nsteps = 300\n"},
      {"free-fall",
       "[problem]\nname = 'free-fall'\ngravity = 9.81\nwalls = [{ coordinate = 'q', min = -1 }]\ninitial = { q = [0], "
       "p = [0] }\n"
       "[method]\nname = 'verlet'\n[run]\ndt = 0.01\nsteps = 400\n"},
      {"driven",
       "[problem]\nname = 'formula'\ncoordinates = ['x']\nhamiltonian = 'p_x^2/2 + x^4/4 - x*cos(t)'\ninitial = { q = "
       "[0], p = [0] }\n"
       "[method]\nname = 'rk4'\n[run]\ndt = 0.05\nsteps = 400\n"},
      {"map",
       "[problem]\nname = 'formula'\ncoordinates = ['q']\nhamiltonian = 'p^2/2 + K*cos(q)'\nparameters = { K = 1.2 }\n"
       "initial = { q = [3], p = [0.4] }\n[method]\nname = 'euler-b'\n[run]\ndt = 1\nsteps = 300\nmap = true\n"},
      {"gas",
       "[problem]\nname = 'gas'\nparticles_per_side = 4\nstart = 'lattice'\nseed = 1\npair = 'lennard-jones'\n"
       "container = { kind = 'circle', radius = 1.5, exponent = 1 }\n[method]\nname = 'stv4'\n[run]\ndt = "
       "0.0001\nsteps = 60\nrecord_every = 20\n"},
      {"box",
       "[problem]\nname = 'gas'\nparticles_per_side = 8\nstart = 'lattice'\nseed = 3\npair = 'lennard-jones'\n"
       "container = { kind = 'periodic', size = [6, 6] }\ncutoff = { radius = 1.2, kind = 'shifted' }\n[method]\nname "
       "= 'verlet'\n"
       "[run]\ndt = 0.0001\nsteps = 100\nrecord_every = 50\n",
       true},
      {"box3",
       "[problem]\nname = 'gas'\ndimension = 3\nparticles_per_side = 5\nstart = 'lattice'\nseed = 5\npair = "
       "'lennard-jones'\n"
       "container = { kind = 'periodic', size = [5, 5, 5] }\ncutoff = { radius = 1.5, kind = 'smooth', inner = 1.2 "
       "}\n[method]\nname = 'verlet'\n"
       "[run]\ndt = 0.0005\nsteps = 60\nrecord_every = 30\n",
       true},
      {"walled-gas",
       "[problem]\nname = 'gas'\nparticles_per_side = 4\nstart = 'lattice'\nseed = 2\npair = 'lennard-jones'\n"
       "container = { kind = 'box', size = [4, 4] }\n[method]\nname = 'stv4'\n[run]\ndt = 0.001\nsteps = "
       "60\nrecord_every = 20\n"}};
  return all;
}

/// Whether a gas with these settings may have its forces computed by several threads.
bool takes_threads(const std::vector<std::string>& sets) {
  return std::none_of(sets.begin(), sets.end(), [](const std::string& set) {
    return set.find("quad") != std::string::npos || set.find("step_control") != std::string::npos;
  });
}

/// Whole runs in memory: what is recorded, events, sections, Lyapunov exponents, threads.
void add_runs(std::vector<Case>& cases) {
  const std::vector<std::vector<std::string>> settings{
      {},
      {"run.record_every=7"},
      {"run.record=[0, 0.25, 0.5, 0.7001]"},
      {"run.lyapunov=1"},
      {"run.lyapunov=2"},
      {"run.section={coordinate='q1'}"},
      {"run.section={expression='x-y/3',direction=0}"},
      {"run.events=[{name='up',expression='q1-0.01',direction=0}]"},
      {"run.events=[{name='down',expression='x',direction=-1,action='stop'}]"},
      {"run.events=[{expression='q+0.5',direction=0}]"},
      {"output.observables={a='p1*q1', b='q2^2'}"},
      {"problem.wall_rule='mirror'"},
      {"problem.wall_rule='reject'"},
      {"run.dt=-0.01"},
      {"run.arithmetic='compensated'"},
      {"run.arithmetic='lattice'"},
      {"run.arithmetic='quad'", "run.steps=20"},
      {"method={name='cg',degree=2}"},
      {"method={name='verlet',step_control='reversible'}"}};
  for (const RunText& each : run_texts()) {
    for (const std::vector<std::string>& sets : settings) {
      const std::string text = each.text;
      if (each.has_threads && !sets.empty() && sets[0].find("'cg'") != std::string::npos) continue;  // takes seconds
      Case one;
      one.name = std::string("runs/") + each.name + "/" + (sets.empty() ? "as-it-is" : joined(sets, ","));
      std::erase(one.name, ' ');
      one.request = text + joined(sets, "\n") + "\n";
      one.numbers = [=] { return numbers_of_run(text, sets); };
      if (each.has_threads && takes_threads(sets)) {
        for (const char* threads : {"2", "3"}) {
          std::vector<std::string> more = sets;
          more.push_back(std::string("run.threads=") + threads);
          one.variants.push_back(
              {std::string("with threads = ") + threads, [=] { return numbers_of_run(text, more); }});
        }
      }
      cases.push_back(std::move(one));
    }
  }
}

std::string numbers_of_sweep(const SweepRequest& request) {
  return or_refusal([&] {
    ScenarioSweep sweep(request);
    if (!sweep.complaints().empty()) throw Rejection(sweep.complaints());
    const SweepReport report = sweep.run();
    return "status " + report.status + "\n" + numbers_of(sweep.members()) + numbers_of(sweep.sections());
  });
}

void add_sweeps(std::vector<Case>& cases) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> varied{
      {"henon-heiles", {"problem.initial.q[1]=0.1:0.2:7"}},
      {"henon-heiles", {"run.dt=0.1,0.05", "problem.initial.p[0]=0.1:0.2:5"}},
      {"kepler", {"problem.orbit.r_aph=1.5:4:5"}},
      {"free-fall", {"problem.initial.q[0]=-0.5:1:9"}},
      {"map", {"problem.parameters.K=0.5:2:11"}},
      {"driven", {"run.dt=0.05,0.03,0.01"}}};
  const std::vector<std::vector<std::string>> settings{{},
                                                       {"run.lyapunov=1"},
                                                       {"run.arithmetic='compensated'"},
                                                       {"method={name='cg',degree=2}"},
                                                       {"method={name='rk4'}"},
                                                       {"run.section={coordinate='q1'}"},
                                                       {"output.observables={a='p1*q1'}"},
                                                       {"problem.wall_rule='mirror'"},
                                                       {"problem.wall_rule='reject'"}};
  for (const auto& [name, keys] : varied) {
    const auto found = std::find_if(run_texts().begin(), run_texts().end(),
                                    [&name = name](const RunText& each) { return each.name == name; });
    for (const std::vector<std::string>& sets : settings) {
      SweepRequest request{.text = found->text, .name = "ledger", .sets = sets, .varied = keys};
      request.threads = 1;
      request.lanes = "none";
      Case one;
      one.name = "sweeps/" + name + "/" + joined(keys, ";") + (sets.empty() ? "" : "/" + joined(sets, ","));
      std::erase(one.name, ' ');
      one.request = request.text + joined(sets, "\n") + "\n" + joined(keys, "\n") + "\n";
      one.numbers = [=] { return numbers_of_sweep(request); };
      for (const char* lanes : {"auto", "generic"}) {
        SweepRequest other = request;
        other.lanes = lanes;
        other.threads = 3;
        one.variants.push_back({std::string("3 threads, lanes = ") + lanes, [=] { return numbers_of_sweep(other); }});
      }
      cases.push_back(std::move(one));
    }
  }
}

}  // namespace

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  add_catalogue(cases);
  add_typed(cases);
  add_hard_steps(cases);
  add_steps(cases);
  add_lanes(cases);
  add_walls(cases);
  add_runs(cases);
  add_sweeps(cases);
  for (Case& one : cases) {
    one.is_beyond_portable =
        one.name.ends_with("/quad") || one.name.ends_with("/mp(40)") || one.name.find("'quad'") != std::string::npos;
  }
  if (!has_quad_and_mp) std::erase_if(cases, [](const Case& one) { return one.is_beyond_portable; });
  std::set<std::string> names;
  for (const Case& one : cases) {
    if (one.name.find(' ') != std::string::npos || !names.insert(one.name).second) {
      throw std::logic_error("the ledger has the name '" + one.name + "' twice, or with a blank");
    }
  }
  return cases;
}

}  // namespace hamflow::test
