// The list of all methods, from the declarations of the families.
#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "engine/large_steps.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/core/option_names.hpp"
#include "hamflow/detail/run/fitting_methods.hpp"
#include "hamflow/detail/run/splitting_named.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/gas.hpp"
#include "methods/recipes.hpp"
#include "methods/step_control.hpp"

namespace hamflow {

Shape families::cached_shape_of(const AnySplitting& method) {
  static std::mutex mutex;
  static std::map<std::pair<const void*, bool>, Shape> known;
  const std::lock_guard lock(mutex);
  const auto [at, is_new] = known.try_emplace({method.table(), method.describe() == detail::describe_drift_first});
  if (is_new) at->second = method.sequence<double>().shape();
  return at->second;
}

std::span<const MethodFamily> method_families() {
  static const std::vector<MethodFamily> all = [] {
    std::vector<MethodFamily> families = families::All::declared();
    for (MethodFamily& family : families) add_step_control(family);
    return families;
  }();
  return all;
}

std::span<const MethodEntry> methods() {
  static const std::vector<MethodEntry> all = [] {
    std::vector<MethodEntry> list;
    for (const MethodFamily& family : method_families()) {
      for (std::size_t i = 0; i < family.methods.size(); ++i) list.push_back({family.methods[i], &family, i});
    }
    // Tables first, sorted by order and cost. Each method is described only once, because a description parses the
    // coefficients of its table and the list is made at every start of the command.
    std::map<std::string, int> keys;
    for (const MethodEntry& entry : list) {
      const MethodInfo info = entry.family->rank > 0 ? MethodInfo{} : entry.family->describe(entry.index, {});
      keys[entry.name] = entry.family->rank > 0 ? 1000 * entry.family->rank : 50 * info.order + info.forces_per_step;
    }
    std::stable_sort(list.begin(), list.end(),
                     [&](const MethodEntry& a, const MethodEntry& b) { return keys.at(a.name) < keys.at(b.name); });
    return list;
  }();
  return all;
}

const MethodEntry& find_method(const std::string& name) {
  static const std::map<std::string, const MethodEntry*> by_name = [] {
    std::map<std::string, const MethodEntry*> map;
    for (const MethodEntry& entry : methods()) map[entry.name] = &entry;
    return map;
  }();
  const auto found = by_name.find(name);
  if (found != by_name.end()) return *found->second;
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods()) names.push_back(entry.name);
  const std::vector<std::string> first = first_methods();
  throw Error("found the method '" + name + "'; allowed " + joined(first) + " and " +
              std::to_string(names.size() - first.size()) + " others (" + command_name("list methods") + ")" +
              suggestion(name, names));
}

std::size_t family_number(const MethodEntry& method) {
  return static_cast<std::size_t>(method.family - method_families().data());
}

MethodInfo describe(const MethodSpec& spec) {
  const MethodEntry& entry = find_method(spec.name);
  MethodInfo info = entry.family->describe(entry.index, spec.options);
  const StepControl control = step_control_of(spec);
  return control.reversible ? with_varying_steps(std::move(info), control.monitor) : info;
}

MethodAdvice advice(const MethodSpec& spec) {
  const MethodEntry& entry = find_method(spec.name);
  return entry.family->advice ? entry.family->advice(entry.index) : MethodAdvice{};
}

std::vector<std::string> first_methods() {
  std::vector<std::string> names;
  for (const MethodEntry& entry : methods()) {
    if (!advice(MethodSpec{.name = entry.name}).purpose.empty()) names.push_back(entry.name);
  }
  return names;
}

