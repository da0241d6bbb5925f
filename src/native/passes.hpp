// Optimisations of programs that keep every bit: they fold constants, and remove duplicate and unused operations.
#pragma once

#include "hamflow/detail/numerics/program.hpp"

namespace hamflow::native {

/// Removes unused operations, folds constants, merges equal operations, and moves negations into sums, products and
/// quotients. Only payloads of NaN may change.
Program simplified(const Program& program);

/// Replaces the sine and the cosine of the same number by one call, at the place of the first of them.
Program with_both(const Program& program);

/// Reorders operations so that long chains begin early: list scheduling by height, in a window of `window` operations.
/// Constants, outputs and checks keep their meaning.
Program scheduled(const Program& program, std::size_t window = 64);

}  // namespace hamflow::native
