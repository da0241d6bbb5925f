// Recorded steps without machine code: in place of the assemblers of src/native. Every program is interpreted.
#include "native/lanes.hpp"
#include "native/machine_code.hpp"

namespace hamflow::native {

unsigned scalar_registers() { return 0; }
unsigned lane_registers(LaneSet) { return 0; }
bool needs_masks(const Program&) { return false; }
std::unique_ptr<const Function> assembled(const PlacedProgram&, const std::vector<double>&) { return nullptr; }
std::unique_ptr<const Function> assembled_lanes(const PlacedProgram&, const std::vector<double>&, std::size_t,
                                                std::size_t, LaneSet) {
  return nullptr;
}

}  // namespace hamflow::native
