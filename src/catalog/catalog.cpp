#include "hamflow/run/catalog.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catalog_lists.hpp"  // generated from the folders of problems and tables
#include "hamflow/arithmetic/plain.hpp"
#include "hamflow/methods/boris.hpp"
#include "hamflow/problems/magnetic.hpp"

namespace hamflow {

std::span<const ProblemEntry> problems() {
  static const std::vector<ProblemEntry> all = generated_problems();
  return all;
}

std::span<const MethodEntry> methods() {
  static const std::vector<MethodEntry> all = [] {
    std::vector<MethodEntry> list;
    for (const CompositionTable* table : generated_compositions()) {
      list.push_back({std::string(table->name), MethodKind::composition, StartsWith::kick, table, nullptr});
      list.push_back({std::string(table->name) + "-dkd", MethodKind::composition, StartsWith::drift, table, nullptr});
    }
    for (const SplittingTable* table : generated_splittings()) {
      list.push_back({std::string(table->name), MethodKind::splitting, table->starts_with, nullptr, table});
    }
    for (const ForceGradientTable* table : generated_force_gradients()) {
      list.push_back({.name = std::string(table->name), .kind = MethodKind::force_gradient, .force_gradient = table});
    }
    for (const std::string& name : generated_tableaus()) list.push_back({name, MethodKind::runge_kutta});
    list.push_back({"cg", MethodKind::cg});
    list.push_back({"boris", MethodKind::boris});
    list.push_back({"dop853", MethodKind::dop853});
    list.push_back({"taylor", MethodKind::taylor});
    // Explicit methods by order and cost, then the rest.
    std::stable_sort(list.begin(), list.end(), [](const MethodEntry& a, const MethodEntry& b) {
      const auto key = [](const MethodEntry& e) {
        if (e.kind == MethodKind::cg) return 1000;
        if (e.kind == MethodKind::boris) return 1001;
        if (e.kind == MethodKind::dop853) return 1002;
        if (e.kind == MethodKind::taylor) return 1003;
        const MethodInfo info = describe(MethodSpec{.name = e.name});
        return 50 * info.order + info.forces_per_step;
      };
      return key(a) < key(b);
    });
    return list;
  }();
  return all;
}

namespace {
[[noreturn]] void unknown(const std::string& what, const std::string& name,
                          const std::vector<std::string>& candidates) {
  const std::string near = nearest(name, candidates);
  throw Error(what + " '" + name + "' is unknown" + (near.empty() ? "" : "; did you mean " + near + "?") +
              " (list them with: hamflow list " + what + "s)");
}
}  // namespace

const MethodEntry& find_method(const std::string& name) {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  unknown("method", name, names);
}

const ProblemEntry& find_problem(const std::string& name, const std::map<std::string, std::string>& variant) {
  std::vector<std::string> names;
  const ProblemEntry* same_name = nullptr;
  for (const ProblemEntry& entry : problems()) {
    names.push_back(entry.info.name);
    if (entry.info.name != name) continue;
    same_name = &entry;
    const bool matches = std::all_of(entry.info.variant.begin(), entry.info.variant.end(), [&](const auto& choice) {
      const auto given = variant.find(choice.first);
      return given == variant.end() || given->second == choice.second;
    });
    if (matches) return entry;
  }
  if (same_name == nullptr) unknown("problem", name, names);
  std::string wanted;
  for (const auto& [key, value] : variant) wanted += (wanted.empty() ? "" : ", ") + key + " = " + value;
  throw Error("problem '" + name + "' has no variant with " + wanted + " (hamflow show " + name + ")");
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

MethodInfo describe(const MethodSpec& spec) {
  for (const CompositionTable* table : generated_compositions()) {
    if (spec.name == table->name) return describe(*table, StartsWith::kick);
    if (spec.name == std::string(table->name) + "-dkd") return describe(*table, StartsWith::drift);
  }
  for (const SplittingTable* table : generated_splittings()) {
    if (spec.name == table->name) return describe(*table);
  }
  for (const ForceGradientTable* table : generated_force_gradients()) {
    if (spec.name == table->name) return describe(*table);
  }
  if (spec.name == "cg") return describe(spec.cg);
  if (spec.name == "boris") return BorisStep<Magnetic<double>, Plain<double>>::describe();
  if (spec.name == "dop853" || spec.name == "taylor") {
    MethodInfo info = spec.name == "dop853" ? describe_dop853(spec.adaptive)
                                            : describe_taylor(spec.adaptive, taylor_order(spec.adaptive));
    std::string options;
    const auto add = [&](const std::string& text) { options += (options.empty() ? "" : ",") + text; };
    if (spec.adaptive.order > 0) add("order=" + std::to_string(spec.adaptive.order));
    if (spec.adaptive.tolerance_given) add("tolerance=" + shortest(spec.adaptive.tolerance));
    if (spec.adaptive.fixed) add("step_control=fixed");
    if (!options.empty()) info.name += "(" + options + ")";
    return info;
  }
  if (const auto info = generated_tableau_info(spec.name)) return *info;
  (void)find_method(spec.name);  // throws, naming the nearest
  throw Error("method '" + spec.name + "' has no description");
}

std::string refusal(const MethodSpec& spec, const ProblemEntry& problem) {
  if (problem.accepts(spec)) return {};
  // All of them, or, of the many, the best known.
  const std::vector<std::string> well_known{"verlet", "stv4", "yoshida6", "kahan-li8", "cg", "rk4", "dop853", "taylor"};
  std::vector<std::string> accepted;
  for (const MethodEntry& entry : methods()) {
    if (problem.accepts(MethodSpec{.name = entry.name})) accepted.push_back(entry.name);
  }
  const bool many = accepted.size() > 12;
  std::string all;
  for (const std::string& name : accepted) {
    if (!many || std::find(well_known.begin(), well_known.end(), name) != well_known.end()) {
      all += (all.empty() ? "" : ", ") + name;
    }
  }
  if (many) all += " and others (hamflow list methods)";
  std::string needs;
  const MethodEntry& method = find_method(spec.name);
  switch (method.kind) {
    case MethodKind::composition:
    case MethodKind::splitting:
      needs = "a separable H = T(p) + V(q)";
      if (method.splitting != nullptr && method.splitting->nystroem) {
        needs += ", T quadratic in p with constant mass matrix";
      }
      break;
    case MethodKind::force_gradient:
      needs = "a separable H = T(p) + V(q), T quadratic in p with constant mass matrix, V twice differentiable";
      break;
    case MethodKind::runge_kutta:
    case MethodKind::dop853:
      needs = "a differentiable H";
      break;
    case MethodKind::taylor:
      needs = "an H whose derivatives can be recorded";
      break;
    case MethodKind::cg:
      needs = "a twice differentiable H";
      break;
    case MethodKind::boris:
      needs = "a charge in a uniform magnetic field (problem magnetic)";
      break;
  }
  return spec.name + " needs " + needs + ", and that of " + problem.info.name + " is none; allowed here: " + all;
}

std::string refused_fast_kernel(const Request& request, const ProblemEntry& problem) {
  if (!problem.has_fast_kernel) {
    std::string all;
    for (const ProblemEntry& entry : problems()) {
      if (!entry.has_fast_kernel) continue;
      all += (all.empty() ? "" : ", ") + entry.info.name;
      for (const auto& [key, value] : entry.info.variant) all += " " + value;
    }
    return "there is no fast kernel for " + problem.info.name + "; there is for: " + all;
  }
  if (request.arithmetic == "lattice") return "on the lattice forces are exact; allowed exact";
  const MethodKind kind = find_method(request.method.name).kind;
  if (kind == MethodKind::cg) return "an energy-conserving element needs the exact force; allowed exact";
  if (kind == MethodKind::force_gradient) return "a force gradient needs the exact force; allowed exact";
  if (kind == MethodKind::dop853 || kind == MethodKind::taylor || digits_beyond_double(request.arithmetic) > 0) {
    return "the fast kernel is for splitting methods in double; allowed exact";
  }
  return {};
}

std::string refused_threads(const Request& request, const ProblemEntry& problem) {
  if (request.threads == 1) return {};
  if (request.threads < 1 || request.threads > most_threads) {
    return "allowed a whole number from 1 to " + std::to_string(most_threads);
  }
  if (!problem.has_pairwise_forces) {
    std::string all;
    for (const ProblemEntry& entry : problems()) {
      if (entry.has_pairwise_forces) all += (all.empty() ? "" : ", ") + entry.info.name;
    }
    return "a step of " + problem.info.name + " is too short to be shared; allowed 1 (more for " + all +
           " with arithmetic = \"lattice\")";
  }
  if (request.arithmetic != "lattice") {
    return "in " + request.arithmetic +
           " threads would change the order of floating-point sums, and with it the bits; " +
           "allowed 1, or arithmetic = \"lattice\", whose integer sums have no order";
  }
  return {};
}

std::unique_ptr<Simulation> make_simulation(const Request& request) {
  const ProblemEntry& problem = find_problem(request.problem, request.variant);
  check_arithmetic(request.arithmetic);
  const std::string why_not = refusal(request.method, request.arithmetic);
  if (!why_not.empty())
    throw Error("method " + request.method.name + " cannot run in " + request.arithmetic + ": " + why_not);
  const std::string not_here = refusal(request.method, problem);
  if (!not_here.empty()) throw Error(not_here);
  if (request.kernel != "exact") {
    const std::string no_kernel =
        request.kernel == "fast" ? refused_fast_kernel(request, problem) : "allowed exact, fast";
    if (!no_kernel.empty()) throw Error("kernel '" + request.kernel + "': " + no_kernel);
  }
  const std::string one_thread = refused_threads(request, problem);
  if (!one_thread.empty()) throw Error("threads = " + std::to_string(request.threads) + ": " + one_thread);
  Request full = request;
  full.parameters = complete(problem.info, request.parameters);
  // Where more digits are asked for, so is their accuracy: four of them are left to rounding.
  if (const int digits = digits_beyond_double(request.arithmetic);
      digits > 0 && !full.method.adaptive.tolerance_given) {
    full.method.adaptive.tolerance = std::pow(10.0, 4 - std::min(digits, 300));
  }
  const MethodKind kind = find_method(request.method.name).kind;
  const bool typed =
      digits_beyond_double(request.arithmetic) == 0 && kind != MethodKind::dop853 && kind != MethodKind::taylor &&
      kind != MethodKind::force_gradient &&
      !(kind == MethodKind::runge_kutta && request.arithmetic == "compensated" && request.kernel == "exact");
  return typed ? problem.simulate(full) : problem.simulate_erased(full);
}

}  // namespace hamflow
