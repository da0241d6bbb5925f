#include "erased_simulation.hpp"

namespace hamflow {
template std::unique_ptr<Simulation> simulate_erased<DoubleDouble>(const ErasedRun<DoubleDouble>&, const Request&);
}  // namespace hamflow
