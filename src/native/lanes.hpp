// Programs for lanes. A program is split into a part that runs once and a part that runs in every step, and each value
// can take several registers.
#pragma once

#include "machine_code.hpp"
#include "numerics/program_lanes.hpp"

namespace hamflow::native {

struct LaneProgram {
  Program step;  // simplified; its constants from `uniform` on differ between lanes
  std::size_t uniform = 0;
  /// Computes results that depend only on constants. One step of `before` runs once; it carries all constants that
  /// differ, and the caller sets the first `given` of them.
  Program before;
  std::size_t given = 0;
};

/// @param differs for each constant, whether it differs between members
LaneProgram lane_program(const Program& program, std::span<const bool> differs);

/// Replicates a step for values of `registers` registers. Value k becomes the values k registers .. k registers +
/// registers - 1, and likewise checks and constants that differ. `chunk` operations of one register are followed by
/// those of the next. Then few values are live at a time, and the processor can still overlap the registers.
Program interleaved(const LaneProgram& program, std::size_t registers, std::size_t chunk);

/// The number of vector registers of this processor for lanes; 0 if it does not have the instructions.
unsigned lane_registers(LaneSet lanes);

/// As assembled(), for lanes. Constants from `uniform` on are read from the array `varying`.
std::unique_ptr<const Function> assembled_lanes(const PlacedProgram& program, const std::vector<double>& constants,
                                                std::size_t uniform, std::size_t registers, LaneSet lanes);

/// The step as machine code with `registers` registers per value; null if there is none, or it is not enabled.
std::unique_ptr<const Function> lane_function(const LaneProgram& program, std::size_t registers, LaneSet lanes,
                                              StepsOfLoop steps);

/// Interprets a program on arrays, operation by operation. Constants from `uniform` on are read from `varying`.
/// @param lanes the length of each array, a multiple of 4   @return the number of steps taken
std::int64_t interpret_lanes(const Program& program, std::size_t uniform, std::size_t lanes, double* carried,
                             const double* varying, std::int64_t steps, bool* failed);

}  // namespace hamflow::native
