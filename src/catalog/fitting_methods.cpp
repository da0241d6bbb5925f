#include "hamflow/detail/run/fitting_methods.hpp"

namespace hamflow {

std::string fitting_methods(std::initializer_list<std::string_view> candidates, const ProblemEntry* problem,
                            const std::string& arithmetic) {
  constexpr int most = 3;
  std::string all;
  int count = 0;
  for (const std::string_view name : candidates) {
    const MethodSpec method{.name = std::string(name)};
    if (count == most || !refusal(method, arithmetic).empty()) continue;
    if (problem != nullptr && !problem->accepts(method)) continue;
    all += (count++ > 0 ? ", " : "") + method.name;
  }
  return all;
}

std::string or_fitting_method(const std::string& before, const std::string& what,
                              std::initializer_list<std::string_view> candidates, const ProblemEntry* problem,
                              const std::string& arithmetic) {
  const std::string names = fitting_methods(candidates, problem, arithmetic);
  if (names.empty()) return before;
  return before + (before.empty() ? "" : ", or ") + what + ", e.g. " + names;
}

std::string with_fitting_methods(std::initializer_list<std::string_view> candidates, const ProblemEntry* problem,
                                 const std::string& arithmetic) {
  const std::string names = fitting_methods(candidates, problem, arithmetic);
  return names.empty() ? "" : ", e.g. " + names;
}

std::string refusal_with_advice(const MethodSpec& spec, const ProblemEntry* problem, const std::string& arithmetic) {
  const std::string why_not = refusal(spec, arithmetic);
  if (why_not.empty()) return why_not;
  const std::string names = fitting_methods({"stv4", "verlet", "taylor", "rk4", "cg"}, problem, arithmetic);
  return why_not + (names.empty() ? "; allowed another arithmetic: no method accepts this problem in " + arithmetic
                                  : "; allowed another method, e.g. " + names);
}

}  // namespace hamflow
