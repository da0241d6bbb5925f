#include "erased_simulation.hpp"

namespace hamflow {
template std::unique_ptr<Simulation> simulate_erased<Quad>(const ErasedRun<Quad>&, const Request&);
}  // namespace hamflow
