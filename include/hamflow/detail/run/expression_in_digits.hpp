// An expression of a state (detail/run/state_expression.hpp) in the digits of a run with more digits than double.
#pragma once

#include <functional>
#include <string>

#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/run/catalog.hpp"

namespace hamflow {

/// An expression, evaluated with the digits of the present MpDigits scope.
using ExpressionInDigits = std::function<Mp(const FrameDigits&)>;

/// @param parameters complete   @param size of q   @throws Error as StateExpression does
ExpressionInDigits expression_in_digits(const std::string& text, const ProblemEntry& problem, const Texts& parameters,
                                        std::size_t size);

}  // namespace hamflow