namespace {
/// The number of unknowns of a step and the options of their iteration. A count of 0: the method has no limit.
struct Unknowns {
  std::size_t count = 0;
  Iteration iteration = Iteration::newton;
  int max_iterations = 0;
  int usual_iterations = 0;  // the default
  bool diagnostics = false;
};

template <class Options>
Unknowns unknowns(std::size_t count, const Options& options) {
  return {count, options.iteration, options.max_iterations, Options{}.max_iterations, options.diagnostics};
}

/// The unknowns as the recipes count them.
Unknowns unknowns_and_options(const MethodSpec& spec, std::size_t coordinates) {
  return visit_method(spec, [&]<class M>(const M& recipe) -> Unknowns {
    const auto times = [&](int per_coordinate) { return coordinates * static_cast<std::size_t>(per_coordinate); };
    if constexpr (std::is_same_v<M, Averages>) {
      return unknowns(times(recipe.options.element.degree), recipe.options.element);
    } else if constexpr (std::is_same_v<M, Cg>) {
      return unknowns(coordinates, recipe.options);
    } else if constexpr (std::is_same_v<M, Eg>) {
      return unknowns(times(recipe.options.degree), recipe.options);
    } else if constexpr (std::is_same_v<M, Lobatto>) {
      return unknowns(times(2 * recipe.options.stages), recipe.options);
    } else if constexpr (std::is_same_v<M, DiscreteGradient> || std::is_same_v<M, ItohAbe>) {
      return unknowns(times(2), recipe.options);
    } else {
      return {};
    }
  });
}

std::string unknowns_text(const Unknowns& step) {
  return "a step has " + std::to_string(step.count) + " unknowns; more than " + std::to_string(most_dense_unknowns) +
         " are solved ";
}
}  // namespace

std::optional<RefusedOption> refused_option(const MethodSpec& spec, std::size_t coordinates) {
  const Unknowns step = unknowns_and_options(spec, coordinates);
  if (step.count <= most_dense_unknowns || !step.diagnostics) return std::nullopt;
  return RefusedOption{diagnostics_option, "found true; allowed false: " + unknowns_text(step) + "without a Jacobian"};
}

std::vector<ReplacedOption> replaced_options(const MethodSpec& spec, std::size_t coordinates) {
  const Unknowns step = unknowns_and_options(spec, coordinates);
  std::vector<ReplacedOption> all;
  if (step.count <= most_dense_unknowns || step.iteration == Iteration::fixed_point) return all;
  if (const auto asked = spec.options.find(families::iteration_option); asked != spec.options.end()) {
    all.push_back(
        {asked->first, "\"" + asked->second + "\" is not used: " + unknowns_text(step) + "by fixed-point iteration"});
  }
  const bool has_default_iteration =
      step.iteration == Iteration::newton && step.max_iterations == step.usual_iterations;
  if (const auto asked = spec.options.find(families::max_iterations_option);
      asked != spec.options.end() && has_default_iteration) {
    all.push_back({asked->first, asked->second + " is taken as " + std::to_string(linear_iterations) + ": " +
                                     unknowns_text(step) + "by fixed-point iteration, and " + asked->second +
                                     " is only the default of newton"});
  }
  return all;
}

std::size_t unknowns_of_step(const MethodSpec& spec, std::size_t coordinates) {
  // The method of reference solutions is not in the list.
  const bool is_listed =
      std::any_of(methods().begin(), methods().end(), [&](const MethodEntry& m) { return m.name == spec.name; });
  return is_listed ? unknowns_and_options(spec, coordinates).count : 0;
}

std::string hint_after_divergence(const Request& request, bool differentiated) {
  const MethodFamily& family = *find_method(request.method.name).family;
  if (!family.hint) return std::string(hint(Outcome::not_converged));
  const auto problem_entry = find_problem(request);
  const ProblemEntry& problem = *problem_entry;
  const std::size_t coordinates = request.start.q.size();
  UsableAdvice usable;
  usable.halving = !differentiated;
  usable.newton = unknowns_of_step(request.method, coordinates) <= most_dense_unknowns;
  const bool has_hessian = request.problem != GasKeys::problem || coordinates <= most_gas_coordinates_with_hessian;
  if (has_hessian) usable.without_quadrature = fitting_methods({"discrete-gradient"}, &problem, request.arithmetic);
  return family.hint(request.method.options, usable);
}

std::optional<AnySplitting> splitting_named(const std::string& name) {
  return visit_method(MethodSpec{.name = name}, [](const auto& recipe) -> std::optional<AnySplitting> {
    if constexpr (requires { AnySplitting(recipe.method); }) {
      return recipe.method;
    } else {
      return std::nullopt;
    }
  });
}

}  // namespace hamflow
