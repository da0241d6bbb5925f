// Symplectic Euler, p first: p1 = p0 - h V'(q0), q1 = q0 + h T'(p1).   [Sonnleitner2010, p. 34; HLW2006, I.(1.9)]
// Order 1, one force evaluation per step, symplectic; its adjoint is euler-a.
#pragma once

#include "hamflow/methods/tables.hpp"

namespace hamflow::splittings {

inline constexpr SplittingTable euler_b{.name = "euler-b",
                                        .order = 1,
                                        .reference = "Sonnleitner2010, p. 34; HLW2006, I.(1.9)",
                                        .starts_with = StartsWith::kick,
                                        .coefficients = {"1", "1"}};

}  // namespace hamflow::splittings
