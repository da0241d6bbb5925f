// Keys of a start, whose names the problems declare.
#pragma once

#include <string>
#include <vector>

#include "hamflow/detail/core/option_info.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// A number of a start, which has no range of its own: its conditions are judged together.
inline OptionInfo number_key(const std::string& name) { return {.name = name}; }
inline OptionInfo kind_key(const std::vector<std::string>& kinds) {
  return {.name = "kind", .type = OptionType::word, .words = kinds};
}
inline OptionInfo list_key(const std::string& name, std::size_t length) {
  return {.name = name, .type = OptionType::list, .length = length, .required = true};
}
/// p or v of a state, of which one component may be left to the energy.
inline OptionInfo open_list_key(const std::string& name, std::size_t length) {
  return {.name = name, .type = OptionType::list, .length = length, .words = {largest_root, smallest_root}};
}

}  // namespace hamflow
