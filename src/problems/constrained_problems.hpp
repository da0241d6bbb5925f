// Problems of the catalogue in Cartesian coordinates with constraints. Their Hamiltonians are texts, as for the problem
// `formula`; only their charts are templates. (docs/design/constraints.md)
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "hamflow/detail/run/digits.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// All problems, in both constraint forms.
std::vector<ProblemEntry> constrained_problems();

/// Changes of coordinates in an arithmetic with more digits than double, as in ErasedEntry.
struct DigitCharts {
  std::function<DigitState(const std::string& arithmetic, const DigitState&)> to_reference{};
  std::function<DigitState(const std::string& arithmetic, const DigitState&)> from_reference{};
};
/// The charts of an entry of constrained_problems(); empty if it has no other chart.
DigitCharts constrained_digit_charts(const ProblemEntry& entry, const Texts& parameters);

}  // namespace hamflow
