// Keys of a start, whose names the problems declare.
#pragma once

#include <string>
#include <vector>

#include "hamflow/core/option_info.hpp"

namespace hamflow {

/// A number of a start, which has no range of its own: its conditions are judged together.
inline OptionInfo number_key(const std::string& name) { return {.name = name}; }
inline OptionInfo kind_key(const std::vector<std::string>& kinds) {
  return {.name = "kind", .type = OptionType::word, .words = kinds};
}
inline OptionInfo list_key(const std::string& name, std::size_t length) {
  return {.name = name, .type = OptionType::list, .length = length, .required = true};
}

}  // namespace hamflow
