#include "erased_simulation.hpp"

namespace hamflow {
template std::unique_ptr<Simulation> simulate_erased<Mp>(const ErasedRun<Mp>&, const Request&);
}  // namespace hamflow
