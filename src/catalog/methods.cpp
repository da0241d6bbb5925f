// The closed list of methods, from the families that declare them.
#include <algorithm>
#include <optional>

#include "hamflow/core/text.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/splitting_named.hpp"
#include "recipes.hpp"
#include "step_control.hpp"

namespace hamflow {

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
    // Tables by order and cost, then the rest. Each is described once: a description reads the coefficients of its
    // table, and the list is made at every start of the command.
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
              std::to_string(names.size() - first.size()) + " others (hamflow list methods)" + suggestion(name, names));
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

std::string hint_after_divergence(const MethodSpec& spec) {
  const MethodFamily& family = *find_method(spec.name).family;
  return family.hint ? family.hint(spec.options) : std::string(hint(Outcome::not_converged));
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
