#include "erased_simulation.hpp"

namespace hamflow {
std::unique_ptr<Simulation> simulate_recorded(const ErasedRun<double>& run, const Request& request, bool estimated) {
  return simulate_half<double, true>(run, request, estimated);
}
}  // namespace hamflow
