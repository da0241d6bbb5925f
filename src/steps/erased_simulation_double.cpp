#include "erased_simulation.hpp"

namespace hamflow {
template std::unique_ptr<Simulation> simulate_erased<double>(const ErasedRun<double>&, const Request&);
}  // namespace hamflow
