// Problems of the catalogue in Cartesian coordinates with constraints. Their Hamiltonians are texts, as those of the
// problem `formula` are: nothing is instantiated for them but their charts.   (docs/design/constraints.md)
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hamflow/detail/run/digits.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// Each in both forms.
std::vector<ProblemEntry> constrained_problems();

/// Changes of coordinates in an arithmetic beyond double, as ErasedEntry has them.
struct DigitCharts {
  std::function<DigitState(const std::string& arithmetic, const DigitState&)> to_reference{};
  std::function<DigitState(const std::string& arithmetic, const DigitState&)> from_reference{};
};
/// Of an entry of constrained_problems(); empty where it has no other chart.
DigitCharts constrained_digit_charts(const ProblemEntry& entry, const Texts& parameters);

}  // namespace hamflow
