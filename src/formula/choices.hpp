// Converts the choices of a typed problem to its texts, without checks.
#pragma once

#include "hamflow/formula/problem_texts.hpp"

namespace hamflow::formula {

Choices choices_of(const FormulaTexts& texts);

}  // namespace hamflow::formula
