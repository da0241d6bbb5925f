// Two numbers in one register.
#pragma once

#include "hamflow/core/math.hpp"

namespace hamflow {

/// Sums, products, quotients and roots of a pair have the bits of two separate operations.
using Two = double __attribute__((vector_size(16)));
inline Two sqrt(Two x) { return Two{std::sqrt(x[0]), std::sqrt(x[1])}; }

}  // namespace hamflow
