// The arithmetics that this build has, out of a list.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "hamflow/detail/arithmetic/number_types.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow::test {

/// A portable build has neither quad nor mp(d).
inline std::vector<std::string> present(std::vector<std::string> names) {
  std::erase_if(
      names, [](const std::string& name) { return !has_quad_and_mp && (name == "quad" || name.starts_with("mp(")); });
  return names;
}

}  // namespace hamflow::test
