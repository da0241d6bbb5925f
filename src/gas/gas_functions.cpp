#include "gas_functions_of.hpp"

namespace hamflow {
#define HAMFLOW_GAS(R)                                                             \
  template Gas<R> make_gas<R>(const GasShape&, const Parameters<R>&, std::size_t); \
  template ErasedFunctions<R> gas_functions<R>(const GasShape&, const Parameters<R>&, std::size_t);
HAMFLOW_GAS(long double)
HAMFLOW_GAS(DoubleDouble)
HAMFLOW_GAS(Quad)
HAMFLOW_GAS(Mp)
#undef HAMFLOW_GAS
}  // namespace hamflow
