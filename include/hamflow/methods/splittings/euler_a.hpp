// Symplectic Euler, q first: q1 = q0 + h T'(p0), p1 = p0 - h V'(q1).   [Sonnleitner2010, p. 34; HLW2006, I.(1.9)]
// Order 1, one force evaluation per step, symplectic; its adjoint is euler-b.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable euler_a{.name = "euler-a",
                                        .order = 1,
                                        .reference = "Sonnleitner2010, p. 34; HLW2006, I.(1.9)",
                                        .starts_with = StartsWith::drift,
                                        .coefficients = {"1", "1"}};

}  // namespace hamflow::splittings
