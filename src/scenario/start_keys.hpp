// Keys of a start. The problems declare their names.
#pragma once

#include <string>
#include <vector>

#include "hamflow/detail/core/option_info.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Key of a number of a start. It has no range, because the conditions on all numbers of a start are checked together.
inline OptionInfo number_key(const std::string& name) { return {.name = name}; }
inline OptionInfo kind_key(const std::vector<std::string>& kinds) {
  return {.name = "kind", .type = OptionType::word, .words = kinds};
}
inline OptionInfo list_key(const std::string& name, std::size_t length) {
  return {.name = name, .type = OptionType::list, .length = length, .required = true};
}
/// Key of p or v of a state. One component may be "+" or "-"; it is then computed from the energy.
inline OptionInfo open_list_key(const std::string& name, std::size_t length) {
  return {.name = name, .type = OptionType::list, .length = length, .words = {largest_root, smallest_root}};
}

}  // namespace hamflow
