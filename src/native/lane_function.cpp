// Machine code for lanes: which registers and which order of operations a program gets.
#include "is_enabled.hpp"
#include "lanes.hpp"
#include "passes.hpp"

namespace hamflow {
namespace native {

namespace {
constexpr std::size_t run_of_one = 32;  // 12 to 40 are similar; with 1 Kepler is 10 %, compensated sums 25 % slower
}

std::unique_ptr<const Function> lane_function(const LaneProgram& program, std::size_t registers, LaneSet lanes,
                                              StepsOfLoop steps) {
  const unsigned available = lane_registers(lanes);
  if (available == 0 || !is_enabled()) return nullptr;
  const Program step = with_both(interleaved(program, registers, run_of_one));
  const unsigned masks = lanes == LaneSet::avx2 && needs_masks(step) ? 1 : 0;
  return assembled_lanes(placed(step, available - masks, steps), step.constants, program.uniform, registers, lanes);
}

}  // namespace native

LaneSet widest_native_lanes() {
  if (!native::is_enabled()) return LaneSet::generic;
  for (const LaneSet set : {LaneSet::avx512, LaneSet::avx2}) {
    if (native::lane_registers(set) > 0) return set;
  }
  return LaneSet::generic;
}

}  // namespace hamflow
