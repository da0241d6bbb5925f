#pragma once
#include <string>
#include <vector>
namespace hamflow {
inline const std::vector<std::string>& figure_names() {
  static const std::vector<std::string> names{"orbit", "energy", "energy-error", "phase", "condition", "section"};
  return names;
}
}  // namespace hamflow
