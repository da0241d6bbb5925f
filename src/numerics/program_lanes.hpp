// The steps of many members of a family at once, one in each SIMD lane: their programs are the same but for some
// constants. Every lane has the bits of the member run alone.
#pragma once

#include "hamflow/detail/numerics/lane_set.hpp"
#include "hamflow/detail/numerics/program.hpp"
#include "lane_numbers.hpp"

namespace hamflow {

/// How many steps are asked for at a time.
enum class StepsOfLoop { many, one };

/// A program made runnable for lanes() members. One object may be run by several threads at once.
class LaneLoop {
 public:
  virtual ~LaneLoop() = default;
  virtual std::size_t lanes() const = 0;
  /// What every run of the same members needs of their constants.
  /// @param constants of the j-th constant that differs, in the program's order, in lane i at j lanes() + i
  virtual LaneNumbers prepared(std::span<const double> constants) const = 0;
  /// Repeats the program `steps` times in every lane.
  /// @param carried values() x lanes() numbers, in place: of value k in lane i at k lanes() + i   @param constants
  /// prepared
  /// @param failed lanes() flags; set where a check fails at any step, never cleared. What such a lane carries is
  /// undefined, all others go on
  /// @return how many steps were taken: fewer where the program ends by itself in any lane (Program::ends_at)
  virtual std::int64_t run(LaneNumbers& carried, const LaneNumbers& constants, std::int64_t steps,
                           std::span<bool> failed) const = 0;
};

/// Machine code of 16 (avx2) or 32 lanes (avx512) where `lanes` asks for it, processor and system allow it and
/// HAMFLOW_NATIVE is not 0; else interpreted, as many lanes. generic: 16 lanes, interpreted.
/// @param registers to a number: with fewer than four there are so many fewer lanes. Four hide what waits in programs
/// that are one chain; long programs of many chains are better off with one
/// @param differs of each constant of the program whether members have their own
/// @param steps one: run() is called with one step only
/// @throws std::invalid_argument unless `differs` has a flag for every constant; for LaneSet::none
std::unique_ptr<const LaneLoop> make_lane_loop(const Program& program, std::span<const bool> differs, LaneSet lanes,
                                               std::size_t registers = 4, StepsOfLoop steps = StepsOfLoop::many);
/// The widest lanes that machine code can have here; generic: none.
LaneSet widest_native_lanes();

}  // namespace hamflow
