#include "erased_simulation.hpp"

namespace hamflow {
std::unique_ptr<Simulation> simulate_recorded(const ErasedRun<double>& run, const Request& request) {
  return simulate_half<double, true>(run, request);
}
}  // namespace hamflow
