#include "hamflow/detail/core/operation.hpp"

#include <vector>

namespace hamflow {

std::span<const NamedFunction> named_functions() {
  static const std::vector<NamedFunction> all = [] {
    std::vector<NamedFunction> names{{"sqrt", Operation::sqrt}};
    const auto add = [&](NamedFunction function) {
      names.push_back(function);
      if (function.operation == Operation::atan) names.push_back({"atan2", Operation::atan2});
    };
#define HAMFLOW_ROW(name, symmetry, rule, series) add({#name, Operation::name});
    HAMFLOW_FUNCTIONS(HAMFLOW_ROW)
#undef HAMFLOW_ROW
    add({"abs", Operation::abs});
    return names;
  }();
  return all;
}

const Operation* find_function(std::string_view name) {
  for (const NamedFunction& function : named_functions()) {
    if (function.name == name) return &function.operation;
  }
  return nullptr;
}

}  // namespace hamflow
