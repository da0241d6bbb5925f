#include "hamflow/core/operation.hpp"

#include <array>

namespace hamflow {

std::span<const NamedFunction> named_functions() {
#define HAMFLOW_ROW(name, symmetry, rule, series) NamedFunction{#name, Operation::name},
  static constexpr std::array all{NamedFunction{"sqrt", Operation::sqrt},
                                  HAMFLOW_FUNCTIONS(HAMFLOW_ROW) NamedFunction{"atan2", Operation::atan2},
                                  NamedFunction{"abs", Operation::abs}};
#undef HAMFLOW_ROW
  return all;
}

const Operation* find_function(std::string_view name) {
  for (const NamedFunction& function : named_functions()) {
    if (function.name == name) return &function.operation;
  }
  return nullptr;
}

}  // namespace hamflow
