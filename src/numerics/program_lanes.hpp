// Steps of many members at once, one in each SIMD lane. Their programs differ only in constants. Every lane has the
// bits of a separate run of its member.
#pragma once

#include "hamflow/detail/numerics/lane_set.hpp"
#include "hamflow/detail/numerics/program.hpp"
#include "lane_numbers.hpp"

namespace hamflow {

/// The number of steps requested per call.
enum class StepsOfLoop { many, one };

/// A runnable program for lanes() members. Several threads may run one object at once.
class LaneLoop {
 public:
  virtual ~LaneLoop() = default;
  virtual std::size_t lanes() const = 0;
  /// Prepares the constants of members for all of their runs.
  /// @param constants of the j-th constant that differs, in the program's order, in lane i at j lanes() + i
  virtual LaneNumbers prepared(std::span<const double> constants) const = 0;
  /// Repeats the program `steps` times in every lane.
  /// @param carried values() x lanes() numbers, changed in place; value k of lane i is at index k lanes() + i
  /// @param constants the prepared constants
  /// @param failed lanes() flags; set if a check fails at any step, never cleared. The values of such a lane are
  /// undefined; all other lanes continue
  /// @return the number of steps taken: fewer if the program ends by itself in any lane (Program::ends_at)
  virtual std::int64_t run(LaneNumbers& carried, const LaneNumbers& constants, std::int64_t steps,
                           std::span<bool> failed) const = 0;
};

/// Makes machine code for 16 (avx2) or 32 (avx512) lanes, if the processor and the system allow it and HAMFLOW_NATIVE
/// is not 0; otherwise the same number of lanes is interpreted. generic: 16 interpreted lanes.
/// @param registers per number; with fewer than four there are correspondingly fewer lanes. Four registers hide
/// latencies in programs with one chain of operations; for long programs with many chains one is better
/// @param differs for each constant of the program whether it differs between members
/// @param steps one: run() is called with one step only
/// @throws std::invalid_argument unless `differs` has a flag for every constant; for LaneSet::none
std::unique_ptr<const LaneLoop> make_lane_loop(const Program& program, std::span<const bool> differs, LaneSet lanes,
                                               std::size_t registers = 4, StepsOfLoop steps = StepsOfLoop::many);
/// The widest lanes for which machine code is possible here; generic if none.
LaneSet widest_native_lanes();

}  // namespace hamflow
