#include "gas_functions_of.hpp"

namespace hamflow {
template Gas<double> make_gas<double>(const GasShape&, const Parameters<double>&, std::size_t);
template ErasedFunctions<double> gas_functions<double>(const GasShape&, const Parameters<double>&, std::size_t);
}  // namespace hamflow
