#include "hamflow/run/catalog.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catalog_lists.hpp"  // generated from the folders of problems and tables
#include "engine/make_simulation.hpp"
#include "engine/recorded_step.hpp"
#include "gas/gas_entry.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/detail/run/fitting_methods.hpp"
#include "hamflow/run/gas.hpp"
#include "hamflow/run/socket.hpp"
#include "methods/step_control.hpp"
#include "problems/constrained_problems.hpp"
#include "problems/typed_problem.hpp"
#include "socket/socket_entry.hpp"
#include "walls/walled_problem.hpp"

namespace hamflow {

namespace {
/// A pointer to an entry of the list, which exists as long as the program.
std::shared_ptr<const ProblemEntry> listed(const ProblemEntry& entry) { return {std::shared_ptr<void>(), &entry}; }
}  // namespace

std::span<const ProblemEntry> problems() {
  static const std::vector<ProblemEntry> all = [] {
    std::vector<ProblemEntry> entries = generated_problems();
    for (ProblemEntry& entry : constrained_problems()) entries.push_back(std::move(entry));
    entries.push_back(*gas_problem({}));
    entries.push_back(*socket_problem({}));
    entries.push_back(formula_example());
    return entries;
  }();
  return all;
}

std::shared_ptr<const ProblemEntry> find_problem(const std::string& name,
                                                 const std::map<std::string, std::string>& variant,
                                                 const std::optional<Walls>& walls) {
  if (walls && name == SocketKeys::problem) {
    throw Error("found walls; allowed without walls for " + name + ", whose client computes all forces");
  }
  if (walls) return walled_problem(name, variant, *walls);
  if (is_typed(name, variant)) return typed_problem(name, variant);
  if (name == GasKeys::problem) return gas_problem(variant);
  if (name == SocketKeys::problem) return socket_problem(variant);
  const ProblemEntry* same_name = nullptr;
  for (const ProblemEntry& entry : problems()) {
    if (entry.info.name != name) continue;
    same_name = &entry;
    const bool matches = std::all_of(entry.info.variant.begin(), entry.info.variant.end(), [&](const auto& choice) {
      const auto given = variant.find(choice.first);
      return given == variant.end() || given->second == choice.second;
    });
    if (matches) return listed(entry);
  }
  if (same_name == nullptr) {
    std::vector<std::string> names;
    for (const ProblemEntry& entry : problems()) {
      if (std::find(names.begin(), names.end(), entry.info.name) == names.end()) names.push_back(entry.info.name);
    }
    throw Error("found the problem '" + name + "'; allowed " + joined(names) + suggestion(name, names));
  }
  const std::string wanted = joined(variant, [](const auto& choice) { return choice.first + " = " + choice.second; });
  throw Error("problem '" + name + "' has no variant with " + wanted + " (" + command_name("show " + name) + ")");
}

std::shared_ptr<const ProblemEntry> usual_problem(const std::string& name,
                                                  const std::map<std::string, std::string>& variant) {
  if (is_typed(name, variant)) return typed_problem(name, variant);
  if (name == GasKeys::problem) return gas_problem(variant);
  if (name == SocketKeys::problem) {
    return socket_problem(variant.empty() ? Texts{{SocketKeys::address, socket_options().front().example}} : variant);
  }
  const std::shared_ptr<const ProblemEntry> any = find_problem(name, variant);
  const auto usual = [](const ProblemInfo& info, const std::string& key) {
    const auto listed = [&](const auto& keys) { return std::find(keys.begin(), keys.end(), key) != keys.end(); };
    return listed(info.default_choices) || listed(info.example_choices);
  };
  const auto matches = [&](const auto& choice, const ProblemInfo& info) {
    const auto given = variant.find(choice.first);
    return given != variant.end() ? given->second == choice.second : usual(info, choice.first);
  };
  for (const ProblemEntry& entry : problems()) {
    const ProblemInfo& info = entry.info;
    if (info.name == name && std::all_of(info.variant.begin(), info.variant.end(),
                                         [&](const auto& choice) { return matches(choice, info); })) {
      return listed(entry);
    }
  }
  return any;  // no entry is declared as the usual one
}

Texts complete(const ProblemInfo& info, const Texts& given) {
  Texts all;
  for (const ParameterInfo& parameter : info.parameters) all[parameter.name] = parameter.default_value;
  for (const auto& [name, text] : given) {
    if (!all.contains(name)) throw Error("problem '" + info.name + "' has no parameter '" + name + "'");
    all[name] = text;
  }
  return all;
}

/// A method for constraints needs a problem with constraints; any other method needs a problem without.
static std::string refusal_of_constraints(const std::string& method, const ProblemEntry& problem) {
  const std::string form = FormulaKeys::constraint_form;
  if (problem.constraint_form.empty()) {
    return method + " needs constraints g(q) = 0; " + problem.info.name +
           " has none in these coordinates; allowed with coordinates = \"cartesian\" of pendulum, double-pendulum and "
           "t-tube, or with constraints of formula; other methods work without constraints";
  }
  if (problem.constraint_form == FormulaKeys::manifold) {
    return method + " does not support constraints; allowed here: rattle, rattle4, or, with " + form + " = \"" +
           FormulaKeys::multiplier + "\", rk4, dop853, taylor";
  }
  return method +
         " needs the gradient of H, but the field with multipliers is not a gradient; allowed here: rk4, "
         "dop853, taylor, or, with " +
         form + " = \"" + FormulaKeys::manifold + "\", rattle, rattle4";
}

std::string refusal(const MethodSpec& spec, const ProblemEntry& problem) {
  if (problem.accepts(spec)) return refused_monitor(spec, problem);
  const bool for_constraints = !problem.constraint_form.empty() || spec.name.starts_with("rattle");
  if (for_constraints) return refusal_of_constraints(spec.name, problem);
  // All accepted methods; if there are many, only those recommended first.
  std::vector<std::string> accepted;
  std::vector<std::string> first;
  for (const MethodEntry& entry : methods()) {
    const MethodSpec other{.name = entry.name};
    if (!problem.accepts(other)) continue;
    accepted.push_back(entry.name);
    if (!advice(other).purpose.empty()) first.push_back(entry.name);
  }
  const bool many = accepted.size() > 12;
  const std::string all =
      many ? joined(first) + " and others (" + command_name("list methods --all") + ")" : joined(accepted);
  const auto needs = [](const std::string& name) {
    const MethodEntry& method = find_method(name);
    return method.family->needs(method.index);
  };
  std::string text = spec.name + " needs " + needs(spec.name) + "; " + problem.info.name;
  std::string only;
  if (problem.info.name == GasKeys::problem) {
    only = gas_that_accepts(spec, {problem.info.variant.begin(), problem.info.variant.end()});
  }
  text += (only.empty() ? " does not meet this" : " meets this " + only) + "; ";
  if (!first.empty()) {
    const std::string what = needs(first.front());  // "a separable H ...", "an H ..."
    text += first.front() + " takes any" + what.substr(std::min(what.find(' '), what.size())) + "; ";
  }
  return text + "allowed here: " + all;
}

std::string refused_threads(const Request& request, const ProblemEntry& problem) {
  if (request.threads == 1) return {};
  if (request.threads < 1 || request.threads > most_threads) {
    return "allowed a whole number from 1 to " + std::to_string(most_threads);
  }
  if (step_control_of(request.method).reversible) {
    return "threads can share only steps of equal size; allowed 1, or step_control = \"fixed\"";
  }
  if (!problem.has_pairwise_forces) {
    std::vector<std::string> all;
    for (const ProblemEntry& entry : problems()) {
      if (entry.has_pairwise_forces) all.push_back(entry.info.name);
    }
    return "a step of " + problem.info.name + " is too short to be shared among threads; allowed 1 (more for " +
           joined(all) + " with arithmetic = \"lattice\", and for " + GasKeys::problem + " in double)";
  }
  const auto pair = request.variant.find(GasKeys::pair);
  const bool in_bulk = problem.info.name == GasKeys::problem && digits_beyond_double(request.arithmetic) == 0 &&
                       (pair == request.variant.end() || pair->second != GasKeys::typed);
  if (request.arithmetic != "lattice" && !in_bulk) {
    const bool typed = pair != request.variant.end() && pair->second == GasKeys::typed;
    return "in " + request.arithmetic + (typed ? " with a typed pair law" : "") +
           " threads would change the order of floating-point sums and therefore the bits; " +
           "allowed 1, or arithmetic = \"lattice\", whose integer sums do not depend on the order";
  }
  return {};
}

/// Whether straight-line code is faster than the compiled loop over bodies or particles. It is if it fits into the
/// first-level instruction cache. Longer code takes a fifth of a nanosecond per operation: less than roots and
/// quotients in a loop, more than vectorised sums and products (fput). Measured: docs/design/recorded-steps.md.
static bool faster_than_loops(const Program& program) {
  constexpr std::size_t in_first_cache = 3500, share = 40;
  const auto count = [&](auto... kinds) {
    return static_cast<std::size_t>(
        std::count_if(program.operations.begin(), program.operations.end(),
                      [=](const Program::Operation& operation) { return ((operation.instruction == kinds) || ...); }));
  };
  return program.operations.size() <= in_first_cache ||
         share * count(Instruction::divide, Instruction::sqrt) >= program.operations.size();
}

std::unique_ptr<Simulation> make_simulation(const Request& request) { return make_simulation_of(Request(request)); }

std::unique_ptr<Simulation> make_simulation_of(Request request) {
  const FunctionsInUse functions = request.functions ? FunctionsInUse(*request.functions) : FunctionsInUse();
  const auto problem_entry = find_problem(request);
  const ProblemEntry& problem = *problem_entry;
  check_arithmetic(request.arithmetic);
  const std::string why_not = refusal_with_advice(request.method, &problem, request.arithmetic);
  if (!why_not.empty())
    throw Error("method " + request.method.name + " cannot run in " + request.arithmetic + ": " + why_not);
  if (const auto wrong = refused_option(request.method)) {
    throw Error("method " + request.method.name + ": " + wrong->name + ": " + wrong->message);
  }
  const std::string not_here = refusal(request.method, problem);
  if (!not_here.empty()) throw Error(not_here);
  const std::string one_thread = refused_threads(request, problem);
  if (!one_thread.empty()) throw Error("threads = " + std::to_string(request.threads) + ": " + one_thread);
  Request full = std::move(request);
  full.parameters = complete(problem.info, full.parameters);
  const int digits = digits_beyond_double(full.arithmetic);
  const MethodFamily& family = *find_method(full.method.name).family;
  if (family.completed) full.method.options = family.completed(full.method.options, digits);
  // Steps of varying size run behind virtual calls, one by one, in every arithmetic.
  if (digits > 0 || step_control_of(full.method).reversible) return problem.simulate_erased(full);
  const bool of_any_size = problem.dimension == 0;
  if (of_any_size && full.arithmetic != "lattice") {
    auto simulation = problem.simulate_erased(full);
    auto* const recorded = dynamic_cast<RecordedMember*>(simulation.get());
    const auto step = recorded == nullptr ? nullptr : recorded->recorded_step();
    if (step && faster_than_loops(step->program)) return simulation;
    auto typed = problem.simulate(full);
    return typed ? std::move(typed) : std::move(simulation);
  }
  if (auto simulation = problem.simulate(full)) return simulation;
  return problem.simulate_erased(full);
}

}  // namespace hamflow
