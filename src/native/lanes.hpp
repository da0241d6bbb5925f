// A program for lanes, in parts: what is done once, what is done in every step, several registers to a number.
#pragma once

#include "machine_code.hpp"
#include "numerics/program_lanes.hpp"

namespace hamflow::native {

struct LaneProgram {
  Program step;  // simplified; its constants from `uniform` on differ from lane to lane
  std::size_t uniform = 0;
  /// What follows from constants alone is computed once: one step of `before`, which carries all constants that differ,
  /// the first `given` of them as the caller gives them.
  Program before;
  std::size_t given = 0;
};

/// @param differs of each constant whether members have their own
LaneProgram lane_program(const Program& program, std::span<const bool> differs);

/// The step for numbers of `registers` registers: value k becomes the values k registers .. k registers + registers -
/// 1, and so do checks and the constants that differ. `chunk` operations of one register follow one another before
/// those of the next: few registers then live at a time, and the processor sees far enough to work on all.
Program interleaved(const LaneProgram& program, std::size_t registers, std::size_t chunk);

/// Registers of this processor for lanes; 0 where it does not have their instructions.
unsigned lane_registers(LaneSet lanes);

/// As `assembled`, for lanes; constants from `uniform` on are read from the array `varying`.
std::unique_ptr<const Function> assembled_lanes(const PlacedProgram& program, const std::vector<double>& constants,
                                                std::size_t uniform, std::size_t registers, LaneSet lanes);

/// Repeats a program on arrays, operation by operation; constants from `uniform` on are read from `varying`.
/// @param lanes how many numbers each is; a multiple of 4   @return how many steps were taken
std::int64_t interpret_lanes(const Program& program, std::size_t uniform, std::size_t lanes, double* carried,
                             const double* varying, std::int64_t steps, bool* failed);

}  // namespace hamflow::native
