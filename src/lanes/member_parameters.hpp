// The parameters of a member of an ensemble.
#pragma once

#include "hamflow/run/ensemble.hpp"

namespace hamflow {

inline Parameters<double> parameters_of(const ParameterShape& shape, const std::vector<double>& numbers) {
  Parameters<double> parameters;
  std::size_t at = 0;
  for (const auto& [name, size] : shape) {
    const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(at);
    parameters.set_list(name, {first, first + static_cast<std::ptrdiff_t>(size)});
    at += size;
  }
  return parameters;
}

}  // namespace hamflow
