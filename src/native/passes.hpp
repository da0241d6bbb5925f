// From program to program, every bit kept: what is known is computed, what is written twice or never used goes.
#pragma once

#include "hamflow/detail/numerics/program.hpp"

namespace hamflow::native {

/// The program without what nothing depends on, with operations on constants done, with equal operations as one, with
/// negations in the sums, products and quotients that they meet. Only NaN's payloads may differ.
Program simplified(const Program& program);

/// Where a program has the sine and the cosine of one number, they become one call, where the first of them stands.
Program with_both(const Program& program);

/// The same operations in an order in which long chains begin early (list scheduling by height, window of `window`
/// operations). Constants, outputs and checks keep their meaning.
Program scheduled(const Program& program, std::size_t window = 64);

}  // namespace hamflow::native
