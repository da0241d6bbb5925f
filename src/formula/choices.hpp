// The texts of a typed problem as choices, unchecked.
#pragma once

#include "hamflow/formula/problem_texts.hpp"

namespace hamflow::formula {

Choices choices_of(const FormulaTexts& texts);

}  // namespace hamflow::formula
