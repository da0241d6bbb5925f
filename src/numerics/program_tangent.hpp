// Differentiates a recorded step, operation by operation, like dual numbers but without the problem.
// [GriewankWalther2008, ch. 3]
#pragma once

#include <optional>
#include <span>

#include "hamflow/detail/numerics/program.hpp"

namespace hamflow {

/// The program that carries tangent vectors as well: first the values of `program`, then for each vector the slopes of
/// the values that `moves` flags, in their order.
/// @param moves one flag for each value @return nullopt if an operation that depends on these values cannot be
/// differentiated (|x|, the larger of two)
std::optional<Program> with_tangents(const Program& program, std::span<const bool> moves, std::size_t vectors);

}  // namespace hamflow
